#include "iga/linalg/fast_diagonalization.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/linalg/conjugate_gradients.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

constexpr const char* solver_name = "fast_diagonalization";
/// Elements of the space per element of the coarse grid, in each direction.
constexpr int elements_per_node = 4;
/// Elements of all patches' coarse grids together: their matrix is factorized.
constexpr double max_coarse_elements = 4000.0;
/// Solutions on the wire basket and its tolerance of rounding.
constexpr double wire_tolerance = 1e-6;

/// The translations among the rigid-body modes, if they come first.
MatrixX translations_of(const MatrixX& near_null_space, int nc) {
    return near_null_space.cols() > nc ? MatrixX(near_null_space.leftCols(nc)) : MatrixX();
}

template <int d>
CoarseFunctions coarse_functions(const Space<d>& space) {
    const double n_max = std::pow(max_coarse_elements / space.n_patches(), 1.0 / d);
    return make_coarse_functions(space, elements_per_node, std::max(1, static_cast<int>(n_max)));
}

class FastDiagonalizationSolver final : public LinearSolver {
  public:
    explicit FastDiagonalizationSolver(const SolverOptions& options) : options_(options) {}

    void factorize(const LinearSystem& system) override {
        matrix_ = nullptr;
        check_system(system, solver_name);
        if (!system.matrix.is_symmetric) {
            throw SolverError("{}: the matrix is not stored as symmetric; use petsc", solver_name);
        }
        check_constrained(system, solver_name);
        preconditioner_ = std::make_unique<FastDiagonalization>(system);
        is_fixed_ = system.is_fixed;
        matrix_ = &system.matrix;
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (matrix_ == nullptr) {
            throw SolverError("{}: solve was called before factorize succeeded", solver_name);
        }
        check_right_hand_side(*matrix_, b, solver_name);
        const MatrixX free_b = free_part(is_fixed_, b);
        SolveReport report;
        report.solver = solver_name;
        report.memory = preconditioner_->memory();
        ConjugateGradientOptions options;
        options.tolerance = options_.tolerance;
        options.max_iterations = options_.max_iterations;
        x = MatrixX::Zero(b.rows(), b.cols());
        for (Eigen::Index k = 0; k < b.cols(); ++k) {
            x.col(k) = conjugate_gradients(
                solver_name, [this](const VectorX& p) { return VectorX(*matrix_ * p); }, is_fixed_,
                free_b.col(k), [this](const VectorX& r) { return preconditioner_->apply(r); },
                options, report);
        }
        return report;
    }

  private:
    SolverOptions options_;
    const BlockMatrix* matrix_ = nullptr;
    std::vector<char> is_fixed_;
    std::unique_ptr<FastDiagonalization> preconditioner_;
};

}  // namespace

FastDiagonalization::FastDiagonalization(const LinearSystem& system) {
    const BlockMatrix& A = system.matrix;
    std::vector<char> is_fixed = system.is_fixed;
    is_fixed.resize(A.n_unknowns(), 0);
    const auto make = [&](const auto& space) {
        if (space.n_dofs() != A.n_rows) {
            throw InputError("{}: the space has {} functions, the matrix {} block rows",
                             solver_name, space.n_dofs(), A.n_rows);
        }
        const PatchStructure structure = make_patch_structure(space);
        patches_ = std::make_unique<PatchPreconditioner>(A, is_fixed, structure);
        make_wire_basket(A, is_fixed, structure, {});
        coarse_ = std::make_unique<CoarseSpace>(
            A, is_fixed, translations_of(system.near_null_space, A.block_size),
            coarse_functions(space));
    };
    if (const auto* volume = std::get_if<const Space<3>*>(&system.space)) {
        make(**volume);
    } else if (const auto* surface = std::get_if<const Space<2>*>(&system.space)) {
        make(**surface);
    } else {
        throw InputError("{}: the system has no space; use cholmod or petsc", solver_name);
    }
}

template <int d>
FastDiagonalization::FastDiagonalization(const Space<d>& space, const MatrixFreeParts& parts) {
    const PatchStructure structure = make_patch_structure(space);
    patches_ = std::make_unique<PatchPreconditioner>(parts.coefficients, parts.diagonal,
                                                     parts.is_fixed, structure);
    std::vector<int> wire;
    for (int i = 0; i < structure.n_dofs; ++i) {
        if (structure.places[i] == Place::wire) {
            wire.push_back(i);
        }
    }
    if (!wire.empty()) {
        make_wire_basket(parts.submatrix(wire), parts.is_fixed, structure, wire);
    }
    CoarseFunctions functions = coarse_functions(space);
    BlockMatrix coarse = parts.coarse_matrix(functions);
    coarse_ = std::make_unique<CoarseSpace>(
        std::move(functions), std::move(coarse), parts.is_fixed,
        translations_of(parts.near_null_space, parts.block_size));
}

template FastDiagonalization::FastDiagonalization(const Space<2>&, const MatrixFreeParts&);
template FastDiagonalization::FastDiagonalization(const Space<3>&, const MatrixFreeParts&);

void FastDiagonalization::make_wire_basket(const BlockMatrix& matrix,
                                           const std::vector<char>& is_fixed,
                                           const PatchStructure& structure,
                                           const std::vector<int>& functions) {
    const int nc = matrix.block_size;
    std::vector<char> is_elsewhere(matrix.n_unknowns());
    for (int i = 0; i < matrix.n_unknowns(); ++i) {
        const int function = functions.empty() ? i / nc : functions[i / nc];
        const bool is_wire = structure.places[function] == Place::wire;
        is_elsewhere[i] = is_wire ? is_fixed[function * nc + i % nc] : 1;
    }
    if (std::find(is_elsewhere.begin(), is_elsewhere.end(), 0) == is_elsewhere.end()) {
        return;
    }
    const SparseMatrix lower = to_scalar(matrix, is_elsewhere, true, wire_unknowns_);
    wire_matrix_ = std::make_unique<BlockMatrix>(to_symmetric_blocks(lower));
    SolverOptions options;
    options.tolerance = wire_tolerance;
    wire_solver_ = make_cholmod_solver(options);
    wire_solver_->factorize({*wire_matrix_, {}, {}});
    for (int& unknown : wire_unknowns_) {
        unknown = functions.empty() ? unknown : functions[unknown / nc] * nc + unknown % nc;
    }
}

VectorX FastDiagonalization::apply(const VectorX& r) const {
    VectorX z = patches_->apply(r) + coarse_->apply(r);
    if (wire_solver_) {
        const MatrixX b = r(wire_unknowns_);
        MatrixX x;
        static_cast<void>(wire_solver_->solve(b, x));
        for (std::size_t i = 0; i < wire_unknowns_.size(); ++i) {
            z[wire_unknowns_[i]] += x(static_cast<Eigen::Index>(i), 0);
        }
    }
    return z;
}

std::size_t FastDiagonalization::memory() const {
    return patches_->memory() + coarse_->memory() + (wire_matrix_ ? wire_matrix_->memory() : 0);
}

std::unique_ptr<LinearSolver> make_fast_diagonalization_solver(const SolverOptions& options) {
    return std::make_unique<FastDiagonalizationSolver>(options);
}

}  // namespace couture::iga
