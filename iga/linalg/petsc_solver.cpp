#include "iga/linalg/petsc_solver.h"

#include <fmt/ranges.h>
#include <petscksp.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "iga/core/error.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

static_assert(std::is_same_v<PetscInt, int> && std::is_same_v<PetscScalar, double>,
              "PETSc must be built with 32-bit integers and real double scalars");

/// CG's recursive residual drifts from the true one: it is restarted from the latter this often.
constexpr int max_restarts = 3;
/// CG aims below the tolerance by this factor, for that drift.
constexpr double safety = 0.5;

/// First message of the error that is being passed up through PETSc.
std::string error_message;

PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
    if (type == PETSC_ERROR_INITIAL) {
        error_message = fmt::format("{} (in {})", message, function);
    }
    return code;
}

/// @throws SolverError  with PETSc's message
void check(PetscErrorCode code) {
    if (code != 0) {
        const std::string message =
            error_message.empty() ? fmt::format("error code {}", code) : error_message;
        error_message.clear();
        throw SolverError("petsc: {}", message);
    }
}

void finalize_at_exit() {
    PetscBool is_finalized = PETSC_FALSE;
    int mpi_is_finalized = 0;
    PetscFinalized(&is_finalized);
    MPI_Finalized(&mpi_is_finalized);
    if (is_finalized == PETSC_FALSE && mpi_is_finalized == 0) {
        PetscFinalize();
    }
}

void initialize_once() {
    PetscBool is_initialized = PETSC_FALSE;
    PetscInitialized(&is_initialized);
    if (is_initialized == PETSC_TRUE) {
        return;
    }
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
    PetscOptionsSetValue(nullptr, "-skip_petscrc", "true");
    check(PetscInitializeNoArguments());
    std::atexit(finalize_at_exit);
}

/// While it lives, PETSc reads these options and its errors are kept instead of printed.
class Session {
  public:
    explicit Session(PetscOptions options) {
        check(PetscPushErrorHandler(keep_message, nullptr));
        const PetscErrorCode code = PetscOptionsPush(options);
        if (code != 0) {
            PetscPopErrorHandler();
            check(code);
        }
    }
    ~Session() {
        PetscOptionsPop();
        PetscPopErrorHandler();
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
};

class PetscSolver final : public LinearSolver {
  public:
    explicit PetscSolver(const SolverOptions& options) : options_(options) {}
    ~PetscSolver() override {
        release();
        if (is_alive()) {
            PetscOptionsDestroy(&petsc_options_);
        }
    }
    PetscSolver(const PetscSolver&) = delete;
    PetscSolver& operator=(const PetscSolver&) = delete;

    void factorize(const LinearSystem& system) override {
        check_system(system, "petsc");
        check_constrained(system, "petsc");
        release();
        initialize_once();
        if (petsc_options_ == nullptr) {
            read_options();
        }
        const Session session(petsc_options_);
        is_fixed_ = system.is_fixed;
        try {
            make_matrix(system);
            make_solver(system);
        } catch (...) {
            release();
            throw;
        }
        matrix_ = &system.matrix;
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (matrix_ == nullptr) {
            throw SolverError("petsc: solve was called before factorize succeeded");
        }
        check_right_hand_side(*matrix_, b, "petsc");
        const Session session(petsc_options_);
        const MatrixX free_b = free_part(is_fixed_, b);
        SolveReport report;
        report.solver = "petsc";
        report.memory = memory_;
        x = MatrixX::Zero(b.rows(), b.cols());
        for (Eigen::Index k = 0; k < b.cols(); ++k) {
            solve_column(free_b.col(k), x, k, report);
        }
        return report;
    }

  private:
    static bool is_alive() {
        PetscBool is_finalized = PETSC_FALSE;
        PetscFinalized(&is_finalized);
        return is_finalized == PETSC_FALSE;
    }

    void release() {
        matrix_ = nullptr;
        if (is_alive()) {
            KSPDestroy(&ksp_);
            MatDestroy(&A_);
        }
    }

