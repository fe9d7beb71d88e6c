#include "rom/correlation_matrix.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "rom/correlation.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

MatrixX correlation_of(int n, int d, int seed) {
    const MatrixX points = random_design(d, n, seed);
    return correlations(CorrelationKind::matern_5_2, points, points, VectorX::Constant(d, 0.4));
}

MatrixX symmetric(int n, int seed) {
    const MatrixX a = random_design(n, n, seed);
    return a + a.transpose();
}

MatrixX product(const std::vector<MatrixX>& factors) {
    MatrixX result = MatrixX::Ones(1, 1);
    for (const MatrixX& factor : factors) {
        MatrixX next(result.rows() * factor.rows(), result.cols() * factor.cols());
        for (Eigen::Index i = 0; i < result.rows(); ++i) {
            for (Eigen::Index j = 0; j < result.cols(); ++j) {
                next.block(i * factor.rows(), j * factor.cols(), factor.rows(), factor.cols()) =
                    result(i, j) * factor;
            }
        }
        result = next;
    }
    return result;
}

}  // namespace

TEST_CASE("CorrelationMatrix: agrees with the dense matrix", "[rom]") {
    const std::vector<MatrixX> factors =
        GENERATE(std::vector<MatrixX>{correlation_of(12, 2, 1)},
                 std::vector<MatrixX>{correlation_of(4, 2, 1), correlation_of(3, 1, 2),
                                      correlation_of(5, 2, 3)});
    const double nugget = GENERATE(0.0, 0.05);
    const auto K = CorrelationMatrix::factored(factors, nugget, true);
    REQUIRE(K);
    MatrixX dense = product(factors);
    const Eigen::Index n = dense.rows();
    dense.diagonal().array() += nugget;
    const MatrixX inverse = dense.inverse();
    const MatrixX B = random_design(3, static_cast<int>(n), 7);
    const double scale = inverse.norm();

    const MatrixX X = K->solve(B);
    CHECK((dense * X - B).norm() < 1e-13 * dense.norm() * X.norm());
    CHECK(K->log_determinant() == Approx(std::log(dense.determinant())).epsilon(1e-9));
    CHECK((K->inverse_diagonal() - inverse.diagonal()).norm() < 1e-11 * scale);
    const auto without_traces = CorrelationMatrix::factored(factors, nugget);
    REQUIRE(without_traces);
    CHECK((without_traces->inverse_diagonal() - inverse.diagonal()).norm() < 1e-11 * scale);

    for (int g = 0; g < static_cast<int>(factors.size()); ++g) {
        std::vector<MatrixX> with_derivative = factors;
        with_derivative[g] = symmetric(static_cast<int>(factors[g].rows()), 11 + g);
        const MatrixX derivative = product(with_derivative);
        const VectorX w = B.col(0);
        const double variance = 0.7;
        const double slope =
            0.5 * ((inverse * derivative).trace() - w.dot(derivative * w) / variance);
        CHECK(K->likelihood_slope(g, w, variance).cwiseProduct(with_derivative[g]).sum() ==
              Approx(slope).epsilon(1e-9));
    }
}

TEST_CASE("CorrelationMatrix: points that coincide make none", "[rom]") {
    MatrixX points = random_design(2, 5, 1);
    points.row(4) = points.row(0);
    const MatrixX K =
        correlations(CorrelationKind::gaussian, points, points, VectorX::Constant(2, 0.5));
    CHECK_FALSE(CorrelationMatrix::factored({K}, 0.0));
    CHECK_FALSE(CorrelationMatrix::factored({K, correlation_of(3, 1, 2)}, 0.0));
    CHECK(CorrelationMatrix::factored({K}, 1e-6));
}

TEST_CASE("apply_along: acts on one index", "[rom]") {
    const MatrixX A = random_design(3, 2, 1);
    const MatrixX B = random_design(2, 12, 2);
    const MatrixX result = apply_along(A, 1, {2, 3, 2}, B);
    const MatrixX dense = product({MatrixX::Identity(2, 2), A, MatrixX::Identity(2, 2)});
    CHECK((result - dense * B).norm() < 1e-13);
}
