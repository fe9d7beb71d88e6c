#include "meshing/pipeline/volume_distance.h"

#include <algorithm>
#include <functional>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/pipeline/rounded_edges.h"
#include "meshing/surface/surface_distance.h"
#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

// The spline over a quad of the layout: s runs from its corner 0 to 1, t from 0 to 3, both from 0
// to 1.
struct QuadSpline {
    std::function<Vector3(double, double)> point;
    std::array<int, 2> n_elements{};
};

// Parameters of corner i of a patch.
template <int d>
Vector<d> corner_parameters(const iga::Patch<d>& patch, int i) {
    Vector<d> xi;
    for (int k = 0; k < d; ++k) {
        const auto& knots = patch.knots(k).breakpoints();
        xi[k] = (i >> k & 1) != 0 ? knots.back() : knots.front();
    }
    return xi;
}

// The spline over a quad whose corners, going round, are those of a patch.
template <int d>
QuadSpline spline_of(const iga::Patch<d>& patch, const std::array<int, 4>& corners) {
    const auto n_along = [&](int from, int to) {
        for (int k = 0; k < d; ++k) {
            if (((from ^ to) >> k & 1) != 0) return patch.knots(k).n_elements();
        }
        return 1;
    };
    const Vector<d> start = corner_parameters(patch, corners[0]);
    const Vector<d> along_s = corner_parameters(patch, corners[1]) - start;
    const Vector<d> along_t = corner_parameters(patch, corners[3]) - start;
    return {[&patch, start, along_s, along_t](double s, double t) {
                return Vector3(patch.point(start + s * along_s + t * along_t));
            },
            {n_along(corners[0], corners[1]), n_along(corners[0], corners[3])}};
}

void add_triangles(const QuadSpline& spline, int n_samples, std::vector<SpaceTriangle>& triangles) {
    const int n_s = n_samples * spline.n_elements[0];
    const int n_t = n_samples * spline.n_elements[1];
    std::vector<Vector3> points;
    for (int j = 0; j <= n_t; ++j) {
        for (int i = 0; i <= n_s; ++i) {
            points.push_back(
                spline.point(static_cast<double>(i) / n_s, static_cast<double>(j) / n_t));
        }
    }
    for (int j = 0; j < n_t; ++j) {
        for (int i = 0; i < n_s; ++i) {
            const auto a = static_cast<std::size_t>(j) * (n_s + 1) + i;
            const auto d = a + n_s + 1;
            triangles.push_back({points[a], points[a + 1], points[d + 1]});
            triangles.push_back({points[a], points[d + 1], points[d]});
        }
    }
}

// Side k, from corner k to the next.
void add_segments(const QuadSpline& spline, int k, int n_samples,
                  std::vector<SpaceTriangle>& segments) {
    constexpr double corners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    const int n = n_samples * spline.n_elements[k % 2];
    Vector3 before = spline.point(corners[k][0], corners[k][1]);
    for (int i = 1; i <= n; ++i) {
        const double part = static_cast<double>(i) / n;
        const Vector3 x = spline.point((1.0 - part) * corners[k][0] + part * corners[k + 1][0],
                                       (1.0 - part) * corners[k][1] + part * corners[k + 1][1]);
        segments.push_back({before, x, x});
        before = x;
    }
}

// The element of a spline that one of its add_triangles is on.
std::array<int, 2> element_of(const QuadSpline& spline, int n_samples, int triangle) {
    const int n_s = n_samples * spline.n_elements[0];
    const int cell = triangle / 2;
    return {cell % n_s / n_samples, cell / n_s / n_samples};
}

