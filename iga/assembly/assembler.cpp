#include "iga/assembly/assembler.h"

#include <algorithm>
#include <cstring>

#include "iga/assembly/patch_stencil.h"
#include "iga/assembly/sparsity.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Slabs of rows, one per thread: how they are cut does not change any number.
template <int d>
void integrate_in_parallel(const PatchIntegrator<d>& integrator,
                           const std::function<void(const StencilRow<d>&)>& sink) {
    const int n_planes = integrator.n_row_planes();
    const int n_slabs = d == 2 ? 1 : std::min(n_threads(), n_planes);
    parallel_for(n_slabs, [&](int slab) {
        integrator.integrate(
            static_cast<int>(static_cast<std::int64_t>(n_planes) * slab / n_slabs),
            static_cast<int>(static_cast<std::int64_t>(n_planes) * (slab + 1) / n_slabs), sink);
    });
}

/// Visits the entries j >= i of a row, ascending in j: body(j, offset_0, offset_1, lane).
template <int d, typename Body>
void for_upper_entries(const StencilRow<d>& row, const std::array<int, d>& sizes,
                       const std::array<NeighbourRange, d>& ranges, const Body& body) {
    const std::array<int, 2> half = {(row.widths[0] - 1) / 2, (row.widths[1] - 1) / 2};
    const int last_2 = d == 3 ? ranges[d - 1].last[row.i[d - 1]] : 0;
    const int first_2 = d == 3 ? row.i[d - 1] : 0;
    for (int j2 = first_2; j2 <= last_2; ++j2) {
        const bool same_2 = j2 == first_2;
        const int first_1 = same_2 ? row.i[1] : ranges[1].first[row.i[1]];
        for (int j1 = first_1; j1 <= ranges[1].last[row.i[1]]; ++j1) {
            const bool same_1 = same_2 && j1 == row.i[1];
            const int first_0 = same_1 ? row.i[0] : ranges[0].first[row.i[0]];
            const int base = (j2 * sizes[1] + j1) * sizes[0];
            for (int j0 = first_0; j0 <= ranges[0].last[row.i[0]]; ++j0) {
                body(base + j0, j0 - row.i[0] + half[0], j1 - row.i[1] + half[1], j2 - first_2);
            }
        }
    }
}

/// Adds the rows of a patch whose global numbers ascend with the local ones: each global row gets
/// entries of one local row only.
template <int d>
void add_directly(BlockMatrix& matrix, const Space<d>& space, int patch,
                  const std::array<NeighbourRange, d>& ranges,
                  const PatchIntegrator<d>& integrator) {
    const TensorSpace<d>& tensor = space.tensor(patch);
    const std::array<int, d> sizes = tensor.sizes();
    const std::vector<int>& dofs = space.dofs(patch);
    const VectorX& weights = space.weights(patch);
    const int n = matrix.block_size;
    integrate_in_parallel<d>(integrator, [&](const StencilRow<d>& row) {
        const int i = tensor.index(row.i);
        std::int64_t entry = matrix.row_begin[dofs[i]];
        const double w_i = weights.size() > 0 ? weights[i] : 1.0;
        const int pair_stride = row.pair_stride();
        for_upper_entries<d>(row, sizes, ranges, [&](int j, int o0, int o1, int lane) {
            const int column = dofs[j];
            while (matrix.columns[entry] < column) {
                ++entry;
            }
            const double w = weights.size() > 0 ? w_i * weights[j] : 1.0;
            double* block = &matrix.values[entry * n * n];
            const double* from = row.entry(o0, o1, lane);
            for (int pair = 0; pair < n * n; ++pair) {
                block[pair] += w * from[pair * pair_stride];
            }
        });
    });
}

/// Entries of one patch kept by local row, upper neighbours only.
template <int d>
struct PatchRows {
    std::vector<std::int64_t> begin;
    std::vector<int> columns;
    Buffer<double> values;
};

template <int d>
PatchRows<d> integrate_rows(const Space<d>& space, int patch, int block_size,
                            const std::array<NeighbourRange, d>& ranges,
                            const PatchIntegrator<d>& integrator) {
    const TensorSpace<d>& tensor = space.tensor(patch);
    const std::array<int, d> sizes = tensor.sizes();
    const VectorX& weights = space.weights(patch);
    const int n = block_size;
    PatchRows<d> rows;
    rows.begin.assign(tensor.n_basis() + 1, 0);
    // Upper neighbours of i: later planes, later lines of its plane, later functions of its line.
    for (int i = 0; i < tensor.n_basis(); ++i) {
        const std::array<int, d> index = tensor.indices(i);
        std::int64_t count = 0;
        for (int k = d - 1; k >= 0; --k) {
            const int here = index[k];
            std::int64_t later = ranges[k].last[here] - here;
            for (int l = 0; l < k; ++l) {
                later *= ranges[l].last[index[l]] - ranges[l].first[index[l]] + 1;
            }
            count += later;
        }
        rows.begin[i + 1] = rows.begin[i] + count + 1;
    }
    rows.columns.resize(rows.begin.back());
    rows.values.resize(static_cast<std::size_t>(rows.begin.back()) * n * n);
    integrate_in_parallel<d>(integrator, [&](const StencilRow<d>& row) {
        const int i = tensor.index(row.i);
        std::int64_t entry = rows.begin[i];
        const double w_i = weights.size() > 0 ? weights[i] : 1.0;
        const int pair_stride = row.pair_stride();
        for_upper_entries<d>(row, sizes, ranges, [&](int j, int o0, int o1, int lane) {
            const double w = weights.size() > 0 ? w_i * weights[j] : 1.0;
            rows.columns[entry] = j;
            double* block = &rows.values[entry * n * n];
            const double* from = row.entry(o0, o1, lane);
            for (int pair = 0; pair < n * n; ++pair) {
                block[pair] = w * from[pair * pair_stride];
            }
            ++entry;
        });
    });
    return rows;
}

