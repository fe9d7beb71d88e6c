#pragma once

#include <span>

#include "iga/spline/knot_vector.h"

namespace couture::iga {

/// Non-zero B-splines at xi and their derivatives up to `n_derivatives`.
///
/// @param xi  parameter in [knots.front(), knots.back()]
/// @return (n_derivatives + 1) x (degree + 1); row k holds d^k N / dxi^k of the functions
///         span - degree .. span; rows above the degree are zero
/// @throws InputError  if xi lies outside that range
///
/// Source: [PieglTiller97] Alg. A2.3; [Maquart19] Eq. (1.2)-(1.3). The 0/0 terms are 0.
[[nodiscard]] MatrixX basis_derivatives(const KnotVector& knots, double xi, int n_derivatives);

/// The same in a given knot span (so that xi may be the upper end of it, seen from the left).
[[nodiscard]] MatrixX basis_derivatives(const KnotVector& knots, int span, double xi,
                                        int n_derivatives);

/// Values and first derivatives of the non-zero functions at many points of each element.
struct BasisTable {
    /// Points per element.
    int n_points = 0;
    /// Functions per element, degree + 1.
    int n_functions = 0;
    /// First non-zero function of each element, n_elements.
    std::vector<int> first_function;
    /// [element][point][function], n_elements * n_points * n_functions.
    std::vector<double> values;
    std::vector<double> derivatives;

    [[nodiscard]] const double* value(int i_element, int i_point) const {
        return &values[(static_cast<std::size_t>(i_element) * n_points + i_point) * n_functions];
    }
    [[nodiscard]] const double* derivative(int i_element, int i_point) const {
        return &derivatives[(static_cast<std::size_t>(i_element) * n_points + i_point) *
                            n_functions];
    }
};

/// Tabulates the functions of `knots` on the elements between `breakpoints`, which must contain
/// all breakpoints of `knots` (a finer grid is allowed).
///
/// @param points  points of each element in (0, 1), the same for all
/// @throws InputError  if an element of `breakpoints` crosses a knot
[[nodiscard]] BasisTable tabulate(const KnotVector& knots, std::span<const double> breakpoints,
                                  std::span<const double> points);

}  // namespace couture::iga
