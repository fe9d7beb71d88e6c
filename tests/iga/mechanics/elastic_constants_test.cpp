#include "iga/mechanics/elastic_constants.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Of entries of the size of the moduli; a 6 x 6 inverse in between.
constexpr double rounding = 1e-12;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

OrthotropicConstants wood() { return {{12.0, 0.8, 0.5}, {0.4, 0.35, 0.45}, {0.05, 0.7, 0.75}}; }

/// A symmetric positive definite stiffness without any symmetry of the material.
ElasticStiffness triclinic() {
    Matrix<6> A;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            A(i, j) = std::sin(1.0 + 3.1 * i + 1.7 * j);
        }
    }
    return A * A.transpose() + Matrix<6>::Identity();
}

}  // namespace

TEST_CASE("isotropic_stiffness: entries are Lame's constants", "[mechanics]") {
    // E = 200, nu = 0.25: lambda = 80, mu = 80.
    ElasticStiffness expected = ElasticStiffness::Zero();
    expected.topLeftCorner<3, 3>().setConstant(80.0);
    expected.diagonal() << 240.0, 240.0, 240.0, 80.0, 80.0, 80.0;
    CHECK((isotropic_stiffness(200.0, 0.25) - expected).norm() < rounding * expected.norm());
    CHECK(isotropic_stiffness(200.0, 0.25) == isotropic_stiffness(200.0, 0.25).transpose());
}

TEST_CASE("isotropic_stiffness: tension gives 1/E and -nu/E, pressure the bulk modulus",
          "[mechanics]") {
    const double E = 7.0;
    const double nu = GENERATE(-0.9, -0.3, 0.0, 0.3, 0.49);
    const ElasticStiffness D = isotropic_stiffness(E, nu);
    const Vector<6> strain = D.inverse() * Vector<6>::Unit(1);
    CHECK(strain[1] == Approx(1.0 / E));
    CHECK(strain[0] == Approx(-nu / E).margin(rounding));
    CHECK(strain[2] == Approx(-nu / E).margin(rounding));
    Vector<6> swelling = Vector<6>::Zero();
    swelling.head<3>().setOnes();
    CHECK((D * swelling)[0] == Approx(E / (1.0 - 2.0 * nu)));
    CHECK(D(3, 3) == Approx(E / (2.0 * (1.0 + nu))));
}

TEST_CASE("isotropic_stiffness: constants out of range are named", "[mechanics]") {
    CHECK_THROWS_AS(isotropic_stiffness(0.0, 0.3), InputError);
    CHECK_THROWS_WITH(isotropic_stiffness(-2.5, 0.3),
                      "isotropic material: Young's modulus = -2.5; must be positive and finite");
    CHECK_THROWS_WITH(isotropic_stiffness(not_a_number, 0.3),
                      "isotropic material: Young's modulus = nan; must be positive and finite");
    CHECK_THROWS_WITH(isotropic_stiffness(infinity, 0.3),
                      "isotropic material: Young's modulus = inf; must be positive and finite");
    CHECK_THROWS_WITH(isotropic_stiffness(1.0, 0.5),
                      "isotropic material: Poisson's ratio = 0.5; must lie between -1 and 0.5 (0.5 "
                      "itself is incompressible)");
    CHECK_THROWS_AS(isotropic_stiffness(1.0, -1.0), InputError);
    CHECK_THROWS_AS(isotropic_stiffness(1.0, not_a_number), InputError);
}

TEST_CASE("orthotropic_stiffness: equal constants make an isotropic solid", "[mechanics]") {
    const double E = 210.0;
    const double nu = GENERATE(-0.5, 0.0, 0.3, 0.45);
    const double G = E / (2.0 * (1.0 + nu));
    const ElasticStiffness D = orthotropic_stiffness({{E, E, E}, {nu, nu, nu}, {G, G, G}});
    const ElasticStiffness expected = isotropic_stiffness(E, nu);
    CHECK((D - expected).norm() < rounding * expected.norm());
}

