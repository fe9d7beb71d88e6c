#include "iga/assembly/patch_stencil.h"

#include <algorithm>
#include <cstring>

#include "iga/core/error.h"
#include "iga/core/format.h"

namespace couture::iga {

namespace {

using Vector4d = double __attribute__((vector_size(32)));

template <typename V>
constexpr int lanes_of = sizeof(V) / sizeof(double);

}  // namespace

template <int d>
struct PatchIntegrator<d>::Workspace {
    GeometryPlane<d> plane;
    /// [pair][point][slot of the ring][(s, t)]: parametric coefficients of the planes in use.
    Buffer<double> ring;
    int ring_length = 1;
    int coefficient_stride = 9;
    /// [pair][point][3 x 3][vector]: after the last direction (d = 3).
    Buffer<double> plane_sums;
    /// [pair][q_0][2 x 2][j_1][vector]: after the middle direction.
    Buffer<double> line_sums;
    /// [pair][j_0][j_1][vector]
    Buffer<double> row;
    MatrixX A;
};

template <int d>
PatchIntegrator<d>::PatchIntegrator(int i_patch, const Patch<d>& geometry,
                                    const TensorSpace<d>& space, const VectorX& weights,
                                    const BilinearForm<d>& form,
                                    const std::array<int, d>& points_per_element)
    : i_patch_(i_patch),
      form_(form),
      grid_(geometry, space, points_per_element),
      is_rational_(weights.size() > 0),
      has_value_(form.has_value || is_rational_),
      sizes_(space.sizes()),
      weights_(weights) {
    for (int k = 0; k < d; ++k) {
        Direction& direction = directions_[k];
        const QuadratureLine& line = grid_.line(k);
        direction.table = tabulate(space.knots[k], space.knots[k].breakpoints(), line.unit_points);
        direction.degree = space.knots[k].degree();
        direction.n_functions = sizes_[k];
        direction.n_points = line.points_per_element;
        direction.first_element.assign(sizes_[k], line.n_elements);
        direction.last_element.assign(sizes_[k], -1);
        for (int e = 0; e < line.n_elements; ++e) {
            for (int a = 0; a <= direction.degree; ++a) {
                const int i = direction.table.first_function[e] + a;
                direction.first_element[i] = std::min(direction.first_element[i], e);
                direction.last_element[i] = std::max(direction.last_element[i], e);
            }
        }
    }
    GeometryPlane<d> plane;
    grid_.evaluate(0, plane);
    orientation_ = plane.determinant[0] < 0.0 ? -1.0 : 1.0;
    if (!form.varies) {
        constant_coefficients_ =
            MatrixX::Zero((d + 1) * (d + 1), form.n_components * form.n_components);
        form.coefficients(i_patch, Vector3::Zero(), constant_coefficients_.data());
    }
}

template <int d>
void PatchIntegrator<d>::fill_coefficients(int i_plane, int slot, Workspace& workspace) const {
    GeometryPlane<d>& plane = workspace.plane;
    grid_.evaluate(i_plane, plane);
    const int nc = form_.n_components;
    // Physical slots times this give parametric ones.
    Eigen::Matrix<double, d + 1, d + 1> T = Eigen::Matrix<double, d + 1, d + 1>::Zero();
    const std::size_t pair_stride = static_cast<std::size_t>(plane.n_points) *
                                    workspace.ring_length * workspace.coefficient_stride;
    for (int q = 0; q < plane.n_points; ++q) {
        const double det = plane.determinant[q];
        if (!(det * orientation_ > 0.0)) {
            const Vector<d> xi = grid_.parameter(i_plane, q);
            const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
            throw GeometryError(
                "patch {} is folded: det J = {:.6g} at parameter {}, position {}, "
                "but of the other sign elsewhere; repair the geometry there",
                i_patch_, det, format_point(xi), format_point(x));
        }
        const double factor = plane.quadrature_weight[q] * std::abs(det);
        const double W = plane.denominator[q];
        for (int s = 0; s < d; ++s) {
            double value_slot = 0.0;
            for (int k = 0; k < d; ++k) {
                const double inverse = plane.inverse_jacobian[d * d * q + d * k + s];
                T(s, k) = inverse / W;
                value_slot -= inverse * plane.denominator_gradient[d * q + k];
            }
            T(s, d) = value_slot / (W * W);
        }
        T(d, d) = 1.0 / W;
        const double* A = constant_coefficients_.data();
        if (form_.varies) {
            workspace.A.setZero();
            form_.coefficients(i_patch_,
                               Vector3(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]),
                               workspace.A.data());
            A = workspace.A.data();
        }
        const std::size_t at = (static_cast<std::size_t>(q) * workspace.ring_length + slot) *
                               workspace.coefficient_stride;
        for (int a = 0; a < nc; ++a) {
            for (int b = a; b < nc; ++b) {
                using RowMajor = Eigen::Matrix<double, d + 1, d + 1, Eigen::RowMajor>;
                const Eigen::Map<const RowMajor> A_ab(A + (a * nc + b) * (d + 1) * (d + 1));
                RowMajor C;
                if (form_.has_value) {
                    C.noalias() = (factor * T.transpose()).lazyProduct((A_ab * T).eval());
                } else if (is_rational_) {
                    const Eigen::Matrix<double, d, d + 1> AT =
                        A_ab.template topLeftCorner<d, d>().lazyProduct(T.template topRows<d>());
                    C.noalias() = (factor * T.template topRows<d>().transpose()).lazyProduct(AT);
                } else {
                    const Matrix<d> T_d = T.template topLeftCorner<d, d>();
                    const Matrix<d> AT = A_ab.template topLeftCorner<d, d>().lazyProduct(T_d);
                    C.setZero();
                    C.template topLeftCorner<d, d>() = (factor * T_d.transpose()).lazyProduct(AT);
                }
                double* here = &workspace.ring[(a * nc + b) * pair_stride + at];
                double* mirrored = &workspace.ring[(b * nc + a) * pair_stride + at];
                const int n = d == 2 || has_value_ ? d + 1 : d;
                for (int s = 0; s < n; ++s) {
                    for (int t = 0; t < n; ++t) {
                        here[s * n + t] = C(s, t);
                    }
                }
                if (a != b) {
                    for (int s = 0; s < n; ++s) {
                        for (int t = 0; t < n; ++t) {
                            mirrored[s * n + t] = C(t, s);
                        }
                    }
                }
            }
        }
    }
}

