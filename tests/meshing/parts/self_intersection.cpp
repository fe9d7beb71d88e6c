#include "tests/meshing/parts/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

namespace couture::meshing {

bool intersects_itself(const TriangleSoup& soup) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    for (const Vector3& x : soup.points) {
        points.emplace_back(x.x(), x.y(), x.z());
    }
    std::vector<std::vector<std::size_t>> triangles;
    for (const auto& [a, b, c] : soup.triangles) {
        triangles.push_back({static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                             static_cast<std::size_t>(c)});
    }
    CGAL::Surface_mesh<Kernel::Point_3> mesh;
    CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    return CGAL::Polygon_mesh_processing::does_self_intersect(mesh);
}

}  // namespace couture::meshing
