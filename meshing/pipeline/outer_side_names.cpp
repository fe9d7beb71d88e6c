#include "meshing/pipeline/outer_side_names.h"

#include <algorithm>
#include <set>

#include "iga/core/error.h"
#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

void check_faces(const NamedFaces& faces) {
    const auto n_names = static_cast<int>(faces.names.size());
    if (faces.face_of_triangle.size() != faces.soup.triangles.size()) {
        throw InputError("named faces: {} triangles, but faces of {}", faces.soup.triangles.size(),
                         faces.face_of_triangle.size());
    }
    for (const int face : faces.face_of_triangle) {
        if (face < 0 || face >= n_names) {
            throw InputError("named faces: a triangle belongs to face {}; there are names of {}",
                             face, n_names);
        }
    }
}

TriangleTree make_tree(const TriangleSoup& soup) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [a, b, c] : soup.triangles) {
        triangles.push_back({soup.points[a], soup.points[b], soup.points[c]});
    }
    return TriangleTree(std::move(triangles));
}

}  // namespace

std::map<std::string, std::vector<CuboidSide>> name_outer_sides(const CuboidDecomposition& cuboids,
                                                                const NamedFaces& faces) {
    check_faces(faces);
    std::set<CuboidSide> has_name;
    for (const auto& [name, sides] : cuboids.volume.sets) {
        has_name.insert(sides.begin(), sides.end());
    }
    const TriangleTree tree = make_tree(faces.soup);
    std::vector<std::map<int, double>> area_on(cuboids.sides.size());
    for (const auto face : cuboids.mesh.faces()) {
        const int quad = cuboids.surface.quad_of_face[face.idx()];
        if (has_name.contains(cuboids.sides[quad])) continue;
        Vector3 centre = Vector3::Zero();
        for (const VertexHandle v : face_vertices(cuboids.mesh, face)) {
            centre += cuboids.mesh.point(v) / 3.0;
        }
        const int there = faces.face_of_triangle[tree.nearest(centre).triangle];
        area_on[quad][there] += face_area(cuboids.mesh, face);
    }
    std::map<std::string, std::vector<CuboidSide>> sets;
    for (std::size_t q = 0; q < area_on.size(); ++q) {
        if (area_on[q].empty()) continue;
        const auto most = std::ranges::max_element(area_on[q], {},
                                                   [](const auto& entry) { return entry.second; });
        sets[faces.names[most->first]].push_back(cuboids.sides[q]);
    }
    return sets;
}

}  // namespace couture::meshing
