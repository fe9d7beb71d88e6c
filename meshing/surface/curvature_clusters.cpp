#include "meshing/surface/curvature_clusters.h"

#include <cmath>
#include <numbers>

#include "iga/core/disjoint_sets.h"
#include "meshing/surface/curvature.h"

namespace couture::meshing {

namespace {

constexpr double quarter = 0.5 * std::numbers::pi;

// -1, 0, 1: saddle, flat, bump.
std::vector<int> signs_of_curvature(const SurfaceMesh& mesh) {
    constexpr double flat = 4.0;
    const double diagonal = bounding_box_diagonal(mesh);
    std::vector<int> signs;
    for (const PrincipalCurvatures& k : principal_curvatures(mesh, {.crosses_features = true})) {
        const double scaled = k.gaussian() * diagonal * diagonal;
        signs.push_back(scaled > flat ? 1 : (scaled < -flat ? -1 : 0));
    }
    return signs;
}

}  // namespace

CurvatureClusters find_curvature_clusters(const SurfaceMesh& mesh) {
    const std::vector<int> signs = signs_of_curvature(mesh);
    DisjointSets joined(mesh.n_vertices());
    for (const auto edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const int v = mesh.from_vertex_handle(h).idx();
        const int w = mesh.to_vertex_handle(h).idx();
        if (signs[v] == signs[w]) joined.join(v, w);
    }
    const auto gaussian = gaussian_curvature(mesh);
    const auto geodesic = geodesic_curvature(mesh);
    CurvatureClusters result;
    std::vector<double> sum(mesh.n_vertices(), 0.0);
    double total = 0.0;
    for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
        const double curvature = gaussian[v] + geodesic[v];
        total += curvature;
        if (signs[v] != 0) sum[joined.find(v)] += curvature;
    }
    // Roots are the smallest vertices.
    std::vector<int> number(mesh.n_vertices(), -1);
    result.cluster_of_vertex.assign(mesh.n_vertices(), -1);
    result.rest = total;
    int quarter_turns = 0;
    for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
        const int root = joined.find(v);
        if (signs[v] == 0 || std::abs(sum[root]) < 0.5 * quarter) continue;
        if (root == v) {
            number[v] = static_cast<int>(result.clusters.size());
            const int turns = static_cast<int>(std::lround(sum[v] / quarter));
            result.clusters.push_back(
                {.vertices = {}, .curvature = sum[v], .quarter_turns = turns});
            result.rest -= sum[v];
            quarter_turns += turns;
        }
        CurvatureCluster& cluster = result.clusters[number[root]];
        cluster.vertices.push_back(v);
        cluster.center += mesh.point(VertexHandle(v));
        result.cluster_of_vertex[v] = number[root];
    }
    for (CurvatureCluster& cluster : result.clusters) {
        cluster.center /= static_cast<double>(cluster.vertices.size());
    }
    result.missing_quarter_turns = static_cast<int>(std::lround(total / quarter)) - quarter_turns;
    return result;
}

}  // namespace couture::meshing
