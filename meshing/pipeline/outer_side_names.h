#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A closed surface whose triangles belong to named faces.
struct NamedFaces {
    TriangleSoup soup;
    /// For each triangle its place in `names`.
    std::vector<int> face_of_triangle;
    std::vector<std::string> names;
};

/// The outer sides of the cuboids by the face that most of their area lies on, beside the sets that
/// there are: sides in one of those are left out.
///
/// @throws InputError  if triangles don't have a face each, or faces a name
[[nodiscard]] std::map<std::string, std::vector<CuboidSide>> name_outer_sides(
    const CuboidDecomposition& cuboids, const NamedFaces& faces);

}  // namespace couture::meshing