/// Last direction of a volume: slots (0, 1, derivative, value) become (0, 1, value), for all
/// columns j >= i at once.
template <int d>
template <typename V, int n_vectors, bool has_value>
void PatchIntegrator<d>::contract_last(int i, Workspace& workspace) const {
    const Direction& direction = directions_[d - 1];
    const int m = direction.n_points;
    const int first = direction.first_element[i];
    const int n_used = (direction.last_element[i] - first + 1) * m;
    // Weights of each quadrature plane: products of the row's and the columns' functions.
    struct PlaneWeights {
        V BB[n_vectors], BD[n_vectors], DB[n_vectors], DD[n_vectors];
    };
    std::vector<PlaneWeights> weights(n_used);
    std::vector<int> slots(n_used);
    for (int u = 0; u < n_used; ++u) {
        const int e = first + u / m;
        const double* B = direction.table.value(e, u % m);
        const double* D = direction.table.derivative(e, u % m);
        const int base = direction.table.first_function[e];
        slots[u] = (e * m + u % m) % workspace.ring_length;
        for (int v = 0; v < n_vectors; ++v) {
            for (int lane = 0; lane < lanes_of<V>; ++lane) {
                const int local = i + v * lanes_of<V> + lane - base;
                const bool inside = local >= 0 && local <= direction.degree;
                const double B_j = inside ? B[local] : 0.0;
                const double D_j = inside ? D[local] : 0.0;
                reinterpret_cast<double*>(&weights[u].BB[v])[lane] = B[i - base] * B_j;
                reinterpret_cast<double*>(&weights[u].BD[v])[lane] = B[i - base] * D_j;
                reinterpret_cast<double*>(&weights[u].DB[v])[lane] = D[i - base] * B_j;
                reinterpret_cast<double*>(&weights[u].DD[v])[lane] = D[i - base] * D_j;
            }
        }
    }
    constexpr int stride = has_value ? 16 : 9;
    const std::size_t n_points = grid_.points_per_plane();
    const std::size_t n_chunks = n_points * form_.n_components * form_.n_components;
    const double* ring = workspace.ring.data();
    V* out = reinterpret_cast<V*>(workspace.plane_sums.data());
    for (std::size_t chunk = 0; chunk < n_chunks; ++chunk) {
        const double* point = ring + chunk * workspace.ring_length * stride;
        V* target = out + chunk * 9 * n_vectors;
        for (int v = 0; v < n_vectors; ++v) {
            V s00{}, s01{}, s02{}, s10{}, s11{}, s12{}, s20{}, s21{}, s22{};
            for (int u = 0; u < n_used; ++u) {
                const double* C = point + slots[u] * stride;
                const V BB = weights[u].BB[v];
                const V BD = weights[u].BD[v];
                const V DB = weights[u].DB[v];
                const V DD = weights[u].DD[v];
                if constexpr (has_value) {
                    s00 += C[0] * BB;
                    s01 += C[1] * BB;
                    s02 += C[2] * BD + C[3] * BB;
                    s10 += C[4] * BB;
                    s11 += C[5] * BB;
                    s12 += C[6] * BD + C[7] * BB;
                    s20 += C[8] * DB + C[12] * BB;
                    s21 += C[9] * DB + C[13] * BB;
                    s22 += C[10] * DD + C[11] * DB + C[14] * BD + C[15] * BB;
                } else {
                    s00 += C[0] * BB;
                    s01 += C[1] * BB;
                    s02 += C[2] * BD;
                    s10 += C[3] * BB;
                    s11 += C[4] * BB;
                    s12 += C[5] * BD;
                    s20 += C[6] * DB;
                    s21 += C[7] * DB;
                    s22 += C[8] * DD;
                }
            }
            target[0 * n_vectors + v] = s00;
            target[1 * n_vectors + v] = s01;
            target[2 * n_vectors + v] = s02;
            target[3 * n_vectors + v] = s10;
            target[4 * n_vectors + v] = s11;
            target[5 * n_vectors + v] = s12;
            target[6 * n_vectors + v] = s20;
            target[7 * n_vectors + v] = s21;
            target[8 * n_vectors + v] = s22;
        }
    }
}

