#include "iga/assembly/geometry_grid.h"

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/spline/gauss.h"

namespace couture::iga {

QuadratureLine::QuadratureLine(const KnotVector& elements, int n)
    : n_elements(elements.n_elements()), points_per_element(n) {
    const GaussRule& rule = gauss_rule(n);
    unit_points.assign(rule.points.begin(), rule.points.end());
    for (int e = 0; e < n_elements; ++e) {
        const double first = elements.breakpoints()[e];
        const double length = elements.breakpoints()[e + 1] - first;
        for (int q = 0; q < n; ++q) {
            points.push_back(first + length * rule.points[q]);
            weights.push_back(length * rule.weights[q]);
        }
    }
}

namespace {

template <int d, std::size_t... k>
std::array<QuadratureLine, d> make_lines(const TensorSpace<d>& elements,
                                         const std::array<int, d>& points_per_element,
                                         std::index_sequence<k...>) {
    return {QuadratureLine(elements.knots[k], points_per_element[k])...};
}

}  // namespace

namespace {

using Vector4d = double __attribute__((vector_size(32)));

/// Sum of basis[i] times row i; rows are `stride` apart and `width` long, both multiples of 4.
void contract(const double* rows, std::size_t stride, std::size_t width, const double* basis,
              int n_functions, double* out) {
    for (std::size_t c = 0; c < width; c += 4) {
        const double* column = rows + c;
        Vector4d sum = basis[0] * *reinterpret_cast<const Vector4d*>(column);
        for (int i = 1; i < n_functions; ++i) {
            sum += basis[i] * *reinterpret_cast<const Vector4d*>(column + i * stride);
        }
        *reinterpret_cast<Vector4d*>(out + c) = sum;
    }
}

}  // namespace

template <int d>
SplineGrid<d>::SplineGrid(const TensorSpace<d>& space, const TensorSpace<d>& elements,
                          const MatrixX& rows, const std::array<QuadratureLine, d>& lines)
    : sizes_(space.sizes()), stride_((static_cast<int>(rows.cols()) + 3) / 4 * 4) {
    for (int k = 0; k < d; ++k) {
        lines_[k] = &lines[k];
        tables_[k] =
            tabulate(space.knots[k], elements.knots[k].breakpoints(), lines[k].unit_points);
    }
    rows_.assign(rows.rows() * stride_, 0.0);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        for (Eigen::Index c = 0; c < rows.cols(); ++c) {
            rows_[i * stride_ + c] = rows(i, c);
        }
    }
}

template <int d>
void SplineGrid<d>::evaluate(int i_plane, Buffer<double>& values) const {
    const int nc = stride_;
    const int n0 = lines_[0]->n_points();
    const int n1 = lines_[1]->n_points();
    values.resize(static_cast<std::size_t>(n0) * n1 * (d + 1) * nc);

    // Last direction: coefficients of the plane, and of its derivative.
    const std::size_t net_size = static_cast<std::size_t>(sizes_[0]) * sizes_[1] * nc;
    Buffer<double> net_value;
    Buffer<double> net_derivative;
    const double* net = rows_.data();
    if constexpr (d == 3) {
        const int e = i_plane / lines_[2]->points_per_element;
        const int q = i_plane % lines_[2]->points_per_element;
        const BasisTable& table = tables_[2];
        const double* first = rows_.data() + table.first_function[e] * net_size;
        net_value.resize(net_size);
        net_derivative.resize(net_size);
        contract(first, net_size, net_size, table.value(e, q), table.n_functions, net_value.data());
        contract(first, net_size, net_size, table.derivative(e, q), table.n_functions,
                 net_derivative.data());
        net = net_value.data();
    }

    const std::size_t row_size = static_cast<std::size_t>(sizes_[0]) * nc;
    Buffer<double> row_value(row_size);
    Buffer<double> row_d1(row_size);
    Buffer<double> row_d2(row_size);
    double* out = values.data();
    for (int q1 = 0; q1 < n1; ++q1) {
        const int e1 = q1 / lines_[1]->points_per_element;
        const int p1 = q1 % lines_[1]->points_per_element;
        const BasisTable& table1 = tables_[1];
        const std::size_t offset = table1.first_function[e1] * row_size;
        contract(net + offset, row_size, row_size, table1.value(e1, p1), table1.n_functions,
                 row_value.data());
        contract(net + offset, row_size, row_size, table1.derivative(e1, p1), table1.n_functions,
                 row_d1.data());
        if constexpr (d == 3) {
            contract(net_derivative.data() + offset, row_size, row_size, table1.value(e1, p1),
                     table1.n_functions, row_d2.data());
        }
        for (int q0 = 0; q0 < n0; ++q0, out += (d + 1) * nc) {
            const int e0 = q0 / lines_[0]->points_per_element;
            const int p0 = q0 % lines_[0]->points_per_element;
            const BasisTable& table0 = tables_[0];
            const std::size_t start = static_cast<std::size_t>(table0.first_function[e0]) * nc;
            const double* N = table0.value(e0, p0);
            const double* dN = table0.derivative(e0, p0);
            const int n_functions = table0.n_functions;
            contract(&row_value[start], nc, nc, N, n_functions, out);
            contract(&row_value[start], nc, nc, dN, n_functions, out + nc);
            contract(&row_d1[start], nc, nc, N, n_functions, out + 2 * nc);
            if constexpr (d == 3) {
                contract(&row_d2[start], nc, nc, N, n_functions, out + 3 * nc);
            }
        }
    }
}