    void read_options() {
        check(PetscPushErrorHandler(keep_message, nullptr));
        PetscErrorCode code = PetscOptionsCreate(&petsc_options_);
        if (code == 0) {
            code = PetscOptionsInsertString(petsc_options_, options_.petsc_options.c_str());
        }
        PetscPopErrorHandler();
        check(code);
    }

    /// PETSc's matrix works on the arrays of `scalar_`: rows and columns of fixed unknowns are
    /// those of the identity, scaled like the rest.
    void make_matrix(const LinearSystem& system) {
        std::vector<int> kept;
        scalar_ = to_scalar(system.matrix, {}, false, kept);
        if (!system.matrix.is_symmetric) {
            scalar_ = SparseMatrix(scalar_.transpose());
        }
        if (!is_fixed_.empty()) {
            const double diagonal = scalar_.diagonal().cwiseAbs().mean();
            for (int i = 0; i < scalar_.outerSize(); ++i) {
                for (SparseMatrix::InnerIterator entry(scalar_, i); entry; ++entry) {
                    if (is_fixed_[entry.row()] != 0 || is_fixed_[entry.col()] != 0) {
                        entry.valueRef() = entry.row() == entry.col() ? diagonal : 0.0;
                    }
                }
            }
        }
        const int n = static_cast<int>(scalar_.rows());
        check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, scalar_.outerIndexPtr(),
                                        scalar_.innerIndexPtr(), scalar_.valuePtr(), &A_));
        check(MatSetBlockSize(A_, system.matrix.block_size));
        if (system.matrix.is_symmetric) {
            check(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
        }
        set_near_null_space(system);
        memory_ = static_cast<std::size_t>(scalar_.nonZeros()) * (sizeof(double) + sizeof(int));
    }

