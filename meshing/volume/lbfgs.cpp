#include "meshing/volume/lbfgs.h"

#include <vector>

namespace couture::meshing {

namespace {

/// Least curvature of a recorded step, relative to the lengths.
constexpr double min_curvature = 1e-10;

}  // namespace

void Lbfgs::add(const VectorX& step, const VectorX& gradient_change) {
    const double curvature = step.dot(gradient_change);
    if (!(curvature > min_curvature * step.norm() * gradient_change.norm())) {
        return;
    }
    pairs_.push_back({step, gradient_change, 1.0 / curvature});
    if (static_cast<int>(pairs_.size()) > n_kept_) {
        pairs_.pop_front();
    }
}

VectorX Lbfgs::direction(const VectorX& gradient) const {
    VectorX q = -gradient;
    if (pairs_.empty()) {
        return q;
    }
    std::vector<double> alpha(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
        alpha[i] = pairs_[i].rho * pairs_[i].s.dot(q);
        q -= alpha[i] * pairs_[i].y;
    }
    const Pair& last = pairs_.back();
    q *= 1.0 / (last.rho * last.y.squaredNorm());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const double beta = pairs_[i].rho * pairs_[i].y.dot(q);
        q += (alpha[i] - beta) * pairs_[i].s;
    }
    return q;
}

}  // namespace couture::meshing
