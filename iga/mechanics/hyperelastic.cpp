#include "iga/mechanics/hyperelastic.h"

#include <Eigen/LU>
#include <cmath>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

double lame_lambda(const Hyperelastic& material) {
    return material.bulk_modulus - 2.0 / 3.0 * material.shear_modulus;
}

/// tr C - 3.
double stretch_invariant(const Matrix<3>& H) { return 2.0 * H.trace() + H.squaredNorm(); }

/// Small next to I where H is, so that stresses keep their digits near the undeformed state.
Matrix<3> green_strain(const Matrix<3>& H) { return 0.5 * (H + H.transpose() + H.transpose() * H); }

/// F F^T - I.
Matrix<3> finger_strain(const Matrix<3>& H) { return H + H.transpose() + H * H.transpose(); }

/// F^-T.
Matrix<3> cofactor_over_determinant(const Matrix<3>& F) { return F.inverse().transpose(); }

/// A fourth-order tensor from entry(i, J, k, L), at (3 i + J, 3 k + L).
template <typename Entry>
Matrix<9> fourth_order(const Entry& entry) {
    Matrix<9> A;
    for (int i = 0; i < 3; ++i) {
        for (int J = 0; J < 3; ++J) {
            for (int k = 0; k < 3; ++k) {
                for (int L = 0; L < 3; ++L) {
                    A(3 * i + J, 3 * k + L) = entry(i, J, k, L);
                }
            }
        }
    }
    return A;
}

double equal(int a, int b) { return a == b ? 1.0 : 0.0; }

}  // namespace

Hyperelastic make_hyperelastic(StoredEnergy energy, double shear_modulus, double bulk_modulus) {
    if (!(shear_modulus > 0.0) || !std::isfinite(shear_modulus)) {
        throw InputError("hyperelastic material: shear modulus = {}; must be positive",
                         shear_modulus);
    }
    if (!(bulk_modulus > 0.0) || !std::isfinite(bulk_modulus)) {
        throw InputError(
            "hyperelastic material: bulk modulus = {}; must be positive (Poisson's ratio in "
            "(-1, 0.5))",
            bulk_modulus);
    }
    return {energy, shear_modulus, bulk_modulus};
}

double volume_change(const Matrix<3>& H) {
    const double second = 0.5 * (H.trace() * H.trace() - (H * H).trace());
    return H.trace() + second + H.determinant();
}

double stored_energy(const Hyperelastic& material, const Matrix<3>& H) {
    const double mu = material.shear_modulus;
    if (material.energy == StoredEnergy::saint_venant_kirchhoff) {
        const Matrix<3> E = green_strain(H);
        return 0.5 * lame_lambda(material) * E.trace() * E.trace() + mu * E.squaredNorm();
    }
    const double dJ = volume_change(H);
    const double log_J = std::log1p(dJ);
    if (material.energy == StoredEnergy::neo_hookean_logarithmic) {
        return 0.5 * mu * (stretch_invariant(H) - 2.0 * log_J) +
               0.5 * lame_lambda(material) * log_J * log_J;
    }
    const double shrink = std::exp(-2.0 / 3.0 * log_J);
    return 0.5 * mu * (shrink * stretch_invariant(H) + 3.0 * std::expm1(-2.0 / 3.0 * log_J)) +
           0.5 * material.bulk_modulus * dJ * dJ;
}

Matrix<3> piola_stress(const Hyperelastic& material, const Matrix<3>& H) {
    const Matrix<3> I = Matrix<3>::Identity();
    const double mu = material.shear_modulus;
    if (material.energy == StoredEnergy::saint_venant_kirchhoff) {
        const Matrix<3> E = green_strain(H);
        return (I + H) * (lame_lambda(material) * E.trace() * I + 2.0 * mu * E);
    }
    const double dJ = volume_change(H);
    const double log_J = std::log1p(dJ);
    const Matrix<3> b = finger_strain(H);
    Matrix<3> kirchhoff;
    if (material.energy == StoredEnergy::neo_hookean_logarithmic) {
        kirchhoff = mu * b + lame_lambda(material) * log_J * I;
    } else {
        kirchhoff = mu * std::exp(-2.0 / 3.0 * log_J) * (b - b.trace() / 3.0 * I) +
                    material.bulk_modulus * (1.0 + dJ) * dJ * I;
    }
    return kirchhoff * cofactor_over_determinant(I + H);
}

