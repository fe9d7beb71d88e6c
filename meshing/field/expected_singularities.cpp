#include "meshing/field/expected_singularities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/surface/curvature.h"
#include "meshing/surface/curvature_clusters.h"

namespace couture::meshing {

namespace {

constexpr double quarter = 0.5 * std::numbers::pi;

// Puts singularities on vertices, each far from those before.
class Spread {
  public:
    explicit Spread(const SurfaceMesh& mesh)
        : mesh_(mesh), curvature_(gaussian_curvature(mesh)), is_taken_(mesh.n_vertices(), false) {}

    void add(const std::vector<int>& vertices, int quarter_turns) {
        const int sign = quarter_turns > 0 ? 1 : -1;
        std::vector<double> near(mesh_.n_vertices(), std::numeric_limits<double>::infinity());
        for (int k = 0; k < std::abs(quarter_turns); ++k) {
            int best = -1;
            for (const int v : vertices) {
                if (!is_taken_[v] && (best < 0 || is_better(v, best, sign, near))) best = v;
            }
            if (best < 0) {
                throw TopologyError(
                    "expected_singularities: {} quarter turns for {} vertices; each singularity "
                    "needs a vertex of its own: refine the mesh",
                    quarter_turns, vertices.size());
            }
            singularities.push_back({best, sign});
            for (const VertexHandle v : mesh_.vertices()) {
                const double d = (mesh_.point(v) - mesh_.point(VertexHandle(best))).norm();
                near[v.idx()] = std::min(near[v.idx()], d);
            }
            is_taken_[best] = true;
        }
    }

    std::vector<Singularity> singularities;

  private:
    [[nodiscard]] bool is_better(int v, int than, int sign, const std::vector<double>& near) const {
        if (near[v] != near[than]) return near[v] > near[than];
        return sign * curvature_[v] > sign * curvature_[than];
    }

    const SurfaceMesh& mesh_;
    std::vector<double> curvature_;
    std::vector<bool> is_taken_;
};

}  // namespace

ExpectedSingularities expected_singularities(const SurfaceMesh& mesh) {
    ExpectedSingularities expected;
    const auto geodesic = geodesic_curvature(mesh);
    int given = 0;
    for (const BoundaryLoop& loop : boundary_loops(mesh)) {
        int turns = 0;
        for (const VertexHandle v : loop.vertices) {
            const int at_corner = static_cast<int>(std::lround(geodesic[v.idx()] / quarter));
            turns += at_corner;
            expected.residual += geodesic[v.idx()] - quarter * at_corner;
        }
        expected.boundary_turns.push_back(turns);
        given += turns;
    }
    const auto is_inner = [&](int v) {
        return !mesh.is_isolated(VertexHandle(v)) && !mesh.is_boundary(VertexHandle(v));
    };
    const auto gaussian = gaussian_curvature(mesh);
    Spread spread(mesh);
    std::vector<int> all;
    for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
        if (is_inner(v)) all.push_back(v);
    }
    for (const double curvature : gaussian) expected.residual += curvature;
    for (const CurvatureCluster& cluster : find_curvature_clusters(mesh).clusters) {
        std::vector<int> inner;
        double curvature = 0.0;
        for (const int v : cluster.vertices) {
            if (!is_inner(v)) continue;
            inner.push_back(v);
            curvature += gaussian[v];
        }
        const int turns = static_cast<int>(std::lround(curvature / quarter));
        spread.add(inner, turns);
        given += turns;
        expected.residual -= quarter * turns;
    }
    expected.n_missing = 4 * compute_invariants(mesh).euler_characteristic - given;
    spread.add(all, expected.n_missing);
    expected.singularities = std::move(spread.singularities);
    std::ranges::sort(expected.singularities);
    return expected;
}

}  // namespace couture::meshing
