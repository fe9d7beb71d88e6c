#include "iga/linalg/petsc_solver.h"

#include "iga/core/error.h"
#include "iga/linalg/petsc_krylov.h"
#include "iga/linalg/petsc_session.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

class PetscSolver final : public LinearSolver {
  public:
    explicit PetscSolver(const SolverOptions& options) : krylov_(options) {}
    ~PetscSolver() override { release(); }
    PetscSolver(const PetscSolver&) = delete;
    PetscSolver& operator=(const PetscSolver&) = delete;

    void factorize(const LinearSystem& system) override {
        check_system(system, "petsc");
        check_constrained(system, "petsc");
        release();
        start_petsc();
        const PetscSession session(krylov_.petsc_options());
        is_fixed_ = system.is_fixed;
        try {
            make_matrix(system);
            krylov_.set_up(A_, system.matrix.is_symmetric);
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
        const MatrixX free_b = free_part(is_fixed_, b);
        SolveReport report;
        report.solver = "petsc";
        report.memory = memory_;
        x = MatrixX::Zero(b.rows(), b.cols());
        for (Eigen::Index k = 0; k < b.cols(); ++k) {
            x.col(k) = krylov_.solve(free_b.col(k), is_fixed_, report);
        }
        return report;
    }

  private:
    void release() {
        matrix_ = nullptr;
        if (petsc_is_alive()) {
            MatDestroy(&A_);
        }
    }

    void make_matrix(const LinearSystem& system) {
        rows_ = rows_for_petsc(system.matrix, is_fixed_);
        const int n = static_cast<int>(rows_.rows());
        check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, rows_.outerIndexPtr(),
                                              rows_.innerIndexPtr(), rows_.valuePtr(), &A_));
        check_petsc(MatSetBlockSize(A_, system.matrix.block_size));
        if (system.matrix.is_symmetric) {
            check_petsc(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
        }
        set_near_null_space(A_, system.near_null_space);
        memory_ = static_cast<std::size_t>(rows_.nonZeros()) * (sizeof(double) + sizeof(int));
    }

    PetscKrylov krylov_;
    Mat A_ = nullptr;
    /// The arrays behind A_.
    RowMatrix rows_;
    const BlockMatrix* matrix_ = nullptr;
    std::vector<char> is_fixed_;
    std::size_t memory_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_petsc_solver(const SolverOptions& options) {
    return std::make_unique<PetscSolver>(options);
}

}  // namespace couture::iga
