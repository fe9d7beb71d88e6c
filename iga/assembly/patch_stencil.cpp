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
    /// [slot of the ring][pair][point][(s, t)]: parametric coefficients of the planes in use.
    Buffer<double> ring;
    int ring_length = 1;
    int coefficient_stride = 9;
    /// [pair][point][3 x 3][vector]: after the last direction (d = 3).
    Buffer<double> plane_sums;
    /// [pair][q_0][2 x 2][j_1][vector]: after the middle direction.
    Buffer<double> line_sums;
    /// [pair][j_0][j_1][vector]
    Buffer<double> row;
    /// Values of A's entries at four points.
    std::vector<Vector4d> values;
    /// Values of A at all points of the plane, if it is not constant.
    Buffer<double> A;
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
    std::vector<double> A(form.size(), 0.0);
    if (form.is_constant()) {
        form.coefficients(i_patch_, Vector3::Zero(), A.data());
    }
    const int nc = form.n_components;
    const int n_slots = form.has_value ? d + 1 : d;
    for (int a = 0; a < nc; ++a) {
        for (int b = a; b < nc; ++b) {
            for (int s = 0; s < n_slots; ++s) {
                for (int t = 0; t < n_slots; ++t) {
                    const double value = A[((a * nc + b) * (d + 1) + s) * (d + 1) + t];
                    if (!form.is_constant() || value != 0.0) {
                        entries_.push_back({a, b, s, t, value});
                    }
                }
            }
        }
    }
}

/// Coefficients of the plane in `workspace.plane` by the parametric slots: with T from parametric
/// to physical slots, C = T^T A T times the quadrature weight. Four points at a time.
template <int d>
template <int n_physical, int n_parametric>
void PatchIntegrator<d>::transform_coefficients(int slot, Workspace& workspace) const {
    const GeometryPlane<d>& plane = workspace.plane;
    const int nc = form_.n_components;
    const int n = d == 2 ? d + 1 : n_parametric;
    const int stride = workspace.coefficient_stride;
    const std::size_t pair_size = static_cast<std::size_t>(plane.n_points) * stride;
    double* slot_begin = &workspace.ring[slot * pair_size * nc * nc];
    for (int first = 0; first < plane.n_points; first += 4) {
        const int n_here = std::min(4, plane.n_points - first);
        Vector4d T[n_physical][n_parametric];
        Vector4d weighted[n_physical][n_parametric];
        const auto gather = [&](const Buffer<double>& from, int width, int at) {
            const double* start = &from[static_cast<std::size_t>(first) * width + at];
            const int last = n_here - 1;
            return Vector4d{start[0], start[std::min(1, last) * width],
                            start[std::min(2, last) * width], start[std::min(3, last) * width]};
        };
        // Functions without weights on a rational map have no denominator.
        const Vector4d W =
            is_rational_ ? gather(plane.denominator, 1, 0) : Vector4d{1.0, 1.0, 1.0, 1.0};
        const Vector4d det = gather(plane.determinant, 1, 0);
        const Vector4d factor = gather(plane.quadrature_weight, 1, 0) * det * orientation_;
        for (int s = 0; s < d; ++s) {
            Vector4d value_slot{};
            for (int k = 0; k < d; ++k) {
                const Vector4d inverse = gather(plane.inverse_jacobian, d * d, d * k + s);
                T[s][k] = inverse / W;
                if (n_parametric > d && is_rational_) {
                    value_slot -= inverse * gather(plane.denominator_gradient, d, k);
                }
            }
            if constexpr (n_parametric > d) {
                T[s][d] = value_slot / (W * W);
            }
        }
        if constexpr (n_physical > d) {
            for (int k = 0; k < d; ++k) {
                T[d][k] = Vector4d{};
            }
            T[d][d] = 1.0 / W;
        }
        for (int s = 0; s < n_physical; ++s) {
            for (int k = 0; k < n_parametric; ++k) {
                weighted[s][k] = factor * T[s][k];
            }
        }
        for (int q = 0; q < n_here && !form_.is_constant(); ++q) {
            const double* A = &workspace.A[static_cast<std::size_t>(first + q) * form_.size()];
            for (std::size_t e = 0; e < entries_.size(); ++e) {
                const Entry& entry = entries_[e];
                workspace.values[e][q] =
                    A[((entry.a * nc + entry.b) * (d + 1) + entry.s) * (d + 1) + entry.t];
            }
        }
        std::size_t e = 0;
        while (e < entries_.size()) {
            const int a = entries_[e].a;
            const int b = entries_[e].b;
            Vector4d AT[n_physical][n_parametric] = {};
            for (; e < entries_.size() && entries_[e].a == a && entries_[e].b == b; ++e) {
                for (int k = 0; k < n_parametric; ++k) {
                    AT[entries_[e].s][k] += workspace.values[e] * T[entries_[e].t][k];
                }
            }
            double* here =
                slot_begin + (a * nc + b) * pair_size + static_cast<std::size_t>(first) * stride;
            double* mirrored =
                slot_begin + (b * nc + a) * pair_size + static_cast<std::size_t>(first) * stride;
            for (int k = 0; k < n_parametric; ++k) {
                for (int l = 0; l < n_parametric; ++l) {
                    Vector4d C{};
                    for (int s = 0; s < n_physical; ++s) {
                        C += weighted[s][k] * AT[s][l];
                    }
                    for (int q = 0; q < n_here; ++q) {
                        here[q * stride + k * n + l] = C[q];
                        mirrored[q * stride + l * n + k] = C[q];
                    }
                }
            }
        }
    }
}

