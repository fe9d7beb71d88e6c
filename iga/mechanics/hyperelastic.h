#pragma once

#include <string>

#include "iga/core/types.h"

namespace couture::iga {

/// Stored energy W per reference volume of an isotropic hyperelastic solid, with C = F^T F,
/// I1 = tr C, J = det F, E = (C - I) / 2 and lambda = kappa - 2/3 mu.
enum class StoredEnergy {
    /// mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2. Source: [Maquart19] Sec. 7.1.2.2.
    neo_hookean,
    /// mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2. Source: [BonetWood08] Eq. (6.27).
    neo_hookean_logarithmic,
    /// lambda/2 (tr E)^2 + mu E : E. Softens and folds under compression: small strains only.
    saint_venant_kirchhoff
};

struct Hyperelastic {
    StoredEnergy energy = StoredEnergy::neo_hookean;
    /// Moduli at the undeformed state, pressures.
    double shear_modulus = 0.0;
    double bulk_modulus = 0.0;
};

/// @throws InputError  unless both moduli are positive and finite: names the value
[[nodiscard]] Hyperelastic make_hyperelastic(StoredEnergy energy, double shear_modulus,
                                             double bulk_modulus);

/// J - 1 of F = I + H from the invariants of H, without cancellation.
[[nodiscard]] double volume_change(const Matrix<3>& H);

/// W at F = I + H. @param H  displacement gradient with det(I + H) > 0
[[nodiscard]] double stored_energy(const Hyperelastic& material, const Matrix<3>& H);

/// First Piola stress P = dW/dF, row i of the deformed, column J of the reference axes.
///
/// @param H  displacement gradient with det(I + H) > 0, else the result is not finite
[[nodiscard]] Matrix<3> piola_stress(const Hyperelastic& material, const Matrix<3>& H);

/// dP_iJ / dF_kL at (3 i + J, 3 k + L); symmetric.
[[nodiscard]] Matrix<9> piola_tangent(const Hyperelastic& material, const Matrix<3>& H);

/// The volumetric part of a stored energy, modulus/2 measure(F)^2, for its projection: J - 1 with
/// kappa; ln J (logarithmic) and tr E (Saint Venant-Kirchhoff) with lambda.
struct Dilatation {
    double value = 0.0;
    /// Derivative by F.
    Matrix<3> gradient = Matrix<3>::Zero();
};
[[nodiscard]] Dilatation dilatation(const Hyperelastic& material, const Matrix<3>& H);
/// Second derivative by F, as `piola_tangent`.
[[nodiscard]] Matrix<9> dilatation_hessian(const Hyperelastic& material, const Matrix<3>& H);
[[nodiscard]] double dilatation_modulus(const Hyperelastic& material);

/// Of the undeformed state.
[[nodiscard]] double poissons_ratio(const Hyperelastic& material);

/// Cauchy stress P F^T / J.
[[nodiscard]] Matrix<3> cauchy_stress(const Matrix<3>& piola, const Matrix<3>& H);

}  // namespace couture::iga
