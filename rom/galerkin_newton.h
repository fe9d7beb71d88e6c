#pragma once

#include "iga/assembly/finite_strain.h"
#include "rom/galerkin.h"

namespace couture::rom {

struct GalerkinNewtonOptions {
    /// Time at which loads have the values that they are given.
    double end = 1.0;
    std::optional<int> n_gauss_points = std::nullopt;
    iga::Volumetric volumetric = iga::Volumetric::automatic;
};

/// One step of Newton's method at finite strain in the space of the displacement modes, from the
/// prediction by kriging on the predicted geometry: u + V a with V^T K V a = -V^T r, K the tangent
/// and r the residual there, V without the held unknowns, which take what supports prescribe.
///
/// Residuals are over the larger of internal and external forces; the energy is the stored one, the
/// norm of the change that of the tangent.
///
/// @param problem  at the evaluation's point: hyperelastic
/// @throws InputError   as iga::FiniteStrain and iga::solve_linear_static
/// @throws SolverError  if the body is folded as predicted or after the step: says where
[[nodiscard]] GalerkinSolution galerkin_newton_step(const ReducedModel& model,
                                                    const Evaluation& evaluation,
                                                    const iga::Problem& problem,
                                                    const GalerkinNewtonOptions& options = {});

}  // namespace couture::rom
