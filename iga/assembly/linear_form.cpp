#include "iga/assembly/linear_form.h"

#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Parametric coefficients of a plane, [point][a][k]: k < d derivatives by xi_k, k = d the value.
template <int d>
void to_parametric(const GeometryPlane<d>& plane, bool is_rational, int n_components,
                   Buffer<double>& b) {
    for (int q = 0; q < plane.n_points; ++q) {
        const double factor = plane.quadrature_weight[q] * std::abs(plane.determinant[q]);
        const double W = is_rational ? plane.denominator[q] : 1.0;
        for (int a = 0; a < n_components; ++a) {
            double* here = &b[(static_cast<std::size_t>(q) * n_components + a) * (d + 1)];
            std::array<double, d> gradient{};
            double value = here[d] / W;
            for (int k = 0; k < d; ++k) {
                for (int s = 0; s < d; ++s) {
                    gradient[k] += here[s] * plane.inverse_jacobian[d * d * q + d * k + s];
                }
                if (is_rational) {
                    value -= gradient[k] * plane.denominator_gradient[d * q + k] / (W * W);
                }
            }
            for (int k = 0; k < d; ++k) {
                here[k] = factor * gradient[k] / W;
            }
            here[d] = factor * value;
        }
    }
}

}  // namespace

template <int d>
MatrixX integrate(const Space<d>& space, const LinearForm<d>& form, const std::vector<int>& patches,
                  std::optional<int> n_gauss_points) {
    const int nc = form.n_components;
    MatrixX result = MatrixX::Zero(space.n_dofs(), nc);
    for (int p = 0; p < space.n_patches(); ++p) {
        if (!patches.empty() && std::find(patches.begin(), patches.end(), p) == patches.end()) {
            continue;
        }
        const TensorSpace<d>& tensor = space.tensor(p);
        const GeometryGrid<d> grid(space.geometry().patches[p], tensor,
                                   gauss_points<d>(tensor, n_gauss_points));
        const bool is_rational = space.weights(p).size() > 0;
        std::array<BasisTable, d> tables;
        for (int k = 0; k < d; ++k) {
            tables[k] =
                tabulate(tensor.knots[k], tensor.knots[k].breakpoints(), grid.line(k).unit_points);
        }
        const std::array<int, d> sizes = tensor.sizes();
        const int m0 = grid.line(0).points_per_element;
        const int m1 = grid.line(1).points_per_element;
        const int m2 = d == 3 ? grid.line(d - 1).points_per_element : 1;
        const int n0 = grid.line(0).n_points();
        const int n1 = grid.line(1).n_points();
        const int n_layers = grid.n_planes() / m2;
        const std::size_t net = static_cast<std::size_t>(sizes[0]) * sizes[1] * nc;
        const int net_planes = d == 3 ? tables[d - 1].n_functions : 1;
        // Each layer of elements sums for itself; the layers are added in order.
        std::vector<Buffer<double>> layers(n_layers);
        parallel_for(n_layers, [&](int layer) {
            Buffer<double>& sum = layers[layer];
            sum.assign(net * net_planes, 0.0);
            GeometryPlane<d> plane;
            Buffer<double> b;
            // Slots after directions 0 and 1: [function][a][derivative by xi_2, value].
            Buffer<double> line(static_cast<std::size_t>(sizes[0]) * nc * d);
            Buffer<double> face(net * 2);
            for (int q2 = 0; q2 < m2; ++q2) {
                const int i_plane = layer * m2 + q2;
                grid.evaluate(i_plane, plane);
                b.assign(static_cast<std::size_t>(plane.n_points) * nc * (d + 1), 0.0);
                form.coefficients(p, grid, i_plane, plane, b.data());
                to_parametric<d>(plane, is_rational, nc, b);
                std::fill(face.begin(), face.end(), 0.0);
                for (int q1 = 0; q1 < n1; ++q1) {
                    // Direction 0: slots (xi_0, xi_1, .., value) become (xi_1, .., value).
                    std::fill(line.begin(), line.end(), 0.0);
                    for (int q0 = 0; q0 < n0; ++q0) {
                        const double* B = tables[0].value(q0 / m0, q0 % m0);
                        const double* D = tables[0].derivative(q0 / m0, q0 % m0);
                        const int first = tables[0].first_function[q0 / m0];
                        const double* here =
                            &b[(static_cast<std::size_t>(q1) * n0 + q0) * nc * (d + 1)];
                        for (int i = 0; i < tables[0].n_functions; ++i) {
                            double* to = &line[static_cast<std::size_t>(first + i) * nc * d];
                            for (int a = 0; a < nc; ++a) {
                                const double* c = here + a * (d + 1);
                                for (int k = 0; k < d - 1; ++k) {
                                    to[a * d + k] += B[i] * c[k + 1];
                                }
                                to[a * d + d - 1] += D[i] * c[0] + B[i] * c[d];
                            }
                        }
                    }
                    const double* B = tables[1].value(q1 / m1, q1 % m1);
                    const double* D = tables[1].derivative(q1 / m1, q1 % m1);
                    const int first = tables[1].first_function[q1 / m1];
                    for (int i = 0; i < tables[1].n_functions; ++i) {
                        double* to = &face[static_cast<std::size_t>(first + i) * sizes[0] * nc * 2];
                        for (int c = 0; c < sizes[0] * nc; ++c) {
                            const double* from = &line[static_cast<std::size_t>(c) * d];
                            if constexpr (d == 3) {
                                to[2 * c] += B[i] * from[1];
                            }
                            to[2 * c + 1] += D[i] * from[0] + B[i] * from[d - 1];
                        }
                    }
                }
                for (int i = 0; i < net_planes; ++i) {
                    double B = 1.0;
                    double D = 0.0;
                    if constexpr (d == 3) {
                        B = tables[d - 1].value(layer, q2)[i];
                        D = tables[d - 1].derivative(layer, q2)[i];
                    }
                    for (std::size_t c = 0; c < net; ++c) {
                        sum[i * net + c] += D * face[2 * c] + B * face[2 * c + 1];
                    }
                }
            }
        });
        const std::vector<int>& dofs = space.dofs(p);
        const VectorX& weights = space.weights(p);
        for (int layer = 0; layer < n_layers; ++layer) {
            const int first =
                d == 3 ? tables[d - 1].first_function[layer] * sizes[0] * sizes[1] : 0;
            const std::size_t n = layers[layer].size() / nc;
            for (std::size_t i = 0; i < n; ++i) {
                const double w = is_rational ? weights[first + i] : 1.0;
                for (int a = 0; a < nc; ++a) {
                    result(dofs[first + i], a) += w * layers[layer][i * nc + a];
                }
            }
        }
    }
    return result;
}

template MatrixX integrate(const Space<2>&, const LinearForm<2>&, const std::vector<int>&,
                           std::optional<int>);
template MatrixX integrate(const Space<3>&, const LinearForm<3>&, const std::vector<int>&,
                           std::optional<int>);

}  // namespace couture::iga
