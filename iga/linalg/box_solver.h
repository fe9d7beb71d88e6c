#pragma once

#include <array>
#include <memory>

#include "iga/linalg/patch_coefficients.h"
#include "iga/linalg/univariate.h"

namespace couture::iga {

/// Solves sum_k stretch[k] K_k + reaction M on a tensor grid of functions, K_k the Kronecker
/// product of the stiffness matrix in direction k with mass matrices in the others, by the
/// eigenvectors of each direction: cost 4 (n_0 + n_1 + n_2) per unknown.
///
/// Source: [SangalliTani16], the direct method of fast diagonalization.
class BoxSolver {
  public:
    /// A zero eigenvalue (no end is held, no reaction) is replaced by the lowest one that is not.
    BoxSolver(std::array<std::shared_ptr<const Eigenbasis>, 3> bases,
              const PatchCoefficients& coefficients);

    [[nodiscard]] int first(int direction) const { return bases_[direction]->first; }
    [[nodiscard]] int size(int direction) const { return bases_[direction]->size(); }
    [[nodiscard]] int size() const { return size(0) * size(1) * size(2); }
    [[nodiscard]] const Eigenbasis& basis(int direction) const { return *bases_[direction]; }
    /// Replaces a right-hand side (first direction fastest) by the solution.
    void solve(VectorX& values) const;

  private:
    std::array<std::shared_ptr<const Eigenbasis>, 3> bases_;
    /// 1 / eigenvalue of each product of eigenvectors.
    VectorX inverses_;
};

/// Replaces eigenvalues that are zero but for rounding by the lowest that are not (1 if none is).
void shift_zeros(VectorX& values);

}  // namespace couture::iga
