#include "iga/linalg/petsc_krylov.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "iga/core/error.h"
#include "iga/linalg/petsc_session.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

/// CG's recursive residual drifts from the true one: it is restarted from the latter this often.
constexpr int max_restarts = 3;
/// CG aims below the tolerance by this factor, for that drift.
constexpr double safety = 0.5;
/// A motion that keeps less of itself beside the others depends on them.
constexpr double dependent = 1e-8;

/// A vector fit for a matrix, freed at the end.
class VectorOf {
  public:
    explicit VectorOf(Mat A) { check_petsc(MatCreateVecs(A, &vector_, nullptr)); }
    VectorOf(Mat A, const VectorX& values) : VectorOf(A) {
        double* array = nullptr;
        check_petsc(VecGetArrayWrite(vector_, &array));
        std::copy(values.data(), values.data() + values.size(), array);
        check_petsc(VecRestoreArrayWrite(vector_, &array));
    }
    ~VectorOf() { VecDestroy(&vector_); }
    VectorOf(const VectorOf&) = delete;
    VectorOf& operator=(const VectorOf&) = delete;

    [[nodiscard]] Vec get() const { return vector_; }
    [[nodiscard]] VectorX values() const {
        PetscInt n = 0;
        check_petsc(VecGetLocalSize(vector_, &n));
        const double* array = nullptr;
        check_petsc(VecGetArrayRead(vector_, &array));
        VectorX result = Eigen::Map<const VectorX>(array, n);
        check_petsc(VecRestoreArrayRead(vector_, &array));
        return result;
    }
    [[nodiscard]] double norm() const {
        double result = 0.0;
        check_petsc(VecNorm(vector_, NORM_2, &result));
        return result;
    }

  private:
    Vec vector_ = nullptr;
};

const char* advice(KSPConvergedReason reason) {
    switch (reason) {
        case KSP_DIVERGED_INDEFINITE_MAT:
        case KSP_DIVERGED_INDEFINITE_PC:
            return "the matrix is not positive definite: check supports, material parameters "
                   "and folded elements";
        case KSP_DIVERGED_NANORINF:
            return "the matrix or its preconditioner has entries that are not finite";
        case KSP_DIVERGED_ITS:
            return "raise max_iterations, use cholmod, or choose another preconditioner";
        default:
            return "the matrix may be singular or too ill-conditioned for this tolerance: "
                   "check supports, or use cholmod";
    }
}

}  // namespace

PetscKrylov::~PetscKrylov() {
    if (petsc_is_alive()) {
        release();
        PetscOptionsDestroy(&petsc_options_);
    }
}

void PetscKrylov::release() { KSPDestroy(&ksp_); }

PetscOptions PetscKrylov::petsc_options() {
    if (petsc_options_ == nullptr) {
        petsc_options_ = read_petsc_options(options_.petsc_options);
    }
    return petsc_options_;
}

void PetscKrylov::set_up(Mat A, bool is_symmetric, const std::function<void(KSP)>& prepare) {
    release();
    const PetscSession session(petsc_options());
    MPI_Comm processes = MPI_COMM_NULL;
    check_petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(A), &processes));
    check_petsc(KSPCreate(processes, &ksp_));
    check_petsc(KSPSetOperators(ksp_, A, A));
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp_, &pc));
    check_petsc(PCSetType(pc, PCGAMG));
    // Couplings below it are left out of the aggregates: saves a quarter of the iterations.
    double threshold = 0.02;
    check_petsc(PCGAMGSetThreshold(pc, &threshold, 1));
    if (is_symmetric) {
        check_petsc(KSPSetType(ksp_, KSPCG));
    } else {
        check_petsc(KSPSetType(ksp_, KSPGMRES));
        check_petsc(KSPSetPCSide(ksp_, PC_RIGHT));
    }
    check_petsc(KSPSetTolerances(ksp_, safety * options_.tolerance, 0.0, PETSC_DEFAULT,
                                 options_.max_iterations));
    if (prepare) {
        prepare(ksp_);
    }
    check_petsc(KSPSetFromOptions(ksp_));
    PetscBool is_cg = PETSC_FALSE;
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp_), KSPCG, &is_cg));
    if (is_cg == PETSC_TRUE) {
        check_petsc(KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED));
    }
    check_petsc(KSPSetUp(ksp_));
    check_unused_petsc_options(petsc_options_);
}

double PetscKrylov::residual(const VectorX& b, const VectorX& x, VectorX& r) const {
    Mat A = nullptr;
    check_petsc(KSPGetOperators(ksp_, &A, nullptr));
    const VectorOf x_vector(A, x);
    const VectorOf Ax(A);
    check_petsc(MatMult(A, x_vector.get(), Ax.get()));
    r = b - Ax.values();
    return VectorOf(A, r).norm();
}

