#pragma once

#include "iga/mechanics/problem.h"
#include "iga/topology/field.h"

namespace couture::iga {

/// Strain and stress of one point, Voigt order 11, 22, 33, 23, 13, 12, engineering shear.
struct StressState {
    Vector<6> strain;
    Vector<6> stress;
};

[[nodiscard]] double von_mises(const Vector<6>& stress);
/// Descending.
[[nodiscard]] Vector3 principal_stresses(const Vector<6>& stress);
[[nodiscard]] Matrix<3> to_tensor(const Vector<6>& stress);

/// Strain and stress of a displacement at a point of a patch; thermal strains of `load_case`
/// are taken off. For Poisson `stress` holds the flux in its first three places.
template <int d>
[[nodiscard]] StressState stress_at(const Problem& problem, const Field<d>& displacement,
                                    const std::string& load_case, int patch, const Vector<d>& xi);

/// Integrals of the stress times the functions of the displacement's space: n_dofs x 6.
template <int d>
[[nodiscard]] MatrixX stress_integrals(const Problem& problem, const Field<d>& displacement,
                                       const std::string& load_case);

/// The stress as a smooth field, by L2 projection onto the displacement's space: n_dofs x 6.
/// Continuous over all patches: at a jump of material it shows the mean.
template <int d>
[[nodiscard]] MatrixX project_stress(const Problem& problem, const Field<d>& displacement,
                                     const std::string& load_case);

/// Gauss points of the elements: coordinates (n x 3) and stresses (n x 6).
struct GaussPointStresses {
    MatrixX points;
    MatrixX stresses;
};
template <int d>
[[nodiscard]] GaussPointStresses gauss_point_stresses(const Problem& problem,
                                                      const Field<d>& displacement,
                                                      const std::string& load_case);

}  // namespace couture::iga
