#include "iga/solve/equilibrium.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

#include "iga/assembly/loads.h"
#include "iga/assembly/sparsity.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

/// Antisymmetric entries below this share of the largest are rounding.
constexpr double negligible = 1e-13;
/// Below this share of its volume a point has collapsed: stresses mean nothing there.
constexpr double collapsed = 1e-9;
/// Of the linear systems with LU: Newton's next step corrects what is left.
constexpr double lu_tolerance = 1e-6;

/// The turn from the axes to the frames, over the unknowns.
template <int d>
SparseMatrix frame_matrix(const Constraints<d>& constraints, Eigen::Index n_unknowns) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < n_unknowns; ++i) {
        if (constraints.frames.count(static_cast<int>(i) / d) == 0) {
            entries.emplace_back(i, i, 1.0);
        }
    }
    for (const auto& [dof, Q] : constraints.frames) {
        for (int a = 0; a < d; ++a) {
            for (int b = 0; b < d; ++b) {
                entries.emplace_back(d * dof + a, d * dof + b, Q(a, b));
            }
        }
    }
    SparseMatrix result(n_unknowns, n_unknowns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

/// Entries between free unknowns, or nothing if they are rounding beside `scale`.
SparseMatrix free_entries(const SparseMatrix& matrix, const std::vector<char>& is_fixed,
                          double scale) {
    std::vector<Eigen::Triplet<double>> entries;
    double largest = 0.0;
    for (int column = 0; column < matrix.outerSize(); ++column) {
        for (SparseMatrix::InnerIterator it(matrix, column); it; ++it) {
            if (is_fixed[it.row()] == 0 && is_fixed[column] == 0) {
                entries.emplace_back(it.row(), column, it.value());
                largest = std::max(largest, std::abs(it.value()));
            }
        }
    }
    SparseMatrix result(matrix.rows(), matrix.cols());
    if (largest > negligible * scale) {
        result.setFromTriplets(entries.begin(), entries.end());
    }
    return result;
}

}  // namespace

template <int d>
MatrixX to_unknowns(const Constraints<d>& constraints, const MatrixX& displacement) {
    MatrixX unknowns = flatten(displacement);
    constraints.to_frames(unknowns);
    return unknowns;
}

template <int d>
MatrixX to_displacement(const Constraints<d>& constraints, const MatrixX& unknowns) {
    MatrixX global = unknowns;
    constraints.to_global(global);
    return unflatten(global.col(0), d);
}

template <int d>
Equilibrium<d>::Equilibrium(ReferencePtr<d> reference, const Problem& problem, double end,
                            std::optional<int> n_gauss_points, Volumetric volumetric,
                            const SolverOptions& solver, BodyShare<d>* share)
    : reference_(std::move(reference)),
      undeformed_(reference_->undeformed()),
      problem_(problem),
      share_(share),
      on_pieces_(share != nullptr ? share->on_pieces(problem) : problem),
      end_(end),
      n_gauss_points_(n_gauss_points),
      solver_options_(solver),
      foundations_(assemble_foundations(*undeformed_, on_pieces_, n_gauss_points)),
      body_(reference_, on_pieces_, n_gauss_points, volumetric) {
    if (!is_matrix_free()) {
        matrix_ = make_pattern(*reference_->space, d);
    } else if (body_.is_projected()) {
        throw InputError(
            "linear = \"matrix_free\" does not hold the projected volumetric part of nearly "
            "incompressible materials; set volumetric = \"full\" in [discretization] or take "
            "another linear solver");
    }
    if (share_ != nullptr) {
        if (is_matrix_free() || share_->max(body_.is_projected() ? 1.0 : 0.0) > 0.0) {
            throw InputError(
                "hyperelastic bodies are solved with \"petsc\" and volumetric = \"full\" where "
                "several processes have some elements each; for nearly incompressible materials "
                "start one process");
        }
        share_->require_held(problem);
        return;
    }
    solver_ = make_linear_solver(solver);
    require_held(*undeformed_, problem, make_constraints(*undeformed_, problem, {""}),
                 foundations_);
}

