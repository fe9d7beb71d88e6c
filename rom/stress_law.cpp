#include "rom/stress_law.h"

#include <Eigen/LU>

#include "iga/post/stress.h"

namespace couture::rom {

namespace {

Vector<6> to_voigt(const Matrix<3>& s) {
    return (Vector<6>() << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)).finished();
}

}  // namespace

Vector<6> small_strain(const Matrix<3>& H) {
    return (Vector<6>() << H(0, 0), H(1, 1), H(2, 2), H(1, 2) + H(2, 1), H(0, 2) + H(2, 0),
            H(0, 1) + H(1, 0))
        .finished();
}

StressLaw::StressLaw(const iga::Material& material, const Matrix<3>& H,
                     const Vector<6>& thermal_strain)
    : material_(material), H_(H) {
    stress_ = material.hyperelastic
                  ? to_voigt(iga::cauchy_stress(iga::piola_stress(*material.hyperelastic, H), H))
                  : Vector<6>(material.stiffness * (small_strain(H) - thermal_strain));
}

Vector<6> StressLaw::change(const Matrix<3>& dH) const {
    if (!material_.hyperelastic) {
        return material_.stiffness * small_strain(dH);
    }
    // sigma = P F^T / J.
    const Matrix<3> F = Matrix<3>::Identity() + H_;
    const Matrix<3> P = iga::piola_stress(*material_.hyperelastic, H_);
    const Vector<9> flat = dH.transpose().reshaped();
    const Vector<9> dP_rows = iga::piola_tangent(*material_.hyperelastic, H_) * flat;
    const Matrix<3> dP = dP_rows.reshaped(3, 3).transpose();
    return to_voigt((dP * F.transpose() + P * dH.transpose()) / F.determinant() -
                    iga::cauchy_stress(P, H_) * (F.inverse() * dH).trace());
}

Vector<6> von_mises_slopes(const Vector<6>& stress) {
    const double von_mises = iga::von_mises(stress);
    if (von_mises == 0.0) {
        return Vector<6>::Zero();
    }
    const double mean = stress.head<3>().mean();
    Vector<6> slopes = 3.0 * stress / von_mises;
    slopes.head<3>() = 1.5 * (stress.head<3>().array() - mean) / von_mises;
    return slopes;
}

}  // namespace couture::rom
