#include "iga/assembly/partial_assembly.h"

#include <algorithm>
#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Derivatives in space of a function of several components' shape, and its value in slot d.
template <int d>
using Slots = Vector<d + 1>;

/// A block of the matrix to be.
struct Entry {
    int row;
    int column;
    MatrixX block;
};

/// The blocks between functions at one point are added to entries with row <= column.
///
/// @param A  [a][b][s][t] over d + 1 slots
template <int d>
void add_products(const double* A, int nc, double weight, const std::vector<Slots<d>>& functions,
                  const std::vector<int>& places, std::vector<MatrixX>& sums) {
    const int n = static_cast<int>(functions.size());
    const int n_slots = d + 1;
    std::vector<double> of_column(nc * nc * n_slots);
    for (int j = 0; j < n; ++j) {
        // A times the column's function: [a][b][s].
        for (int ab = 0; ab < nc * nc; ++ab) {
            for (int s = 0; s < n_slots; ++s) {
                double sum = 0.0;
                for (int t = 0; t < n_slots; ++t) {
                    sum += A[(ab * n_slots + s) * n_slots + t] * functions[j][t];
                }
                of_column[ab * n_slots + s] = weight * sum;
            }
        }
        for (int i = 0; i < n; ++i) {
            if (places[i] > places[j]) {
                continue;
            }
            MatrixX& block = sums[i * n + j];
            for (int ab = 0; ab < nc * nc; ++ab) {
                double sum = 0.0;
                for (int s = 0; s < n_slots; ++s) {
                    sum += functions[i][s] * of_column[ab * n_slots + s];
                }
                block(ab / nc, ab % nc) += sum;
            }
        }
    }
}

/// Entries summed up, those of one place in their order.
BlockMatrix to_matrix(std::vector<Entry> entries, int n_rows, int nc) {
    for (int row = 0; row < n_rows; ++row) {
        entries.push_back({row, row, MatrixX::Zero(nc, nc)});
    }
    std::ranges::stable_sort(entries, [](const Entry& a, const Entry& b) {
        return std::pair(a.row, a.column) < std::pair(b.row, b.column);
    });
    BlockMatrix matrix;
    matrix.block_size = nc;
    matrix.n_rows = n_rows;
    matrix.row_begin.push_back(0);
    int row = 0;
    const Entry* last = nullptr;
    for (const Entry& entry : entries) {
        for (; row < entry.row; ++row) {
            matrix.row_begin.push_back(matrix.n_blocks());
        }
        if (last == nullptr || last->row != entry.row || last->column != entry.column) {
            matrix.columns.push_back(entry.column);
            matrix.values.insert(matrix.values.end(), nc * nc, 0.0);
        }
        double* to = matrix.values.data() + matrix.values.size() - nc * nc;
        for (int ab = 0; ab < nc * nc; ++ab) {
            to[ab] += entry.block(ab / nc, ab % nc);
        }
        last = &entry;
    }
    matrix.row_begin.push_back(matrix.n_blocks());
    return matrix;
}

BlockMatrix to_matrix(std::vector<std::vector<Entry>>& lists, int n_rows, int nc) {
    std::vector<Entry> entries;
    for (std::vector<Entry>& list : lists) {
        std::ranges::move(list, std::back_inserter(entries));
    }
    return to_matrix(std::move(entries), n_rows, nc);
}

/// Local numbers of the functions that don't vanish on an element.
template <int d>
std::vector<int> functions_of_element(const TensorSpace<d>& tensor,
                                      const std::array<BasisTable, d>& tables,
                                      const std::array<int, d>& element) {
    int n = 1;
    for (const BasisTable& table : tables) {
        n *= table.n_functions;
    }
    std::vector<int> functions(n);
    for (int f = 0; f < n; ++f) {
        std::array<int, d> i;
        for (int k = 0, rest = f; k < d; rest /= tables[k].n_functions, ++k) {
            i[k] = tables[k].first_function[element[k]] + rest % tables[k].n_functions;
        }
        functions[f] = tensor.index(i);
    }
    return functions;
}

}  // namespace

