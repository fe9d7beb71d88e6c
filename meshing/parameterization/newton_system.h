#pragma once

#include <array>
#include <memory>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Sum of small dense gradients and Hessians of six unknowns each, and the Newton step
/// -H^-1 g. The pattern is analysed once. Runs on one thread, so that results do not depend on
/// their number.
class NewtonSystem {
  public:
    /// Numbers of an element's unknowns, all different; -1 for what is held.
    using Element = std::array<int, 6>;

    NewtonSystem(int n_unknowns, std::vector<Element> elements);
    NewtonSystem(NewtonSystem&&) noexcept;
    NewtonSystem& operator=(NewtonSystem&&) noexcept;
    ~NewtonSystem();

    void set_zero();
    void add(int element, const Vector<6>& gradient, const Matrix<6>& hessian);
    [[nodiscard]] const VectorX& gradient() const { return gradient_; }
    /// The step; a millionth of a millionth of the largest diagonal entry is added to the diagonal.
    ///
    /// @throws SolverError  if the matrix is not positive definite even so
    [[nodiscard]] VectorX step();

  private:
    struct Factor;
    std::vector<Element> elements_;
    /// Place of each entry of an element's Hessian, row by row, among the values; -1 for none.
    std::vector<std::array<int, 36>> places_;
    VectorX gradient_;
    SparseMatrix matrix_;
    std::unique_ptr<Factor> factor_;
};

}  // namespace couture::meshing
