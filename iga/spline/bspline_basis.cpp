#include "iga/spline/bspline_basis.h"

#include <algorithm>
#include <array>

#include "iga/core/error.h"

namespace couture::iga {

MatrixX basis_derivatives(const KnotVector& knots, double xi, int n_derivatives) {
    return basis_derivatives(knots, knots.find_span(xi), xi, n_derivatives);
}

MatrixX basis_derivatives(const KnotVector& knot_vector, int span, double xi, int n_derivatives) {
    const int p = knot_vector.degree();
    const std::vector<double>& knots = knot_vector.knots();
    constexpr int size = max_degree + 1;
    // Upper triangle: functions of lower degree; lower triangle: knot differences.
    std::array<std::array<double, size>, size> ndu{};
    std::array<double, size> left{};
    std::array<double, size> right{};
    ndu[0][0] = 1.0;
    for (int j = 1; j <= p; ++j) {
        left[j] = xi - knots[span + 1 - j];
        right[j] = knots[span + j] - xi;
        double saved = 0.0;
        for (int r = 0; r < j; ++r) {
            ndu[j][r] = right[r + 1] + left[j - r];
            const double term = ndu[r][j - 1] / ndu[j][r];
            ndu[r][j] = saved + right[r + 1] * term;
            saved = left[j - r] * term;
        }
        ndu[j][j] = saved;
    }

    MatrixX result = MatrixX::Zero(n_derivatives + 1, p + 1);
    for (int j = 0; j <= p; ++j) {
        result(0, j) = ndu[j][p];
    }
    const int n_nonzero = std::min(n_derivatives, p);
    for (int r = 0; r <= p; ++r) {
        std::array<std::array<double, size>, 2> a{};
        int current = 0;
        int next = 1;
        a[0][0] = 1.0;
        for (int k = 1; k <= n_nonzero; ++k) {
            double d = 0.0;
            const int rk = r - k;
            const int pk = p - k;
            if (r >= k) {
                a[next][0] = a[current][0] / ndu[pk + 1][rk];
                d = a[next][0] * ndu[rk][pk];
            }
            const int j1 = rk >= -1 ? 1 : -rk;
            const int j2 = r - 1 <= pk ? k - 1 : p - r;
            for (int j = j1; j <= j2; ++j) {
                a[next][j] = (a[current][j] - a[current][j - 1]) / ndu[pk + 1][rk + j];
                d += a[next][j] * ndu[rk + j][pk];
            }
            if (r <= pk) {
                a[next][k] = -a[current][k - 1] / ndu[pk + 1][r];
                d += a[next][k] * ndu[r][pk];
            }
            result(k, r) = d;
            std::swap(current, next);
        }
    }
    double factor = p;
    for (int k = 1; k <= n_nonzero; ++k) {
        result.row(k) *= factor;
        factor *= p - k;
    }
    return result;
}

BasisTable tabulate(const KnotVector& knots, std::span<const double> breakpoints,
                    std::span<const double> points) {
    BasisTable table;
    table.n_points = static_cast<int>(points.size());
    table.n_functions = knots.degree() + 1;
    for (std::size_t e = 0; e + 1 < breakpoints.size(); ++e) {
        const double first = breakpoints[e];
        const double last = breakpoints[e + 1];
        const int i_element = knots.find_element(0.5 * (first + last));
        const double slack = 1e-12 * (knots.back() - knots.front());
        if (first < knots.breakpoints()[i_element] - slack ||
            last > knots.breakpoints()[i_element + 1] + slack) {
            throw InputError("tabulate: element [{}, {}] crosses a knot of span [{}, {}]", first,
                             last, knots.breakpoints()[i_element],
                             knots.breakpoints()[i_element + 1]);
        }
        const int span = knots.span_of_element(i_element);
        table.first_function.push_back(span - knots.degree());
        for (const double t : points) {
            const MatrixX rows = basis_derivatives(knots, span, first + t * (last - first), 1);
            for (int j = 0; j < table.n_functions; ++j) {
                table.values.push_back(rows(0, j));
                table.derivatives.push_back(rows(1, j));
            }
        }
    }
    return table;
}

}  // namespace couture::iga