    void set_near_null_space(const LinearSystem& system) {
        const MatrixX basis = orthonormal_basis(system.near_null_space);
        if (basis.cols() == 0) {
            return;
        }
        std::vector<Vec> vectors(static_cast<std::size_t>(basis.cols()), nullptr);
        PetscErrorCode code = 0;
        for (std::size_t k = 0; k < vectors.size() && code == 0; ++k) {
            code = MatCreateVecs(A_, &vectors[k], nullptr);
            double* values = nullptr;
            if (code == 0) {
                code = VecGetArrayWrite(vectors[k], &values);
            }
            if (code == 0) {
                const auto column = basis.col(static_cast<Eigen::Index>(k));
                std::copy(column.data(), column.data() + column.size(), values);
                code = VecRestoreArrayWrite(vectors[k], &values);
            }
        }
        MatNullSpace space = nullptr;
        if (code == 0) {
            code = MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE,
                                      static_cast<int>(vectors.size()), vectors.data(), &space);
        }
        if (code == 0) {
            code = MatSetNearNullSpace(A_, space);
        }
        MatNullSpaceDestroy(&space);
        for (Vec& vector : vectors) {
            VecDestroy(&vector);
        }
        check(code);
    }

    void make_solver(const LinearSystem& system) {
        check(KSPCreate(PETSC_COMM_SELF, &ksp_));
        check(KSPSetOperators(ksp_, A_, A_));
        PC pc = nullptr;
        check(KSPGetPC(ksp_, &pc));
        check(PCSetType(pc, PCGAMG));
        if (system.matrix.is_symmetric) {
            check(KSPSetType(ksp_, KSPCG));
        } else {
            check(KSPSetType(ksp_, KSPGMRES));
            check(KSPSetPCSide(ksp_, PC_RIGHT));
        }
        check(KSPSetTolerances(ksp_, safety * options_.tolerance, 0.0, PETSC_DEFAULT,
                               options_.max_iterations));
        check(KSPSetFromOptions(ksp_));
        PetscBool is_cg = PETSC_FALSE;
        check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp_), KSPCG, &is_cg));
        if (is_cg == PETSC_TRUE) {
            check(KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED));
        }
        check(KSPSetUp(ksp_));
        check_unused_options();
    }

    /// Options about printing are read later, by the solve.
    void check_unused_options() {
        PetscInt n_left = 0;
        char** names = nullptr;
        char** values = nullptr;
        check(PetscOptionsLeftGet(petsc_options_, &n_left, &names, &values));
        std::vector<std::string> unused;
        for (int i = 0; i < n_left; ++i) {
            const std::string name = names[i];
            const bool is_about_printing = name.find("view") != std::string::npos ||
                                           name.find("reason") != std::string::npos ||
                                           name.find("monitor") != std::string::npos;
            if (!is_about_printing) {
                unused.push_back("-" + name);
            }
        }
        check(PetscOptionsLeftRestore(petsc_options_, &n_left, &names, &values));
        if (!unused.empty()) {
            throw InputError(
                "petsc: nothing reads the option {}; check its spelling and that the chosen "
                "solver and preconditioner have it",
                fmt::join(unused, ", "));
        }
    }

    void solve_column(const VectorX& b, MatrixX& x, Eigen::Index k, SolveReport& report) {
        const double b_norm = b.norm();
        if (b_norm == 0.0) {
            return;
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
            const VectorX correction = run(r, n_left, ratio, n_iterations, reason);
            if (!correction.allFinite()) {
                break;
            }
            x.col(k) += free_part(is_fixed_, correction);
            r = residual(*matrix_, is_fixed_, b, x.col(k));
            const double new_ratio = r.norm() / b_norm;
            if (!(new_ratio < ratio)) {
                ratio = new_ratio;
                break;
            }
            ratio = new_ratio;
        }
        report.iterations = std::max(report.iterations, n_iterations);
        report.residual = std::max(report.residual, ratio);
        if (!(ratio <= options_.tolerance)) {
            throw SolverError(
                "petsc: stopped after {} iterations ({}) with |b - A x| / |b| = {:.3g} > {:.3g}; "
                "{}",
                n_iterations, KSPConvergedReasons[reason], ratio, options_.tolerance,
                advice(reason));
        }
    }

    static const char* advice(KSPConvergedReason reason) {
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

    /// One call of the Krylov method: A^-1 r, as far as it gets.
    ///
    /// @param ratio  |r| / |b|: the goal is relative to b
    VectorX run(VectorX& r, int max_iterations, double ratio, int& n_iterations,
                KSPConvergedReason& reason) {
        double relative = 0.0;
        check(KSPGetTolerances(ksp_, &relative, nullptr, nullptr, nullptr));
        const double goal = std::min(relative / ratio, 0.5);
        check(KSPSetTolerances(ksp_, goal, PETSC_DEFAULT, PETSC_DEFAULT, max_iterations));
        VectorX x = VectorX::Zero(r.size());
        const int n = static_cast<int>(r.size());
        Vec r_vector = nullptr;
        Vec x_vector = nullptr;
        PetscErrorCode code = VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, r.data(), &r_vector);
        if (code == 0) {
            code = VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), &x_vector);
        }
        if (code == 0) {
            code = KSPSolve(ksp_, r_vector, x_vector);
        }
        VecDestroy(&r_vector);
        VecDestroy(&x_vector);
        check(code);
        int n_new = 0;
        check(KSPGetIterationNumber(ksp_, &n_new));
        check(KSPGetConvergedReason(ksp_, &reason));
        check(KSPSetTolerances(ksp_, relative, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
        n_iterations += n_new;
        return x;
    }

    SolverOptions options_;
    PetscOptions petsc_options_ = nullptr;
    Mat A_ = nullptr;
    KSP ksp_ = nullptr;
    /// The arrays behind A_.
    SparseMatrix scalar_;
    const BlockMatrix* matrix_ = nullptr;
    std::vector<char> is_fixed_;
    std::size_t memory_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_petsc_solver(const SolverOptions& options) {
    return std::make_unique<PetscSolver>(options);
}

}  // namespace couture::iga
