#include "iga/spline/bezier_cell.h"

#include "iga/spline/refine.h"

namespace couture::iga {

namespace {

/// Bernstein polynomials and two derivatives at t: 3 x (degree + 1).
using BernsteinRows = std::array<std::array<double, max_degree + 1>, 3>;

BernsteinRows bernstein(int degree, double t) {
    BernsteinRows rows{};
    std::array<double, max_degree + 1> lower{};
    lower[0] = 1.0;
    for (int p = 0;; ++p) {
        // `lower` holds the polynomials of degree p.
        if (p == degree - 2) {
            const double factor = degree * (degree - 1.0);
            for (int i = 0; i <= p; ++i) {
                rows[2][i] += factor * lower[i];
                rows[2][i + 1] -= 2.0 * factor * lower[i];
                rows[2][i + 2] += factor * lower[i];
            }
        }
        if (p == degree - 1) {
            for (int i = 0; i <= p; ++i) {
                rows[1][i] -= degree * lower[i];
                rows[1][i + 1] += degree * lower[i];
            }
        }
        if (p == degree) {
            rows[0] = lower;
            return rows;
        }
        for (int i = p + 1; i > 0; --i) {
            lower[i] = (1.0 - t) * lower[i] + t * lower[i - 1];
        }
        lower[0] *= 1.0 - t;
    }
}

/// All interior knots repeated degree times.
Refinement bezier_knots(const KnotVector& knots) {
    std::vector<double> added;
    for (int e = 1; e < knots.n_elements(); ++e) {
        added.insert(added.end(), knots.degree() - knots.multiplicities()[e],
                     knots.breakpoints()[e]);
    }
    return insert_knots(knots, added);
}

}  // namespace

template <int d>
std::vector<BezierCell<d>> bezier_cells(const Patch<d>& patch) {
    std::array<SparseMatrix, d> matrices;
    TensorSpace<d> space = patch.space();
    for (int k = 0; k < d; ++k) {
        Refinement refinement = bezier_knots(patch.knots(k));
        matrices[k] = std::move(refinement.prolongation);
        space.knots[k] = std::move(refinement.knots);
    }
    const MatrixX rows = apply_kronecker<d>(matrices, patch.homogeneous());
    const std::array<int, d> degrees = space.degrees();
    const std::array<int, d> n_elements = space.n_elements();
    int n_cells = 1;
    int n_functions = 1;
    for (int k = 0; k < d; ++k) {
        n_cells *= n_elements[k];
        n_functions *= degrees[k] + 1;
    }
    std::vector<BezierCell<d>> cells(n_cells);
    for (int i_cell = 0; i_cell < n_cells; ++i_cell) {
        BezierCell<d>& cell = cells[i_cell];
        cell.degrees = degrees;
        std::array<int, d> element;
        int rest = i_cell;
        for (int k = 0; k < d; ++k) {
            element[k] = rest % n_elements[k];
            rest /= n_elements[k];
            cell.lower[k] = space.knots[k].breakpoints()[element[k]];
            cell.upper[k] = space.knots[k].breakpoints()[element[k] + 1];
        }
        cell.rows.resize(n_functions, rows.cols());
        for (int i = 0; i < n_functions; ++i) {
            std::array<int, d> global;
            rest = i;
            for (int k = 0; k < d; ++k) {
                global[k] = element[k] * degrees[k] + rest % (degrees[k] + 1);
                rest /= degrees[k] + 1;
            }
            cell.rows.row(i) = rows.row(space.index(global));
        }
    }
    return cells;
}

template <int d>
std::array<BezierCell<d>, 2> halve(const BezierCell<d>& cell, int direction) {
    std::array<BezierCell<d>, 2> halves{cell, cell};
    const double middle = 0.5 * (cell.lower[direction] + cell.upper[direction]);
    halves[0].upper[direction] = middle;
    halves[1].lower[direction] = middle;
    const int p = cell.degrees[direction];
    int stride = 1;
    for (int k = 0; k < direction; ++k) {
        stride *= cell.degrees[k] + 1;
    }
    MatrixX& left = halves[0].rows;
    MatrixX& right = halves[1].rows;
    for (int i = 0; i < cell.rows.rows(); ++i) {
        if (i / stride % (p + 1) != 0) {
            continue;
        }
        // `right` is worked on in place; its first row of each round is the next of `left`.
        for (int round = 1; round <= p; ++round) {
            for (int j = 0; j <= p - round; ++j) {
                right.row(i + j * stride) =
                    0.5 * (right.row(i + j * stride) + right.row(i + (j + 1) * stride));
            }
            left.row(i + round * stride) = right.row(i);
        }
    }
    return halves;
}

template <int d>
BezierPoint<d> evaluate(const BezierCell<d>& cell, const Vector<d>& t) {
    // Columns: value, d first derivatives, d^2 second ones, of the homogeneous coordinates.
    constexpr int n_columns = 1 + d + d * d;
    std::array<BernsteinRows, d> rows;
    for (int k = 0; k < d; ++k) {
        rows[k] = bernstein(cell.degrees[k], t[k]);
    }
    Eigen::Matrix<double, Eigen::Dynamic, n_columns, 0, 4, n_columns> A =
        Eigen::Matrix<double, Eigen::Dynamic, n_columns>::Zero(cell.rows.cols(), n_columns);
    for (int i = 0; i < cell.rows.rows(); ++i) {
        std::array<int, d> local;
        int rest = i;
        for (int k = 0; k < d; ++k) {
            local[k] = rest % (cell.degrees[k] + 1);
            rest /= cell.degrees[k] + 1;
        }
        const auto product = [&](const std::array<int, d>& orders) {
            double value = 1.0;
            for (int k = 0; k < d; ++k) {
                value *= rows[k][orders[k]][local[k]];
            }
            return value;
        };
        Eigen::Matrix<double, 1, n_columns> factors;
        factors[0] = product({});
        for (int k = 0; k < d; ++k) {
            std::array<int, d> orders{};
            orders[k] = 1;
            factors[1 + k] = product(orders);
            for (int l = 0; l <= k; ++l) {
                std::array<int, d> second = orders;
                ++second[l];
                factors[1 + d + k + d * l] = product(second);
                factors[1 + d + l + d * k] = factors[1 + d + k + d * l];
            }
        }
        A += cell.rows.row(i).transpose() * factors;
    }
    const Eigen::Index dimension = cell.rows.cols() - 1;
    const auto w = A.row(dimension);
    BezierPoint<d> result;
    result.x = A.col(0).head(dimension) / w[0];
    result.dx.resize(dimension, d);
    result.ddx.resize(dimension, d * d);
    for (int k = 0; k < d; ++k) {
        result.dx.col(k) = (A.col(1 + k).head(dimension) - w[1 + k] * result.x) / w[0];
    }
    for (int k = 0; k < d; ++k) {
        for (int l = 0; l < d; ++l) {
            const int column = 1 + d + k + d * l;
            result.ddx.col(k + d * l) =
                (A.col(column).head(dimension) - w[1 + k] * result.dx.col(l) -
                 w[1 + l] * result.dx.col(k) - w[column] * result.x) /
                w[0];
        }
    }
    return result;
}

template std::vector<BezierCell<1>> bezier_cells(const Patch<1>&);
template std::vector<BezierCell<2>> bezier_cells(const Patch<2>&);
template std::vector<BezierCell<3>> bezier_cells(const Patch<3>&);
template std::array<BezierCell<1>, 2> halve(const BezierCell<1>&, int);
template std::array<BezierCell<2>, 2> halve(const BezierCell<2>&, int);
template std::array<BezierCell<3>, 2> halve(const BezierCell<3>&, int);
template BezierPoint<1> evaluate(const BezierCell<1>&, const Vector<1>&);
template BezierPoint<2> evaluate(const BezierCell<2>&, const Vector<2>&);
template BezierPoint<3> evaluate(const BezierCell<3>&, const Vector<3>&);

}  // namespace couture::iga
