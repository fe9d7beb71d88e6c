#pragma once

#include "iga/assembly/bilinear_form.h"
#include "iga/mechanics/problem.h"
#include "iga/topology/field.h"

namespace couture::iga {

/// Strain energy (or k |grad u|^2 for Poisson) of a problem as a bilinear form: integral of
/// strain(v) : stiffness : strain(u), times thickness or 2 pi r.
///
/// @throws InputError  if a patch has no material, or the kinematics do not fit d
template <int d>
[[nodiscard]] BilinearForm<d> stiffness_form(const Problem& problem, int n_patches);

/// Displacement components per function: d, or 1 for Poisson.
template <int d>
[[nodiscard]] int n_components(const Problem& problem) {
    return problem.physics == Physics::poisson ? 1 : d;
}

/// Thermal strain (Voigt) of a patch at x: expansion times the temperature changes that act in a
/// load case or combination.
[[nodiscard]] Vector<6> thermal_strain(const Problem& problem, const Material& material, int patch,
                                       const std::string& load_case, const Vector3& x);

/// True if an entry with `load_case` acts in the case `name`.
[[nodiscard]] inline bool acts_in(const CaseEntry& entry, const std::string& name) {
    return entry.load_case.empty() || entry.load_case == name;
}

/// Stress of strain, Voigt; in plane stress 33 is zero, in plane strain it is not.
template <int d>
[[nodiscard]] Vector<6> elastic_stress(const Problem& problem, const Material& material,
                                       const Vector<6>& elastic_strain);

/// Total strain from the gradient (components x d) and the value of the displacement.
template <int d>
[[nodiscard]] Vector<6> total_strain(Kinematics kinematics, const Vector3& x,
                                     const MatrixX& gradient, const VectorX& value);

/// Volume of the body that a geometry stands for: areas times the thickness, of axisymmetric ones
/// the full ring.
template <int d>
[[nodiscard]] double body_volume(const Problem& problem, const MultiPatch<d>& geometry);

/// Half the integral of stress : elastic strain (Poisson: of conductivity |grad u|^2), by the
/// rule of the assembly.
template <int d>
[[nodiscard]] double strain_energy(const Problem& problem, const Field<d>& displacement,
                                   const std::string& load_case,
                                   std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