template <int d>
LoadState<d> Equilibrium<d>::loads_at(double t) const {
    LoadState<d> loads;
    loads.t = t;
    loads.problem = at_time(on_pieces_, t, end_);
    const auto follows = [](const Pressure& load) { return load.follows_body; };
    if (share_ != nullptr) {
        Problem whole = at_time(problem_, t, end_);
        loads.constraints = share_->constraints(whole);
        std::erase_if(whole.pressures, follows);
        loads.dead_loads = share_->loads(whole);
        return loads;
    }
    loads.constraints = make_constraints(*undeformed_, loads.problem, {""});
    Problem dead = loads.problem;
    std::erase_if(dead.pressures, follows);
    loads.dead_loads = assemble_loads(*undeformed_, dead, "", n_gauss_points_);
    return loads;
}

template <int d>
bool Equilibrium<d>::move_to(const LoadState<d>& loads, const MatrixX& unknowns) {
    displacement_ = to_displacement(loads.constraints, unknowns);
    smallest_ = body_.deform(displacement_);
    if (share_ != nullptr) {
        smallest_.det_F = -share_->max(std::isnan(smallest_.det_F) ? 0.0 : -smallest_.det_F);
    }
    if (!(smallest_.det_F > collapsed)) {
        return false;
    }
    follower_ =
        assemble_follower_pressure(*undeformed_, loads.problem, displacement_, n_gauss_points_);
    external_rows_ = loads.dead_loads + follower_.forces;
    VectorX forces = flatten(body_.internal_forces());
    if (foundations_.nonZeros() > 0) {
        forces += foundations_ * flatten(displacement_);
    }
    MatrixX both(forces.size(), 2);
    both << forces, flatten(external_rows_);
    both = complete(std::move(both));
    loads.constraints.to_frames(both);
    internal_ = both.col(0);
    external_ = both.col(1);
    return std::isfinite(norm(internal_)) && std::isfinite(norm(external_));
}

template <int d>
MatrixX Equilibrium<d>::complete(MatrixX share) const {
    return share_ != nullptr ? share_->complete(share) : std::move(share);
}

template <int d>
double Equilibrium<d>::energy() const {
    return share_ != nullptr ? share_->sum(body_.energy()) : body_.energy();
}

template <int d>
Vector3 Equilibrium<d>::applied_force() const {
    Vector3 force = sum_of_components(external_rows_);
    for (int a = 0; a < 3 && share_ != nullptr; ++a) {
        force[a] = share_->sum(force[a]);
    }
    return force;
}

template <int d>
std::map<std::string, Vector3> Equilibrium<d>::reactions(const LoadState<d>& loads) const {
    if (share_ == nullptr) {
        return support_reactions(problem_, loads.constraints, residual());
    }
    std::map<std::string, Vector3> result = support_reactions(
        problem_, loads.constraints, VectorX(residual().cwiseProduct(share_->weights())));
    for (auto& [on, force] : result) {
        for (double& component : force) {
            component = share_->sum(component);
        }
    }
    return result;
}

template <int d>
double Equilibrium<d>::dot(const VectorX& a, const VectorX& b,
                           const std::vector<char>* is_fixed) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < a.size(); ++i) {
        if (is_fixed == nullptr || (*is_fixed)[i] == 0) {
            sum += a[i] * b[i] * (share_ != nullptr ? share_->weights()[i] : 1.0);
        }
    }
    return share_ != nullptr ? share_->sum(sum) : sum;
}

template <int d>
double Equilibrium<d>::largest(const VectorX& a) const {
    const double here = a.size() > 0 ? a.cwiseAbs().maxCoeff() : 0.0;
    return share_ != nullptr ? share_->max(here) : here;
}

