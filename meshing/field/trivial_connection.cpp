#include "meshing/field/trivial_connection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "iga/linalg/sparse_solver.h"

namespace couture::meshing {

namespace {

// Rows of cycles with what x must sum to along them.
struct CycleSystem {
    SparseMatrix A;
    VectorX b;
    // Rows that follow from others.
    std::vector<char> is_dropped;
};

class SystemBuilder {
  public:
    SystemBuilder(const SurfaceMesh& mesh, int symmetry)
        : mesh_(mesh),
          turn_(2.0 * std::numbers::pi / symmetry),
          component_(face_components(mesh)),
          has_dropped_(component_.size(), false) {}

    void add(const DualCycle& cycle, int turns, bool may_drop) {
        const auto row = static_cast<int>(right_side_.size());
        for (const HalfedgeHandle h : cycle.crossed) {
            const EdgeHandle edge = mesh_.edge_handle(h);
            entries_.emplace_back(row, edge.idx(),
                                  mesh_.halfedge_handle(edge, 0) == h ? 1.0 : -1.0);
        }
        right_side_.push_back(cycle.curvature - turn_ * turns);
        bool is_dropped = false;
        if (may_drop && !cycle.crossed.empty()) {
            auto dropped =
                has_dropped_.begin() + component_[mesh_.face_handle(cycle.crossed.front()).idx()];
            is_dropped = !*dropped;
            *dropped = true;
        }
        // Along the boundary of a single triangle, say, nothing is crossed.
        dropped_.push_back(is_dropped || cycle.crossed.empty() ? 1 : 0);
    }

    [[nodiscard]] CycleSystem finish() const {
        CycleSystem system;
        const auto n = static_cast<Eigen::Index>(right_side_.size());
        system.A.resize(n, static_cast<Eigen::Index>(mesh_.n_edges()));
        system.A.setFromTriplets(entries_.begin(), entries_.end());
        system.b = Eigen::Map<const VectorX>(right_side_.data(), n);
        system.is_dropped = dropped_;
        return system;
    }

  private:
    const SurfaceMesh& mesh_;
    double turn_;
    std::vector<int> component_;
    // For each component.
    std::vector<bool> has_dropped_;
    std::vector<Eigen::Triplet<double>> entries_;
    std::vector<double> right_side_;
    std::vector<char> dropped_;
};

Connection least_connection(const SurfaceMesh& mesh, const DualCycles& cycles,
                            const FieldTopology& topology, bool with_generators) {
    std::vector<int> index(mesh.n_vertices(), 0);
    for (const Singularity& s : topology.singularities) index[s.vertex] = s.index;
    SystemBuilder builder(mesh, topology.symmetry);
    // Those with boundaries, whose cycles may be empty, drop one of these.
    for (std::size_t k = 0; k < cycles.along_boundaries.size(); ++k) {
        builder.add(cycles.along_boundaries[k], topology.boundary_turns[k], true);
    }
    for (std::size_t k = 0; k < cycles.inner_vertices.size(); ++k) {
        builder.add(cycles.around_vertices[k],
                    topology.symmetry - index[cycles.inner_vertices[k].idx()], true);
    }
    for (std::size_t k = 0; with_generators && k < cycles.generators.size(); ++k) {
        builder.add(cycles.generators[k], topology.generator_turns[k], false);
    }
    const CycleSystem system = builder.finish();
    const iga::BlockMatrix matrix =
        iga::to_symmetric_blocks(SparseMatrix(system.A * system.A.transpose()));
    VectorX x = VectorX::Zero(static_cast<Eigen::Index>(mesh.n_edges()));
    if (std::ranges::count(system.is_dropped, 0) > 0) {
        iga::SolverOptions cholesky;
        cholesky.name = "cholmod";
        const auto solver = iga::make_linear_solver(cholesky);
        solver->factorize({matrix, system.is_dropped, {}});
        MatrixX multipliers;
        static_cast<void>(solver->solve(system.b, multipliers));
        x = system.A.transpose() * multipliers;
    }
    return Connection(std::vector<double>(x.begin(), x.end()));
}

}  // namespace

double turns_against(const SurfaceMesh& mesh, const DualCycle& cycle,
                     const Connection& connection) {
    double turns = cycle.curvature;
    for (const HalfedgeHandle h : cycle.crossed) turns -= connection(mesh, h);
    return turns;
}

Connection trivial_connection(const SurfaceMesh& mesh, const DualCycles& cycles,
                              const FieldTopology& topology) {
    check_topology(mesh, cycles, topology);
    return least_connection(mesh, cycles, topology, true);
}

FieldTopology with_smooth_generators(const SurfaceMesh& mesh, const DualCycles& cycles,
                                     FieldTopology topology) {
    topology.generator_turns.assign(cycles.generators.size(), 0);
    check_topology(mesh, cycles, topology);
    const Connection connection = least_connection(mesh, cycles, topology, false);
    for (std::size_t k = 0; k < cycles.generators.size(); ++k) {
        topology.generator_turns[k] =
            static_cast<int>(std::lround(turns_against(mesh, cycles.generators[k], connection) *
                                         topology.symmetry / (2.0 * std::numbers::pi)));
    }
    return topology;
}

}  // namespace couture::meshing
