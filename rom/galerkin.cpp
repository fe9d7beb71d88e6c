#include "rom/galerkin.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/solve/static_system.h"
#include "rom/member_geometry.h"

namespace couture::rom {

namespace {

void check_problem(const iga::Problem& problem) {
    if (problem.physics != iga::Physics::elasticity) {
        throw InputError(
            "Galerkin solution: the problem is not elastic; displacement modes solve "
            "elastic problems only");
    }
    for (const iga::Material& material : problem.materials) {
        if (material.hyperelastic) {
            throw InputError(
                "Galerkin solution: material '{}' is hyperelastic; only linear systems are "
                "projected",
                material.name);
        }
    }
}

void check_case(const iga::Problem& problem, const std::string& load_case) {
    const std::vector<std::string> cases = problem.load_cases();
    if (std::find(cases.begin(), cases.end(), load_case) == cases.end()) {
        throw InputError("Galerkin solution: there is no load case '{}'; there are: '{}'",
                         load_case, fmt::join(cases, "', '"));
    }
}

/// The full system on one geometry, in the frames of the constraints: a column for each load case.
class LinearSystem {
  public:
    LinearSystem(const iga::Space<3>& space, const iga::Problem& problem,
                 const std::vector<std::string>& load_cases, std::optional<int> n_gauss_points)
        : constraints_(iga::make_constraints(space, problem, load_cases)),
          loads_(3L * space.n_dofs(), static_cast<Eigen::Index>(load_cases.size())) {
        const SparseMatrix foundations = iga::assemble_foundations(space, problem, n_gauss_points);
        iga::require_held(space, problem, constraints_, foundations);
        for (std::size_t i = 0; i < load_cases.size(); ++i) {
            loads_.col(static_cast<Eigen::Index>(i)) =
                iga::flatten(iga::assemble_loads(space, problem, load_cases[i], n_gauss_points));
        }
        constraints_.to_frames(loads_);
        stiffness_ = iga::assemble(space, iga::stiffness_form<3>(problem, space.n_patches()),
                                   n_gauss_points);
        iga::add_symmetric(stiffness_, foundations);
        iga::rotate_to_frames(stiffness_, constraints_);
    }

    [[nodiscard]] MatrixX stiffness_times(const MatrixX& u) const { return stiffness_ * u; }
    /// What supports prescribe, 0 at the free unknowns.
    [[nodiscard]] MatrixX prescribed() const { return constraints_.values; }
    [[nodiscard]] MatrixX to_frames(MatrixX u) const {
        constraints_.to_frames(u);
        return u;
    }
    [[nodiscard]] MatrixX to_global(MatrixX u) const {
        constraints_.to_global(u);
        return u;
    }
    /// 0 at the unknowns that are held.
    [[nodiscard]] MatrixX free_part(MatrixX u) const {
        for (Eigen::Index i = 0; i < u.rows(); ++i) {
            if (constraints_.is_fixed[i] != 0) {
                u.row(i).setZero();
            }
        }
        return u;
    }
    /// f - K u on the free unknowns.
    [[nodiscard]] MatrixX residual(const MatrixX& u) const {
        return free_part(loads_ - stiffness_times(u));
    }

  private:
    iga::Constraints<3> constraints_;
    MatrixX loads_;
    iga::BlockMatrix stiffness_;
};

/// Solves A a = B for a positive semidefinite A: directions in which A vanishes to rounding (modes
/// that depend on each other) are left out. `rank` gets the number of the others.
MatrixX solve_projected(const MatrixX& A, const MatrixX& B, int& rank) {
    constexpr double rounding = 1e-13;
    const VectorX scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(scale.asDiagonal() * A * scale.asDiagonal());
    const VectorX& values = eigen.eigenvalues();
    MatrixX in_directions = eigen.eigenvectors().transpose() * (scale.asDiagonal() * B);
    rank = 0;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const bool is_kept = values[i] > rounding * values[values.size() - 1];
        in_directions.row(i) *= is_kept ? 1.0 / values[i] : 0.0;
        rank += is_kept ? 1 : 0;
    }
    return scale.asDiagonal() * (eigen.eigenvectors() * in_directions);
}

struct Projection {
    /// In the frames of the constraints, a column for each load case.
    MatrixX displacements;
    /// Of the fields that are independent in energy.
    int rank = 0;
};

/// @param fields  3 n_nodes x n, not in frames
Projection project(const LinearSystem& system, const MatrixX& fields) {
    const MatrixX V = system.free_part(system.to_frames(fields));
    const MatrixX g = system.prescribed();
    Projection result;
    const MatrixX A = V.transpose() * system.stiffness_times(V);
    result.displacements =
        g + V * solve_projected(A, V.transpose() * system.residual(g), result.rank);
    return result;
}

/// Modes, and the mean where there is one.
MatrixX trial_fields(const ReducedModel& model) {
    MatrixX fields = model.displacement_modes();
    const VectorX mean = model.displacement_mean();
    if (mean.squaredNorm() > 0.0) {
        fields.conservativeResize(Eigen::NoChange, fields.cols() + 1);
        fields.rightCols(1) = mean;
    }
    return fields;
}

}  // namespace

GalerkinSolution solve_galerkin(const ReducedModel& model, const Evaluation& evaluation,
                                const iga::Problem& problem, const std::string& load_case,
                                std::optional<int> n_gauss_points) {
    check_problem(problem);
    check_case(problem, load_case);
    const iga::Space<3> space(model.member(evaluation));
    const LinearSystem system(space, problem, {load_case}, n_gauss_points);
    const Projection projection = project(system, trial_fields(model));
    const VectorX u = projection.displacements;

    const VectorX kriged = system.to_frames(evaluation.displacement);
    const double scale = std::max(system.residual(system.prescribed()).norm(), 1e-300);
    GalerkinSolution solution;
    solution.n_modes = projection.rank;
    const auto energy_product = [&](const VectorX& v) {
        return v.dot(system.stiffness_times(v).col(0));
    };
    solution.displacement = system.to_global(u);
    solution.relative_residual = system.residual(u).norm() / scale;
    solution.relative_residual_of_kriging = system.residual(kriged).norm() / scale;
    solution.energy = 0.5 * energy_product(u);
    solution.relative_change = std::sqrt(std::max(0.0, energy_product(u - kriged)) /
                                         std::max(2.0 * solution.energy, 1e-300));
    return solution;
}

MatrixX projected_displacements(const iga::Space<3>& member, const MatrixX& fields,
                                const iga::Problem& problem, std::optional<int> n_gauss_points) {
    check_problem(problem);
    if (fields.rows() != 3L * member.n_dofs()) {
        throw InputError("Galerkin solution: fields of {} values on {} nodes; there must be 3 each",
                         fields.rows(), member.n_dofs());
    }
    const LinearSystem system(member, problem, problem.load_cases(), n_gauss_points);
    return system.to_global(project(system, fields).displacements);
}

}  // namespace couture::rom