template <int d>
BlockMatrix assemble_between(const Space<d>& space, const BilinearForm<d>& form,
                             const std::vector<int>& functions, std::optional<int> n_gauss_points) {
    const int nc = form.n_components;
    std::vector<int> row_of_dof(space.n_dofs(), -1);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        row_of_dof[functions[i]] = static_cast<int>(i);
    }
    std::vector<std::vector<Entry>> lists;
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        const std::vector<int>& dofs = space.dofs(p);
        const VectorX& weights = space.weights(p);
        const bool is_rational = weights.size() > 0;
        const GeometryGrid<d> grid(space.geometry().patches[p], tensor,
                                   gauss_points<d>(tensor, n_gauss_points));
        std::array<BasisTable, d> tables;
        for (int k = 0; k < d; ++k) {
            tables[k] =
                tabulate(tensor.knots[k], tensor.knots[k].breakpoints(), grid.line(k).unit_points);
        }
        const std::array<int, d> n_elements = tensor.n_elements();
        const int m2 = d == 3 ? grid.line(d - 1).points_per_element : 1;
        const int n_layers = grid.n_planes() / m2;
        const std::size_t first_list = lists.size();
        lists.resize(first_list + n_layers);
        parallel_for(n_layers, [&](int layer) {
            // Elements of the layer with some of the functions: these, and their blocks.
            struct Piece {
                std::array<int, d> element;
                std::vector<int> functions;
                std::vector<int> rows;
                std::vector<MatrixX> sums;
            };
            std::vector<Piece> pieces;
            for (int e1 = 0; e1 < n_elements[1]; ++e1) {
                for (int e0 = 0; e0 < n_elements[0]; ++e0) {
                    Piece piece;
                    piece.element = {e0, e1};
                    if constexpr (d == 3) {
                        piece.element[2] = layer;
                    }
                    for (const int f : functions_of_element<d>(tensor, tables, piece.element)) {
                        if (row_of_dof[dofs[f]] >= 0) {
                            piece.functions.push_back(f);
                            piece.rows.push_back(row_of_dof[dofs[f]]);
                        }
                    }
                    if (!piece.functions.empty()) {
                        piece.sums.assign(piece.rows.size() * piece.rows.size(),
                                          MatrixX::Zero(nc, nc));
                        pieces.push_back(std::move(piece));
                    }
                }
            }
            if (pieces.empty()) {
                return;
            }
            GeometryPlane<d> plane;
            Buffer<double> A;
            const int m0 = grid.line(0).points_per_element;
            const int m1 = grid.line(1).points_per_element;
            const int n0 = grid.line(0).n_points();
            for (int q2 = 0; q2 < m2; ++q2) {
                const int i_plane = layer * m2 + q2;
                grid.evaluate(i_plane, plane);
                evaluate_coefficients(form, p, grid, i_plane, plane, A);
                for (Piece& piece : pieces) {
                    std::vector<Slots<d>> values(piece.functions.size());
                    for (int q = 0; q < m0 * m1; ++q) {
                        const std::array<int, 3> points{q % m0, q / m0, q2};
                        const int point = (piece.element[1] * m1 + points[1]) * n0 +
                                          piece.element[0] * m0 + points[0];
                        const double W = plane.denominator[point];
                        for (std::size_t n = 0; n < piece.functions.size(); ++n) {
                            const std::array<int, d> i = tensor.indices(piece.functions[n]);
                            Vector<d> by_xi = Vector<d>::Ones();
                            double value = 1.0;
                            for (int k = 0; k < d; ++k) {
                                const int local = i[k] - tables[k].first_function[piece.element[k]];
                                const double N =
                                    tables[k].value(piece.element[k], points[k])[local];
                                const double D =
                                    tables[k].derivative(piece.element[k], points[k])[local];
                                value *= N;
                                for (int l = 0; l < d; ++l) {
                                    by_xi[l] *= l == k ? D : N;
                                }
                            }
                            if (is_rational) {
                                const double w = weights[piece.functions[n]] / W;
                                value *= w;
                                for (int k = 0; k < d; ++k) {
                                    by_xi[k] =
                                        w * by_xi[k] -
                                        value * plane.denominator_gradient[d * point + k] / W;
                                }
                            }
                            const double* inverse = &plane.inverse_jacobian[d * d * point];
                            for (int s = 0; s < d; ++s) {
                                values[n][s] = 0.0;
                                for (int k = 0; k < d; ++k) {
                                    values[n][s] += by_xi[k] * inverse[d * k + s];
                                }
                            }
                            values[n][d] = value;
                        }
                        add_products<d>(
                            &A[form.is_constant() ? 0
                                                  : static_cast<std::size_t>(point) * form.size()],
                            nc, plane.quadrature_weight[point] * std::abs(plane.determinant[point]),
                            values, piece.rows, piece.sums);
                    }
                }
            }
            std::vector<Entry>& entries = lists[first_list + layer];
            for (Piece& piece : pieces) {
                const std::size_t n = piece.rows.size();
                for (std::size_t i = 0; i < n; ++i) {
                    for (std::size_t j = 0; j < n; ++j) {
                        if (piece.rows[i] <= piece.rows[j]) {
                            entries.push_back(
                                {piece.rows[i], piece.rows[j], std::move(piece.sums[i * n + j])});
                        }
                    }
                }
            }
        });
    }
    return to_matrix(lists, static_cast<int>(functions.size()), nc);
}

