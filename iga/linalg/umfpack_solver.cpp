#include "iga/linalg/umfpack_solver.h"

#include <umfpack.h>

#include <array>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/linalg/refinement.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

/// Smallest over largest pivot of a matrix that is singular but for rounding.
constexpr double smallest_pivot_ratio = 1e-15;

class UmfpackSolver final : public LinearSolver {
  public:
    explicit UmfpackSolver(const SolverOptions& options) : options_(options) {}
    ~UmfpackSolver() override { release(); }
    UmfpackSolver(const UmfpackSolver&) = delete;
    UmfpackSolver& operator=(const UmfpackSolver&) = delete;

    void factorize(const LinearSystem& system) override {
        check_system(system, "umfpack");
        check_constrained(system, "umfpack");
        static_cast<void>(n_threads());  // hands the number of threads to BLAS before its first use
        matrix_ = nullptr;
        is_fixed_ = system.is_fixed;
        A_ = to_scalar(system.matrix, is_fixed_, false, kept_);
        if (!kept_.empty()) {
            factorize_numbers();
        }
        matrix_ = &system.matrix;
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (matrix_ == nullptr) {
            throw SolverError("umfpack: solve was called before factorize succeeded");
        }
        check_right_hand_side(*matrix_, b, "umfpack");
        SolveReport report = solve_refined(
            "umfpack", *matrix_, is_fixed_, b, options_.tolerance,
            [this](const MatrixX& r) { return apply_inverse(r); }, "LU factorization", x);
        report.memory = memory_;
        return report;
    }

  private:
    void release() {
        umfpack_di_free_symbolic(&symbolic_);
        umfpack_di_free_numeric(&numeric_);
    }

    void check(int status) const {
        if (status == UMFPACK_OK) {
            return;
        }
        throw SolverError("umfpack: the matrix of {} unknowns can't be factorized: {}",
                          kept_.size(),
                          status == UMFPACK_ERROR_out_of_memory       ? "out of memory"
                          : status == UMFPACK_WARNING_singular_matrix ? "it is singular"
                                                                      : "internal error");
    }

    void factorize_numbers() {
        release();
        A_.makeCompressed();
        const auto n = static_cast<int>(A_.rows());
        std::array<double, UMFPACK_CONTROL> control{};
        std::array<double, UMFPACK_INFO> info{};
        umfpack_di_defaults(control.data());
        check(umfpack_di_symbolic(n, n, A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(),
                                  &symbolic_, control.data(), info.data()));
        const double unit = info[UMFPACK_SIZE_OF_UNIT];
        const double needed = unit * info[UMFPACK_PEAK_MEMORY_ESTIMATE];
        const auto limit = static_cast<double>(
            options_.memory_limit > 0 ? options_.memory_limit : available_memory());
        if (needed > limit) {
            throw FactorTooLarge(
                "umfpack: the factors of {} unknowns need up to {:.4g} MB, the limit is {:.4g} MB; "
                "use a coarser mesh",
                kept_.size(), 1e-6 * needed, 1e-6 * limit);
        }
        check(umfpack_di_numeric(A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(), symbolic_,
                                 &numeric_, control.data(), info.data()));
        memory_ = static_cast<std::size_t>(unit * info[UMFPACK_NUMERIC_SIZE]);
        const double pivots = info[UMFPACK_RCOND];
        if (!(pivots > smallest_pivot_ratio)) {
            throw SolverError(
                "umfpack: the matrix of {} unknowns is singular: its pivots differ by {:.1e}",
                kept_.size(), pivots);
        }
    }

    MatrixX apply_inverse(const MatrixX& b) const {
        MatrixX x = MatrixX::Zero(b.rows(), b.cols());
        VectorX free_x(static_cast<Eigen::Index>(kept_.size()));
        for (Eigen::Index column = 0; column < b.cols() && !kept_.empty(); ++column) {
            const VectorX free_b = b.col(column)(kept_);
            check(umfpack_di_solve(UMFPACK_A, A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(),
                                   free_x.data(), free_b.data(), numeric_, nullptr, nullptr));
            x.col(column)(kept_) = free_x;
        }
        return x;
    }

    SolverOptions options_;
    const BlockMatrix* matrix_ = nullptr;
    std::vector<char> is_fixed_;
    std::vector<int> kept_;
    SparseMatrix A_;
    std::size_t memory_ = 0;
    void* symbolic_ = nullptr;
    void* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack_solver(const SolverOptions& options) {
    return std::make_unique<UmfpackSolver>(options);
}

}  // namespace couture::iga
