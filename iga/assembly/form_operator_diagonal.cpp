#include <algorithm>
#include <cmath>

#include "iga/assembly/form_operator_data.h"
#include "iga/core/parallel.h"

namespace couture::iga {

template <int d>
MatrixX FormOperator<d>::diagonal_blocks(bool is_diagonal) const {
    const int nc = form_.n_components;
    const int n_slots = n_slots_;
    // Entries of a block.
    std::vector<std::array<int, 2>> columns;
    for (int a = 0; a < nc; ++a) {
        for (int b = 0; b < nc; ++b) {
            if (a == b || !is_diagonal) {
                columns.push_back({a, b});
            }
        }
    }
    const int n_columns = static_cast<int>(columns.size());
    MatrixX result = MatrixX::Zero(n_unknowns(), nc);
    // Pairs of slots k <= l, slot d the value. A direction of a function enters as N^2, N N' or
    // N'^2, as many derivatives as the pair has of it.
    struct Pair {
        int k, l;
    };
    std::vector<Pair> pairs;
    for (int k = 0; k < n_slots; ++k) {
        for (int l = k; l < n_slots; ++l) {
            pairs.push_back({k, l});
        }
    }
    for (const auto& patch_data : patches_) {
        const PatchData& patch = *patch_data;
        const std::vector<int>& dofs = space_->dofs(patch.index);
        const int n0 = patch.grid.line(0).n_points();
        const int n1 = patch.grid.line(1).n_points();
        const auto products = [&](int k, int q, int i) {
            const int m = patch.grid.line(k).points_per_element;
            const double N = patch.tables[k].value(q / m, q % m)[i];
            const double D = patch.tables[k].derivative(q / m, q % m)[i];
            return std::array<double, 3>{N * N, N * D, D * D};
        };
        const auto first = [&](int k, int q) {
            return patch.tables[k].first_function[q / patch.grid.line(k).points_per_element];
        };
        // After direction 0: by the number of derivatives by parameter 1 and by parameter 2, 3 x 3;
        // after direction 1 by that of parameter 2.
        const std::size_t line_size = static_cast<std::size_t>(patch.sizes[0]) * n_columns;
        const std::size_t net_size = line_size * patch.sizes[1];
        std::vector<Buffer<double>> planes(patch.grid.n_planes());
        parallel_for(patch.grid.n_planes(), [&](int i_plane) {
            PlaneData plane;
            fill_plane(patch, i_plane, plane);
            Buffer<double>& net = planes[i_plane];
            net.assign(net_size * 3, 0.0);
            Buffer<double> line(line_size * 9);
            std::vector<double> C(n_slots * n_slots);
            for (int q1 = 0; q1 < n1; ++q1) {
                std::fill(line.begin(), line.end(), 0.0);
                for (int q0 = 0; q0 < n0; ++q0) {
                    const std::size_t point = static_cast<std::size_t>(q1) * n0 + q0;
                    const double* T = &plane.records[point * record_size()];
                    const double* A =
                        form_.is_constant()
                            ? patch.coefficients.data()
                            : &plane.coefficients[point * coefficient_size(n_slots, nc)];
                    for (int column = 0; column < n_columns; ++column) {
                        const auto [a, b] = columns[column];
                        std::fill(C.begin(), C.end(), 0.0);
                        for (int s = 0; s < n_slots; ++s) {
                            for (int t = 0; t < n_slots; ++t) {
                                const double value = T[n_slots * n_slots] *
                                                     A[((t * nc + b) * n_slots + s) * lanes + a];
                                for (int k = 0; value != 0.0 && k < n_slots; ++k) {
                                    for (int l = 0; l < n_slots; ++l) {
                                        C[k * n_slots + l] +=
                                            value * T[s * n_slots + k] * T[t * n_slots + l];
                                    }
                                }
                            }
                        }
                        for (const auto& [k, l] : pairs) {
                            const double c =
                                C[k * n_slots + l] + (k == l ? 0.0 : C[l * n_slots + k]);
                            const auto count = [&, k = k, l = l](int x) {
                                return (k == x ? 1 : 0) + (l == x ? 1 : 0);
                            };
                            const int slot = 3 * count(1) + (d == 3 ? count(2) : 0);
                            for (int i = 0; i < patch.tables[0].n_functions; ++i) {
                                line[((first(0, q0) + i) * 9 + slot) * n_columns + column] +=
                                    c * products(0, q0, i)[count(0)];
                            }
                        }
                    }
                }
                for (int i1 = 0; i1 < patch.tables[1].n_functions; ++i1) {
                    const auto P = products(1, q1, i1);
                    double* to = &net[(first(1, q1) + i1) * line_size * 3];
                    for (int i0 = 0; i0 < patch.sizes[0]; ++i0) {
                        for (int slot = 0; slot < 9; ++slot) {
                            for (int c = 0; c < n_columns; ++c) {
                                to[(i0 * 3 + slot % 3) * n_columns + c] +=
                                    P[slot / 3] * line[(i0 * 9 + slot) * n_columns + c];
                            }
                        }
                    }
                }
            }
        });
        Buffer<double> all(net_size * (d == 3 ? patch.sizes[d - 1] : 1), 0.0);
        for (int i_plane = 0; i_plane < patch.grid.n_planes(); ++i_plane) {
            const int n_last = d == 3 ? patch.tables[d - 1].n_functions : 1;
            for (int i2 = 0; i2 < n_last; ++i2) {
                const auto P =
                    d == 3 ? products(d - 1, i_plane, i2) : std::array<double, 3>{1.0, 0.0, 0.0};
                double* to = &all[(d == 3 ? first(d - 1, i_plane) + i2 : 0) * net_size];
                for (std::size_t f = 0; f < net_size / n_columns; ++f) {
                    for (int k = 0; k < 3; ++k) {
                        for (int c = 0; c < n_columns; ++c) {
                            to[f * n_columns + c] +=
                                P[k] * planes[i_plane][(f * 3 + k) * n_columns + c];
                        }
                    }
                }
            }
        }
        for (std::size_t f = 0; f < dofs.size(); ++f) {
            const double w = patch.is_rational
                                 ? space_->weights(patch.index)[static_cast<Eigen::Index>(f)]
                                 : 1.0;
            for (int c = 0; c < n_columns; ++c) {
                result(dofs[f] * nc + columns[c][0], columns[c][1]) +=
                    w * w * all[f * n_columns + c];
            }
        }
    }
    return result;
}

template <int d>
std::vector<std::vector<PatchCoefficients>> FormOperator<d>::mean_coefficients() const {
    const int nc = form_.n_components;
    std::vector<std::vector<PatchCoefficients>> result;
    for (const auto& patch_data : patches_) {
        const PatchData& patch = *patch_data;
        // Of each plane the integrals, [component][direction, value].
        std::vector<MatrixX> planes(patch.grid.n_planes(), MatrixX::Zero(d + 1, nc));
        parallel_for(patch.grid.n_planes(), [&](int i_plane) {
            PlaneData plane;
            fill_plane(patch, i_plane, plane);
            const GeometryPlane<d>& geometry = plane.geometry;
            for (int q = 0; q < geometry.n_points; ++q) {
                const double* A = form_.is_constant()
                                      ? patch.coefficients.data()
                                      : &plane.coefficients[static_cast<std::size_t>(q) *
                                                            coefficient_size(n_slots_, nc)];
                const double weight =
                    geometry.quadrature_weight[q] * std::abs(geometry.determinant[q]);
                const double* inverse = &geometry.inverse_jacobian[d * d * q];
                for (int c = 0; c < nc; ++c) {
                    const auto entry = [&](int s, int t) {
                        return A[((t * nc + c) * n_slots_ + s) * lanes + c];
                    };
                    for (int k = 0; k < d; ++k) {
                        for (int s = 0; s < d; ++s) {
                            for (int t = 0; t < d; ++t) {
                                planes[i_plane](k, c) +=
                                    weight * inverse[d * k + s] * entry(s, t) * inverse[d * k + t];
                            }
                        }
                    }
                    planes[i_plane](d, c) += n_slots_ > d ? weight * entry(d, d) : 0.0;
                }
            }
        });
        MatrixX sum = MatrixX::Zero(d + 1, nc);
        for (const MatrixX& plane : planes) {
            sum += plane;
        }
        auto& of_patch = result.emplace_back(nc);
        for (int c = 0; c < nc; ++c) {
            for (int k = 0; k < d; ++k) {
                const KnotVector& knots = space_->tensor(patch.index).knots[k];
                const double length = knots.back() - knots.front();
                of_patch[c].stretch[k] = sum(k, c) / (length * length);
            }
            of_patch[c].reaction = sum(d, c);
        }
    }
    return result;
}

#define COUTURE_INSTANTIATE(d)                                     \
    template MatrixX FormOperator<d>::diagonal_blocks(bool) const; \
    template std::vector<std::vector<PatchCoefficients>> FormOperator<d>::mean_coefficients() const;
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
