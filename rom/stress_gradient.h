#pragma once

#include "iga/mechanics/problem.h"
#include "rom/reduced_model.h"

namespace couture::rom {

/// Stress of a predicted member at a material point (a parameter of a patch), and its derivatives
/// by the parameters, units of the deck.
struct StressGradient {
    Vector3 position;
    /// Cauchy, Voigt order 11, 22, 33, 23, 13, 12.
    Vector<6> stress;
    double von_mises = 0.0;
    /// 3 x n_parameters; 6 x n_parameters; n_parameters. That of the von Mises stress is 0 where
    /// the stress is a pressure: it has no derivative there.
    MatrixX position_gradient;
    MatrixX stress_gradient;
    VectorX von_mises_gradient;
};

/// By the chain rule: with H = U J^-1, U = du/dxi, J = dx/dxi, dH = (dU - H dJ) J^-1.
///
/// @param evaluation, gradient  of one point
/// @param problem          materials at that point; solids without temperatures
/// @param stiffness_slopes derivative of the stiffness of the patch's material by each parameter;
///                         empty: it depends on none
/// @throws InputError  for a patch that does not exist, xi outside of it, another number of slopes,
///                     a problem that is no elastic solid or has temperatures, slopes of a
///                     hyperelastic material
/// @throws GeometryError  where the map is singular
[[nodiscard]] StressGradient stress_gradient(
    const ReducedModel& model, const Evaluation& evaluation, const EvaluationGradient& gradient,
    const iga::Problem& problem, const std::vector<iga::ElasticStiffness>& stiffness_slopes,
    int patch, const Vector3& xi);

}  // namespace couture::rom
