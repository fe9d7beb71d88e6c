#pragma once

#include <cmath>
#include <map>
#include <memory>

#include "iga/assembly/constraints.h"
#include "iga/assembly/finite_strain.h"
#include "iga/assembly/follower_pressure.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/solve/body_share.h"
#include "iga/solve/matrix_free_system.h"

namespace couture::iga {

/// What acts on a body at one time.
template <int d>
struct LoadState {
    double t = 0.0;
    /// The problem with its values at t.
    Problem problem;
    /// Prescribed displacements in column 0 of the values.
    Constraints<d> constraints;
    /// Work of the loads that do not follow the body on the functions, n_dofs x d.
    MatrixX dead_loads;
};

/// Forces on a hyperelastic body at a displacement, and their linearisation. Unknowns are total
/// displacements d * dof + component, in the frames of the constraints.
template <int d>
class Equilibrium {
  public:
    /// @param problem  must outlive this
    /// @param end  time at which loads that do not name t have the value that they are given
    /// @param share  where several processes have some elements each: the reference is that of this
    ///               process' pieces. Must outlive this; null: all elements are here
    /// @throws InputError, TopologyError  as `solve_linear_static`; for matrix_free, and for
    /// several
    ///                                    processes, where the volumetric part is projected
    Equilibrium(ReferencePtr<d> reference, const Problem& problem, double end,
                std::optional<int> n_gauss_points, Volumetric volumetric,
                const SolverOptions& solver, BodyShare<d>* share = nullptr);

    [[nodiscard]] LoadState<d> loads_at(double t) const;

    /// Moves the body to `unknowns` (one column) under these loads; false where it is folded there,
    /// or forces are not finite: they have no meaning then.
    [[nodiscard]] bool move_to(const LoadState<d>& loads, const MatrixX& unknowns);
    [[nodiscard]] const SmallestVolume<d>& smallest_volume() const { return smallest_; }

    /// Of the place moved to: forces of stress and foundations, of the loads, and the difference
    /// of the first and the second.
    [[nodiscard]] const VectorX& internal_forces() const { return internal_; }
    [[nodiscard]] const VectorX& external_forces() const { return external_; }
    [[nodiscard]] VectorX residual() const { return internal_ - external_; }
    /// Of the whole body.
    [[nodiscard]] double energy() const;
    [[nodiscard]] Vector3 applied_force() const;
    /// Of the residual at the supports.
    [[nodiscard]] std::map<std::string, Vector3> reactions(const LoadState<d>& loads) const;
    /// n_dofs x d.
    [[nodiscard]] const MatrixX& displacement() const { return displacement_; }

    /// Over the unknowns of the whole body; `is_fixed`: over those that are free.
    [[nodiscard]] double dot(const VectorX& a, const VectorX& b,
                             const std::vector<char>* is_fixed = nullptr) const;
    [[nodiscard]] double norm(const VectorX& a, const std::vector<char>* is_fixed = nullptr) const {
        return std::sqrt(dot(a, a, is_fixed));
    }
    /// Largest absolute value.
    [[nodiscard]] double largest(const VectorX& a) const;

    /// Assembles the derivative of the residual by the unknowns where the body is.
    void linearize(const LoadState<d>& loads);
    /// The derivative times columns.
    [[nodiscard]] MatrixX apply(const MatrixX& x) const;
    /// Solves for columns, zero at fixed unknowns. Cholesky while the tangent is symmetric and
    /// positive definite, LU where it is not; or conjugate gradients without the matrix.
    /// @throws SolverError  if the tangent is singular
    [[nodiscard]] MatrixX solve(const LoadState<d>& loads, const MatrixX& b);
    /// Largest entry of the derivative.
    [[nodiscard]] double stiffness_scale() const;

  private:
    [[nodiscard]] bool is_matrix_free() const { return solver_options_.name == "matrix_free"; }
    /// What is added to the body's tangent: foundations, symmetric part of follower pressures.
    [[nodiscard]] SparseMatrix addition() const;
    void assemble_matrix(const LoadState<d>& loads);
    [[nodiscard]] BlockMatrix extended_matrix() const;
    /// Columns from shares, where there are several processes.
    [[nodiscard]] MatrixX complete(MatrixX share) const;
    /// Whether antisymmetric parts of several processes cancel.
    [[nodiscard]] bool is_symmetric_in_all(const LoadState<d>& loads) const;

    ReferencePtr<d> reference_;
    SpacePtr<d> undeformed_;
    const Problem& problem_;
    BodyShare<d>* share_;
    /// What `problem_` is on the elements here.
    Problem on_pieces_;
    double end_;
    std::optional<int> n_gauss_points_;
    SolverOptions solver_options_;
    SparseMatrix foundations_;
    FiniteStrain<d> body_;
    std::unique_ptr<LinearSolver> solver_;

    MatrixX displacement_;
    SmallestVolume<d> smallest_;
    /// Loads of the elements here in the axes' directions, n_dofs x d.
    MatrixX external_rows_;
    VectorX internal_;
    VectorX external_;
    FollowerPressure follower_;

    /// Without rows while the tangent is applied without a matrix.
    BlockMatrix matrix_;
    std::unique_ptr<MatrixFreeSystem<d>> system_;
    /// What a follower pressure on an open rim adds: over the unknowns, antisymmetric.
    SparseMatrix skew_;
    std::optional<VolumetricCoupling> coupling_;
};

/// n_dofs x d as unknowns in the frames of the constraints, one column, and back.
template <int d>
[[nodiscard]] MatrixX to_unknowns(const Constraints<d>& constraints, const MatrixX& displacement);
template <int d>
[[nodiscard]] MatrixX to_displacement(const Constraints<d>& constraints, const MatrixX& unknowns);

}  // namespace couture::iga
