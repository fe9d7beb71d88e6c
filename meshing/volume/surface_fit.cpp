#include "meshing/volume/surface_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"
#include "iga/spline/gauss.h"
#include "iga/spline/patch.h"
#include "meshing/volume/coons.h"

namespace couture::meshing {

namespace {

// Of a sparse matrix.
struct Entry {
    int row;
    int column;
    double value;
};

// Integrals of products of the k-th derivatives of the functions, k = 0 .. 2.
std::array<MatrixX, 3> gram_matrices(const iga::KnotVector& knots) {
    std::array<MatrixX, 3> result;
    result.fill(MatrixX::Zero(knots.n_basis(), knots.n_basis()));
    const iga::GaussRule rule = iga::gauss_rule(knots.degree() + 1);
    for (int e = 0; e < knots.n_elements(); ++e) {
        const double start = knots.breakpoints()[e];
        const double length = knots.breakpoints()[e + 1] - start;
        const int span = knots.span_of_element(e);
        const int first = span - knots.degree();
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
            const MatrixX N =
                iga::basis_derivatives(knots, span, start + length * rule.points[q], 2);
            for (int k = 0; k < 3; ++k) {
                result[k].block(first, first, N.cols(), N.cols()) +=
                    length * rule.weights[q] * N.row(k).transpose() * N.row(k);
            }
        }
    }
    return result;
}

// Entries of the weighted integral of |x_ss|^2, in the plane |x_ss|^2 + 2 |x_st|^2 + |x_tt|^2.
template <int d>
std::vector<Entry> bending_energy(const iga::TensorSpace<d>& space, double fairness) {
    std::array<std::array<MatrixX, 3>, d> gram;
    double scale = fairness;
    double h = 1.0;
    int degree = 0;
    for (int k = 0; k < d; ++k) {
        gram[k] = gram_matrices(space.knots[k]);
        h = std::min(h, 1.0 / space.knots[k].n_elements());
        degree = std::max(degree, space.knots[k].degree());
    }
    scale *= std::pow(h, 2 * (degree + 1));
    std::vector<Entry> entries;
    for (int row = 0; row < space.n_basis(); ++row) {
        const auto i = space.indices(row);
        for (int column = 0; column < space.n_basis(); ++column) {
            const auto j = space.indices(column);
            double value = 0.0;
            if constexpr (d == 1) {
                value = gram[0][2](i[0], j[0]);
            } else {
                const auto entry = [&](int k, int m) { return gram[k][m](i[k], j[k]); };
                value = entry(0, 2) * entry(1, 0) + 2.0 * entry(0, 1) * entry(1, 1) +
                        entry(0, 0) * entry(1, 2);
            }
            if (value != 0.0) entries.push_back({row, column, scale * value});
        }
    }
    return entries;
}

// Number among the inner functions, -1 on the border.
template <int d>
std::vector<int> number_inner(const iga::TensorSpace<d>& space) {
    std::vector<int> numbers(space.n_basis(), -1);
    int n = 0;
    for (int i = 0; i < space.n_basis(); ++i) {
        const auto at = space.indices(i);
        bool is_inner = true;
        for (int k = 0; k < d; ++k) {
            is_inner = is_inner && at[k] > 0 && at[k] + 1 < space.knots[k].n_basis();
        }
        if (is_inner) numbers[i] = n++;
    }
    return numbers;
}

// Samples inside a grid with their parameters.
template <int d>
struct Samples {
    MatrixX points;
    std::vector<Vector<d>> parameters;
    /// Between neighbours.
    Vector<d> spacing;
};

template <int d>
Samples<d> inner_samples(const MatrixX& grid, const std::array<int, d>& n) {
    Samples<d> samples;
    std::vector<int> columns;
    for (int k = 0; k < d; ++k) samples.spacing[k] = 1.0 / (n[k] - 1);
    for (int c = 0; c < grid.cols(); ++c) {
        Vector<d> xi;
        bool is_inner = true;
        for (int k = 0, rest = c; k < d; rest /= n[k], ++k) {
            const int i = rest % n[k];
            is_inner = is_inner && i > 0 && i + 1 < n[k];
            xi[k] = i * samples.spacing[k];
        }
        if (!is_inner) continue;
        columns.push_back(c);
        samples.parameters.push_back(xi);
    }
    samples.points = grid(Eigen::all, columns);
    return samples;
}

// The inner rows that minimise the mean of the squared distances plus the energy.
template <int d>
MatrixX least_squares(const iga::TensorSpace<d>& space, MatrixX net, const Samples<d>& samples,
                      const std::vector<Entry>& energy) {
    const std::vector<int> number = number_inner(space);
    const int n_inner = *std::ranges::max_element(number) + 1;
    if (n_inner == 0 || samples.parameters.empty()) return net;
    MatrixX matrix = MatrixX::Zero(n_inner, n_inner);
    MatrixX right = MatrixX::Zero(n_inner, 3);
    const auto add = [&](int row, int column, double value) {
        if (number[column] >= 0) {
            matrix(number[row], number[column]) += value;
        } else {
            right.row(number[row]) -= value * net.row(column);
        }
    };
    for (const Entry& entry : energy) {
        if (number[entry.row] >= 0) add(entry.row, entry.column, entry.value);
    }
    const double weight = 1.0 / static_cast<double>(samples.parameters.size());
    for (std::size_t s = 0; s < samples.parameters.size(); ++s) {
        const auto basis = iga::evaluate_basis<d>(space, {}, samples.parameters[s]);
        for (std::size_t a = 0; a < basis.functions.size(); ++a) {
            const int row = basis.functions[a];
            if (number[row] < 0) continue;
            right.row(number[row]) += weight * basis.values[a] * samples.points.col(s).transpose();
            for (std::size_t b = 0; b < basis.functions.size(); ++b) {
                add(row, basis.functions[b], weight * basis.values[a] * basis.values[b]);
            }
        }
    }
    const Eigen::LLT<MatrixX> solver(matrix);
    if (solver.info() != Eigen::Success) {
        throw SolverError("fit: the samples don't determine {} control points; take more", n_inner);
    }
    const MatrixX inner = solver.solve(right);
    for (int i = 0; i < net.rows(); ++i) {
        if (number[i] >= 0) net.row(i) = inner.row(number[i]);
    }
    return net;
}

// One step of Gauss-Newton to the nearest point, at most half way to the next sample.
template <int d>
void correct_parameters(const iga::Patch<d>& patch, Samples<d>& samples) {
    for (std::size_t s = 0; s < samples.parameters.size(); ++s) {
        Vector<d>& xi = samples.parameters[s];
        const Eigen::Matrix<double, 3, d> J = patch.jacobian(xi);
        const Vector3 gap = samples.points.col(s) - patch.point(xi);
        const Matrix<d> metric = J.transpose() * J;
        Vector<d> step = metric.ldlt().solve(J.transpose() * gap);
        if (!step.allFinite()) continue;
        const double ratio = (step.cwiseAbs().array() / samples.spacing.array()).maxCoeff();
        if (ratio > 0.5) step *= 0.5 / ratio;
        xi = (xi + step).cwiseMax(0.0).cwiseMin(1.0);
    }
}

template <int d>
SplineFit fit(const iga::TensorSpace<d>& given, MatrixX net, const MatrixX& grid,
              const std::array<int, d>& n, const FitOptions& options) {
    iga::TensorSpace<d> space = given;
    for (auto& knots : space.knots) knots = knots.rescaled(0.0, 1.0);
    Samples<d> samples = inner_samples<d>(grid, n);
    const std::vector<Entry> energy = bending_energy<d>(space, options.fairness);
    net = least_squares<d>(space, std::move(net), samples, energy);
    for (int i = 0; i < options.n_corrections; ++i) {
        correct_parameters<d>(iga::Patch<d>(space, net), samples);
        net = least_squares<d>(space, std::move(net), samples, energy);
    }
    const iga::Patch<d> patch(space, net);
    correct_parameters<d>(patch, samples);
    SplineFit result{std::move(net)};
    for (std::size_t s = 0; s < samples.parameters.size(); ++s) {
        const double squared =
            (patch.point(samples.parameters[s]) - samples.points.col(s)).squaredNorm();
        result.max_distance = std::max(result.max_distance, std::sqrt(squared));
        result.sum_of_squares += squared;
    }
    return result;
}

}  // namespace

