#include "tests/drivers/remeshed_surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace couture::tests {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

meshing::TriangleSoup remeshed(const meshing::TriangleSoup& soup, double edge_length,
                               unsigned seed) {
    CgalMesh mesh;
    for (const Vector3& x : soup.points) mesh.add_vertex({x.x(), x.y(), x.z()});
    for (const auto& [a, b, c] : soup.triangles) {
        mesh.add_face(CgalMesh::Vertex_index(a), CgalMesh::Vertex_index(b),
                      CgalMesh::Vertex_index(c));
    }
    constexpr int n_iterations = 5;
    CGAL::Polygon_mesh_processing::isotropic_remeshing(
        mesh.faces(), edge_length, mesh,
        CGAL::Polygon_mesh_processing::parameters::number_of_iterations(n_iterations));
    mesh.collect_garbage();

    std::mt19937 random(seed);
    std::vector<int> number(mesh.number_of_vertices());
    std::iota(number.begin(), number.end(), 0);
    std::ranges::shuffle(number, random);
    meshing::TriangleSoup result;
    result.points.resize(number.size());
    for (const auto vertex : mesh.vertices()) {
        const auto& x = mesh.point(vertex);
        result.points[number[vertex]] = Vector3(x.x(), x.y(), x.z());
    }
    for (const auto face : mesh.faces()) {
        std::array<int, 3> triangle{};
        int k = 0;
        for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
            triangle[k++] = number[vertex];
        }
        result.triangles.push_back(triangle);
    }
    std::ranges::shuffle(result.triangles, random);
    return result;
}

}  // namespace couture::tests
