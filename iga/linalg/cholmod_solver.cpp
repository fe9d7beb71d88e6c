#include "iga/linalg/cholmod_solver.h"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "iga/linalg/refinement.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

using Index = SuiteSparse_long;

/// A matrix counts as singular if |A v| is below this part of max |A_ii| |v| for some v: rounding.
constexpr double singular_energy = 1e-14;
/// Such a v is looked for if the smallest pivot is below this part of its diagonal entry.
constexpr double suspicious_pivot = 1e-9;

/// CHOLMOD's settings and statistics.
class Common {
  public:
    Common() {
        cholmod_l_start(&common_);
        common_.print = 0;
        common_.supernodal = CHOLMOD_SUPERNODAL;
        common_.final_ll = 1;
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_GIVEN;
        common_.postorder = 1;
    }
    ~Common() { cholmod_l_finish(&common_); }
    Common(const Common&) = delete;
    Common& operator=(const Common&) = delete;

    cholmod_common* get() { return &common_; }
    cholmod_common* operator->() { return &common_; }

    /// @throws SolverError  if the last call failed for another reason than its matrix
    void check(const char* phase) const {
        if (common_.status == CHOLMOD_OUT_OF_MEMORY) {
            throw FactorTooLarge("cholmod: out of memory in the {}", phase);
        }
        if (common_.status == CHOLMOD_TOO_LARGE) {
            throw FactorTooLarge("cholmod: the {} exceeds the range of its integers", phase);
        }
        if (common_.status < CHOLMOD_OK) {
            throw SolverError("cholmod: the {} failed with status {}", phase, common_.status);
        }
    }

  private:
    cholmod_common common_;
};

/// Compressed columns of a symmetric matrix, lower triangle, with the integers that CHOLMOD wants.
struct LowerTriangle {
    std::vector<Index> begin;
    std::vector<Index> rows;
    Buffer<double> values;

    /// A view, valid as long as this object. No values: the pattern.
    cholmod_sparse view() {
        cholmod_sparse result{};
        result.nrow = result.ncol = begin.size() - 1;
        result.nzmax = rows.size();
        result.p = begin.data();
        result.i = rows.data();
        result.x = values.empty() ? nullptr : values.data();
        result.stype = -1;
        result.itype = CHOLMOD_LONG;
        result.xtype = values.empty() ? CHOLMOD_PATTERN : CHOLMOD_REAL;
        result.dtype = CHOLMOD_DOUBLE;
        result.sorted = 1;
        result.packed = 1;
        return result;
    }
};

LowerTriangle to_lower_triangle(const SparseMatrix& A) {
    LowerTriangle result;
    result.begin.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1);
    result.rows.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
    result.values.assign(A.valuePtr(), A.valuePtr() + A.nonZeros());
    return result;
}

/// The graph of blocks that keep an unknown: `n_kept_of_row` counts them.
LowerTriangle block_graph(const BlockMatrix& A, const std::vector<int>& n_kept_of_row) {
    std::vector<int> number(A.n_rows, -1);
    int n_nodes = 0;
    for (int row = 0; row < A.n_rows; ++row) {
        if (n_kept_of_row[row] > 0) {
            number[row] = n_nodes++;
        }
    }
    LowerTriangle graph;
    graph.begin.push_back(0);
    for (int row = 0; row < A.n_rows; ++row) {
        if (number[row] < 0) {
            continue;
        }
        for (std::int64_t e = A.row_begin[row]; e < A.row_begin[row + 1]; ++e) {
            if (number[A.columns[e]] >= 0) {
                graph.rows.push_back(number[A.columns[e]]);
            }
        }
        graph.begin.push_back(static_cast<Index>(graph.rows.size()));
    }
    return graph;
}

class CholmodSolver final : public LinearSolver {
  public:
    explicit CholmodSolver(const SolverOptions& options) : options_(options) {}
    ~CholmodSolver() override { release(); }
    CholmodSolver(const CholmodSolver&) = delete;
    CholmodSolver& operator=(const CholmodSolver&) = delete;