namespace {

template <int d>
MatrixX map_rows(const Patch<d>& patch) {
    if (patch.dimension() != d) {
        throw GeometryError(
            "the patch has {} parameters but {} coordinates; integrals need equal "
            "numbers",
            d, patch.dimension());
    }
    return patch.is_rational() ? patch.homogeneous() : patch.control_points();
}

}  // namespace

template <int d>
GeometryGrid<d>::GeometryGrid(const Patch<d>& patch, const TensorSpace<d>& elements,
                              const std::array<int, d>& points_per_element)
    : lines_(make_lines<d>(elements, points_per_element, std::make_index_sequence<d>())),
      is_rational_(patch.is_rational()),
      map_(patch.space(), elements, map_rows(patch), lines_) {}

template <int d>
void GeometryGrid<d>::evaluate(int i_plane, GeometryPlane<d>& plane) const {
    const int nc = map_.stride();
    const int n0 = lines_[0].n_points();
    plane.n_points = points_per_plane();
    plane.x.resize(3 * static_cast<std::size_t>(plane.n_points));
    plane.inverse_jacobian.resize(d * d * static_cast<std::size_t>(plane.n_points));
    plane.determinant.resize(plane.n_points);
    plane.quadrature_weight.resize(plane.n_points);
    plane.denominator.resize(plane.n_points);
    plane.denominator_gradient.resize(d * static_cast<std::size_t>(plane.n_points));
    map_.evaluate(i_plane, plane.map);
    const double plane_weight = d == 3 ? lines_[d - 1].weights[i_plane] : 1.0;
    for (int i_point = 0; i_point < plane.n_points; ++i_point) {
        const double* X = &plane.map[static_cast<std::size_t>(i_point) * (d + 1) * nc];
        const double W = is_rational_ ? X[d] : 1.0;
        plane.denominator[i_point] = W;
        Matrix<d> J;
        for (int i = 0; i < d; ++i) {
            const double x = X[i] / W;
            plane.x[3 * i_point + i] = x;
            for (int k = 0; k < d; ++k) {
                const double* dX = X + (1 + k) * nc;
                J(i, k) = is_rational_ ? (dX[i] - x * dX[d]) / W : dX[i];
            }
        }
        if constexpr (d == 2) {
            plane.x[3 * i_point + 2] = 0.0;
        }
        for (int k = 0; k < d; ++k) {
            plane.denominator_gradient[d * i_point + k] = is_rational_ ? X[(1 + k) * nc + d] : 0.0;
        }
        // Inverse by cofactors.
        Matrix<d> inverse;
        double det = 0.0;
        if constexpr (d == 2) {
            det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
            inverse << J(1, 1), -J(0, 1), -J(1, 0), J(0, 0);
        } else {
            inverse(0, 0) = J(1, 1) * J(2, 2) - J(1, 2) * J(2, 1);
            inverse(0, 1) = J(0, 2) * J(2, 1) - J(0, 1) * J(2, 2);
            inverse(0, 2) = J(0, 1) * J(1, 2) - J(0, 2) * J(1, 1);
            inverse(1, 0) = J(1, 2) * J(2, 0) - J(1, 0) * J(2, 2);
            inverse(1, 1) = J(0, 0) * J(2, 2) - J(0, 2) * J(2, 0);
            inverse(1, 2) = J(0, 2) * J(1, 0) - J(0, 0) * J(1, 2);
            inverse(2, 0) = J(1, 0) * J(2, 1) - J(1, 1) * J(2, 0);
            inverse(2, 1) = J(0, 1) * J(2, 0) - J(0, 0) * J(2, 1);
            inverse(2, 2) = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
            det = J(0, 0) * inverse(0, 0) + J(0, 1) * inverse(1, 0) + J(0, 2) * inverse(2, 0);
        }
        for (int k = 0; k < d; ++k) {
            for (int i = 0; i < d; ++i) {
                plane.inverse_jacobian[d * d * i_point + d * k + i] = inverse(k, i) / det;
            }
        }
        plane.determinant[i_point] = det;
        plane.quadrature_weight[i_point] =
            lines_[0].weights[i_point % n0] * lines_[1].weights[i_point / n0] * plane_weight;
    }
}

template <int d>
void GeometryGrid<d>::require_orientation(int patch, int i_plane, const GeometryPlane<d>& plane,
                                          double orientation) const {
    for (int q = 0; q < plane.n_points; ++q) {
        const double det = plane.determinant[q];
        if (!(det * orientation > 0.0)) {
            const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
            throw GeometryError(
                "patch {} is folded: det J = {:.6g} at parameter {}, position {}, "
                "but of the other sign elsewhere; repair the geometry there",
                patch, det, format_point(parameter(i_plane, q)), format_point(x));
        }
    }
}

template <int d>
Vector<d> GeometryGrid<d>::parameter(int i_plane, int i_point) const {
    const int n0 = lines_[0].n_points();
    Vector<d> xi;
    xi[0] = lines_[0].points[i_point % n0];
    xi[1] = lines_[1].points[i_point / n0];
    if constexpr (d == 3) {
        xi[2] = lines_[2].points[i_plane];
    }
    return xi;
}

template struct GeometryPlane<2>;
template struct GeometryPlane<3>;
template class SplineGrid<2>;
template class SplineGrid<3>;
template class GeometryGrid<2>;
template class GeometryGrid<3>;

}  // namespace couture::iga