VectorX PetscKrylov::solve(const VectorX& b, const std::vector<char>& is_fixed,
                           SolveReport& report) {
    if (ksp_ == nullptr) {
        throw SolverError("petsc: solve was called before factorize succeeded");
    }
    const PetscSession session(petsc_options_);
    Mat A = nullptr;
    check_petsc(KSPGetOperators(ksp_, &A, nullptr));
    VectorX x = VectorX::Zero(b.size());
    const double b_norm = VectorOf(A, b).norm();
    if (b_norm == 0.0) {
        return x;
    }
    VectorX r = b;
    double ratio = 1.0;
    int n_iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    for (int i = 0; i <= max_restarts && !(ratio <= options_.tolerance); ++i) {
        const int n_left = options_.max_iterations - n_iterations;
        if (n_left <= 0) {
            break;
        }
        // Multigrid leaves traces at fixed unknowns.
        const VectorX next = x + free_part(is_fixed, run(r, n_left, ratio, n_iterations, reason));
        const double new_ratio = residual(b, next, r) / b_norm;
        if (!std::isfinite(new_ratio)) {
            break;
        }
        x = next;
        const bool is_better = new_ratio < ratio;
        ratio = new_ratio;
        if (!is_better) {
            break;
        }
    }
    report.iterations = std::max(report.iterations, n_iterations);
    report.residual = std::max(report.residual, ratio);
    if (!(ratio <= options_.tolerance)) {
        throw SolverError(
            "petsc: stopped after {} iterations ({}) with |b - A x| / |b| = {:.3g} > {:.3g}; {}",
            n_iterations, KSPConvergedReasons[reason], ratio, options_.tolerance, advice(reason));
    }
    return x;
}

/// One call of the Krylov method: A^-1 r, as far as it gets.
///
/// @param ratio  |r| / |b|: the goal is relative to b
VectorX PetscKrylov::run(const VectorX& r, int max_iterations, double ratio, int& n_iterations,
                         KSPConvergedReason& reason) {
    double relative = 0.0;
    check_petsc(KSPGetTolerances(ksp_, &relative, nullptr, nullptr, nullptr));
    const double goal = std::min(relative / ratio, 0.5);
    check_petsc(KSPSetTolerances(ksp_, goal, PETSC_DEFAULT, PETSC_DEFAULT, max_iterations));
    Mat A = nullptr;
    check_petsc(KSPGetOperators(ksp_, &A, nullptr));
    const VectorOf r_vector(A, r);
    const VectorOf x_vector(A);
    check_petsc(KSPSolve(ksp_, r_vector.get(), x_vector.get()));
    int n_new = 0;
    check_petsc(KSPGetIterationNumber(ksp_, &n_new));
    check_petsc(KSPGetConvergedReason(ksp_, &reason));
    check_petsc(KSPSetTolerances(ksp_, relative, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    n_iterations += n_new;
    return x_vector.values();
}

RowMatrix rows_for_petsc(const BlockMatrix& matrix, const std::vector<char>& is_fixed) {
    std::vector<int> kept;
    SparseMatrix scalar = to_scalar(matrix, {}, false, kept);
    // The columns of a symmetric matrix are its rows.
    RowMatrix rows = matrix.is_symmetric
                         ? RowMatrix(Eigen::Map<const RowMatrix>(
                               scalar.rows(), scalar.cols(), scalar.nonZeros(),
                               scalar.outerIndexPtr(), scalar.innerIndexPtr(), scalar.valuePtr()))
                         : RowMatrix(scalar);
    if (is_fixed.empty()) {
        return rows;
    }
    const double diagonal = rows.diagonal().cwiseAbs().mean();
    for (int i = 0; i < rows.outerSize(); ++i) {
        for (RowMatrix::InnerIterator entry(rows, i); entry; ++entry) {
            if (is_fixed[entry.row()] != 0 || is_fixed[entry.col()] != 0) {
                entry.valueRef() = entry.row() == entry.col() ? diagonal : 0.0;
            }
        }
    }
    return rows;
}

void set_near_null_space(Mat A, const MatrixX& columns) {
    std::vector<std::unique_ptr<VectorOf>> basis;
    std::vector<Vec> vectors;
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
        auto vector = std::make_unique<VectorOf>(A, columns.col(k));
        const double length = vector->norm();
        // Twice is enough.
        for (int pass = 0; pass < 2; ++pass) {
            for (const Vec other : vectors) {
                double share = 0.0;
                check_petsc(VecDot(vector->get(), other, &share));
                check_petsc(VecAXPY(vector->get(), -share, other));
            }
        }
        if (vector->norm() > dependent * length) {
            check_petsc(VecNormalize(vector->get(), nullptr));
            vectors.push_back(vector->get());
            basis.push_back(std::move(vector));
        }
    }
    if (vectors.empty()) {
        return;
    }
    MPI_Comm processes = MPI_COMM_NULL;
    check_petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(A), &processes));
    MatNullSpace space = nullptr;
    check_petsc(MatNullSpaceCreate(processes, PETSC_FALSE, static_cast<int>(vectors.size()),
                                   vectors.data(), &space));
    const PetscErrorCode code = MatSetNearNullSpace(A, space);
    MatNullSpaceDestroy(&space);
    check_petsc(code);
}

}  // namespace couture::iga