SplineFit fit_curve(const iga::KnotVector& knots, const MatrixX& points,
                    const FitOptions& options) {
    check_fit_options(options);
    if (points.rows() != 3 || points.cols() < 2) {
        throw InputError("fit_curve: {} x {} points; there must be 3 coordinates of 2 or more",
                         points.rows(), points.cols());
    }
    MatrixX net =
        straight_net(knots, points.col(0).transpose(), points.col(points.cols() - 1).transpose());
    return fit<1>({{knots}}, std::move(net), points, {static_cast<int>(points.cols())}, options);
}

SplineFit fit_surface(const iga::TensorSpace<2>& space, const MatrixX& net, const MatrixX& points,
                      const std::array<int, 2>& n, const FitOptions& options) {
    check_fit_options(options);
    if (points.rows() != 3 || n[0] < 2 || n[1] < 2 || points.cols() != n[0] * n[1]) {
        throw InputError("fit_surface: {} x {} points for a grid of {} x {}", points.rows(),
                         points.cols(), n[0], n[1]);
    }
    return fit<2>(space, fill_coons<2>(space, net), points, n, options);
}

void check_fit_options(const FitOptions& options) {
    if (!(options.fairness >= 0.0) || !std::isfinite(options.fairness)) {
        throw InputError("fit: fairness = {}; it must be finite and not negative",
                         options.fairness);
    }
    if (options.n_corrections < 0 || options.n_corrections > 20) {
        throw InputError("fit: n_corrections = {}; it must lie in [0, 20]", options.n_corrections);
    }
}

}  // namespace couture::meshing
