#include "meshing/pipeline/rounded_edges.h"

#include <limits>
#include <map>
#include <vector>

namespace couture::meshing {

namespace {

// Length and place of edges that are known.
void measure(const SurfaceMesh& mesh, RoundedEdge& rounded) {
    Vector3 sum = Vector3::Zero();
    for (const EdgeHandle edge : rounded.edges) {
        const double length = edge_length(mesh, edge);
        rounded.length += length;
        sum += length * mesh.calc_edge_midpoint(edge);
    }
    const Vector3 centre = sum / rounded.length;
    double least = std::numeric_limits<double>::infinity();
    for (const EdgeHandle edge : rounded.edges) {
        const Vector3 middle = mesh.calc_edge_midpoint(edge);
        const double distance = (middle - centre).norm();
        if (distance >= least) continue;
        least = distance;
        rounded.place = middle;
    }
}

}  // namespace

std::vector<RoundedEdge> find_rounded_edges(const CuboidDecomposition& cuboids) {
    std::vector<bool> is_along_feature(cuboids.mesh.n_edges(), false);
    for (int a = 0; a < cuboids.surface.layout.n_arcs(); ++a) {
        if (!cuboids.surface.is_feature_arc[a]) continue;
        const auto& path = cuboids.surface.arcs[a];
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const HalfedgeHandle h = cuboids.mesh.find_halfedge(path[k], path[k + 1]);
            is_along_feature[cuboids.mesh.edge_handle(h).idx()] = true;
        }
    }
    std::map<int, RoundedEdge> by_curve;
    for (const auto edge : cuboids.mesh.edges()) {
        const auto& data = cuboids.mesh.data(edge);
        if (data.feature < 0 || is_along_feature[edge.idx()]) continue;
        by_curve[data.feature].edges.push_back(edge);
    }
    std::vector<RoundedEdge> result;
    for (auto& [curve, rounded] : by_curve) {
        rounded.curve = curve;
        measure(cuboids.mesh, rounded);
        result.push_back(std::move(rounded));
    }
    return result;
}

}  // namespace couture::meshing
