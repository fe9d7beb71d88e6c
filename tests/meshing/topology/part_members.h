#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/pants_record.h"

namespace couture::testing {

/// A member of a family of parts, ready to be cut.
struct Member {
    meshing::SurfaceMesh mesh;
    std::vector<std::string> boundary_names;
    meshing::Landmarks landmarks;
};

/// @param is_open  whether its caps are taken off
[[nodiscard]] Member make_member(const std::string& part,
                                 const std::map<std::string, double>& parameters,
                                 double edge_length, bool is_open);

}  // namespace couture::testing
