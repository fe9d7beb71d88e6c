#include "iga/assembly/form_operator.h"

#include <algorithm>
#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/assembly/form_operator_data.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"

namespace couture::iga {

namespace {

/// Rows, `width` numbers each: out = sum of basis[i] rows[i].
void contract(const double* rows, std::size_t width, const double* basis, int n, double* out) {
    for (std::size_t c = 0; c < width; c += lanes) {
        const double* column = rows + c;
        Vector4d sum = basis[0] * *reinterpret_cast<const Vector4d*>(column);
        for (int i = 1; i < n; ++i) {
            sum += basis[i] * *reinterpret_cast<const Vector4d*>(column + i * width);
        }
        *reinterpret_cast<Vector4d*>(out + c) = sum;
    }
}

/// The transpose: rows[i] += basis_a[i] a + basis_b[i] b.
void expand(const double* a, const double* b, std::size_t width, const double* basis_a,
            const double* basis_b, int n, double* rows) {
    for (int i = 0; i < n; ++i) {
        double* row = rows + i * width;
        for (std::size_t c = 0; c < width; c += lanes) {
            *reinterpret_cast<Vector4d*>(row + c) +=
                basis_a[i] * *reinterpret_cast<const Vector4d*>(a + c) +
                basis_b[i] * *reinterpret_cast<const Vector4d*>(b + c);
        }
    }
}

/// A of one point, [a][b][s][t] over d + 1 slots, as [t][b][s][lane a] over n_slots.
template <int d>
void reorder(const double* A, int nc, int n_slots, double* to) {
    std::fill_n(to, coefficient_size(n_slots, nc), 0.0);
    for (int a = 0; a < nc; ++a) {
        for (int b = 0; b < nc; ++b) {
            for (int s = 0; s < n_slots; ++s) {
                for (int t = 0; t < n_slots; ++t) {
                    to[((t * nc + b) * n_slots + s) * lanes + a] =
                        A[((a * nc + b) * (d + 1) + s) * (d + 1) + t];
                }
            }
        }
    }
}

}  // namespace

template <int d>
FormOperator<d>::FormOperator(const Space<d>& space, BilinearForm<d> form,
                              std::optional<int> n_gauss_points)
    : space_(&space), form_(std::move(form)), incidence_(make_incidence(space)) {
    if (form_.n_components != 1 && form_.n_components != d) {
        throw InputError("FormOperator: {} components; there can be 1 or {}", form_.n_components,
                         d);
    }
    for (int p = 0; p < space.n_patches(); ++p) {
        if (form_.has_value || space.weights(p).size() > 0) {
            n_slots_ = d + 1;
        }
    }
    require_memory(n_gauss_points);
    for (int p = 0; p < space.n_patches(); ++p) {
        set_up(p, n_gauss_points);
    }
}

template <int d>
void FormOperator<d>::require_memory(std::optional<int> n_gauss_points) const {
    double n_bytes = 0.0;
    for (int p = 0; p < space_->n_patches() && form_.is_constant(); ++p) {
        const TensorSpace<d>& tensor = space_->tensor(p);
        double n_points = 1.0;
        for (int k = 0; k < d; ++k) {
            n_points *= static_cast<double>(gauss_points<d>(tensor, n_gauss_points)[k]) *
                        tensor.knots[k].n_elements();
        }
        n_bytes += sizeof(double) * n_points * record_size();
    }
    constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
    if (n_bytes > static_cast<double>(available_memory())) {
        throw SolverError(
            "matrix_free: the geometry at the quadrature points of {} unknowns takes {:.1f} GiB, "
            "{:.1f} GiB are free; use fewer elements or gauss_points",
            n_unknowns(), n_bytes / gibibyte, available_memory() / gibibyte);
    }
}

template <int d>
FormOperator<d>::FormOperator(FormOperator&&) noexcept = default;
template <int d>
FormOperator<d>::~FormOperator() = default;

template <int d>
void FormOperator<d>::set_up(int p, std::optional<int> n_gauss_points) {
    const TensorSpace<d>& tensor = space_->tensor(p);
    patches_.push_back(std::make_unique<PatchData>(p, space_->geometry().patches[p], tensor,
                                                   gauss_points<d>(tensor, n_gauss_points)));
    PatchData& patch = *patches_.back();
    patch.is_rational = space_->weights(p).size() > 0;
    GeometryPlane<d> first;
    patch.grid.evaluate(0, first);
    patch.orientation = first.determinant[0] < 0.0 ? -1.0 : 1.0;
    const std::size_t plane_size =
        static_cast<std::size_t>(patch.grid.points_per_plane()) * record_size();
    const bool is_constant = form_.is_constant();
    if (is_constant) {
        std::vector<double> A(form_.size(), 0.0);
        form_.coefficients(p, Vector3::Zero(), A.data());
        patch.coefficients.resize(coefficient_size(n_slots_, form_.n_components));
        reorder<d>(A.data(), form_.n_components, n_slots_, patch.coefficients.data());
        patch.records.resize(plane_size * patch.grid.n_planes());
    }
    // Forms that vary are looked at, too: a fold must be found before the first product.
    parallel_for(patch.grid.n_planes(), [&](int i_plane) {
        PlaneData plane;
        fill_plane(patch, i_plane, plane);
        if (is_constant) {
            std::copy(plane.records.begin(), plane.records.end(),
                      patch.records.begin() + static_cast<std::int64_t>(plane_size * i_plane));
        }
    });
    patch.rows.resize(static_cast<std::size_t>(tensor.n_basis()) * lanes);
    patch.sums.resize(patch.n_layers);
}

template <int d>
void FormOperator<d>::fill_plane(const PatchData& patch, int i_plane, PlaneData& plane) const {
    const int n_slots = n_slots_;
    GeometryPlane<d>& geometry = plane.geometry;
    patch.grid.evaluate(i_plane, geometry);
    patch.grid.require_orientation(patch.index, i_plane, geometry, patch.orientation);
    plane.records.resize(static_cast<std::size_t>(geometry.n_points) * record_size());
    for (int q = 0; q < geometry.n_points; ++q) {
        const double det = geometry.determinant[q];
        double* T = &plane.records[static_cast<std::size_t>(q) * record_size()];
        const double W = patch.is_rational ? geometry.denominator[q] : 1.0;
        for (int s = 0; s < d; ++s) {
            double of_value = 0.0;
            for (int k = 0; k < d; ++k) {
                const double inverse = geometry.inverse_jacobian[d * d * q + d * k + s];
                T[s * n_slots + k] = inverse / W;
                if (patch.is_rational) {
                    of_value -= inverse * geometry.denominator_gradient[d * q + k];
                }
            }
            if (n_slots > d) {
                T[s * n_slots + d] = of_value / (W * W);
            }
        }
        if (n_slots > d) {
            std::fill_n(T + d * n_slots, d, 0.0);
            T[d * n_slots + d] = 1.0 / W;
        }
        T[n_slots * n_slots] = geometry.quadrature_weight[q] * std::abs(det);
    }
    if (form_.is_constant()) {
        return;
    }
    evaluate_coefficients(form_, patch.index, patch.grid, i_plane, geometry, plane.A);
    const std::size_t size = form_.size();
    const int nc = form_.n_components;
    plane.coefficients.resize(static_cast<std::size_t>(geometry.n_points) *
                              coefficient_size(n_slots, nc));
    for (int q = 0; q < geometry.n_points; ++q) {
        reorder<d>(
            &plane.A[q * size], nc, n_slots,
            &plane.coefficients[static_cast<std::size_t>(q) * coefficient_size(n_slots, nc)]);
    }
}

template <int d>
template <int nc, int n_slots, int n_functions>
void FormOperator<d>::apply_layer_of(const PatchData& patch, int layer) const {
    const int n0 = patch.grid.line(0).n_points();
    const int n1 = patch.grid.line(1).n_points();
    const int m0 = patch.grid.line(0).points_per_element;
    const int m1 = patch.grid.line(1).points_per_element;
    const BasisTable& table0 = patch.tables[0];
    const BasisTable& table1 = patch.tables[1];
    const int n_0 = n_functions > 0 ? n_functions : table0.n_functions;
    const std::size_t row_size = static_cast<std::size_t>(patch.sizes[0]) * lanes;
    const std::size_t net_size = row_size * patch.sizes[1];
    const bool is_constant = form_.is_constant();
    const int record = record_size();

    Buffer<double>& sum = const_cast<PatchData&>(patch).sums[layer];
    sum.assign(d == 3 ? net_size * patch.layer_planes : net_size, 0.0);
    // Of the plane: the functions of directions 0 and 1, and what goes back to them; value and
    // derivative by the last parameter.
    Buffer<double> net[2];
    Buffer<double> net_back[2];
    // Of a line: the functions of direction 0; value, derivatives by the other parameters.
    Buffer<double> line[3];
    Buffer<double> line_back[3];
    for (int k = 0; k < d; ++k) {
        line[k].resize(row_size);
        line_back[k].resize(row_size);
    }
    for (int k = 0; k < 2 && d == 3; ++k) {
        net[k].resize(net_size);
        net_back[k].resize(net_size);
    }
    PlaneData plane;
    for (int q2 = 0; q2 < patch.points_per_layer; ++q2) {
        const int i_plane = layer * patch.points_per_layer + q2;
        const double* records = nullptr;
        if (is_constant) {
            records = &patch.records[static_cast<std::size_t>(i_plane) * n0 * n1 * record];
        } else {
            fill_plane(patch, i_plane, plane);
            records = plane.records.data();
        }
        const double* from = patch.rows.data();
        double* back = sum.data();
        if constexpr (d == 3) {
            const BasisTable& table2 = patch.tables[d - 1];
            const double* first = &patch.rows[table2.first_function[layer] * net_size];
            contract(first, net_size, table2.value(layer, q2), table2.n_functions, net[0].data());
            contract(first, net_size, table2.derivative(layer, q2), table2.n_functions,
                     net[1].data());
            from = net[0].data();
            std::fill(net_back[0].begin(), net_back[0].end(), 0.0);
            std::fill(net_back[1].begin(), net_back[1].end(), 0.0);
            back = net_back[0].data();
        }
        for (int q1 = 0; q1 < n1; ++q1) {
            const double* N1 = table1.value(q1 / m1, q1 % m1);
            const double* D1 = table1.derivative(q1 / m1, q1 % m1);
            const std::size_t start1 = table1.first_function[q1 / m1] * row_size;
            contract(from + start1, row_size, N1, table1.n_functions, line[0].data());
            contract(from + start1, row_size, D1, table1.n_functions, line[1].data());
            if constexpr (d == 3) {
                contract(&net[1][start1], row_size, N1, table1.n_functions, line[2].data());
            }
            for (int k = 0; k < d; ++k) {
                std::fill(line_back[k].begin(), line_back[k].end(), 0.0);
            }
            for (int q0 = 0; q0 < n0; ++q0) {
                const double* N = table0.value(q0 / m0, q0 % m0);
                const double* D = table0.derivative(q0 / m0, q0 % m0);
                const std::size_t start =
                    static_cast<std::size_t>(table0.first_function[q0 / m0]) * lanes;
                Vector4d U[n_slots] = {};
                for (int i = 0; i < n_0; ++i) {
                    const auto at = [&](int k) {
                        return *reinterpret_cast<const Vector4d*>(&line[k][start + i * lanes]);
                    };
                    U[0] += D[i] * at(0);
                    for (int k = 1; k < d; ++k) {
                        U[k] += N[i] * at(k);
                    }
                    if constexpr (n_slots > d) {
                        U[d] += N[i] * at(0);
                    }
                }
                const std::size_t point = static_cast<std::size_t>(q1) * n0 + q0;
                const double* T = records + point * record;
                alignas(32) double G[n_slots * lanes];
                for (int s = 0; s < n_slots; ++s) {
                    Vector4d g = T[s * n_slots] * U[0];
                    for (int k = 1; k < n_slots; ++k) {
                        g += T[s * n_slots + k] * U[k];
                    }
                    *reinterpret_cast<Vector4d*>(G + s * lanes) = g;
                }
                const double* A = is_constant
                                      ? patch.coefficients.data()
                                      : &plane.coefficients[point * coefficient_size(n_slots, nc)];
                Vector4d S[n_slots] = {};
                for (int t = 0; t < n_slots; ++t) {
                    for (int b = 0; b < nc; ++b, A += n_slots * lanes) {
                        const double g = G[t * lanes + b];
                        for (int s = 0; s < n_slots; ++s) {
                            S[s] += g * *reinterpret_cast<const Vector4d*>(A + s * lanes);
                        }
                    }
                }
                const double weight = T[n_slots * n_slots];
                for (int s = 0; s < n_slots; ++s) {
                    S[s] *= weight;
                }
                Vector4d V[n_slots];
                for (int k = 0; k < n_slots; ++k) {
                    V[k] = T[k] * S[0];
                    for (int s = 1; s < n_slots; ++s) {
                        V[k] += T[s * n_slots + k] * S[s];
                    }
                }
                for (int i = 0; i < n_0; ++i) {
                    const auto at = [&](int k) -> Vector4d& {
                        return *reinterpret_cast<Vector4d*>(&line_back[k][start + i * lanes]);
                    };
                    if constexpr (n_slots > d) {
                        at(0) += D[i] * V[0] + N[i] * V[d];
                    } else {
                        at(0) += D[i] * V[0];
                    }
                    for (int k = 1; k < d; ++k) {
                        at(k) += N[i] * V[k];
                    }
                }
            }
            expand(line_back[0].data(), line_back[1].data(), row_size, N1, D1, table1.n_functions,
                   back + start1);
            if constexpr (d == 3) {
                double* to = &net_back[1][start1];
                for (int i = 0; i < table1.n_functions; ++i) {
                    for (std::size_t c = 0; c < row_size; c += lanes) {
                        *reinterpret_cast<Vector4d*>(to + i * row_size + c) +=
                            N1[i] * *reinterpret_cast<const Vector4d*>(&line_back[2][c]);
                    }
                }
            }
        }
        if constexpr (d == 3) {
            const BasisTable& table2 = patch.tables[d - 1];
            expand(net_back[0].data(), net_back[1].data(), net_size, table2.value(layer, q2),
                   table2.derivative(layer, q2), table2.n_functions, sum.data());
        }
    }
}

template <int d>
template <int nc, int n_slots>
void FormOperator<d>::apply_layer(const PatchData& patch, int layer) const {
    switch (patch.tables[0].n_functions) {
        case 2:
            return apply_layer_of<nc, n_slots, 2>(patch, layer);
        case 3:
            return apply_layer_of<nc, n_slots, 3>(patch, layer);
        case 4:
            return apply_layer_of<nc, n_slots, 4>(patch, layer);
        case 5:
            return apply_layer_of<nc, n_slots, 5>(patch, layer);
        default:
            return apply_layer_of<nc, n_slots, 0>(patch, layer);
    }
}

template <int d>
void FormOperator<d>::gather(const VectorX& u) const {
    const int nc = form_.n_components;
    parallel_for(static_cast<int>(patches_.size()), [&](int p) {
        PatchData& patch = *patches_[p];
        const std::vector<int>& dofs = space_->dofs(p);
        const VectorX& weights = space_->weights(p);
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            const double w = patch.is_rational ? weights[static_cast<Eigen::Index>(i)] : 1.0;
            for (int a = 0; a < lanes; ++a) {
                patch.rows[i * lanes + a] = a < nc ? w * u[dofs[i] * nc + a] : 0.0;
            }
        }
    });
}

