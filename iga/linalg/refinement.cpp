#include "iga/linalg/refinement.h"

#include <fmt/format.h>

#include <limits>

#include "iga/core/error.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

/// Residuals above it are refined, as long as that helps.
constexpr double refinement_goal = 1e-13;
constexpr int max_refinements = 4;
/// A residual above the tolerance is accepted as rounding up to here.
constexpr double largest_rounding = 1e-6;

}  // namespace

SolveReport solve_refined(const std::string& solver, const BlockMatrix& matrix,
                          const std::vector<char>& is_fixed, const MatrixX& b, double tolerance,
                          const std::function<MatrixX(const MatrixX&)>& apply_inverse,
                          const std::string& diagnosis, MatrixX& x) {
    const MatrixX free_b = free_part(is_fixed, b);
    SolveReport report;
    report.solver = solver;
    x = apply_inverse(free_b);
    MatrixX r = residual(matrix, is_fixed, free_b, x);
    report.residual = worst_ratio(r, free_b);
    for (int i = 0; i < max_refinements && report.residual > refinement_goal; ++i) {
        const MatrixX better_x = x + apply_inverse(r);
        MatrixX better_r = residual(matrix, is_fixed, free_b, better_x);
        const double better_residual = worst_ratio(better_r, free_b);
        ++report.iterations;
        if (!(better_residual < report.residual)) {
            break;
        }
        const bool has_stalled = better_residual > 0.5 * report.residual;
        x = better_x;
        r = std::move(better_r);
        report.residual = better_residual;
        if (has_stalled) {
            break;
        }
    }
    // A tolerance below the precision of one number is refused like any other that is missed.
    if (report.residual > tolerance && report.residual <= largest_rounding &&
        tolerance >= std::numeric_limits<double>::epsilon()) {
        const double rounding = rounding_ratio(matrix, is_fixed, free_b, x);
        if (report.residual <= rounding) {
            report.note =
                fmt::format("the residual is the rounding of A x: |A| |x| is {:.1e} times |b|",
                            rounding / std::numeric_limits<double>::epsilon());
            return report;
        }
    }
    if (!(report.residual <= tolerance)) {
        throw SolverError(
            "{}: |b - A x| / |b| = {:.3g} > {:.3g} after {} refinements; the matrix is "
            "ill-conditioned ({}): scale the problem or raise the tolerance",
            solver, report.residual, tolerance, report.iterations, diagnosis);
    }
    return report;
}

}  // namespace couture::iga