/// Middle direction: slots (0, derivative, value) become (0, value), for all columns j_1.
/// `n` functions and points per element, or 0 where known at run time only.
template <int d>
template <typename V, int n_vectors, int n>
void PatchIntegrator<d>::contract_middle(int i, Workspace& workspace) const {
    const Direction& direction = directions_[1];
    const int m = n > 0 ? n : direction.n_points;
    const int n_local = n > 0 ? n : direction.degree + 1;
    const int width = 2 * direction.degree + 1;
    const int n0 = grid_.line(0).n_points();
    const int n1 = grid_.line(1).n_points();
    const int n_pairs = form_.n_components * form_.n_components;
    const V* in =
        reinterpret_cast<const V*>(d == 3 ? workspace.plane_sums.data() : workspace.ring.data());
    V* out = reinterpret_cast<V*>(workspace.line_sums.data());
    std::memset(workspace.line_sums.data(), 0, workspace.line_sums.size() * sizeof(double));
    V r[64][6];
    for (int pair = 0; pair < n_pairs; ++pair) {
        for (int e = direction.first_element[i]; e <= direction.last_element[i]; ++e) {
            const int base = direction.table.first_function[e];
            for (int q0 = 0; q0 < n0; ++q0) {
                for (int v = 0; v < n_vectors; ++v) {
                    for (int q = 0; q < m; ++q) {
                        const double B = direction.table.value(e, q)[i - base];
                        const double D = direction.table.derivative(e, q)[i - base];
                        const std::size_t point =
                            (static_cast<std::size_t>(pair) * n1 + e * m + q) * n0 + q0;
                        const V* T = in + point * 9 * n_vectors + v;
                        r[q][0] = T[0] * B;
                        r[q][1] = T[1 * n_vectors] * B;
                        r[q][2] = T[2 * n_vectors] * B;
                        r[q][3] = T[3 * n_vectors] * D + T[6 * n_vectors] * B;
                        r[q][4] = T[4 * n_vectors] * D + T[7 * n_vectors] * B;
                        r[q][5] = T[5 * n_vectors] * D + T[8 * n_vectors] * B;
                    }
                    V* target =
                        out + (static_cast<std::size_t>(pair) * n0 + q0) * 4 * width * n_vectors;
                    for (int j = 0; j < n_local; ++j) {
                        V s00{}, s01{}, s10{}, s11{};
                        for (int q = 0; q < m; ++q) {
                            const double B = direction.table.value(e, q)[j];
                            const double D = direction.table.derivative(e, q)[j];
                            s00 += r[q][0] * B;
                            s01 += r[q][1] * D + r[q][2] * B;
                            s10 += r[q][3] * B;
                            s11 += r[q][4] * D + r[q][5] * B;
                        }
                        const int offset = base + j - i + direction.degree;
                        target[(0 * width + offset) * n_vectors + v] += s00;
                        target[(1 * width + offset) * n_vectors + v] += s01;
                        target[(2 * width + offset) * n_vectors + v] += s10;
                        target[(3 * width + offset) * n_vectors + v] += s11;
                    }
                }
            }
        }
    }
}

