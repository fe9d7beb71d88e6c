#include "rom/inner_product.h"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

/// Of hat functions on a line.
SparseMatrix mass(int n) {
    SparseMatrix matrix(n, n);
    for (int i = 0; i < n; ++i) {
        matrix.coeffRef(i, i) = 4.0 + 0.1 * i;
        if (i > 0) {
            matrix.coeffRef(i, i - 1) = 1.0;
            matrix.coeffRef(i - 1, i) = 1.0;
        }
    }
    return matrix;
}

}  // namespace

TEST_CASE("InnerProduct: the same mass for each component", "[rom]") {
    const InnerProduct product(mass(5), 3);
    const MatrixX fields = random_design(2, 15, 1);
    const MatrixX dense(mass(5));
    double expected = 0.0;
    for (int c = 0; c < 3; ++c) {
        const Eigen::Map<const VectorX, 0, Eigen::InnerStride<3>> component(
            fields.col(1).data() + c, 5);
        expected += component.dot(dense * component);
    }
    CHECK(product.squared_norms(fields)[1] == Approx(expected));
}

TEST_CASE("InnerProduct: Euclidean columns have the same products", "[rom]") {
    const InnerProduct product(mass(9), 2);
    const MatrixX fields = random_design(4, 18, 1);
    const MatrixX columns = product.to_euclidean(fields);
    CHECK((columns.transpose() * columns - fields.transpose() * product.apply(fields)).norm() <
          1e-12);
    CHECK((product.from_euclidean(columns) - fields).norm() < 1e-12);
}

TEST_CASE("InnerProduct: refuses wrong sizes and masses", "[rom]") {
    CHECK_THROWS_AS(InnerProduct(mass(4), 3).apply(MatrixX::Ones(11, 1)), InputError);
    CHECK_THROWS_AS(InnerProduct(3).apply(MatrixX::Ones(11, 1)), InputError);
    SparseMatrix negative = -mass(4);
    CHECK_THROWS_WITH(InnerProduct(negative, 1), Catch::Contains("not positive definite"));
}
