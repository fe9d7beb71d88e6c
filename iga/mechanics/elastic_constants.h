#pragma once

#include <array>

#include "iga/core/types.h"

namespace couture::iga {

/// Stiffness of a linear elastic solid in Voigt order 11, 22, 33, 23, 13, 12 with engineering
/// shear strains: stress = stiffness * strain.
using ElasticStiffness = Matrix<6>;

/// @param youngs_modulus  > 0
/// @param poissons_ratio  in (-1, 0.5)
/// @throws InputError  naming the value outside its range
[[nodiscard]] ElasticStiffness isotropic_stiffness(double youngs_modulus, double poissons_ratio);

/// Constants along the axes: moduli E_1, E_2, E_3 > 0; Poisson's ratios nu_23, nu_13, nu_12
/// (nu_ij: contraction along j under tension along i); shear moduli G_23, G_13, G_12 > 0.
struct OrthotropicConstants {
    std::array<double, 3> youngs_moduli;
    std::array<double, 3> poissons_ratios;
    std::array<double, 3> shear_moduli;
};

/// @throws InputError  if a modulus is not positive or the stiffness not positive definite
[[nodiscard]] ElasticStiffness orthotropic_stiffness(const OrthotropicConstants& constants);

/// Stiffness that leaves no stress across the plane 1-2 (components 33, 23, 13 zero), from the
/// three-dimensional one.
[[nodiscard]] ElasticStiffness condense_plane_stress(const ElasticStiffness& stiffness);

}  // namespace couture::iga
