#include "iga/spline/approximate.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"

namespace couture::iga {

namespace {

/// Banded LU factors of the values of all functions at the Greville points. The matrix is totally
/// positive: elimination needs no pivoting ([deBoor01] Ch. XIII).
class GrevilleCollocation {
  public:
    explicit GrevilleCollocation(const KnotVector& knots)
        : n_(knots.n_basis()),
          width_(knots.degree()),
          band_(MatrixX::Zero(2 * knots.degree() + 1, knots.n_basis())) {
        const std::vector<double> points = knots.greville();
        for (int i = 0; i < n_; ++i) {
            const int first = knots.find_span(points[i]) - width_;
            const MatrixX values = basis_derivatives(knots, points[i], 0);
            for (int k = 0; k <= width_; ++k) {
                // Beyond the band the values are zero up to the rounding of the point.
                if (std::abs(first + k - i) <= width_) {
                    entry(i, first + k) = values(0, k);
                }
            }
        }
        for (int k = 0; k < n_; ++k) {
            const int end = std::min(n_, k + width_ + 1);
            for (int i = k + 1; i < end; ++i) {
                entry(i, k) /= entry(k, k);
                for (int j = k + 1; j < end; ++j) {
                    entry(i, j) -= entry(i, k) * entry(k, j);
                }
            }
        }
    }

    /// Replaces each column of values by coefficients.
    void solve_in_place(Eigen::Map<MatrixX> columns) const {
        for (Eigen::Index c = 0; c < columns.cols(); ++c) {
            for (int i = 1; i < n_; ++i) {
                for (int j = std::max(0, i - width_); j < i; ++j) {
                    columns(i, c) -= entry(i, j) * columns(j, c);
                }
            }
            for (int i = n_ - 1; i >= 0; --i) {
                for (int j = i + 1; j < std::min(n_, i + width_ + 1); ++j) {
                    columns(i, c) -= entry(i, j) * columns(j, c);
                }
                columns(i, c) /= entry(i, i);
            }
        }
    }

  private:
    [[nodiscard]] double& entry(int i, int j) { return band_(j - i + width_, i); }
    [[nodiscard]] double entry(int i, int j) const { return band_(j - i + width_, i); }

    int n_;
    int width_;
    MatrixX band_;
};

}  // namespace

template <int d>
std::vector<Vector<d>> greville_points(const TensorSpace<d>& space) {
    std::array<std::vector<double>, d> points;
    for (int k = 0; k < d; ++k) {
        points[k] = space.knots[k].greville();
    }
    std::vector<Vector<d>> result(space.n_basis());
    for (int i = 0; i < space.n_basis(); ++i) {
        const std::array<int, d> indices = space.indices(i);
        for (int k = 0; k < d; ++k) {
            result[i][k] = points[k][indices[k]];
        }
    }
    return result;
}

template <int d>
MatrixX interpolate(const TensorSpace<d>& space, const MatrixX& values) {
    if (values.rows() != space.n_basis()) {
        throw InputError("interpolate: {} rows of values for {} functions", values.rows(),
                         space.n_basis());
    }
    MatrixX current = values;
    const Eigen::Index dimension = values.cols();
    // Each step solves along the first index and moves it behind the others.
    for (const KnotVector& knots : space.knots) {
        const Eigen::Index n = knots.n_basis();
        const Eigen::Map<MatrixX> unfolded(current.data(), n, current.size() / n);
        GrevilleCollocation(knots).solve_in_place(unfolded);
        const MatrixX turned = unfolded.transpose();
        current = turned;
    }
    const Eigen::Map<const MatrixX> unfolded(current.data(), dimension, space.n_basis());
    return unfolded.transpose();
}

template <int d>
MatrixX interpolate(const TensorSpace<d>& space, int dimension,
                    const std::function<VectorX(const Vector<d>&)>& function) {
    const std::vector<Vector<d>> points = greville_points(space);
    MatrixX values(space.n_basis(), dimension);
    for (int i = 0; i < space.n_basis(); ++i) {
        const Vector<d>& xi = points[i];
        const VectorX value = function(xi);
        if (value.size() != dimension) {
            throw InputError("interpolate: the function returns {} numbers; {} were promised",
                             value.size(), dimension);
        }
        if (!value.allFinite()) {
            throw InputError(
                "interpolate: the function is not finite at Greville point {}, xi[0] = {}", i,
                xi[0]);
        }
        values.row(i) = value.transpose();
    }
    return interpolate<d>(space, values);
}

template std::vector<Vector<1>> greville_points(const TensorSpace<1>&);
template std::vector<Vector<2>> greville_points(const TensorSpace<2>&);
template std::vector<Vector<3>> greville_points(const TensorSpace<3>&);
template MatrixX interpolate<1>(const TensorSpace<1>&, const MatrixX&);
template MatrixX interpolate<2>(const TensorSpace<2>&, const MatrixX&);
template MatrixX interpolate<3>(const TensorSpace<3>&, const MatrixX&);
template MatrixX interpolate<1>(const TensorSpace<1>&, int,
                                const std::function<VectorX(const Vector<1>&)>&);
template MatrixX interpolate<2>(const TensorSpace<2>&, int,
                                const std::function<VectorX(const Vector<2>&)>&);
template MatrixX interpolate<3>(const TensorSpace<3>&, int,
                                const std::function<VectorX(const Vector<3>&)>&);

}  // namespace couture::iga