TEST_CASE("orthotropic_stiffness: tension and shear along the axes give the constants back",
          "[mechanics]") {
    const OrthotropicConstants constants = wood();
    const ElasticStiffness D = orthotropic_stiffness(constants);
    CHECK((D - D.transpose()).norm() < rounding * D.norm());
    const Matrix<6> compliance = D.inverse();
    const auto& [E_1, E_2, E_3] = constants.youngs_moduli;
    const auto& [nu_23, nu_13, nu_12] = constants.poissons_ratios;
    // nu_ij: contraction along j under tension along i.
    CHECK(compliance(0, 0) == Approx(1.0 / E_1));
    CHECK(compliance(1, 0) == Approx(-nu_12 / E_1));
    CHECK(compliance(2, 0) == Approx(-nu_13 / E_1));
    CHECK(compliance(1, 1) == Approx(1.0 / E_2));
    CHECK(compliance(2, 1) == Approx(-nu_23 / E_2));
    CHECK(compliance(2, 2) == Approx(1.0 / E_3));
    // Voigt order 23, 13, 12.
    CHECK(D(3, 3) == Approx(0.05));
    CHECK(D(4, 4) == Approx(0.7));
    CHECK(D(5, 5) == Approx(0.75));
    CHECK(D.topRightCorner<3, 3>().norm() < rounding);
}

TEST_CASE("orthotropic_stiffness: constants out of range are named", "[mechanics]") {
    OrthotropicConstants constants = wood();
    constants.youngs_moduli[1] = -1.0;
    CHECK_THROWS_AS(orthotropic_stiffness(constants), InputError);
    CHECK_THROWS_WITH(orthotropic_stiffness(constants),
                      "orthotropic material: E_2 = -1; must be positive and finite");
    constants = wood();
    constants.shear_moduli[0] = not_a_number;
    CHECK_THROWS_WITH(orthotropic_stiffness(constants),
                      "orthotropic material: G_23 = nan; must be positive and finite");
    constants = wood();
    constants.poissons_ratios = {0.4, 0.35, 4.0};
    CHECK_THROWS_WITH(orthotropic_stiffness(constants),
                      "orthotropic material: Poisson's ratios nu_23 = 0.4, nu_13 = 0.35, nu_12 = 4 "
                      "make the stiffness indefinite; |nu_ij| must be below sqrt(E_i / E_j) and "
                      "their determinant positive");
    constants.poissons_ratios[2] = not_a_number;
    CHECK_THROWS_AS(orthotropic_stiffness(constants), InputError);
}

TEST_CASE("orthotropic_stiffness: Poisson's ratios are taken up to the limit and not beyond",
          "[mechanics]") {
    // Two equal directions, no contraction in the third: |nu_12| < 1.
    OrthotropicConstants constants = {{1.0, 1.0, 1.0}, {0.0, 0.0, 0.999}, {1.0, 1.0, 1.0}};
    CHECK(orthotropic_stiffness(constants)(0, 0) == Approx(1.0 / (1.0 - 0.999 * 0.999)));
    constants.poissons_ratios[2] = 1.001;
    CHECK_THROWS_AS(orthotropic_stiffness(constants), InputError);
}

TEST_CASE("condense_plane_stress: an isotropic solid becomes E / (1 - nu^2)", "[mechanics]") {
    const double E = 70.0;
    const double nu = GENERATE(-0.4, 0.0, 0.33, 0.499);
    const double factor = E / (1.0 - nu * nu);
    ElasticStiffness expected = ElasticStiffness::Zero();
    expected(0, 0) = expected(1, 1) = factor;
    expected(0, 1) = expected(1, 0) = factor * nu;
    expected(5, 5) = factor * (1.0 - nu) / 2.0;
    const ElasticStiffness D = condense_plane_stress(isotropic_stiffness(E, nu));
    // Near nu = 0.5 the entries that cancel are 500 times larger.
    CHECK((D - expected).norm() < 1000.0 * rounding * expected.norm());
}

TEST_CASE("condense_plane_stress: is the stiffness at zero stress across the plane",
          "[mechanics]") {
    const ElasticStiffness D = GENERATE(orthotropic_stiffness(wood()), triclinic());
    const ElasticStiffness condensed = condense_plane_stress(D);
    // A stress in the plane, the full strain that it causes, and the stress again from its part in
    // the plane.
    Vector<6> stress = Vector<6>::Zero();
    stress[0] = 1.0;
    stress[1] = -2.0;
    stress[5] = 0.7;
    const Vector<6> strain = D.inverse() * stress;
    CHECK((condensed * strain - stress).norm() < 100.0 * rounding);
    for (const int across : {2, 3, 4}) {
        CHECK(condensed.row(across).isZero(0.0));
        CHECK(condensed.col(across).isZero(0.0));
    }
}