// The largest from the ends and middles of the edges of the mesh on rounded edges. A length.
double distance_of_rounded_edges(const CuboidDecomposition& cuboids,
                                 const std::vector<SpaceTriangle>& splines) {
    const std::vector<RoundedEdge> rounded = find_rounded_edges(cuboids);
    if (rounded.empty()) return 0.0;
    const TriangleTree tree(splines);
    const SurfaceMesh& mesh = cuboids.mesh;
    double largest = 0.0;
    for (const RoundedEdge& one : rounded) {
        for (const EdgeHandle edge : one.edges) {
            const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
            for (const Vector3& x :
                 {mesh.point(mesh.from_vertex_handle(h)), mesh.point(mesh.to_vertex_handle(h)),
                  mesh.calc_edge_midpoint(edge)}) {
                largest = std::max(largest, std::sqrt(tree.nearest(x).squared_distance));
            }
        }
    }
    return largest;
}

// The largest length of each of n groups, over the diagonal.
std::vector<double> largest_of(const std::vector<double>& lengths, const std::vector<int>& groups,
                               int n, double diagonal) {
    std::vector<double> largest(n, 0.0);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        largest[groups[i]] = std::max(largest[groups[i]], lengths[i] / diagonal);
    }
    return largest;
}

VolumeDistance distance_of(const std::vector<QuadSpline>& splines,
                           const CuboidDecomposition& cuboids, int n_samples) {
    if (n_samples < 1) throw InputError("volume_distance: {} samples per element", n_samples);
    std::vector<SpaceTriangle> triangles;
    std::vector<SpaceTriangle> segments;
    std::vector<int> quads;
    std::vector<int> arcs;
    const QuadLayout& layout = cuboids.surface.layout;
    for (int q = 0; q < layout.n_quads(); ++q) {
        add_triangles(splines[q], n_samples, triangles);
        quads.resize(triangles.size(), q);
        for (int k = 0; k < 4; ++k) {
            const QuadLayout::Side& arc = layout.sides(q)[k];
            if (!arc.is_forward || !cuboids.surface.is_feature_arc[arc.arc]) continue;
            add_segments(splines[q], k, n_samples, segments);
            arcs.resize(segments.size(), arc.arc);
        }
    }
    const double diagonal = bounding_box_diagonal(cuboids.mesh);
    VolumeDistance distance;
    const std::vector<double> distances = triangle_distances(triangles, triangles_of(cuboids.mesh));
    distance.of_quads = largest_of(distances, quads, layout.n_quads(), diagonal);
    auto first = distances.begin();
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto last = first + std::ranges::count(quads, q);
        const auto worst = std::max_element(first, last) - first;
        distance.worst_elements.push_back(
            element_of(splines[q], n_samples, static_cast<int>(worst)));
        first = last;
    }
    distance.surface = std::ranges::max(distance.of_quads);
    distance.rounded = distance_of_rounded_edges(cuboids, triangles) / diagonal;
    std::vector<SpaceTriangle> features;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (!cuboids.surface.is_feature_arc[a]) continue;
        const auto& path = cuboids.surface.arcs[a];
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const Vector3& end = cuboids.mesh.point(path[k + 1]);
            features.push_back({cuboids.mesh.point(path[k]), end, end});
        }
    }
    distance.of_arcs.assign(layout.n_arcs(), 0.0);
    if (!features.empty()) {
        distance.of_arcs =
            largest_of(triangle_distances(segments, features), arcs, layout.n_arcs(), diagonal);
        distance.features = std::ranges::max(distance.of_arcs);
    }
    return distance;
}

}  // namespace

VolumeDistance volume_distance(const iga::MultiPatch<3>& volume, const CuboidDecomposition& cuboids,
                               int n_samples) {
    std::vector<QuadSpline> splines;
    for (const CuboidSide& side : cuboids.sides) {
        splines.push_back(spline_of(volume.patches[side.cuboid], side_corners(side.side)));
    }
    return distance_of(splines, cuboids, n_samples);
}

VolumeDistance volume_distance(const iga::MultiPatch<2>& surfaces,
                               const CuboidDecomposition& cuboids, int n_samples) {
    std::vector<QuadSpline> splines;
    for (const iga::Surface& surface : surfaces.patches) {
        splines.push_back(spline_of(surface, {0, 1, 3, 2}));
    }
    return distance_of(splines, cuboids, n_samples);
}

}  // namespace couture::meshing