/// First direction: slots (derivative, value) become the entries of one row.
template <int d>
template <typename V, int n_vectors, int n>
void PatchIntegrator<d>::contract_first(int i, Workspace& workspace) const {
    const Direction& direction = directions_[0];
    const int m = n > 0 ? n : direction.n_points;
    const int n_local = n > 0 ? n : direction.degree + 1;
    const int n0 = grid_.line(0).n_points();
    const int n_columns = (2 * directions_[1].degree + 1) * n_vectors;
    const int width = 2 * direction.degree + 1;
    const int n_pairs = form_.n_components * form_.n_components;
    const V* in = reinterpret_cast<const V*>(workspace.line_sums.data());
    V* out = reinterpret_cast<V*>(workspace.row.data());
    std::memset(workspace.row.data(), 0, workspace.row.size() * sizeof(double));
    V r0[64];
    V r1[64];
    for (int pair = 0; pair < n_pairs; ++pair) {
        for (int e = direction.first_element[i]; e <= direction.last_element[i]; ++e) {
            const int base = direction.table.first_function[e];
            const double* B_e = direction.table.value(e, 0);
            const double* D_e = direction.table.derivative(e, 0);
            V* target =
                out +
                (static_cast<std::size_t>(pair) * width + base - i + direction.degree) * n_columns;
            for (int column = 0; column < n_columns; ++column) {
                for (int q = 0; q < m; ++q) {
                    const double B = B_e[q * n_local + i - base];
                    const double D = D_e[q * n_local + i - base];
                    const V* T = in +
                                 (static_cast<std::size_t>(pair) * n0 + e * m + q) * 4 * n_columns +
                                 column;
                    r0[q] = T[0] * D + T[2 * n_columns] * B;
                    r1[q] = T[n_columns] * D + T[3 * n_columns] * B;
                }
                for (int j = 0; j < n_local; ++j) {
                    V sum = target[j * n_columns + column];
                    for (int q = 0; q < m; ++q) {
                        sum += r0[q] * D_e[q * n_local + j] + r1[q] * B_e[q * n_local + j];
                    }
                    target[j * n_columns + column] = sum;
                }
            }
        }
    }
}