template <int d>
void PatchIntegrator<d>::fill_coefficients(int i_plane, int slot, Workspace& workspace) const {
    GeometryPlane<d>& plane = workspace.plane;
    grid_.evaluate(i_plane, plane);
    grid_.require_orientation(i_patch_, i_plane, plane, orientation_);
    if (!form_.is_constant()) {
        evaluate_coefficients(form_, i_patch_, grid_, i_plane, plane, workspace.A);
    }
    if (form_.has_value) {
        transform_coefficients<d + 1, d + 1>(slot, workspace);
    } else if (is_rational_) {
        transform_coefficients<d, d + 1>(slot, workspace);
    } else {
        transform_coefficients<d, d>(slot, workspace);
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
    const std::size_t n_chunks = static_cast<std::size_t>(grid_.points_per_plane()) *
                                 form_.n_components * form_.n_components;
    const std::size_t slot_size = n_chunks * stride;
    V* out = reinterpret_cast<V*>(workspace.plane_sums.data());
    // Few planes at a time over a block of points: their coefficients stream through the cache,
    // the sums stay in it.
    constexpr std::size_t block_size = 64;
    for (std::size_t block = 0; block < n_chunks; block += block_size) {
        const std::size_t block_end = std::min(block + block_size, n_chunks);
        for (int group = 0; group < n_used; group += m) {
            for (std::size_t chunk = block; chunk < block_end; ++chunk) {
                V* target = out + chunk * 9 * n_vectors;
                for (int v = 0; v < n_vectors; ++v) {
                    V sums[9] = {};
                    if (group > 0) {
                        for (int c = 0; c < 9; ++c) {
                            sums[c] = target[c * n_vectors + v];
                        }
                    }
                    for (int u = group; u < group + m; ++u) {
                        const double* C = &workspace.ring[slots[u] * slot_size + chunk * stride];
                        const V BB = weights[u].BB[v];
                        const V BD = weights[u].BD[v];
                        const V DB = weights[u].DB[v];
                        const V DD = weights[u].DD[v];
                        if constexpr (has_value) {
                            sums[0] += C[0] * BB;
                            sums[1] += C[1] * BB;
                            sums[2] += C[2] * BD + C[3] * BB;
                            sums[3] += C[4] * BB;
                            sums[4] += C[5] * BB;
                            sums[5] += C[6] * BD + C[7] * BB;
                            sums[6] += C[8] * DB + C[12] * BB;
                            sums[7] += C[9] * DB + C[13] * BB;
                            sums[8] += C[10] * DD + C[11] * DB + C[14] * BD + C[15] * BB;
                        } else {
                            sums[0] += C[0] * BB;
                            sums[1] += C[1] * BB;
                            sums[2] += C[2] * BD;
                            sums[3] += C[3] * BB;
                            sums[4] += C[4] * BB;
                            sums[5] += C[5] * BD;
                            sums[6] += C[6] * DB;
                            sums[7] += C[7] * DB;
                            sums[8] += C[8] * DD;
                        }
                    }
                    for (int c = 0; c < 9; ++c) {
                        target[c * n_vectors + v] = sums[c];
                    }
                }
            }
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
    for (const Entry& entry : entries_) {
        workspace.values.push_back(Vector4d{} + entry.value);
    }
    if (d == 3) {
        workspace.ring_length = (directions_[d - 1].degree + 1) * directions_[d - 1].n_points;
        workspace.plane_sums.resize(n_pairs * n_points * 9 * n_lanes);
    }
    // Pairs without entries, and slots that do not occur, stay zero.
    workspace.ring.assign(n_pairs * n_points * workspace.ring_length * workspace.coefficient_stride,
                          0.0);
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

template <int d>
double PatchIntegrator<d>::flops() const {
    // Functions times elements of their support: what each stage's row loop runs over.
    std::array<double, d> supports;
    for (int k = 0; k < d; ++k) {
        supports[k] = 0.0;
        for (int i = 0; i < sizes_[k]; ++i) {
            supports[k] += directions_[k].last_element[i] - directions_[k].first_element[i] + 1;
        }
    }
    const auto points = [this](int k) { return directions_[k].n_points; };
    const auto local = [this](int k) { return directions_[k].degree + 1; };
    const double lanes = d == 3 ? local(d - 1) : 1;
    double sum = 0.0;
    if (d == 3) {
        sum += supports[d - 1] * points(d - 1) * grid_.points_per_plane() *
               (has_value_ ? 16.0 : 9.0) * lanes;
    }
    const double planes = d == 3 ? sizes_[d - 1] : 1;
    sum += planes * supports[1] * points(1) * grid_.line(0).n_points() * (9.0 + 6.0 * local(1)) *
           lanes;
    sum += planes * sizes_[1] * supports[0] * points(0) * (2.0 * directions_[1].degree + 1.0) *
           (4.0 + 2.0 * local(0)) * lanes;
    return 2.0 * sum * form_.n_components * form_.n_components;
}

template class PatchIntegrator<2>;
template class PatchIntegrator<3>;

}  // namespace couture::iga
