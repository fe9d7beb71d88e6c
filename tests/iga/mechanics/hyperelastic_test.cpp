#include "iga/mechanics/hyperelastic.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "iga/mechanics/elastic_constants.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double mu = 3.0;
constexpr double kappa = 20.0;
/// Of central differences with a step of 1e-5: its square, and rounding over it.
constexpr double step = 1e-5;
constexpr double difference_error = 1e-8;
/// Ten printed digits.
constexpr double printed = 1e-9;

const std::vector<StoredEnergy> all_energies = {StoredEnergy::neo_hookean,
                                                StoredEnergy::neo_hookean_logarithmic,
                                                StoredEnergy::saint_venant_kirchhoff};

/// Random displacement gradients with det F > 0.2.
std::vector<Matrix<3>> random_gradients() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> entry(-0.6, 0.6);
    std::vector<Matrix<3>> result;
    while (result.size() < 20) {
        Matrix<3> H;
        for (double& value : H.reshaped()) {
            value = entry(random);
        }
        if (volume_change(H) > -0.8) {
            result.push_back(H);
        }
    }
    return result;
}

Matrix<3> stretch(double x, double y, double z) {
    return Vector3(x - 1.0, y - 1.0, z - 1.0).asDiagonal();
}

Matrix<3> cauchy_of(const Matrix<3>& H) {
    return cauchy_stress(piola_stress({StoredEnergy::neo_hookean, mu, kappa}, H), H);
}

}  // namespace

TEST_CASE("hyperelastic: stress is the derivative of the energy, tangent that of the stress",
          "[mechanics]") {
    for (const StoredEnergy energy : all_energies) {
        const Hyperelastic material = make_hyperelastic(energy, mu, kappa);
        for (const Matrix<3>& H : random_gradients()) {
            const Matrix<3> P = piola_stress(material, H);
            const Matrix<9> A = piola_tangent(material, H);
            const double scale = A.norm();
            CHECK((A - A.transpose()).norm() < 1e-13 * scale);
            for (int k = 0; k < 3; ++k) {
                for (int L = 0; L < 3; ++L) {
                    Matrix<3> up = H;
                    Matrix<3> down = H;
                    up(k, L) += step;
                    down(k, L) -= step;
                    const double slope =
                        (stored_energy(material, up) - stored_energy(material, down)) / (2 * step);
                    CHECK(std::abs(slope - P(k, L)) < difference_error * scale);
                    const Matrix<3> dP =
                        (piola_stress(material, up) - piola_stress(material, down)) / (2 * step);
                    const Matrix<3> exact = A.col(3 * k + L).reshaped<Eigen::RowMajor>(3, 3);
                    CHECK((dP - exact).norm() < 10.0 * difference_error * scale);
                }
            }
        }
    }
}

TEST_CASE("hyperelastic: a rotation changes no energy and turns the stress", "[mechanics]") {
    const Matrix<3> Q =
        Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    for (const StoredEnergy energy : all_energies) {
        const Hyperelastic material = make_hyperelastic(energy, mu, kappa);
        for (const Matrix<3>& H : random_gradients()) {
            const Matrix<3> turned = Q * (Matrix<3>::Identity() + H) - Matrix<3>::Identity();
            CHECK(stored_energy(material, turned) ==
                  Approx(stored_energy(material, H)).epsilon(1e-11));
            const Matrix<3> P = piola_stress(material, H);
            CHECK((piola_stress(material, turned) - Q * P).norm() < 1e-12 * (1.0 + P.norm()));
        }
    }
}

