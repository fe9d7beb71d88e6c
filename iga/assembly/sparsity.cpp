#include "iga/assembly/sparsity.h"

#include <algorithm>
#include <array>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"

namespace couture::iga {

NeighbourRange neighbours(const KnotVector& knots) {
    const int n = knots.n_basis();
    const int p = knots.degree();
    NeighbourRange range{std::vector<int>(n, n), std::vector<int>(n, -1)};
    for (int e = 0; e < knots.n_elements(); ++e) {
        const int first = knots.span_of_element(e) - p;
        for (int i = first; i <= first + p; ++i) {
            range.first[i] = std::min(range.first[i], first);
            range.last[i] = std::max(range.last[i], first + p);
        }
    }
    return range;
}

template <int d>
Incidence make_incidence(const Space<d>& space) {
    Incidence incidence;
    incidence.begin.assign(space.n_dofs() + 1, 0);
    for (int p = 0; p < space.n_patches(); ++p) {
        for (const int dof : space.dofs(p)) {
            ++incidence.begin[dof + 1];
        }
    }
    for (int i = 0; i < space.n_dofs(); ++i) {
        incidence.begin[i + 1] += incidence.begin[i];
    }
    incidence.patch.resize(incidence.begin.back());
    incidence.function.resize(incidence.begin.back());
    std::vector<std::int64_t> next(incidence.begin.begin(), incidence.begin.end() - 1);
    for (int p = 0; p < space.n_patches(); ++p) {
        const std::vector<int>& dofs = space.dofs(p);
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            const std::int64_t at = next[dofs[i]]++;
            incidence.patch[at] = p;
            incidence.function[at] = static_cast<int>(i);
        }
    }
    return incidence;
}

namespace {

/// Columns >= row of one row, ascending.
template <int d>
void collect_columns(const Space<d>& space, const Incidence& incidence,
                     const std::vector<std::array<NeighbourRange, d>>& ranges, int row,
                     std::vector<int>& columns) {
    columns.clear();
    for (std::int64_t at = incidence.begin[row]; at < incidence.begin[row + 1]; ++at) {
        const int p = incidence.patch[at];
        const TensorSpace<d>& tensor = space.tensor(p);
        const std::vector<int>& dofs = space.dofs(p);
        const std::array<int, d> i = tensor.indices(incidence.function[at]);
        std::array<int, d> first;
        std::array<int, d> last;
        for (int k = 0; k < d; ++k) {
            first[k] = ranges[p][k].first[i[k]];
            last[k] = ranges[p][k].last[i[k]];
        }
        std::array<int, d> j = first;
        while (true) {
            const int start = tensor.index(j);
            for (int j0 = 0; j0 <= last[0] - first[0]; ++j0) {
                if (dofs[start + j0] >= row) {
                    columns.push_back(dofs[start + j0]);
                }
            }
            int k = 1;
            for (; k < d; ++k) {
                if (++j[k] <= last[k]) {
                    break;
                }
                j[k] = first[k];
            }
            if (k == d) {
                break;
            }
        }
    }
    if (!std::is_sorted(columns.begin(), columns.end())) {
        std::sort(columns.begin(), columns.end());
    }
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
}

}  // namespace

template <int d>
BlockMatrix make_pattern(const Space<d>& space, int block_size) {
    const Incidence incidence = make_incidence(space);
    std::vector<std::array<NeighbourRange, d>> ranges(space.n_patches());
    for (int p = 0; p < space.n_patches(); ++p) {
        for (int k = 0; k < d; ++k) {
            ranges[p][k] = neighbours(space.tensor(p).knots[k]);
        }
    }
    BlockMatrix matrix;
    matrix.block_size = block_size;
    matrix.n_rows = space.n_dofs();
    matrix.is_symmetric = true;
    matrix.row_begin.assign(matrix.n_rows + 1, 0);

    // Rows in fixed pieces; each piece keeps its columns until all counts are known.
    const int n_pieces = std::clamp(matrix.n_rows / 256, 1, 512);
    std::vector<std::vector<int>> piece_columns(n_pieces);
    const auto piece_begin = [&](int piece) {
        return static_cast<int>(static_cast<std::int64_t>(matrix.n_rows) * piece / n_pieces);
    };
    parallel_for(n_pieces, [&](int piece) {
        std::vector<int> columns;
        for (int row = piece_begin(piece); row < piece_begin(piece + 1); ++row) {
            collect_columns<d>(space, incidence, ranges, row, columns);
            matrix.row_begin[row + 1] = static_cast<std::int64_t>(columns.size());
            piece_columns[piece].insert(piece_columns[piece].end(), columns.begin(), columns.end());
        }
    });
    for (int row = 0; row < matrix.n_rows; ++row) {
        matrix.row_begin[row + 1] += matrix.row_begin[row];
    }
    const std::int64_t n_blocks = matrix.row_begin.back();
    const std::size_t bytes = static_cast<std::size_t>(n_blocks) * block_size * block_size * 8;
    if (bytes > available_memory()) {
        throw SolverError(
            "assembly: the matrix of {} unknowns takes {:.1f} GiB, {:.1f} GiB are "
            "free; use fewer elements or a lower degree",
            static_cast<std::int64_t>(matrix.n_rows) * block_size, bytes / 1073741824.0,
            available_memory() / 1073741824.0);
    }
    matrix.columns.resize(n_blocks);
    parallel_for(n_pieces, [&](int piece) {
        std::copy(piece_columns[piece].begin(), piece_columns[piece].end(),
                  matrix.columns.begin() + matrix.row_begin[piece_begin(piece)]);
    });
    matrix.values.resize(static_cast<std::size_t>(n_blocks) * block_size * block_size);
    return matrix;
}

template Incidence make_incidence(const Space<2>&);
template Incidence make_incidence(const Space<3>&);
template BlockMatrix make_pattern(const Space<2>&, int);
template BlockMatrix make_pattern(const Space<3>&, int);

}  // namespace couture::iga