Matrix<9> piola_tangent(const Hyperelastic& material, const Matrix<3>& H) {
    const Matrix<3> F = Matrix<3>::Identity() + H;
    const double mu = material.shear_modulus;
    const double lambda = lame_lambda(material);
    if (material.energy == StoredEnergy::saint_venant_kirchhoff) {
        const Matrix<3> E = green_strain(H);
        const Matrix<3> S = lambda * E.trace() * Matrix<3>::Identity() + 2.0 * mu * E;
        const Matrix<3> b = F * F.transpose();
        return fourth_order([&](int i, int J, int k, int L) {
            return equal(i, k) * S(L, J) + lambda * F(i, J) * F(k, L) +
                   mu * (F(i, L) * F(k, J) + b(i, k) * equal(J, L));
        });
    }
    const double dJ = volume_change(H);
    const double log_J = std::log1p(dJ);
    const Matrix<3> G = cofactor_over_determinant(F);
    if (material.energy == StoredEnergy::neo_hookean_logarithmic) {
        return fourth_order([&](int i, int J, int k, int L) {
            return mu * equal(i, k) * equal(J, L) + lambda * G(i, J) * G(k, L) +
                   (mu - lambda * log_J) * G(i, L) * G(k, J);
        });
    }
    const double J_now = 1.0 + dJ;
    const double kappa = material.bulk_modulus;
    const double m = mu * std::exp(-2.0 / 3.0 * log_J);
    const double I1 = F.squaredNorm();
    return fourth_order([&](int i, int J, int k, int L) {
        const double GG = G(i, J) * G(k, L);
        const double crossed = G(i, L) * G(k, J);
        return m * (equal(i, k) * equal(J, L) -
                    2.0 / 3.0 * (F(i, J) * G(k, L) + G(i, J) * F(k, L)) + 2.0 / 9.0 * I1 * GG +
                    I1 / 3.0 * crossed) +
               kappa * ((2.0 * J_now - 1.0) * J_now * GG - dJ * J_now * crossed);
    });
}

double dilatation_modulus(const Hyperelastic& material) {
    return material.energy == StoredEnergy::neo_hookean ? material.bulk_modulus
                                                        : lame_lambda(material);
}

Dilatation dilatation(const Hyperelastic& material, const Matrix<3>& H) {
    const Matrix<3> F = Matrix<3>::Identity() + H;
    if (material.energy == StoredEnergy::saint_venant_kirchhoff) {
        return {green_strain(H).trace(), F};
    }
    const double dJ = volume_change(H);
    const Matrix<3> G = cofactor_over_determinant(F);
    if (material.energy == StoredEnergy::neo_hookean_logarithmic) {
        return {std::log1p(dJ), G};
    }
    return {dJ, (1.0 + dJ) * G};
}

Matrix<9> dilatation_hessian(const Hyperelastic& material, const Matrix<3>& H) {
    if (material.energy == StoredEnergy::saint_venant_kirchhoff) {
        return Matrix<9>::Identity();
    }
    const double J = 1.0 + volume_change(H);
    const Matrix<3> G = cofactor_over_determinant(Matrix<3>::Identity() + H);
    if (material.energy == StoredEnergy::neo_hookean_logarithmic) {
        return fourth_order([&](int i, int I, int k, int L) { return -G(i, L) * G(k, I); });
    }
    return fourth_order(
        [&](int i, int I, int k, int L) { return J * (G(i, I) * G(k, L) - G(i, L) * G(k, I)); });
}

double poissons_ratio(const Hyperelastic& material) {
    const double kappa = material.bulk_modulus;
    const double mu = material.shear_modulus;
    return (3.0 * kappa - 2.0 * mu) / (6.0 * kappa + 2.0 * mu);
}

Matrix<3> cauchy_stress(const Matrix<3>& piola, const Matrix<3>& H) {
    return piola * (Matrix<3>::Identity() + H).transpose() / (1.0 + volume_change(H));
}

}  // namespace couture::iga
