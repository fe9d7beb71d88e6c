#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>

#include "iga/core/error.h"
#include "meshing/surface/hole_filling.h"

namespace couture::meshing {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The names of members are CGAL's to call: it makes one from three numbers.
struct Corners {
    Corners(int a, int b, int c) : numbers{a, b, c} {}
    std::array<int, 3> numbers;
};

}  // namespace

std::vector<std::array<int, 3>> fill_loop(std::span<const Vector3> loop) {
    if (loop.size() < 3) {
        throw InputError("fill_loop: {} points; a loop has three or more", loop.size());
    }
    if (loop.size() == 3) return {{0, 1, 2}};
    std::vector<Kernel::Point_3> points;
    for (const Vector3& point : loop) points.emplace_back(point.x(), point.y(), point.z());
    std::vector<Corners> found;
    // Of all triangulations, cubic in the number of points: for small loops only.
    constexpr std::size_t longest_for_all = 300;
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, std::back_inserter(found),
        CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
            loop.size() > longest_for_all));
    if (found.size() != loop.size() - 2) return {};
    std::vector<std::array<int, 3>> triangles;
    for (const Corners& corners : found) triangles.push_back(corners.numbers);
    return triangles;
}

}  // namespace couture::meshing
