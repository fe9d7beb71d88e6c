#pragma once

#include "iga/linalg/block_matrix.h"

namespace couture::iga {

/// Upper triangle (or all) of a dense matrix as blocks; blocks of zeros off the diagonal are left
/// out.
[[nodiscard]] BlockMatrix to_blocks(const MatrixX& dense, int block_size, bool is_symmetric = true);

/// 7-point Laplacian on n^3 points with zero values around, times a positive definite block.
[[nodiscard]] BlockMatrix laplacian(int n, int block_size);

/// Isotropic elasticity on the unit cube, B-splines of `degree` on n^3 elements, no supports.
struct ElasticCube {
    BlockMatrix matrix;
    /// Control points, n_rows x 3.
    MatrixX points;
    /// Three translations, three rotations: n_unknowns x 6.
    MatrixX rigid_motions;
    /// Flags that hold all components at z = 0.
    std::vector<char> clamped;
};
[[nodiscard]] ElasticCube elastic_cube(int degree, int n);

}  // namespace couture::iga
