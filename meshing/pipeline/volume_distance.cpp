#include "meshing/pipeline/volume_distance.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/pipeline/rounded_edges.h"
#include "meshing/surface/surface_distance.h"
#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

// Parameters of corner i of a patch.
Vector3 corner_parameters(const iga::Volume& patch, int i) {
    Vector3 xi;
    for (int d = 0; d < 3; ++d) {
        const auto& knots = patch.knots(d);
        xi[d] = (i >> d & 1) != 0 ? knots.breakpoints().back() : knots.breakpoints().front();
    }
    return xi;
}

// Samples along the edge between two corners: the largest number that its elements ask for.
int n_parts(const iga::Volume& patch, int from, int to, int n_samples) {
    for (int d = 0; d < 3; ++d) {
        if (((from ^ to) >> d & 1) != 0) return n_samples * patch.knots(d).n_elements();
    }
    return n_samples;
}

// Points of an outer side, its corners as side_corners.
void add_side(const iga::Volume& patch, int side, int n_samples,
              std::vector<SpaceTriangle>& triangles) {
    const auto& corners = side_corners(side);
    const int n_s = n_parts(patch, corners[0], corners[1], n_samples);
    const int n_t = n_parts(patch, corners[1], corners[2], n_samples);
    std::array<Vector3, 4> xi;
    for (int k = 0; k < 4; ++k) xi[k] = corner_parameters(patch, corners[k]);
    std::vector<Vector3> points;
    for (int j = 0; j <= n_t; ++j) {
        for (int i = 0; i <= n_s; ++i) {
            const double s = static_cast<double>(i) / n_s;
            const double t = static_cast<double>(j) / n_t;
            points.emplace_back(patch.point(xi[0] + s * (xi[1] - xi[0]) + t * (xi[3] - xi[0])));
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

void add_edge(const iga::Volume& patch, int from, int to, int n_samples,
              std::vector<SpaceTriangle>& segments) {
    const int n = n_parts(patch, from, to, n_samples);
    const Vector3 start = corner_parameters(patch, from);
    const Vector3 way = corner_parameters(patch, to) - start;
    Vector3 before = patch.point(start);
    for (int i = 1; i <= n; ++i) {
        const Vector3 x = patch.point(start + way * i / n);
        segments.push_back({before, x, x});
        before = x;
    }
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

}  // namespace

VolumeDistance volume_distance(const iga::MultiPatch<3>& volume, const CuboidDecomposition& cuboids,
                               int n_samples) {
    if (n_samples < 1) throw InputError("volume_distance: {} samples per element", n_samples);
    std::vector<SpaceTriangle> triangles;
    std::vector<SpaceTriangle> segments;
    std::vector<int> quads;
    std::vector<int> arcs;
    const QuadLayout& layout = cuboids.surface.layout;
    for (int q = 0; q < layout.n_quads(); ++q) {
        const CuboidSide& side = cuboids.sides[q];
        const iga::Volume& patch = volume.patches[side.cuboid];
        add_side(patch, side.side, n_samples, triangles);
        quads.resize(triangles.size(), q);
        const auto& corners = side_corners(side.side);
        for (int k = 0; k < 4; ++k) {
            const QuadLayout::Side& arc = layout.sides(q)[k];
            if (!arc.is_forward || !cuboids.surface.is_feature_arc[arc.arc]) continue;
            add_edge(patch, corners[k], corners[(k + 1) % 4], n_samples, segments);
            arcs.resize(segments.size(), arc.arc);
        }
    }
    const double diagonal = bounding_box_diagonal(cuboids.mesh);
    VolumeDistance distance;
    distance.of_quads = largest_of(triangle_distances(triangles, triangles_of(cuboids.mesh)), quads,
                                   layout.n_quads(), diagonal);
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

}  // namespace couture::meshing