template <int d>
VectorX FormOperator<d>::scatter() const {
    // Layers of each patch in order, into its rows.
    struct Plane {
        int patch;
        int i;
    };
    std::vector<Plane> planes;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        for (int i = 0; i < patches_[p]->sizes[d - 1]; ++i) {
            planes.push_back({static_cast<int>(p), i});
        }
    }
    parallel_for(static_cast<int>(planes.size()), [&](int n) {
        PatchData& patch = *patches_[planes[n].patch];
        const int i = planes[n].i;
        const std::size_t size = static_cast<std::size_t>(patch.n_plane_functions) * lanes;
        double* to = &patch.rows[i * size];
        std::fill_n(to, size, 0.0);
        for (int layer = 0; layer < patch.n_layers; ++layer) {
            const int first = d == 3 ? patch.tables[d - 1].first_function[layer] : 0;
            if (i < first || i >= first + patch.layer_planes) {
                continue;
            }
            const double* from = &patch.sums[layer][(i - first) * size];
            for (std::size_t c = 0; c < size; ++c) {
                to[c] += from[c];
            }
        }
    });
    const int nc = form_.n_components;
    VectorX result(n_unknowns());
    constexpr int chunk = 4096;
    const int n_dofs = space_->n_dofs();
    parallel_for((n_dofs + chunk - 1) / chunk, [&](int c) {
        for (int dof = c * chunk; dof < std::min((c + 1) * chunk, n_dofs); ++dof) {
            Vector4d sum{};
            for (std::int64_t at = incidence_.begin[dof]; at < incidence_.begin[dof + 1]; ++at) {
                const PatchData& patch = *patches_[incidence_.patch[at]];
                const int f = incidence_.function[at];
                const double w = patch.is_rational ? space_->weights(patch.index)[f] : 1.0;
                sum += w * *reinterpret_cast<const Vector4d*>(
                               &patch.rows[static_cast<std::size_t>(f) * lanes]);
            }
            for (int a = 0; a < nc; ++a) {
                result[dof * nc + a] = sum[a];
            }
        }
    });
    return result;
}

template <int d>
VectorX FormOperator<d>::operator*(const VectorX& u) const {
    struct Layer {
        int patch;
        int i;
    };
    std::vector<Layer> layers;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        for (int i = 0; i < patches_[p]->n_layers; ++i) {
            layers.push_back({static_cast<int>(p), i});
        }
    }
    gather(u);
    parallel_for(static_cast<int>(layers.size()), [&](int n) {
        const PatchData& patch = *patches_[layers[n].patch];
        const int i = layers[n].i;
        if (form_.n_components == 1) {
            n_slots_ > d ? apply_layer<1, d + 1>(patch, i) : apply_layer<1, d>(patch, i);
        } else {
            n_slots_ > d ? apply_layer<d, d + 1>(patch, i) : apply_layer<d, d>(patch, i);
        }
    });
    return scatter();
}

template <int d>
std::size_t FormOperator<d>::memory() const {
    std::size_t n = 0;
    for (const auto& patch : patches_) {
        n += patch->records.size() + patch->rows.size();
        for (const Buffer<double>& sum : patch->sums) {
            n += sum.size();
        }
    }
    return n * sizeof(double);
}

template class FormOperator<2>;
template class FormOperator<3>;

}  // namespace couture::iga
