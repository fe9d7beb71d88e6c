#pragma once

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

/// State at a point of a patch of the reference's mesh: F = (I + grad(U - U_b)) F_b.
///
/// @param problem  all materials hyperelastic
/// @throws GeometryError  where the map is singular
///
/// Source: [Maquart19] Eq. (7.3).
template <int d>
[[nodiscard]] FiniteState finite_state_at(const Problem& problem, const SteppingState<d>& state,
                                          int patch, const Vector<d>& xi);

/// Smooth fields by L2 projection onto the displacement's space; continuous over all patches: at a
/// jump of material they show the mean.
struct FiniteFields {
    /// n_dofs x 6, as in FiniteState.
    MatrixX stress;
    MatrixX strain;
    /// n_dofs x 1.
    MatrixX det_F;
};
template <int d>
[[nodiscard]] FiniteFields project_finite_state(const Problem& problem,
                                                const SteppingState<d>& state);

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
/// @param n_gauss_points  per direction and element; nothing: degree + 1
template <int d>
[[nodiscard]] FiniteGaussPoints gauss_point_states(const Problem& problem,
                                                   const SteppingState<d>& state,
                                                   std::optional<int> n_gauss_points = {});

/// Volume of the deformed body: with the thickness of plane problems, or of the full ring.
template <int d>
[[nodiscard]] double deformed_volume(const Problem& problem, const SteppingState<d>& state);

}  // namespace couture::iga
