#include "tests/iga/linalg/model_systems.h"

#include <Eigen/Geometry>
#include <array>

#include "iga/spline/bspline_basis.h"
#include "iga/spline/gauss.h"
#include "iga/spline/tensor_space.h"

namespace couture::iga {

namespace {

/// Calls visit(row, column) for all pairs of a tensor grid whose indices differ by at most `reach`
/// in each direction, rows and columns ascending.
template <typename Visit>
void visit_neighbours(int n, int reach, const Visit& visit) {
    const auto low = [&](int i) { return std::max(i - reach, 0); };
    const auto high = [&](int i) { return std::min(i + reach, n - 1); };
    for (int row = 0; row < n * n * n; ++row) {
        const std::array<int, 3> i{row % n, row / n % n, row / (n * n)};
        for (int z = low(i[2]); z <= high(i[2]); ++z) {
            for (int y = low(i[1]); y <= high(i[1]); ++y) {
                for (int x = low(i[0]); x <= high(i[0]); ++x) {
                    visit(row, x + n * (y + n * z), i, std::array<int, 3>{x, y, z});
                }
            }
        }
    }
}

void append(BlockMatrix& matrix, int row, int column, const MatrixX& block) {
    while (static_cast<int>(matrix.row_begin.size()) <= row) {
        matrix.row_begin.push_back(matrix.n_blocks());
    }
    matrix.columns.push_back(column);
    for (int a = 0; a < matrix.block_size; ++a) {
        for (int b = 0; b < matrix.block_size; ++b) {
            matrix.values.push_back(block(a, b));
        }
    }
}

BlockMatrix make_empty(int n_rows, int block_size, bool is_symmetric) {
    BlockMatrix matrix;
    matrix.block_size = block_size;
    matrix.n_rows = n_rows;
    matrix.is_symmetric = is_symmetric;
    return matrix;
}

/// Integrals of d^a N_i d^b N_j over [0, 1] for a, b in {0, 1}: [a][b](i, j).
std::array<std::array<MatrixX, 2>, 2> integrals(const KnotVector& knots) {
    std::array<std::array<MatrixX, 2>, 2> result;
    for (auto& row : result) {
        row.fill(MatrixX::Zero(knots.n_basis(), knots.n_basis()));
    }
    const GaussRule& rule = gauss_rule(knots.degree() + 1);
    for (int e = 0; e < knots.n_elements(); ++e) {
        const double start = knots.breakpoints()[e];
        const double length = knots.breakpoints()[e + 1] - start;
        const int span = knots.span_of_element(e);
        const int first = span - knots.degree();
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
            const MatrixX N = basis_derivatives(knots, span, start + length * rule.points[q], 1);
            for (int a = 0; a < 2; ++a) {
                for (int b = 0; b < 2; ++b) {
                    result[a][b].block(first, first, N.cols(), N.cols()) +=
                        length * rule.weights[q] * N.row(a).transpose() * N.row(b);
                }
            }
        }
    }
    return result;
}

}  // namespace

BlockMatrix to_blocks(const MatrixX& dense, int block_size, bool is_symmetric) {
    const int n_rows = static_cast<int>(dense.rows()) / block_size;
    BlockMatrix matrix = make_empty(n_rows, block_size, is_symmetric);
    for (int row = 0; row < n_rows; ++row) {
        for (int column = is_symmetric ? row : 0; column < n_rows; ++column) {
            const MatrixX block =
                dense.block(row * block_size, column * block_size, block_size, block_size);
            if (row == column || !block.isZero(0.0)) {
                append(matrix, row, column, block);
            }
        }
    }
    matrix.row_begin.push_back(matrix.n_blocks());
    return matrix;
}

BlockMatrix laplacian(int n, int block_size) {
    MatrixX block = MatrixX::Constant(block_size, block_size, 0.25);
    block.diagonal().setOnes();
    BlockMatrix matrix = make_empty(n * n * n, block_size, true);
    visit_neighbours(n, 1, [&](int row, int column, const auto& i, const auto& j) {
        const int distance = std::abs(i[0] - j[0]) + std::abs(i[1] - j[1]) + std::abs(i[2] - j[2]);
        if (column >= row && distance <= 1) {
            append(matrix, row, column, (distance == 0 ? 6.0 : -1.0) * block);
        }
    });
    matrix.row_begin.push_back(matrix.n_blocks());
    return matrix;
}

ElasticCube elastic_cube(int degree, int n_elements) {
    const KnotVector knots = KnotVector::uniform(degree, n_elements);
    const int n = knots.n_basis();
    const auto I = integrals(knots);
    constexpr double lambda = 1.0;
    constexpr double mu = 1.0;
    ElasticCube cube;
    cube.matrix = make_empty(n * n * n, 3, true);
    visit_neighbours(n, degree, [&](int row, int column, const auto& i, const auto& j) {
        if (column < row) {
            return;
        }
        // gradients(a, b): integral of dN_i/dx_a dN_j/dx_b.
        Matrix<3> gradients;
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                gradients(a, b) = 1.0;
                for (int k = 0; k < 3; ++k) {
                    gradients(a, b) *= I[k == a ? 1 : 0][k == b ? 1 : 0](i[k], j[k]);
                }
            }
        }
        append(cube.matrix, row, column,
               lambda * gradients + mu * gradients.transpose() +
                   mu * gradients.trace() * Matrix<3>::Identity());
    });
    cube.matrix.row_begin.push_back(cube.matrix.n_blocks());

    const std::vector<double> greville = knots.greville();
    const int n_points = cube.matrix.n_rows;
    cube.points.resize(n_points, 3);
    cube.rigid_motions.resize(3 * n_points, 6);
    cube.clamped.assign(3 * n_points, 0);
    for (int p = 0; p < n_points; ++p) {
        const Vector3 x(greville[p % n], greville[p / n % n], greville[p / (n * n)]);
        cube.points.row(p) = x.transpose();
        for (int a = 0; a < 3; ++a) {
            cube.rigid_motions.block<3, 1>(3 * p, a) = Vector3::Unit(a);
            cube.rigid_motions.block<3, 1>(3 * p, 3 + a) = Vector3::Unit(a).cross(x);
            cube.clamped[3 * p + a] = p < n * n ? 1 : 0;
        }
    }
    return cube;
}

}  // namespace couture::iga
