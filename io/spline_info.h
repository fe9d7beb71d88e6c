#pragma once

#include <string>

#include "io/spline_file.h"

namespace couture::io {

/// What `couture info FILE` prints: format, patches (degrees, elements, control points, rational or
/// not, certificate of the Jacobian's sign with handedness, smallest value and smallest scaled
/// Jacobian), interfaces, outer sides, boundary sets, bounding box, volume, element quality (scaled
/// Jacobian, shape ratio, angle deviation in radians), lists of folded and left-handed patches,
/// signature, notes. Numbers have six digits, the volume twelve.
/// Certificate and quality are left out for surfaces in space.
[[nodiscard]] std::string spline_info_text(const SplineFile& file);

/// The same for machines, with all digits, knots, and the names of interfaces and of the sets'
/// entities: one JSON object, indented by two. An infinite shape ratio is null.
[[nodiscard]] std::string spline_info_json(const SplineFile& file);

}  // namespace couture::io