template <int d>
BlockMatrix assemble_multilinear(const Space<d>& space, const BilinearForm<d>& form,
                                 const CoarseFunctions& coarse) {
    const int nc = form.n_components;
    constexpr int n_corners = 1 << d;
    std::vector<std::vector<Entry>> lists;
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        std::array<int, d> one;
        one.fill(1);
        const GeometryGrid<d> grid(space.geometry().patches[p], tensor, one);
        const std::array<int, 3>& n = coarse.n_elements[p];
        // Place of a point on the coarse grid of a direction.
        const auto place = [&](int k, int q) {
            const KnotVector& knots = tensor.knots[k];
            const double length = knots.back() - knots.front();
            return (grid.line(k).points[q] - knots.front()) / length * n[k];
        };
        const auto element = [&](int k, int q) {
            return std::min(static_cast<int>(place(k, q)), n[k] - 1);
        };
        // Planes of points by layers of the coarse grid.
        std::vector<std::vector<int>> planes(d == 3 ? n[2] : 1);
        for (int i = 0; i < grid.n_planes(); ++i) {
            planes[d == 3 ? element(d - 1, i) : 0].push_back(i);
        }
        const std::size_t first_list = lists.size();
        lists.resize(first_list + planes.size());
        parallel_for(static_cast<int>(planes.size()), [&](int layer) {
            std::vector<std::vector<MatrixX>> sums(
                static_cast<std::size_t>(n[0]) * n[1],
                std::vector<MatrixX>(n_corners * n_corners, MatrixX::Zero(nc, nc)));
            const auto nodes_of = [&](int e0, int e1) {
                std::vector<int> nodes(n_corners);
                for (int c = 0; c < n_corners; ++c) {
                    const int i0 = e0 + (c & 1);
                    const int i1 = e1 + (c >> 1 & 1);
                    const int i2 = d == 3 ? layer + (c >> 2 & 1) : 0;
                    nodes[c] = coarse.nodes_of_patch[p][i0 + (n[0] + 1) * (i1 + (n[1] + 1) * i2)];
                }
                return nodes;
            };
            GeometryPlane<d> plane;
            Buffer<double> A;
            std::vector<Slots<d>> values(n_corners);
            for (const int i_plane : planes[layer]) {
                grid.evaluate(i_plane, plane);
                evaluate_coefficients(form, p, grid, i_plane, plane, A);
                for (int q = 0; q < plane.n_points; ++q) {
                    const int n0 = grid.line(0).n_points();
                    const std::array<int, 3> points{q % n0, q / n0, i_plane};
                    std::array<int, 3> e{0, 0, 0};
                    std::array<double, 3> part{};
                    for (int k = 0; k < d; ++k) {
                        e[k] = element(k, points[k]);
                        part[k] = place(k, points[k]) - e[k];
                    }
                    const double* inverse = &plane.inverse_jacobian[d * d * q];
                    for (int c = 0; c < n_corners; ++c) {
                        double value = 1.0;
                        Vector<d> by_xi = Vector<d>::Ones();
                        for (int k = 0; k < d; ++k) {
                            const bool is_high = (c >> k & 1) == 1;
                            const KnotVector& knots = tensor.knots[k];
                            const double N = is_high ? part[k] : 1.0 - part[k];
                            const double D =
                                (is_high ? 1.0 : -1.0) * n[k] / (knots.back() - knots.front());
                            value *= N;
                            for (int l = 0; l < d; ++l) {
                                by_xi[l] *= l == k ? D : N;
                            }
                        }
                        for (int s = 0; s < d; ++s) {
                            values[c][s] = 0.0;
                            for (int k = 0; k < d; ++k) {
                                values[c][s] += by_xi[k] * inverse[d * k + s];
                            }
                        }
                        values[c][d] = value;
                    }
                    add_products<d>(
                        &A[form.is_constant() ? 0 : static_cast<std::size_t>(q) * form.size()], nc,
                        plane.quadrature_weight[q] * std::abs(plane.determinant[q]), values,
                        nodes_of(e[0], e[1]), sums[e[0] + n[0] * e[1]]);
                }
            }
            std::vector<Entry>& entries = lists[first_list + layer];
            for (std::size_t e = 0; e < sums.size(); ++e) {
                const std::vector<int> nodes =
                    nodes_of(static_cast<int>(e) % n[0], static_cast<int>(e) / n[0]);
                for (int i = 0; i < n_corners; ++i) {
                    for (int j = 0; j < n_corners; ++j) {
                        if (nodes[i] <= nodes[j]) {
                            entries.push_back(
                                {nodes[i], nodes[j], std::move(sums[e][i * n_corners + j])});
                        }
                    }
                }
            }
        });
    }
    return to_matrix(lists, coarse.n_nodes, nc);
}

template BlockMatrix assemble_between(const Space<2>&, const BilinearForm<2>&,
                                      const std::vector<int>&, std::optional<int>);
template BlockMatrix assemble_between(const Space<3>&, const BilinearForm<3>&,
                                      const std::vector<int>&, std::optional<int>);
template BlockMatrix assemble_multilinear(const Space<2>&, const BilinearForm<2>&,
                                          const CoarseFunctions&);
template BlockMatrix assemble_multilinear(const Space<3>&, const BilinearForm<3>&,
                                          const CoarseFunctions&);

}  // namespace couture::iga
