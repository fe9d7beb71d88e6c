#pragma once

#include <string>
#include <string_view>

#include "io/raw_splines.h"

namespace couture::io {

/// Reads a GeoPDEs text file, version 2.0 or 2.1 (control points multiplied by their weights;
/// interfaces with the flag for swapped directions and the two senses). Boundaries become sets: the
/// name in parentheses, where letters, digits and `. _ + -` stay and every run of other characters
/// becomes one `_` ("x = 0" is x_0), else `boundary_n`. Subdomains are left out.
///
/// @throws FileError  with file and line
[[nodiscard]] RawSplines read_geopdes_text(const std::string& file, std::string_view text);

/// The multipatch as GeoPDEs text 2.1, all patches in one subdomain.
///
/// @throws InputError  if a boundary set holds edges or corners
template <int d>
[[nodiscard]] std::string to_geopdes_text(const iga::MultiPatch<d>& multipatch);

/// The rule for names given above.
[[nodiscard]] std::string to_set_name(std::string_view text);

}  // namespace couture::io
