#pragma once

#include "iga/assembly/finite_strain.h"
#include "iga/mechanics/problem.h"
#include "iga/post/stress.h"
#include "iga/solve/load_stepping.h"

namespace couture::iga {

/// Deformation and stress of one point at finite strain.
struct FiniteState {
    /// F - I, from the undeformed body.
    Matrix<3> H = Matrix<3>::Zero();
    double det_F = 1.0;
    /// Green-Lagrange strain and Cauchy stress, Voigt order 11, 22, 33, 23, 13, 12, engineering
    /// shear.
    StressState state;
};

/// Smooth fields by L2 projection onto the displacement's space; continuous over all patches: at a
/// jump of material they show the mean.
struct FiniteFields {
    /// n_dofs x 6, as in FiniteState.
    MatrixX stress;
    MatrixX strain;
    /// n_dofs x 1.
    MatrixX det_F;

    /// @param coefficients  n_dofs x 13: stress, strain, det F
    [[nodiscard]] static FiniteFields from(const MatrixX& coefficients);
};

/// The state at the Gauss points of all elements.
struct FiniteGaussPoints {
    /// Undeformed positions and displacements, n x 3.
    MatrixX points;
    MatrixX displacement;
    /// n x 6, n x 6, n x 1, as in FiniteFields.
    MatrixX stress;
    MatrixX strain;
    MatrixX det_F;
    /// 2^d neighbouring points of one element each, in the order of VTK's quads and hexahedra.
    std::vector<std::vector<int>> cells;
};

/// Stresses and strains of a hyperelastic body in one state, with the pressure that its equilibrium
/// has where the volumetric energy is projected.
///
/// Source: [Maquart19] Eq. (7.3) for bodies that were meshed again.
template <int d>
class FiniteStresses {
  public:
    /// @param problem  must outlive this
    /// @param n_gauss_points, volumetric  as the state was computed with
    /// @throws InputError, GeometryError  as `FiniteStrain`
    FiniteStresses(const Problem& problem, const SteppingState<d>& state,
                   std::optional<int> n_gauss_points = {},
                   Volumetric volumetric = Volumetric::automatic);

    /// State at a parameter of a patch of the state's mesh.
    /// @throws GeometryError  where the map is singular
    [[nodiscard]] FiniteState at(int patch, const Vector<d>& xi) const;
    [[nodiscard]] FiniteFields project() const;
    /// Integrals of what `project` makes fields of times the functions, n_dofs x 13: by the mass
    /// matrix they are the coefficients for `FiniteFields::from`.
    [[nodiscard]] MatrixX integrals() const;
    [[nodiscard]] FiniteGaussPoints at_gauss_points() const;
    /// Of the deformed body: with the thickness of plane problems, or of the full ring.
    [[nodiscard]] double volume() const;
    /// The undeformed body in the patches of the state's mesh.
    [[nodiscard]] const SpacePtr<d>& undeformed() const { return undeformed_; }

  private:
    const Problem& problem_;
    ReferencePtr<d> reference_;
    SpacePtr<d> undeformed_;
    MatrixX displacement_;
    std::optional<int> n_gauss_points_;
    FiniteStrain<d> body_;
};

}  // namespace couture::iga
