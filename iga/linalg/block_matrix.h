#pragma once

#include <cstdint>
#include <vector>

#include "iga/core/buffer.h"
#include "iga/core/types.h"

namespace couture::iga {

/// Sparse matrix of small square blocks, compressed rows, columns ascending.
struct BlockMatrix {
    int block_size = 1;
    int n_rows = 0;
    /// Only blocks with column >= row are stored; the rest follows by transposition.
    bool is_symmetric = true;
    std::vector<std::int64_t> row_begin;
    std::vector<int> columns;
    /// [entry][row in block][column in block]
    Buffer<double> values;

    [[nodiscard]] std::int64_t n_blocks() const {
        return static_cast<std::int64_t>(columns.size());
    }
    [[nodiscard]] int n_unknowns() const { return n_rows * block_size; }
    /// Bytes of columns and values.
    [[nodiscard]] std::size_t memory() const;
    /// A x, x of n_unknowns numbers numbered block_size * row + component.
    [[nodiscard]] MatrixX operator*(const MatrixX& x) const;
    /// The block at (row, column), or null; of a symmetric matrix column >= row.
    [[nodiscard]] const double* find(int row, int column) const;
};

/// A symmetric scalar matrix as one of blocks of size 1.
[[nodiscard]] BlockMatrix to_symmetric_blocks(const SparseMatrix& matrix);

/// All stored and implied entries as a scalar matrix without the rows and columns that are fixed
/// (an empty list keeps all). `triangle_only` keeps the lower triangle of a symmetric matrix.
///
/// @param is_fixed  n_unknowns flags or empty
/// @param kept  filled with the original number of each remaining unknown
[[nodiscard]] SparseMatrix to_scalar(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                                     bool triangle_only, std::vector<int>& kept);

}  // namespace couture::iga