template <int d>
double Equilibrium<d>::stiffness_scale() const {
    double largest = system_ ? system_->scale() : 0.0;
    for (const double value : matrix_.values) {
        largest = std::max(largest, std::abs(value));
    }
    return share_ != nullptr ? share_->max(largest) : largest;
}

template <int d>
void Equilibrium<d>::linearize(const LoadState<d>& loads) {
    if (is_matrix_free()) {
        matrix_ = {};
        system_ =
            std::make_unique<MatrixFreeSystem<d>>(*reference_->space, body_.tangent_form(),
                                                  addition(), loads.constraints, n_gauss_points_);
        std::vector<std::string> names;
        MatrixX modes = rigid_body_modes(*reference_->space, problem_, names);
        loads.constraints.to_frames(modes);
        system_->prepare(modes);
    } else {
        assemble_matrix(loads);
    }
    const SparseMatrix transposed = follower_.stiffness.transpose();
    skew_ = SparseMatrix(0.5 * (follower_.stiffness - transposed));
    coupling_ = body_.coupling();
    if (!loads.constraints.frames.empty()) {
        const SparseMatrix Q = frame_matrix(loads.constraints, internal_.size());
        skew_ = SparseMatrix(Q * skew_ * SparseMatrix(Q.transpose()));
        if (coupling_) {
            coupling_->B = SparseMatrix(Q * coupling_->B);
        }
    }
    const double scale = stiffness_scale();
    if (share_ != nullptr) {
        skew_ = is_symmetric_in_all(loads) ? SparseMatrix(skew_.rows(), skew_.cols())
                                           : free_entries(skew_, loads.constraints.is_fixed, 0.0);
        return;
    }
    skew_ = free_entries(skew_, loads.constraints.is_fixed, scale);
}

template <int d>
bool Equilibrium<d>::is_symmetric_in_all(const LoadState<d>& loads) const {
    // Each share has a rim where the processes' elements meet: only sums tell.
    VectorX probe(internal_.size());
    for (Eigen::Index i = 0; i < probe.size(); ++i) {
        probe[i] = std::sin(1.0 + static_cast<double>(i)) * share_->weights()[i];
    }
    probe = share_->complete(probe);
    for (Eigen::Index i = 0; i < probe.size(); ++i) {
        probe[i] = loads.constraints.is_fixed[i] != 0 ? 0.0 : probe[i];
    }
    const VectorX product = share_->complete(skew_ * probe);
    constexpr double rounding = 1e-10;
    return norm(product, &loads.constraints.is_fixed) <= rounding * stiffness_scale() * norm(probe);
}

template <int d>
SparseMatrix Equilibrium<d>::addition() const {
    const SparseMatrix transposed = follower_.stiffness.transpose();
    SparseMatrix result = 0.5 * (follower_.stiffness + transposed);
    if (foundations_.nonZeros() > 0) {
        result += foundations_;
    }
    return result;
}

template <int d>
void Equilibrium<d>::assemble_matrix(const LoadState<d>& loads) {
    if (matrix_.n_rows == 0) {
        matrix_ = make_pattern(*reference_->space, d);
    }
    body_.tangent(matrix_);
    add_symmetric(matrix_, addition());
    rotate_to_frames(matrix_, loads.constraints);
}

template <int d>
MatrixX Equilibrium<d>::apply(const MatrixX& x) const {
    MatrixX result = system_ ? *system_ * x : matrix_ * x;
    result += skew_ * x;
    result = complete(std::move(result));
    if (coupling_) {
        Eigen::SimplicialLDLT<SparseMatrix> compliance(coupling_->compliance);
        result += coupling_->B * compliance.solve(MatrixX(coupling_->B.transpose() * x));
    }
    return result;
}

