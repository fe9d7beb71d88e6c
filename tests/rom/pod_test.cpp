#include "rom/pod.h"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

constexpr int n_nodes = 60;
constexpr int n_values = 3 * n_nodes;

SparseMatrix mass() {
    SparseMatrix matrix(n_nodes, n_nodes);
    for (int i = 0; i < n_nodes; ++i) {
        matrix.coeffRef(i, i) = 1.0 + 0.5 * std::sin(i);
        if (i > 0) {
            matrix.coeffRef(i, i - 1) = 0.2;
            matrix.coeffRef(i - 1, i) = 0.2;
        }
    }
    return matrix;
}

MatrixX centred(int rows, int columns, int seed) {
    return random_design(columns, rows, seed).array() - 0.5;
}

/// Columns that are orthonormal in the inner product times the given singular values and a
/// rotation.
MatrixX with_singular_values(const VectorX& values, int n_snapshots, const InnerProduct& product) {
    const auto rank = static_cast<int>(values.size());
    const MatrixX u = centred(n_values, rank, 1);
    const MatrixX U =
        Eigen::HouseholderQR<MatrixX>(u).householderQ() * MatrixX::Identity(n_values, rank);
    const MatrixX v = centred(n_snapshots, rank, 2);
    const MatrixX V =
        Eigen::HouseholderQR<MatrixX>(v).householderQ() * MatrixX::Identity(n_snapshots, rank);
    return product.from_euclidean(U * values.asDiagonal() * V.transpose());
}

}  // namespace

TEST_CASE("make_pod_basis: modes are orthonormal", "[rom]") {
    const InnerProduct product = GENERATE(InnerProduct(3), InnerProduct(mass(), 3));
    const PodBasis basis = make_pod_basis(centred(n_values, 20, 3), product);
    REQUIRE(basis.modes.cols() == 20);
    CHECK(
        (basis.modes.transpose() * product.apply(basis.modes) - MatrixX::Identity(20, 20)).norm() <
        1e-12);
}

TEST_CASE("make_pod_basis: the squared error is the sum of discarded squares", "[rom]") {
    const InnerProduct product(mass(), 3);
    const MatrixX snapshots = centred(n_values, 20, 3);
    const int n_modes = GENERATE(1, 7, 19);
    const PodBasis basis = make_pod_basis(snapshots, product, {.n_modes = n_modes});
    REQUIRE(basis.modes.cols() == n_modes);
    const MatrixX error = snapshots - basis.modes * project(basis, product, snapshots);
    const double squared = product.squared_norms(error).sum();
    CHECK(squared == Approx(basis.singular_values.tail(20 - n_modes).squaredNorm()));
    CHECK(std::sqrt(squared / product.squared_norms(snapshots).sum()) ==
          Approx(basis.relative_error(n_modes)));
}

TEST_CASE("make_pod_basis: data of rank r has r modes that give it back", "[rom]") {
    const InnerProduct product(mass(), 3);
    const MatrixX snapshots =
        with_singular_values((VectorX(4) << 5.0, 2.0, 1.0, 1e-3).finished(), 15, product);
    const PodBasis basis = make_pod_basis(snapshots, product);
    REQUIRE(basis.modes.cols() == 4);
    CHECK((basis.modes * project(basis, product, snapshots) - snapshots).norm() < 1e-12);
}

TEST_CASE("make_pod_basis: small singular values keep their digits", "[rom]") {
    // By the eigenvalues of U^T U those below 1e-8 would be lost.
    const InnerProduct product(3);
    const VectorX values = (VectorX(4) << 1.0, 1e-4, 1e-8, 1e-11).finished();
    const PodBasis basis = make_pod_basis(with_singular_values(values, 10, product), product);
    REQUIRE(basis.modes.cols() == 4);
    for (int i = 0; i < 4; ++i) {
        CHECK(basis.singular_values[i] == Approx(values[i]).epsilon(1e-4));
    }
}

TEST_CASE("make_pod_basis: the tolerance is the error (1.14)", "[rom]") {
    const InnerProduct product(3);
    const VectorX values = (VectorX(4) << 10.0, 3.0, 0.5, 0.1).finished();
    const MatrixX snapshots = with_singular_values(values, 10, product);
    const auto n_modes = [&](double tolerance) {
        return make_pod_basis(snapshots, product, {.tolerance = tolerance}).modes.cols();
    };
    const double error_of_2 = std::sqrt((0.25 + 0.01) / (100.0 + 9.0 + 0.25 + 0.01));
    CHECK(n_modes(1.01 * error_of_2) == 2);
    CHECK(n_modes(0.99 * error_of_2) == 3);
    CHECK(n_modes(0.9) == 1);
}

TEST_CASE("make_pod_basis: randomised modes agree with the exact ones", "[rom]") {
    const InnerProduct product(mass(), 3);
    VectorX values(40);
    for (int i = 0; i < 40; ++i) {
        values[i] = std::pow(0.6, i);
    }
    const MatrixX snapshots = with_singular_values(values, 120, product);
    const PodBasis exact = make_pod_basis(snapshots, product, {.n_modes = 8});
    const PodBasis random =
        make_pod_basis(snapshots, product, {.n_modes = 8, .randomised_above = 100});
    REQUIRE(random.singular_values.size() < exact.singular_values.size());
    CHECK((random.singular_values.head(8) - exact.singular_values.head(8)).norm() < 1e-9);
    CHECK((random.modes - exact.modes).norm() < 1e-6);
    CHECK(random.relative_error(8) == Approx(exact.relative_error(8)).epsilon(1e-6));
}

TEST_CASE("make_pod_basis: refuses what has no modes", "[rom]") {
    CHECK_THROWS_AS(make_pod_basis(MatrixX(9, 0), InnerProduct(3)), InputError);
    CHECK_THROWS_AS(make_pod_basis(MatrixX::Ones(9, 2), InnerProduct(3), {.n_modes = 0}),
                    InputError);
    MatrixX snapshots = MatrixX::Ones(9, 4);
    snapshots(5, 2) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(make_pod_basis(snapshots, InnerProduct(3)), Catch::Contains("snapshot 2"));
}
