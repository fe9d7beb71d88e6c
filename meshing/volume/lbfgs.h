#pragma once

#include <deque>

#include "iga/core/types.h"

namespace couture::meshing {

/// Limited-memory BFGS approximation of an inverse Hessian from the last steps.
///
/// Source: [NocedalWright06] Alg. 7.4, Eq. (7.20).
class Lbfgs {
  public:
    explicit Lbfgs(int n_kept = 12) : n_kept_(n_kept) {}

    void clear() { pairs_.clear(); }
    [[nodiscard]] bool is_empty() const { return pairs_.empty(); }
    /// Records a step and the change of the gradient along it; one without positive curvature is
    /// left out.
    void add(const VectorX& step, const VectorX& gradient_change);
    /// Minus the inverse Hessian times the gradient; minus the gradient if nothing is recorded.
    [[nodiscard]] VectorX direction(const VectorX& gradient) const;

  private:
    struct Pair {
        VectorX s;
        VectorX y;
        double rho = 0.0;
    };
    int n_kept_;
    std::deque<Pair> pairs_;
};

}  // namespace couture::meshing
