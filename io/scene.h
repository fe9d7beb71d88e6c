#pragma once

#include <string>

#include "iga/topology/space.h"
#include "io/picture.h"

namespace couture::io {

/// What is drawn on the shape; everything may be left out.
struct SceneOptions {
    /// Coefficients on the Space's functions, n_dofs x dimension.
    MatrixX displacement;
    /// Factor on the displacement.
    double displacement_scale = 1.0;
    /// Coefficients of the field shown in colours, n_dofs.
    VectorX values;
    /// Quantity and unit.
    std::string legend;
    std::string title;
    /// Triangle pairs per element and direction; 0: enough for smooth curves (a side gets about
    /// 32 per direction).
    int samples = 0;
    /// Thin lines between elements.
    bool element_lines = false;
};

/// The outer sides of volumes, or all patches of surfaces, as triangles, with the edges of the
/// patches as dark lines; without values each patch has a colour of its own. Surfaces in the plane
/// are seen from above.
///
/// @throws InputError  if coefficients have the wrong size, or samples are negative
template <int d>
[[nodiscard]] Scene make_scene(const iga::Space<d>& space, const SceneOptions& options = {});

}  // namespace couture::io
