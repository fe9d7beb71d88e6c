#pragma once

#include "iga/mechanics/problem.h"

namespace couture::rom {

/// Small strain of a displacement gradient, Voigt order 11, 22, 33, 23, 13, 12.
[[nodiscard]] Vector<6> small_strain(const Matrix<3>& H);

/// Stress of a solid at a displacement gradient, and its change with that gradient.
class StressLaw {
  public:
    /// @param material        outlives the law
    /// @param H               du/dx by the undeformed position
    /// @param thermal_strain  Voigt; of linear elasticity only
    StressLaw(const iga::Material& material, const Matrix<3>& H, const Vector<6>& thermal_strain);

    /// Cauchy, Voigt.
    [[nodiscard]] const Vector<6>& stress() const { return stress_; }
    /// d stress in the direction dH.
    [[nodiscard]] Vector<6> change(const Matrix<3>& dH) const;

  private:
    const iga::Material& material_;
    Matrix<3> H_;
    Vector<6> stress_;
};

/// Derivative of the von Mises stress by the stress; 0 where the stress is a pressure: it has no
/// derivative there.
[[nodiscard]] Vector<6> von_mises_slopes(const Vector<6>& stress);

}  // namespace couture::rom