/// [K + skew, B; B^T, -M / k] as scalars.
template <int d>
BlockMatrix Equilibrium<d>::extended_matrix() const {
    std::vector<int> kept;
    const SparseMatrix K = to_scalar(matrix_, {}, false, kept);
    const Eigen::Index n = K.rows();
    const Eigen::Index n_all = n + (coupling_ ? coupling_->B.cols() : 0);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(K.nonZeros() + skew_.nonZeros()));
    const auto add = [&](const SparseMatrix& block, Eigen::Index row, Eigen::Index column,
                         double factor, bool is_transposed) {
        for (int j = 0; j < block.outerSize(); ++j) {
            for (SparseMatrix::InnerIterator it(block, j); it; ++it) {
                entries.emplace_back(row + (is_transposed ? j : it.row()),
                                     column + (is_transposed ? it.row() : j), factor * it.value());
            }
        }
    };
    add(K, 0, 0, 1.0, false);
    add(skew_, 0, 0, 1.0, false);
    if (coupling_) {
        add(coupling_->B, 0, n, 1.0, false);
        add(coupling_->B, n, 0, 1.0, true);
        add(coupling_->compliance, n, n, -1.0, false);
    }
    Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t> all(n_all, n_all);
    all.setFromTriplets(entries.begin(), entries.end());
    BlockMatrix matrix;
    matrix.n_rows = static_cast<int>(n_all);
    matrix.is_symmetric = false;
    matrix.row_begin.assign(all.outerIndexPtr(), all.outerIndexPtr() + n_all + 1);
    matrix.columns.assign(all.innerIndexPtr(), all.innerIndexPtr() + all.nonZeros());
    matrix.values.assign(all.valuePtr(), all.valuePtr() + all.nonZeros());
    return matrix;
}

template <int d>
MatrixX Equilibrium<d>::solve(const LoadState<d>& loads, const MatrixX& b) {
    const std::vector<char>& is_fixed = loads.constraints.is_fixed;
    if (share_ != nullptr) {
        std::vector<std::string> names;
        MatrixX modes = rigid_body_modes(*reference_->space, problem_, names, Vector3::Zero());
        loads.constraints.to_frames(modes);
        return share_->solve(matrix_, skew_, is_fixed, modes, b);
    }
    MatrixX x;
    if (skew_.nonZeros() == 0 && !coupling_) {
        try {
            if (system_) {
                static_cast<void>(system_->solve(b, solver_options_, x));
                return x;
            }
            // Ordered once: the pattern stays.
            solver_->factorize({matrix_, is_fixed, {}, reference_->space.get()});
            static_cast<void>(solver_->solve(b, x));
            return x;
        } catch (const NotPositiveDefinite& error) {
            log::detail("the tangent is indefinite, LU instead of Cholesky");
        }
    }
    if (system_) {
        log::warn("the tangent is not symmetric positive definite: its matrix is formed for LU");
        assemble_matrix(loads);
    }
    SolverOptions options = solver_options_;
    options.name = "umfpack";
    options.tolerance = std::max(options.tolerance, lu_tolerance);
    const std::unique_ptr<LinearSolver> lu = make_linear_solver(options);
    if (skew_.nonZeros() == 0 && !coupling_) {
        lu->factorize({matrix_, is_fixed, {}});
        static_cast<void>(lu->solve(b, x));
        return x;
    }
    const BlockMatrix extended = extended_matrix();
    std::vector<char> fixed = is_fixed;
    fixed.resize(extended.n_rows, 0);
    MatrixX rhs = MatrixX::Zero(extended.n_rows, b.cols());
    rhs.topRows(b.rows()) = b;
    lu->factorize({extended, fixed, {}});
    static_cast<void>(lu->solve(rhs, x));
    return x.topRows(b.rows());
}

#define COUTURE_INSTANTIATE(d)                                           \
    template class Equilibrium<d>;                                       \
    template MatrixX to_unknowns(const Constraints<d>&, const MatrixX&); \
    template MatrixX to_displacement(const Constraints<d>&, const MatrixX&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
