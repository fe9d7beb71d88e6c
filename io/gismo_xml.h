#pragma once

#include <string>
#include <string_view>

#include "io/raw_splines.h"

namespace couture::io {

/// Reads the geometries (TensorBSpline, TensorNurbs; 2 or 3 parameters) of a G+Smo XML text and its
/// MultiPatch: interface lines `patch side patch side`, direction map, orientation. Without a
/// MultiPatch all geometries are taken. Named `boundary` lists and `bc` entries of boundary
/// conditions become boundary sets: by their name or label, else `dirichlet_0` of type and
/// function.
///
/// @throws FileError  with file and line
[[nodiscard]] RawSplines read_gismo_xml(const std::string& file, std::string_view text);

/// The multipatch as G+Smo XML; boundary sets as named `boundary` lists, the other outer sides in a
/// list without name.
///
/// @throws InputError  if a boundary set holds edges or corners
template <int d>
[[nodiscard]] std::string to_gismo_xml(const iga::MultiPatch<d>& multipatch);

}  // namespace couture::io
