#pragma once

#include "iga/assembly/constraints.h"
#include "iga/assembly/finite_strain.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

struct NewtonOptions {
    /// Largest accepted |residual| over |forces|, both over all free, and all, unknowns.
    double tolerance = 1e-9;
    int max_iterations = 20;
    SolverOptions solver;
};

struct NewtonReport {
    bool converged = false;
    /// Linear systems solved.
    int iterations = 0;
    /// |residual| over |forces| before each of them and at the end.
    std::vector<double> residuals;
    /// Where the body is compressed most at the end: det F.
    double min_det_F = 1.0;
    /// What stopped it, if it did not converge.
    std::string reason;
};

/// Equilibrium of a hyperelastic body under given loads, those of `FollowerPressure` among them, by
/// Newton's method with a backtracking line search: a step is halved while det F <= 0 somewhere, or
/// while neither the residual nor its work on the step falls.
template <int d>
class Newton {
  public:
    /// All must outlive this. @param foundations  over the unknowns; may be empty
    Newton(const Space<d>& space, FiniteStrain<d>& body, const SparseMatrix& foundations,
           std::optional<int> n_gauss_points, const NewtonOptions& options);

    /// @param constraints  prescribed displacements in column 0 of their values
    /// @param dead_loads  n_dofs x d
    /// @param problem  whose pressures follow the body, at this time
    /// @param u  n_dofs x d: the start; the equilibrium, if it is found, else unchanged
    NewtonReport solve(const Constraints<d>& constraints, const MatrixX& dead_loads,
                       const Problem& problem, MatrixX& u);

    /// Internal minus external forces over the unknowns, in the frames of the last solution.
    [[nodiscard]] const VectorX& residual() const { return residual_; }
    /// Dead and follower loads of the last solution, n_dofs x d.
    [[nodiscard]] const MatrixX& external_forces() const { return external_; }

  private:
    [[nodiscard]] VectorX internal_forces(const MatrixX& u) const;
    [[nodiscard]] MatrixX solve_tangent(const std::vector<char>& is_fixed, const MatrixX& b);

    const Space<d>& space_;
    FiniteStrain<d>& body_;
    const SparseMatrix& foundations_;
    std::optional<int> n_gauss_points_;
    NewtonOptions options_;
    std::unique_ptr<LinearSolver> solver_;
    BlockMatrix matrix_;
    VectorX residual_;
    MatrixX external_;
};

}  // namespace couture::iga
