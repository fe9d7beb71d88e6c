#pragma once

#include <vector>

#include "iga/core/types.h"

namespace couture::iga {

constexpr int max_degree = 8;

/// An open knot vector with its degree: the first and the last knot are repeated degree + 1 times,
/// interior knots at most degree times (functions are at least continuous). Or, made by
/// `restricted` alone, a part of one, with the knots beyond its ends that its functions have.
class KnotVector {
  public:
    /// Checks the rules above.
    ///
    /// @throws InputError  naming the knot that breaks a rule
    KnotVector(int degree, std::vector<double> knots);

    /// `n_elements` equal spans of [first, last], interior knots simple.
    [[nodiscard]] static KnotVector uniform(int degree, int n_elements, double first = 0.0,
                                            double last = 1.0);

    [[nodiscard]] int degree() const { return degree_; }
    [[nodiscard]] const std::vector<double>& knots() const { return knots_; }
    [[nodiscard]] int n_basis() const { return static_cast<int>(knots_.size()) - degree_ - 1; }
    [[nodiscard]] int n_elements() const { return static_cast<int>(breakpoints_.size()) - 1; }
    /// The interval on which the functions are meant.
    [[nodiscard]] double front() const { return breakpoints_.front(); }
    [[nodiscard]] double back() const { return breakpoints_.back(); }

    /// Distinct knots from front() to back(), n_elements + 1 of them, increasing.
    [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }
    /// How often each breakpoint occurs among the knots, n_elements + 1 numbers.
    [[nodiscard]] const std::vector<int>& multiplicities() const { return multiplicities_; }

    /// Knot span of element `i_element`: the index s with knots[s] <= xi < knots[s + 1] there. The
    /// functions s - degree .. s do not vanish on it.
    [[nodiscard]] int span_of_element(int i_element) const { return element_spans_[i_element]; }
    /// Element that contains xi; the last one for xi = back().
    ///
    /// @throws InputError  if xi lies outside [front(), back()]
    [[nodiscard]] int find_element(double xi) const;
    /// Knot span that contains xi. Source: [PieglTiller97] Alg. A2.1.
    [[nodiscard]] int find_span(double xi) const { return span_of_element(find_element(xi)); }

    /// Means of degree consecutive knots, n_basis of them; for degree 1 the knots themselves.
    [[nodiscard]] std::vector<double> greville() const;

    /// The functions that do not vanish on the elements from `first` on and before `end`, there
    /// only: function i is function span_of_element(first) - degree + i of this. Their knots are
    /// those of this one, not repeated at the new ends.
    ///
    /// @throws InputError  if there are no such elements
    [[nodiscard]] KnotVector restricted(int first, int end) const;
    /// Whether both ends are repeated degree + 1 times.
    [[nodiscard]] bool is_open() const {
        return multiplicities_.front() == degree_ + 1 && multiplicities_.back() == degree_ + 1;
    }

    /// The same functions read backwards: xi -> front() + back() - xi.
    [[nodiscard]] KnotVector reversed() const;
    /// The same functions over [first, last].
    [[nodiscard]] KnotVector rescaled(double first, double last) const;

    /// Equal up to an affine change of the parameter, within `tolerance` of the unit interval.
    [[nodiscard]] bool conforms_to(const KnotVector& other, double tolerance = 1e-10) const;

    bool operator==(const KnotVector&) const = default;

  private:
    struct Part {};
    KnotVector(Part, int degree, std::vector<double> knots);
    void find_elements();

    int degree_;
    std::vector<double> knots_;
    std::vector<double> breakpoints_;
    std::vector<int> multiplicities_;
    std::vector<int> element_spans_;
};

}  // namespace couture::iga
