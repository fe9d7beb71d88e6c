#include "iga/linalg/block_matrix.h"

#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "tests/iga/linalg/model_systems.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Sums of some 30 products of numbers below 1.
constexpr double rounding = 1e-13;

MatrixX random_matrix(int n_rows, int n_columns, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return MatrixX::NullaryExpr(n_rows, n_columns, [&]() { return uniform(generator); });
}

/// Block-sparse: block (i, j) is zero unless i = j or (i + j) % 3 = 0.
MatrixX random_sparse(int n_rows, int block_size, bool is_symmetric) {
    MatrixX A = random_matrix(n_rows * block_size, n_rows * block_size, 7);
    if (is_symmetric) {
        A = (A + A.transpose()).eval();
    }
    for (int i = 0; i < n_rows; ++i) {
        for (int j = 0; j < n_rows; ++j) {
            if (i != j && (i + j) % 3 != 0) {
                A.block(i * block_size, j * block_size, block_size, block_size).setZero();
            }
        }
    }
    return A;
}

}  // namespace

TEST_CASE("BlockMatrix: products equal those of the dense matrix", "[linalg]") {
    const int block_size = GENERATE(1, 2, 3, 4);
    const bool is_symmetric = GENERATE(true, false);
    const MatrixX dense = random_sparse(40, block_size, is_symmetric);
    const BlockMatrix A = to_blocks(dense, block_size, is_symmetric);
    const MatrixX x = random_matrix(A.n_unknowns(), 3, 11);
    CHECK((A * x - dense * x).cwiseAbs().maxCoeff() < rounding);
    CHECK(A.memory() == A.columns.size() * 4 + A.values.size() * 8);
}

TEST_CASE("BlockMatrix: products have the same bits for any number of threads", "[linalg]") {
    const int n_before = n_threads();
    const BlockMatrix A = elastic_cube(2, 6).matrix;
    const MatrixX x = random_matrix(A.n_unknowns(), 2, 3);
    set_n_threads(1);
    const MatrixX one = A * x;
    for (const int n : {2, 3, 8}) {
        set_n_threads(n);
        CHECK(A * x == one);
    }
    set_n_threads(n_before);
}

TEST_CASE("BlockMatrix: find returns stored blocks only", "[linalg]") {
    const MatrixX dense = random_sparse(6, 2, true);
    const BlockMatrix A = to_blocks(dense, 2);
    REQUIRE(A.find(1, 2) != nullptr);
    CHECK(A.find(1, 2)[1] == dense(2, 5));
    CHECK(A.find(2, 1) == nullptr);
    CHECK(A.find(1, 3) == nullptr);
}

TEST_CASE("to_scalar: kept rows and columns in order, all or the lower triangle", "[linalg]") {
    const int block_size = GENERATE(1, 2, 3);
    const bool is_symmetric = GENERATE(true, false);
    const bool triangle_only = GENERATE(true, false);
    const MatrixX dense = random_sparse(20, block_size, is_symmetric);
    const BlockMatrix A = to_blocks(dense, block_size, is_symmetric);
    std::vector<char> is_fixed(A.n_unknowns(), 0);
    for (int i = 0; i < A.n_unknowns(); i += 5) {
        is_fixed[i] = 1;
    }
    std::vector<int> kept;
    const SparseMatrix scalar = to_scalar(A, is_fixed, triangle_only, kept);
    CHECK(static_cast<int>(kept.size()) == A.n_unknowns() - (A.n_unknowns() + 4) / 5);
    MatrixX expected = dense(kept, kept);
    if (triangle_only) {
        expected = MatrixX(expected.triangularView<Eigen::Lower>());
    }
    CHECK(MatrixX(scalar) == expected);
    for (int j = 0; j < scalar.outerSize(); ++j) {
        CHECK(std::is_sorted(scalar.innerIndexPtr() + scalar.outerIndexPtr()[j],
                             scalar.innerIndexPtr() + scalar.outerIndexPtr()[j + 1]));
    }
}

TEST_CASE("BlockMatrix: wrong sizes are named", "[linalg]") {
    const BlockMatrix A = laplacian(2, 1);
    CHECK_THROWS_WITH(A * MatrixX::Zero(7, 1),
                      "BlockMatrix: the vector has 7 rows; must be the 8 unknowns");
    std::vector<int> kept;
    CHECK_THROWS_WITH(to_scalar(A, {1, 0}, true, kept),
                      "to_scalar: 2 flags of fixed unknowns for 8 unknowns");
}
