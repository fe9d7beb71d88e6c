#include "iga/linalg/univariate.h"

#include <Eigen/Eigenvalues>

#include "iga/spline/bspline_basis.h"
#include "iga/spline/gauss.h"

namespace couture::iga {

Univariate make_univariate(const KnotVector& knots) {
    const KnotVector unit = knots.rescaled(0.0, 1.0);
    const int degree = unit.degree();
    const int n = unit.n_basis();
    Univariate result;
    result.stiffness = MatrixX::Zero(n, n);
    result.mass = MatrixX::Zero(n, n);
    const GaussRule& rule = gauss_rule(degree + 1);
    for (int e = 0; e < unit.n_elements(); ++e) {
        const double start = unit.breakpoints()[e];
        const double length = unit.breakpoints()[e + 1] - start;
        const int span = unit.span_of_element(e);
        const int first = span - degree;
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
            const MatrixX N = basis_derivatives(unit, span, start + length * rule.points[q], 1);
            const double weight = length * rule.weights[q];
            result.mass.block(first, first, degree + 1, degree + 1) +=
                weight * N.row(0).transpose() * N.row(0);
            result.stiffness.block(first, first, degree + 1, degree + 1) +=
                weight * N.row(1).transpose() * N.row(1);
        }
    }
    const std::vector<double> greville = unit.greville();
    result.linear = Eigen::Map<const VectorX>(greville.data(), n);
    result.square = result.linear.cwiseAbs2();
    result.integral = result.mass.rowwise().sum();
    if (degree > 1) {
        // The blossom of xi^2: the mean product of two of the function's inner knots.
        for (int i = 0; i < n; ++i) {
            double sum = 0.0;
            double sum_of_squares = 0.0;
            for (int k = 1; k <= degree; ++k) {
                sum += unit.knots()[i + k];
                sum_of_squares += unit.knots()[i + k] * unit.knots()[i + k];
            }
            result.square[i] = (sum * sum - sum_of_squares) / (degree * (degree - 1));
        }
    }
    return result;
}

Univariate make_constant() {
    Univariate result;
    result.stiffness = MatrixX::Zero(1, 1);
    result.mass = MatrixX::Ones(1, 1);
    result.linear = VectorX::Zero(1);
    result.square = VectorX::Zero(1);
    result.integral = VectorX::Ones(1);
    return result;
}

Eigenbasis make_eigenbasis(const Univariate& functions, bool without_first, bool without_last) {
    Eigenbasis result;
    result.first = without_first ? 1 : 0;
    const int size = std::max(functions.size() - result.first - (without_last ? 1 : 0), 0);
    if (size == 0) {
        return result;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixX> solver(
        functions.stiffness.block(result.first, result.first, size, size),
        functions.mass.block(result.first, result.first, size, size));
    result.values = solver.eigenvalues().cwiseMax(0.0);
    result.vectors = solver.eigenvectors();
    return result;
}

}  // namespace couture::iga