TEST_CASE("hyperelastic: all are linear elasticity at the undeformed state", "[mechanics]") {
    const double E = 9.0 * kappa * mu / (3.0 * kappa + mu);
    const double nu = E / (2.0 * mu) - 1.0;
    const ElasticStiffness C = isotropic_stiffness(E, nu);
    const std::array<std::array<int, 2>, 6> voigt = {
        {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
    for (const StoredEnergy energy : all_energies) {
        const Matrix<9> A = piola_tangent({energy, mu, kappa}, Matrix<3>::Zero());
        for (int I = 0; I < 6; ++I) {
            for (int J = 0; J < 6; ++J) {
                const auto [i, j] = voigt[I];
                const auto [k, l] = voigt[J];
                CHECK(std::abs(A(3 * i + j, 3 * k + l) - C(I, J)) < 1e-12 * C.norm());
            }
        }
    }
}

TEST_CASE("hyperelastic: small strains keep their digits", "[mechanics]") {
    // W = mu/2 (J^(-2/3) I1 - 3) of a pure shear g is mu g^2 / 2 (J = 1): 16 digits down to 1e-8,
    // where I1 - 3 computed from F would have none.
    for (const double g : {1e-2, 1e-5, 1e-8}) {
        Matrix<3> H = Matrix<3>::Zero();
        H(0, 1) = g;
        for (const StoredEnergy energy :
             {StoredEnergy::neo_hookean, StoredEnergy::neo_hookean_logarithmic}) {
            CHECK(stored_energy({energy, mu, kappa}, H) == Approx(0.5 * mu * g * g).epsilon(1e-14));
            CHECK(piola_stress({energy, mu, kappa}, H)(0, 1) == Approx(mu * g).epsilon(1e-3 * g));
        }
    }
}

TEST_CASE("hyperelastic: homogeneous states have their closed forms", "[mechanics]") {
    // Lateral stretches are those that leave no lateral stress.
    struct Uniaxial {
        double stretch, lateral, J, cauchy, nominal;
    };
    for (const Uniaxial& row :
         {Uniaxial{0.5, 1.3476184651, 0.9080377638, -5.5177341722, -10.0206219979},
          Uniaxial{1.25, 0.9098158487, 1.0347060981, 2.0823658870, 1.7237093455},
          Uniaxial{1.5, 0.8441183553, 1.0688036965, 4.1282217920, 2.9415058076},
          Uniaxial{2.0, 0.7544020407, 1.1382448779, 8.2946926763, 4.7206957265}}) {
        const Matrix<3> H = stretch(row.stretch, row.lateral, row.lateral);
        const Matrix<3> sigma = cauchy_of(H);
        CHECK(std::abs(sigma(1, 1)) < 20.0 * printed * kappa);
        CHECK(sigma(0, 0) == Approx(row.cauchy).epsilon(20.0 * printed));
        CHECK(1.0 + volume_change(H) == Approx(row.J).epsilon(printed));
        CHECK(piola_stress({StoredEnergy::neo_hookean, mu, kappa}, H)(0, 0) ==
              Approx(row.nominal).epsilon(20.0 * printed));
    }
    CHECK(cauchy_of(stretch(1.5, 1.5, 0.5137691686))(0, 0) ==
          Approx(4.6794188790).epsilon(20.0 * printed));
    const Matrix<3> plane = cauchy_of(stretch(1.5, 0.7293912692, 1.0));
    CHECK(plane(0, 0) == Approx(4.4366493929).epsilon(20.0 * printed));
    CHECK(plane(2, 2) == Approx(1.2085648392).epsilon(20.0 * printed));
    const Matrix<3> confined = cauchy_of(stretch(0.8, 1.0, 1.0));
    CHECK(confined(0, 0) == Approx(-5.0443574876).epsilon(printed));
    CHECK(confined(1, 1) == Approx(-3.4778212562).epsilon(printed));
    Matrix<3> shear = Matrix<3>::Zero();
    shear(0, 1) = 0.8;
    const Matrix<3> sigma = cauchy_of(shear);
    CHECK(sigma(0, 1) == Approx(mu * 0.8).epsilon(1e-14));
    CHECK(sigma(0, 0) == Approx(2.0 / 3.0 * mu * 0.64).epsilon(1e-14));
    CHECK(sigma(2, 2) == Approx(-1.0 / 3.0 * mu * 0.64).epsilon(1e-14));
}

TEST_CASE("hyperelastic: constants out of range are named", "[mechanics]") {
    CHECK_THROWS_WITH(make_hyperelastic(StoredEnergy::neo_hookean, -1.0, 1.0),
                      "hyperelastic material: shear modulus = -1; must be positive");
    CHECK_THROWS_WITH(make_hyperelastic(StoredEnergy::neo_hookean, 1.0, 0.0),
                      "hyperelastic material: bulk modulus = 0; must be positive (Poisson's ratio "
                      "in (-1, 0.5))");
}
