#pragma once

#include "iga/mechanics/problem.h"

namespace couture::iga {

/// Strain of a displacement with components a: E[I, a (d + 1) + s] times D_s u_a, where D_s is the
/// derivative by x_s for s < d and D_d the value. Voigt order 11, 22, 33, 23, 13, 12, engineering
/// shear; axisymmetric: 11 radial, 22 axial, 33 hoop = u_r / r.
template <int d>
[[nodiscard]] Eigen::Matrix<double, 6, d*(d + 1)> strain_operator(Kinematics kinematics,
                                                                  const Vector3& x);

/// What an area or volume of the model counts in the body: the thickness, 2 pi r, or 1.
[[nodiscard]] double measure(Kinematics kinematics, double thickness, const Vector3& x);

/// The stiffness that acts on those strains: condensed in plane stress.
[[nodiscard]] ElasticStiffness effective_stiffness(Kinematics kinematics,
                                                   const ElasticStiffness& stiffness);

/// The material of each patch.
///
/// @throws InputError  if a patch has none or two, or a list names a patch that does not exist
[[nodiscard]] std::vector<int> materials_of_patches(const Problem& problem, int n_patches);

/// Checks the values of a problem that do not depend on a geometry: thickness, kinematics against
/// the dimension.
void check_kinematics(const Problem& problem, int dimension);

}  // namespace couture::iga
