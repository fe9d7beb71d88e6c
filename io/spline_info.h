#pragma once

#include <string>

#include "io/spline_file.h"

namespace couture::io {

/// What `couture info FILE` prints: format, patches (degrees, elements, control points, rational or
/// not, certificate of the Jacobian's sign with handedness and smallest value), interfaces, outer
/// sides, boundary sets, volume, element quality, signature, notes. Certificate and quality are
/// left out for surfaces in space.
[[nodiscard]] std::string spline_info_text(const SplineFile& file);

/// The same for machines: one JSON object, indented by two.
[[nodiscard]] std::string spline_info_json(const SplineFile& file);

}  // namespace couture::io
