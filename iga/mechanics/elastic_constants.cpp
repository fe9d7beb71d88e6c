#include "iga/mechanics/elastic_constants.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

void check_modulus(const char* material, const char* name, double modulus) {
    if (!(modulus > 0.0) || !std::isfinite(modulus)) {
        throw InputError("{} material: {} = {}; must be positive and finite", material, name,
                         modulus);
    }
}

}  // namespace

ElasticStiffness isotropic_stiffness(double youngs_modulus, double poissons_ratio) {
    check_modulus("isotropic", "Young's modulus", youngs_modulus);
    if (!(poissons_ratio > -1.0 && poissons_ratio < 0.5)) {
        throw InputError(
            "isotropic material: Poisson's ratio = {}; must lie between -1 and 0.5 "
            "(0.5 itself is incompressible)",
            poissons_ratio);
    }
    const double lambda =
        youngs_modulus * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
    const double mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
    ElasticStiffness D = ElasticStiffness::Zero();
    D.topLeftCorner<3, 3>().setConstant(lambda);
    for (int i = 0; i < 3; ++i) {
        D(i, i) += 2.0 * mu;
        D(3 + i, 3 + i) = mu;
    }
    return D;
}

ElasticStiffness orthotropic_stiffness(const OrthotropicConstants& constants) {
    constexpr std::array<const char*, 3> youngs_names = {"E_1", "E_2", "E_3"};
    constexpr std::array<const char*, 3> shear_names = {"G_23", "G_13", "G_12"};
    for (int i = 0; i < 3; ++i) {
        check_modulus("orthotropic", youngs_names[i], constants.youngs_moduli[i]);
        check_modulus("orthotropic", shear_names[i], constants.shear_moduli[i]);
    }
    const auto& E = constants.youngs_moduli;
    const auto& [nu_23, nu_13, nu_12] = constants.poissons_ratios;
    Matrix<6> compliance = Matrix<6>::Zero();
    for (int i = 0; i < 3; ++i) {
        compliance(i, i) = 1.0 / E[i];
        compliance(3 + i, 3 + i) = 1.0 / constants.shear_moduli[i];
    }
    compliance(0, 1) = compliance(1, 0) = -nu_12 / E[0];
    compliance(0, 2) = compliance(2, 0) = -nu_13 / E[0];
    compliance(1, 2) = compliance(2, 1) = -nu_23 / E[1];
    const Eigen::LLT<Matrix<6>> factor(compliance);
    if (factor.info() != Eigen::Success || !compliance.allFinite()) {
        throw InputError(
            "orthotropic material: Poisson's ratios nu_23 = {}, nu_13 = {}, nu_12 = {} "
            "make the stiffness indefinite; |nu_ij| must be below sqrt(E_i / E_j) and "
            "their determinant positive",
            nu_23, nu_13, nu_12);
    }
    return factor.solve(Matrix<6>::Identity());
}

ElasticStiffness condense_plane_stress(const ElasticStiffness& stiffness) {
    const std::array<int, 3> kept = {0, 1, 5};
    const std::array<int, 3> dropped = {2, 3, 4};
    const Matrix<3> D_kk = stiffness(kept, kept);
    const Matrix<3> D_kd = stiffness(kept, dropped);
    const Matrix<3> D_dd = stiffness(dropped, dropped);
    ElasticStiffness result = ElasticStiffness::Zero();
    result(kept, kept) = D_kk - D_kd * D_dd.inverse() * D_kd.transpose();
    return result;
}

}  // namespace couture::iga
