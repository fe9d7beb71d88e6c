#pragma once

#include "io/picture.h"

class vtkRenderer;

namespace couture::io {

/// Adds triangles, coloured by their values if they have some.
///
/// @param range  values at the ends of the colour map
void add_surface(vtkRenderer& renderer, const SurfacePiece& piece,
                 const std::array<double, 2>& range);

/// @param scale  pixels for each of the width's
void add_curve(vtkRenderer& renderer, const CurvePiece& piece, double scale);

}  // namespace couture::io
