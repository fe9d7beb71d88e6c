#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "iga/spline/bspline_basis.h"
#include "iga/spline/gauss.h"
#include "iga/spline/refine.h"
#include "iga/topology/multipatch.h"

namespace couture::iga {

namespace {

/// Largest ratio of weights within one element along lines in `direction`.
template <int d>
double weight_ratio(const Patch<d>& patch, int direction) {
    if (!patch.is_rational()) {
        return 1.0;
    }
    const TensorSpace<d>& space = patch.space();
    int stride = 1;
    for (int k = 0; k < direction; ++k) {
        stride *= space.knots[k].n_basis();
    }
    const int degree = space.knots[direction].degree();
    const int n = space.knots[direction].n_basis();
    double ratio = 1.0;
    for (int i = 0; i < space.n_basis(); ++i) {
        const int n_behind = std::min(degree, n - 1 - (i / stride) % n);
        for (int j = 1; j <= n_behind; ++j) {
            const double here = patch.weights()[i + j * stride] / patch.weights()[i];
            ratio = std::max({ratio, here, 1.0 / here});
        }
    }
    return ratio;
}

/// Points per element: exact for the polynomial det J of degree d p - 1, and for rational maps
/// enough for a remainder of 1e-17. A parabola of weights 1, 1/r, 1 has its roots at
/// y = sqrt((r + 1) / (r - 1)) off the interval [-1, 1], and the remainder of n Gauss points falls
/// like rho^(-2n) with rho = y + sqrt(1 + y^2).
template <int d>
int n_gauss_points(const Patch<d>& patch, int direction) {
    const int n_polynomial = (d * patch.knots(direction).degree() + 1) / 2;
    const double r = weight_ratio(patch, direction);
    constexpr double no_spread = 1e-14;
    if (r - 1.0 < no_spread) {
        return n_polynomial;
    }
    const double y = std::sqrt((r + 1.0) / (r - 1.0));
    const double rho = y + std::sqrt(1.0 + y * y);
    const double n_rational = -std::log(1e-17) / (2.0 * std::log(rho));
    return static_cast<int>(
        std::min<double>(n_polynomial + std::ceil(n_rational), max_gauss_points));
}

/// One direction's functions at all Gauss points: points x functions.
struct Direction {
    SparseMatrix values;
    SparseMatrix derivatives;
    /// Of every point, in units of the parameter.
    std::vector<double> weights;
};

/// Table of the elements `first` to `last` (excluded); columns count from the first function that
/// does not vanish there.
Direction tabulate_direction(const KnotVector& knots, int n_points, int first, int last) {
    const GaussRule& rule = gauss_rule(n_points);
    const std::vector<double> breakpoints(knots.breakpoints().begin() + first,
                                          knots.breakpoints().begin() + last + 1);
    const BasisTable table = tabulate(knots, breakpoints, rule.points);
    const int n_elements = last - first;
    const int offset = table.first_function.front();
    const int n_columns = table.first_function.back() + table.n_functions - offset;
    std::vector<Eigen::Triplet<double>> values;
    std::vector<Eigen::Triplet<double>> derivatives;
    Direction direction;
    for (int e = 0; e < n_elements; ++e) {
        for (int q = 0; q < n_points; ++q) {
            const int row = e * n_points + q;
            for (int j = 0; j < table.n_functions; ++j) {
                const int column = table.first_function[e] - offset + j;
                values.emplace_back(row, column, table.value(e, q)[j]);
                derivatives.emplace_back(row, column, table.derivative(e, q)[j]);
            }
            direction.weights.push_back(rule.weights[q] * (breakpoints[e + 1] - breakpoints[e]));
        }
    }
    direction.values.resize(n_elements * n_points, n_columns);
    direction.values.setFromTriplets(values.begin(), values.end());
    direction.derivatives.resize(n_elements * n_points, n_columns);
    direction.derivatives.setFromTriplets(derivatives.begin(), derivatives.end());
    return direction;
}

/// |det J|, or sqrt(det J^T J) of a surface in space.
template <int d>
double measure(const MatrixX& J) {
    if (J.rows() == d) {
        return std::abs(Matrix<d>(J).determinant());
    }
    return std::sqrt(std::abs(Matrix<d>(J.transpose() * J).determinant()));
}

/// Integral over the grid of Gauss points of the given directions.
template <int d>
double grid_volume(const std::array<Direction, d>& directions, const MatrixX& homogeneous,
                   bool is_rational) {
    // Homogeneous rows X and their derivatives on the grid: [0] values, [1 + k] d / dxi_k.
    std::array<MatrixX, d + 1> X;
    for (int which = 0; which <= d; ++which) {
        std::array<SparseMatrix, d> matrices;
        for (int k = 0; k < d; ++k) {
            matrices[k] = which == k + 1 ? directions[k].derivatives : directions[k].values;
        }
        X[which] = apply_kronecker<d>(matrices, homogeneous);
    }
    const Eigen::Index dimension = homogeneous.cols() - 1;
    double sum = 0.0;
    MatrixX J(dimension, d);
    for (Eigen::Index point = 0; point < X[0].rows(); ++point) {
        Eigen::Index rest = point;
        double weight = 1.0;
        for (int k = 0; k < d; ++k) {
            const auto n = static_cast<Eigen::Index>(directions[k].weights.size());
            weight *= directions[k].weights[rest % n];
            rest /= n;
        }
        for (int k = 0; k < d; ++k) {
            J.col(k) = X[k + 1].row(point).head(dimension).transpose();
            if (is_rational) {
                const double W = X[0](point, dimension);
                const double dW = X[k + 1](point, dimension);
                J.col(k) = (J.col(k) - dW / W * X[0].row(point).head(dimension).transpose()) / W;
            }
        }
        sum += weight * measure<d>(J);
    }
    return sum;
}

template <int d>
double patch_volume(const Patch<d>& patch) {
    const TensorSpace<d>& space = patch.space();
    std::array<Direction, d> directions;
    for (int k = 0; k < d - 1; ++k) {
        directions[k] = tabulate_direction(space.knots[k], n_gauss_points(patch, k), 0,
                                           space.knots[k].n_elements());
    }
    // Slabs of one element in the last direction keep the grid small.
    const KnotVector& last = space.knots[d - 1];
    const int n_points = n_gauss_points(patch, d - 1);
    const int n_layer = space.n_basis() / last.n_basis();
    const MatrixX homogeneous = patch.homogeneous();
    double sum = 0.0;
    for (int e = 0; e < last.n_elements(); ++e) {
        directions[d - 1] = tabulate_direction(last, n_points, e, e + 1);
        const int first = last.span_of_element(e) - last.degree();
        sum += grid_volume<d>(
            directions, homogeneous.middleRows(first * n_layer, (last.degree() + 1) * n_layer),
            patch.is_rational());
    }
    return sum;
}

}  // namespace

template <int d>
double volume(const MultiPatch<d>& multipatch) {
    double sum = 0.0;
    for (const Patch<d>& patch : multipatch.patches) {
        sum += patch_volume(patch);
    }
    return sum;
}

template double volume(const MultiPatch<2>&);
template double volume(const MultiPatch<3>&);

}  // namespace couture::iga