/// Adds kept rows to the global ones. An entry (i, j) of the patch goes to global row
/// min(dof i, dof j); global rows are shared out in fixed pieces, each with one owner, and every
/// owner meets the entries in the same order.
template <int d>
void add_rows(BlockMatrix& matrix, const std::vector<int>& dofs, const PatchRows<d>& rows) {
    const int n = matrix.block_size;
    const int n_local = static_cast<int>(dofs.size());
    // Entries sorted by the global row that gets them.
    std::vector<std::int64_t> begin(matrix.n_rows + 1, 0);
    for (int i = 0; i < n_local; ++i) {
        for (std::int64_t e = rows.begin[i]; e < rows.begin[i + 1]; ++e) {
            ++begin[std::min(dofs[i], dofs[rows.columns[e]]) + 1];
        }
    }
    for (int r = 0; r < matrix.n_rows; ++r) {
        begin[r + 1] += begin[r];
    }
    struct Entry {
        int local_row;
        std::int64_t entry;
    };
    std::vector<Entry> entries(begin.back());
    std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
    for (int i = 0; i < n_local; ++i) {
        for (std::int64_t e = rows.begin[i]; e < rows.begin[i + 1]; ++e) {
            entries[next[std::min(dofs[i], dofs[rows.columns[e]])]++] = {i, e};
        }
    }
    const int n_pieces = std::clamp(matrix.n_rows / 64, 1, 512);
    parallel_for(n_pieces, [&](int piece) {
        const int first =
            static_cast<int>(static_cast<std::int64_t>(matrix.n_rows) * piece / n_pieces);
        const int last =
            static_cast<int>(static_cast<std::int64_t>(matrix.n_rows) * (piece + 1) / n_pieces);
        for (int r = first; r < last; ++r) {
            const auto row_first = matrix.columns.begin() + matrix.row_begin[r];
            const auto row_last = matrix.columns.begin() + matrix.row_begin[r + 1];
            for (std::int64_t at = begin[r]; at < begin[r + 1]; ++at) {
                const int i = entries[at].local_row;
                const int j = rows.columns[entries[at].entry];
                const int column = std::max(dofs[i], dofs[j]);
                const auto place = std::lower_bound(row_first, row_last, column);
                double* block = &matrix.values[(place - matrix.columns.begin()) * n * n];
                const double* source = &rows.values[entries[at].entry * n * n];
                const bool as_is = dofs[i] <= dofs[j];
                const bool both = dofs[i] == dofs[j] && i != j;
                for (int a = 0; a < n; ++a) {
                    for (int b = 0; b < n; ++b) {
                        if (as_is) {
                            block[a * n + b] += source[a * n + b];
                        }
                        if (!as_is || both) {
                            block[a * n + b] += source[b * n + a];
                        }
                    }
                }
            }
        }
    });
}

}  // namespace

template <int d>
std::array<int, d> gauss_points(const TensorSpace<d>& space, std::optional<int> n_gauss_points) {
    std::array<int, d> points;
    for (int k = 0; k < d; ++k) {
        points[k] = n_gauss_points.value_or(space.knots[k].degree() + 1);
    }
    return points;
}

template <int d>
void assemble_into(BlockMatrix& matrix, const Space<d>& space, const BilinearForm<d>& form,
                   std::optional<int> n_gauss_points) {
    parallel_for(64, [&](int piece) {
        const std::size_t n = matrix.values.size();
        std::fill(matrix.values.begin() + n * piece / 64,
                  matrix.values.begin() + n * (piece + 1) / 64, 0.0);
    });
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        const PatchIntegrator<d> integrator(p, space.geometry().patches[p], tensor,
                                            space.weights(p), form,
                                            gauss_points<d>(tensor, n_gauss_points));
        std::array<NeighbourRange, d> ranges;
        for (int k = 0; k < d; ++k) {
            ranges[k] = neighbours(tensor.knots[k]);
        }
        const std::vector<int>& dofs = space.dofs(p);
        const bool ascending = std::adjacent_find(dofs.begin(), dofs.end(), [](int a, int b) {
                                   return a >= b;
                               }) == dofs.end();
        if (ascending) {
            add_directly<d>(matrix, space, p, ranges, integrator);
        } else {
            add_rows<d>(matrix, dofs,
                        integrate_rows<d>(space, p, matrix.block_size, ranges, integrator));
        }
    }
}

template <int d>
BlockMatrix assemble(const Space<d>& space, const BilinearForm<d>& form,
                     std::optional<int> n_gauss_points) {
    BlockMatrix matrix = make_pattern(space, form.n_components);
    assemble_into(matrix, space, form, n_gauss_points);
    return matrix;
}

template std::array<int, 2> gauss_points<2>(const TensorSpace<2>&, std::optional<int>);
template std::array<int, 3> gauss_points<3>(const TensorSpace<3>&, std::optional<int>);
template void assemble_into(BlockMatrix&, const Space<2>&, const BilinearForm<2>&,
                            std::optional<int>);
template void assemble_into(BlockMatrix&, const Space<3>&, const BilinearForm<3>&,
                            std::optional<int>);
template BlockMatrix assemble(const Space<2>&, const BilinearForm<2>&, std::optional<int>);
template BlockMatrix assemble(const Space<3>&, const BilinearForm<3>&, std::optional<int>);

}  // namespace couture::iga
