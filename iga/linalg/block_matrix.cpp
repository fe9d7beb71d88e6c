#include "iga/linalg/block_matrix.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

#include "iga/core/error.h"
#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Pieces of work. A fixed number: sums are taken piece by piece, so that results do not depend on
/// the number of threads.
constexpr int n_chunks = 32;

/// n_chunks + 1 bounds of row ranges with about equally many blocks.
std::vector<int> row_chunks(const BlockMatrix& A) {
    std::vector<int> bounds(n_chunks + 1, 0);
    for (int c = 1; c < n_chunks; ++c) {
        const std::int64_t target = A.n_blocks() * c / n_chunks;
        const auto row = std::lower_bound(A.row_begin.begin(), A.row_begin.end(), target);
        bounds[c] = std::min(static_cast<int>(row - A.row_begin.begin()), A.n_rows);
    }
    bounds[n_chunks] = A.n_rows;
    return bounds;
}

/// Adds the product of rows [first_row, last_row) to y. The transposed blocks of a symmetric matrix
/// write below those rows; y[0] belongs to unknown first_row * block_size.
///
/// @tparam fixed_size  block size known at compile time, or 0
template <int fixed_size>
void multiply_rows(const BlockMatrix& A, int first_row, int last_row, const double* x, double* y) {
    const int size = fixed_size > 0 ? fixed_size : A.block_size;
    using Sums = std::conditional_t<(fixed_size > 0), std::array<double, std::max(fixed_size, 1)>,
                                    std::vector<double>>;
    Sums sums;
    if constexpr (fixed_size == 0) {
        sums.resize(size);
    }
    for (int row = first_row; row < last_row; ++row) {
        std::fill(sums.begin(), sums.end(), 0.0);
        const double* x_row = x + static_cast<std::int64_t>(row) * size;
        for (std::int64_t e = A.row_begin[row]; e < A.row_begin[row + 1]; ++e) {
            const double* block = A.values.data() + e * size * size;
            const double* x_column = x + static_cast<std::int64_t>(A.columns[e]) * size;
            for (int a = 0; a < size; ++a) {
                for (int b = 0; b < size; ++b) {
                    sums[a] += block[a * size + b] * x_column[b];
                }
            }
            if (A.is_symmetric && A.columns[e] != row) {
                double* y_column = y + static_cast<std::int64_t>(A.columns[e] - first_row) * size;
                for (int a = 0; a < size; ++a) {
                    for (int b = 0; b < size; ++b) {
                        y_column[b] += block[a * size + b] * x_row[a];
                    }
                }
            }
        }
        double* y_row = y + static_cast<std::int64_t>(row - first_row) * size;
        for (int a = 0; a < size; ++a) {
            y_row[a] += sums[a];
        }
    }
}

void multiply_rows(const BlockMatrix& A, int first_row, int last_row, const double* x, double* y) {
    switch (A.block_size) {
        case 1:
            return multiply_rows<1>(A, first_row, last_row, x, y);
        case 2:
            return multiply_rows<2>(A, first_row, last_row, x, y);
        case 3:
            return multiply_rows<3>(A, first_row, last_row, x, y);
        default:
            return multiply_rows<0>(A, first_row, last_row, x, y);
    }
}

/// One past the last row that the rows of a chunk write to.
int end_of_writes(const BlockMatrix& A, int first_row, int last_row) {
    int end = last_row;
    if (A.is_symmetric) {
        for (int row = first_row; row < last_row; ++row) {
            if (A.row_begin[row] < A.row_begin[row + 1]) {
                end = std::max(end, A.columns[A.row_begin[row + 1] - 1] + 1);
            }
        }
    }
    return end;
}

/// Blocks by columns: entry k in [begin[j], begin[j + 1]) is block entries[k] in row rows[k], rows
/// ascending. Blocks on the diagonal are left out of a symmetric matrix.
struct ColumnIndex {
    std::vector<std::int64_t> begin;
    std::vector<int> rows;
    std::vector<std::int64_t> entries;
};

ColumnIndex index_columns(const BlockMatrix& A) {
    ColumnIndex index;
    index.begin.assign(A.n_rows + 1, 0);
    const auto is_listed = [&](int row, int column) { return !A.is_symmetric || row != column; };
    for (int row = 0; row < A.n_rows; ++row) {
        for (std::int64_t e = A.row_begin[row]; e < A.row_begin[row + 1]; ++e) {
            index.begin[A.columns[e] + 1] += is_listed(row, A.columns[e]) ? 1 : 0;
        }
    }
    std::partial_sum(index.begin.begin(), index.begin.end(), index.begin.begin());
    index.rows.resize(index.begin.back());
    index.entries.resize(index.begin.back());
    std::vector<std::int64_t> next(index.begin.begin(), index.begin.end() - 1);
    for (int row = 0; row < A.n_rows; ++row) {
        for (std::int64_t e = A.row_begin[row]; e < A.row_begin[row + 1]; ++e) {
            if (is_listed(row, A.columns[e])) {
                const std::int64_t k = next[A.columns[e]]++;
                index.rows[k] = row;
                index.entries[k] = e;
            }
        }
    }
    return index;
}