template <int d>
template <typename V, int n_vectors>
void PatchIntegrator<d>::integrate_with(
    int first, int last, const std::function<void(const StencilRow<d>&)>& sink) const {
    const std::size_t n_pairs = static_cast<std::size_t>(form_.n_components) * form_.n_components;
    const std::size_t n_points = grid_.points_per_plane();
    const int n_lanes = n_vectors * lanes_of<V>;
    const int width_0 = 2 * directions_[0].degree + 1;
    const int width_1 = 2 * directions_[1].degree + 1;

    Workspace workspace;
    workspace.coefficient_stride = d == 3 && has_value_ ? 16 : 9;
    workspace.A.resize((d + 1) * (d + 1), static_cast<Eigen::Index>(n_pairs));
    if (d == 3) {
        workspace.ring_length = (directions_[d - 1].degree + 1) * directions_[d - 1].n_points;
        workspace.plane_sums.resize(n_pairs * n_points * 9 * n_lanes);
    }
    workspace.ring.resize(n_pairs * n_points * workspace.ring_length *
                          workspace.coefficient_stride);
    workspace.line_sums.resize(n_pairs * grid_.line(0).n_points() * 4 * width_1 * n_lanes);
    workspace.row.resize(n_pairs * width_0 * width_1 * n_lanes);

    const auto middle = [&](int i) {
        const int n =
            directions_[1].n_points == directions_[1].degree + 1 ? directions_[1].n_points : 0;
        switch (n) {
            case 2:
                return contract_middle<V, n_vectors, 2>(i, workspace);
            case 3:
                return contract_middle<V, n_vectors, 3>(i, workspace);
            case 4:
                return contract_middle<V, n_vectors, 4>(i, workspace);
            case 5:
                return contract_middle<V, n_vectors, 5>(i, workspace);
            default:
                return contract_middle<V, n_vectors, 0>(i, workspace);
        }
    };
    const auto inner = [&](int i) {
        const int n =
            directions_[0].n_points == directions_[0].degree + 1 ? directions_[0].n_points : 0;
        switch (n) {
            case 2:
                return contract_first<V, n_vectors, 2>(i, workspace);
            case 3:
                return contract_first<V, n_vectors, 3>(i, workspace);
            case 4:
                return contract_first<V, n_vectors, 4>(i, workspace);
            case 5:
                return contract_first<V, n_vectors, 5>(i, workspace);
            default:
                return contract_first<V, n_vectors, 0>(i, workspace);
        }
    };

    StencilRow<d> row;
    row.values = workspace.row.data();
    row.n_lanes = n_lanes;
    row.widths = {width_0, width_1};
    const auto rows_of_plane = [&](int i_last, int i_middle) {
        middle(i_middle);
        for (int i = 0; i < sizes_[0]; ++i) {
            inner(i);
            row.i[0] = i;
            row.i[1] = i_middle;
            row.i[d - 1] = d == 3 ? i_last : i_middle;
            sink(row);
        }
    };

    if constexpr (d == 2) {
        fill_coefficients(0, 0, workspace);
        for (int i = first; i < last; ++i) {
            rows_of_plane(0, i);
        }
    } else {
        const Direction& direction = directions_[2];
        const int m = direction.n_points;
        int next_plane = direction.first_element[first] * m;
        for (int i = first; i < last; ++i) {
            for (; next_plane < (direction.last_element[i] + 1) * m; ++next_plane) {
                fill_coefficients(next_plane, next_plane % workspace.ring_length, workspace);
            }
            if (has_value_) {
                contract_last<V, n_vectors, true>(i, workspace);
            } else {
                contract_last<V, n_vectors, false>(i, workspace);
            }
            for (int i_middle = 0; i_middle < sizes_[1]; ++i_middle) {
                rows_of_plane(i, i_middle);
            }
        }
    }
}

template <int d>
void PatchIntegrator<d>::integrate(int first, int last,
                                   const std::function<void(const StencilRow<d>&)>& sink) const {
    if (first >= last) {
        return;
    }
    if constexpr (d == 2) {
        integrate_with<double, 1>(first, last, sink);
    } else if (directions_[2].degree <= 3) {
        integrate_with<Vector4d, 1>(first, last, sink);
    } else if (directions_[2].degree <= 7) {
        integrate_with<Vector4d, 2>(first, last, sink);
    } else {
        integrate_with<Vector4d, 3>(first, last, sink);
    }
}

template class PatchIntegrator<2>;
template class PatchIntegrator<3>;

}  // namespace couture::iga