    void factorize(const LinearSystem& system) override {
        check_system(system, "cholmod");
        if (!system.matrix.is_symmetric) {
            throw SolverError("cholmod: the matrix is not stored as symmetric; use petsc");
        }
        check_constrained(system, "cholmod");
        static_cast<void>(n_threads());  // hands the number of threads to BLAS before its first use
        matrix_ = nullptr;
        const bool same_pattern = factor_ != nullptr && is_fixed_ == system.is_fixed &&
                                  row_begin_ == system.matrix.row_begin &&
                                  columns_ == system.matrix.columns;
        is_fixed_ = system.is_fixed;
        LowerTriangle A = to_lower_triangle(to_scalar(system.matrix, is_fixed_, true, kept_));
        if (!same_pattern) {
            release();
            if (!kept_.empty()) {
                analyze(system.matrix, A);
            }
            row_begin_ = system.matrix.row_begin;
            columns_ = system.matrix.columns;
        }
        if (!kept_.empty()) {
            check_memory();
            factorize_numbers(system.matrix, A);
        }
        matrix_ = &system.matrix;
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (matrix_ == nullptr) {
            throw SolverError("cholmod: solve was called before factorize succeeded");
        }
        check_right_hand_side(*matrix_, b, "cholmod");
        SolveReport report = solve_refined(
            "cholmod", *matrix_, is_fixed_, b, options_.tolerance,
            [this](const MatrixX& r) { return apply_inverse(r); },
            fmt::format("smallest pivot {:.1e} of its diagonal entry", smallest_pivot_), x);
        report.memory = factor_bytes();
        return report;
    }

  private:
    void release() {
        cholmod_l_free_factor(&factor_, common_.get());
        matrix_ = nullptr;
    }

    /// Orders the graph of blocks, then the unknowns block by block, and finds the pattern of L.
    void analyze(const BlockMatrix& matrix, LowerTriangle& A) {
        std::vector<int> n_kept_of_row(matrix.n_rows, 0);
        for (const int unknown : kept_) {
            ++n_kept_of_row[unknown / matrix.block_size];
        }
        LowerTriangle graph = block_graph(matrix, n_kept_of_row);
        cholmod_sparse graph_view = graph.view();
        std::vector<Index> node_order(graph_view.ncol);
        cholmod_l_metis(&graph_view, nullptr, 0, 1, node_order.data(), common_.get());
        common_.check("ordering");

        std::vector<Index> first_of_node;
        Index n_unknowns = 0;
        for (const int n : n_kept_of_row) {
            if (n > 0) {
                first_of_node.push_back(n_unknowns);
                n_unknowns += n;
            }
        }
        first_of_node.push_back(n_unknowns);
        std::vector<Index> order;
        order.reserve(n_unknowns);
        for (const Index node : node_order) {
            for (Index i = first_of_node[node]; i < first_of_node[node + 1]; ++i) {
                order.push_back(i);
            }
        }
        cholmod_sparse view = A.view();
        factor_ = cholmod_l_analyze_p(&view, order.data(), nullptr, 0, common_.get());
        common_.check("analysis");
    }

    /// Factor and largest update matrix, bytes.
    [[nodiscard]] std::size_t factor_bytes() const {
        return factor_ == nullptr ? 0
                                  : (factor_->xsize + factor_->maxcsize) * sizeof(double) +
                                        factor_->ssize * sizeof(Index);
    }

    void check_memory() {
        const std::size_t needed = factor_bytes();
        const bool is_given = options_.memory_limit > 0;
        // A factor that is there already is reused.
        const std::size_t held = factor_->x != nullptr ? factor_->xsize * sizeof(double) : 0;
        const std::size_t limit = is_given ? options_.memory_limit : available_memory() + held;
        if (needed > limit) {
            const std::size_t n_entries = factor_->xsize;
            release();
            constexpr double megabyte = 1e6;
            throw FactorTooLarge(
                "cholmod: the factor of {} unknowns has {} entries and needs {:.4g} MB, {} {:.4g} "
                "MB; use petsc or a coarser mesh",
                kept_.size(), n_entries, static_cast<double>(needed) / megabyte,
                is_given ? "the limit is" : "the machine has free",
                static_cast<double>(limit) / megabyte);
        }
    }

