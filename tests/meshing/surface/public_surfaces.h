#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// What the list beside the public surfaces (surfaces/oracle.json) says of one that is an oriented
/// manifold in OFF format.
struct PublicSurface {
    std::string file;
    int n_vertices;
    int genus;
    int n_boundaries;
    int euler_characteristic;
    int n_sharp_edges;
};

[[nodiscard]] const std::vector<PublicSurface>& public_surfaces();

/// Polygons are divided into fans.
[[nodiscard]] TriangleSoup read_off(const std::filesystem::path& path);

/// All public surfaces that are oriented manifolds in one piece, in any format.
[[nodiscard]] const std::vector<std::string>& public_surface_files();

/// A file in OFF, OBJ (its points and faces) or STL format.
[[nodiscard]] TriangleSoup read_surface(const std::filesystem::path& path);

}  // namespace couture::meshing
