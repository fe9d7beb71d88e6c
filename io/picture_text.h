#pragma once

#include <string>

#include "io/picture.h"

class vtkRenderer;

namespace couture::io {

/// Height of text at 900 pixels of picture height.
constexpr double text_size = 19.0;
/// Part of the width that the colour bar takes.
constexpr double legend_width = 0.16;

/// @param size  pixels of its letters
void add_label(vtkRenderer& renderer, const Label& label, double size);

/// Puts text at pixel (x, y); vertically centred there.
void add_text(vtkRenderer& renderer, const std::string& text, double size, double x, double y);

/// The colour bar with its ticks and the scene's legend above, on the right.
///
/// @param range  values at the ends of the colour map
/// @param width, height  pixels of the picture
/// @param scale  pixels per pixel of a picture 900 high
void add_legend(vtkRenderer& renderer, const Scene& scene, const std::array<double, 2>& range,
                int width, int height, double scale);

}  // namespace couture::io
