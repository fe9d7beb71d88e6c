#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/picture.h"

namespace couture::drivers {

/// Values at which all sizes of a part are seen well: the defaults, but for caps, which are moved.
[[nodiscard]] std::map<std::string, double> picture_parameters(const std::string& part);

/// A dimensioned drawing of a part as a surface: a view of the whole with its caps named, and a
/// view or section across each axis that some size is seen along, all of these to one scale.
///
/// @param parameters  by name; those left out take their values of `picture_parameters`. mm.
/// @return rows of views
/// @throws InputError  for an unknown part or parameter, and a value out of range
[[nodiscard]] std::vector<std::vector<io::Scene>> make_part_views(
    const std::string& part, const std::map<std::string, double>& parameters = {});

/// Writes that drawing as PNG.
///
/// @throws  as `make_part_views`; FileError  if it can't be written or pictures can't be made here
void write_part_picture(const std::filesystem::path& path, const std::string& part,
                        const std::map<std::string, double>& parameters = {});

}  // namespace couture::drivers