    void factorize_numbers(const BlockMatrix& matrix, LowerTriangle& A) {
        cholmod_sparse view = A.view();
        cholmod_l_factorize(&view, factor_, common_.get());
        if (common_->status == CHOLMOD_NOT_POSDEF) {
            const Index column = static_cast<const Index*>(factor_->Perm)[factor_->minor];
            release();
            throw NotPositiveDefinite(
                "cholmod: the matrix is not positive definite: the pivot of {} is not positive; "
                "check supports, material parameters and folded elements",
                describe_unknown(matrix, kept_[column]));
        }
        common_.check("factorization");
        check_pivots(matrix, A);
    }

    /// A singular matrix often passes with a pivot that is rounding. Then A^-1 times anything is a
    /// motion without energy.
    void check_pivots(const BlockMatrix& matrix, const LowerTriangle& A) {
        const auto* first_column = static_cast<const Index*>(factor_->super);
        const auto* row_begin = static_cast<const Index*>(factor_->pi);
        const auto* value_begin = static_cast<const Index*>(factor_->px);
        const auto* values = static_cast<const double*>(factor_->x);
        const auto* order = static_cast<const Index*>(factor_->Perm);
        smallest_pivot_ = 1.0;
        int weakest = 0;
        double largest_diagonal = 0.0;
        for (std::size_t s = 0; s < factor_->nsuper; ++s) {
            const Index n_rows = row_begin[s + 1] - row_begin[s];
            for (Index j = first_column[s]; j < first_column[s + 1]; ++j) {
                const double root = values[value_begin[s] + (j - first_column[s]) * (n_rows + 1)];
                const double diagonal = A.values[A.begin[order[j]]];
                largest_diagonal = std::max(largest_diagonal, diagonal);
                if (!(root * root > smallest_pivot_ * diagonal)) {
                    smallest_pivot_ = root * root / diagonal;
                    weakest = kept_[order[j]];
                }
            }
        }
        if (smallest_pivot_ > suspicious_pivot) {
            return;
        }
        VectorX probe(matrix.n_unknowns());
        for (Eigen::Index i = 0; i < probe.size(); ++i) {
            probe[i] = std::sin(1.0 + 2.4 * static_cast<double>(i));
        }
        const MatrixX motion = apply_inverse(free_part(is_fixed_, probe));
        const double force = free_part(is_fixed_, matrix * motion).norm();
        if (!(force > singular_energy * largest_diagonal * motion.norm())) {
            release();
            throw SolverError(
                "cholmod: the matrix is singular: the pivot of {} is {:.2g} of its diagonal entry; "
                "check that supports hold every rigid-body motion",
                describe_unknown(matrix, weakest), smallest_pivot_);
        }
    }

    /// A^-1 b, zero at fixed unknowns.
    MatrixX apply_inverse(const MatrixX& b) {
        MatrixX x = MatrixX::Zero(b.rows(), b.cols());
        if (kept_.empty() || b.cols() == 0) {
            return x;
        }
        MatrixX kept_b = b(kept_, Eigen::all);
        cholmod_dense view{};
        view.nrow = view.d = static_cast<std::size_t>(kept_b.rows());
        view.ncol = static_cast<std::size_t>(kept_b.cols());
        view.nzmax = static_cast<std::size_t>(kept_b.size());
        view.x = kept_b.data();
        view.xtype = CHOLMOD_REAL;
        view.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* solution = cholmod_l_solve(CHOLMOD_A, factor_, &view, common_.get());
        common_.check("solution");
        x(kept_, Eigen::all) = Eigen::Map<const MatrixX>(static_cast<const double*>(solution->x),
                                                         kept_b.rows(), kept_b.cols());
        cholmod_l_free_dense(&solution, common_.get());
        return x;
    }

    SolverOptions options_;
    Common common_;
    cholmod_factor* factor_ = nullptr;
    /// The smallest, as part of its diagonal entry.
    double smallest_pivot_ = 1.0;
    const BlockMatrix* matrix_ = nullptr;
    std::vector<char> is_fixed_;
    std::vector<std::int64_t> row_begin_;
    std::vector<int> columns_;
    /// Original number of each unknown of the factor.
    std::vector<int> kept_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_solver(const SolverOptions& options) {
    return std::make_unique<CholmodSolver>(options);
}

}  // namespace couture::iga
