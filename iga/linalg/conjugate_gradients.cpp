#include "iga/linalg/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

#include "iga/linalg/cholmod_solver.h"
#include "iga/linalg/system_checks.h"

namespace couture::iga {

namespace {

/// The iteration aims below the tolerance by this factor: the recursive residual drifts.
constexpr double safety = 0.5;
constexpr int max_restarts = 3;
/// What counts as progress of the residual.
constexpr double progress = 0.1;

void require_positive(double energy, const std::string& solver, const char* what) {
    if (!(energy > 0.0)) {
        throw NotPositiveDefinite(
            "{}: the {} is not positive definite: an energy is {:.3g}; check supports, material "
            "parameters and folded elements",
            solver, what, energy);
    }
}

}  // namespace

VectorX conjugate_gradients(const std::string& solver,
                            const std::function<VectorX(const VectorX&)>& A,
                            const std::vector<char>& is_fixed, const VectorX& b,
                            const std::function<VectorX(const VectorX&)>& precondition,
                            const ConjugateGradientOptions& options, SolveReport& report) {
    VectorX x = VectorX::Zero(b.size());
    const double b_norm = b.norm();
    if (b_norm == 0.0) {
        return x;
    }
    VectorX r = b;
    double ratio = 1.0;
    int n_iterations = 0;
    bool is_idle = false;
    for (int run = 0; run <= max_restarts && ratio > options.tolerance && !is_idle; ++run) {
        VectorX step = VectorX::Zero(b.size());
        VectorX z = precondition(r);
        VectorX p = z;
        double rz = r.dot(z);
        const double goal = safety * options.tolerance * b_norm;
        double milestone = r.norm();
        int n_idle = 0;
        while (r.norm() > goal && n_iterations < options.max_iterations) {
            require_positive(rz, solver, "preconditioner");
            const VectorX Ap = free_part(is_fixed, A(p));
            const double energy = p.dot(Ap);
            require_positive(energy, solver, "matrix");
            const double alpha = rz / energy;
            step += alpha * p;
            r -= alpha * Ap;
            ++n_iterations;
            const double r_norm = r.norm();
            n_idle = r_norm < progress * milestone ? 0 : n_idle + 1;
            milestone = n_idle == 0 ? r_norm : milestone;
            if (n_idle > options.max_idle_iterations) {
                is_idle = true;
                break;
            }
            z = precondition(r);
            const double next_rz = r.dot(z);
            p = z + (next_rz / rz) * p;
            rz = next_rz;
        }
        const VectorX better_x = x + step;
        r = free_part(is_fixed, b - A(better_x));
        const double better_ratio = r.norm() / b_norm;
        if (!(better_ratio < ratio)) {
            break;
        }
        x = better_x;
        ratio = better_ratio;
        if (n_iterations >= options.max_iterations) {
            break;
        }
    }
    report.iterations = std::max(report.iterations, n_iterations);
    report.residual = std::max(report.residual, ratio);
    if (!(ratio <= options.tolerance)) {
        throw SolverError(
            "{}: {} after {} iterations with |b - A x| / |b| = {:.3g} > {:.3g}; {}", solver,
            is_idle ? "stalled" : "stopped", n_iterations, ratio, options.tolerance,
            n_iterations >= options.max_iterations
                ? "raise max_iterations or use cholmod"
                : "the matrix may be singular or too ill-conditioned for this tolerance: check "
                  "supports, or use cholmod");
    }
    return x;
}

}  // namespace couture::iga