/// Calls visit(unknown of the row, value) for the entries of one scalar column, rows ascending.
template <typename Visit>
void visit_column(const BlockMatrix& A, const ColumnIndex& above, bool triangle_only, int column,
                  int b, const Visit& visit) {
    const int size = A.block_size;
    const int unknown = column * size + b;
    const bool skip_above = triangle_only && A.is_symmetric;
    for (std::int64_t k = skip_above ? 0 : above.begin[column];
         !skip_above && k < above.begin[column + 1]; ++k) {
        const double* block = A.values.data() + above.entries[k] * size * size;
        for (int a = 0; a < size; ++a) {
            const int row = above.rows[k] * size + a;
            if (!triangle_only || row >= unknown) {
                visit(row, block[a * size + b]);
            }
        }
    }
    if (A.is_symmetric) {
        for (std::int64_t e = A.row_begin[column]; e < A.row_begin[column + 1]; ++e) {
            const double* block = A.values.data() + e * size * size;
            for (int a = 0; a < size; ++a) {
                const int row = A.columns[e] * size + a;
                if (!triangle_only || row >= unknown) {
                    visit(row, block[b * size + a]);
                }
            }
        }
    }
}

}  // namespace

std::size_t BlockMatrix::memory() const {
    return columns.size() * sizeof(int) + values.size() * sizeof(double);
}

const double* BlockMatrix::find(int row, int column) const {
    const auto first = columns.begin() + row_begin[row];
    const auto last = columns.begin() + row_begin[row + 1];
    const auto found = std::lower_bound(first, last, column);
    if (found == last || *found != column) {
        return nullptr;
    }
    return values.data() + (found - columns.begin()) * block_size * block_size;
}

MatrixX BlockMatrix::operator*(const MatrixX& x) const {
    if (x.rows() != n_unknowns()) {
        throw InputError("BlockMatrix: the vector has {} rows; must be the {} unknowns", x.rows(),
                         n_unknowns());
    }
    const std::vector<int> chunks = row_chunks(*this);
    std::vector<int> ends(n_chunks);
    std::vector<MatrixX> parts(n_chunks);
    parallel_for(n_chunks, [&](int c) {
        ends[c] = end_of_writes(*this, chunks[c], chunks[c + 1]);
        parts[c] =
            MatrixX::Zero((ends[c] - chunks[c]) * static_cast<Eigen::Index>(block_size), x.cols());
        for (Eigen::Index k = 0; k < x.cols(); ++k) {
            multiply_rows(*this, chunks[c], chunks[c + 1], x.col(k).data(), parts[c].col(k).data());
        }
    });
    MatrixX y = MatrixX::Zero(x.rows(), x.cols());
    parallel_for(n_chunks, [&](int slice) {
        for (int c = 0; c <= slice; ++c) {
            const int first = chunks[slice];
            const int last = std::min(chunks[slice + 1], ends[c]);
            if (first < last) {
                const Eigen::Index n = static_cast<Eigen::Index>(last - first) * block_size;
                y.middleRows(static_cast<Eigen::Index>(first) * block_size, n) +=
                    parts[c].middleRows(static_cast<Eigen::Index>(first - chunks[c]) * block_size,
                                        n);
            }
        }
    });
    return y;
}

BlockMatrix to_symmetric_blocks(const SparseMatrix& matrix) {
    BlockMatrix blocks;
    blocks.n_rows = static_cast<int>(matrix.cols());
    blocks.row_begin.push_back(0);
    for (int column = 0; column < blocks.n_rows; ++column) {
        // Column of the lower triangle, row of the upper one.
        for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
            if (entry.row() < column) continue;
            blocks.columns.push_back(static_cast<int>(entry.row()));
            blocks.values.push_back(entry.value());
        }
        blocks.row_begin.push_back(blocks.n_blocks());
    }
    return blocks;
}

SparseMatrix to_scalar(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                       bool triangle_only, std::vector<int>& kept) {
    const int size = matrix.block_size;
    const int n_unknowns = matrix.n_unknowns();
    if (!is_fixed.empty() && static_cast<int>(is_fixed.size()) != n_unknowns) {
        throw InputError("to_scalar: {} flags of fixed unknowns for {} unknowns", is_fixed.size(),
                         n_unknowns);
    }
    std::vector<int> number(n_unknowns, -1);
    kept.clear();
    for (int i = 0; i < n_unknowns; ++i) {
        if (is_fixed.empty() || is_fixed[i] == 0) {
            number[i] = static_cast<int>(kept.size());
            kept.push_back(i);
        }
    }
    ColumnIndex above;
    if (!triangle_only || !matrix.is_symmetric) {
        above = index_columns(matrix);
    }
    const int n_kept = static_cast<int>(kept.size());
    const std::vector<int> chunks = row_chunks(matrix);
    const auto for_kept_columns = [&](const auto& body) {
        parallel_for(n_chunks, [&](int c) {
            for (int column = chunks[c]; column < chunks[c + 1]; ++column) {
                for (int b = 0; b < size; ++b) {
                    const int j = number[column * size + b];
                    if (j >= 0) {
                        body(column, b, j);
                    }
                }
            }
        });
    };

    std::vector<std::int64_t> begin(n_kept + 1, 0);
    for_kept_columns([&](int column, int b, int j) {
        visit_column(matrix, above, triangle_only, column, b,
                     [&](int row, double) { begin[j + 1] += number[row] >= 0 ? 1 : 0; });
    });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    if (begin.back() > std::numeric_limits<int>::max()) {
        throw SolverError("to_scalar: {} entries; a scalar matrix holds at most {}", begin.back(),
                          std::numeric_limits<int>::max());
    }
    SparseMatrix result(n_kept, n_kept);
    result.resizeNonZeros(begin.back());
    std::copy(begin.begin(), begin.end(), result.outerIndexPtr());
    for_kept_columns([&](int column, int b, int j) {
        std::int64_t next = begin[j];
        visit_column(matrix, above, triangle_only, column, b, [&](int row, double value) {
            if (number[row] >= 0) {
                result.innerIndexPtr()[next] = number[row];
                result.valuePtr()[next] = value;
                ++next;
            }
        });
    });
    return result;
}

}  // namespace couture::iga
