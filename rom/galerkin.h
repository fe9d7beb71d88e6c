#pragma once

#include <optional>
#include <string>

#include "iga/mechanics/problem.h"
#include "rom/reduced_model.h"

namespace couture::rom {

/// A linear solution in the space of the displacement modes on the predicted geometry, with the
/// residual of the full system as its certificate.
struct GalerkinSolution {
    /// 3 n_nodes numbers.
    VectorX displacement;
    /// |f - K u| / |f| on the free unknowns, of this solution and of the one predicted by kriging.
    double relative_residual = 0.0;
    double relative_residual_of_kriging = 0.0;
    /// |u - u of kriging| / |u| in the energy norm, and half the energy u^T K u.
    double relative_change = 0.0;
    double energy = 0.0;
    /// Dimension of the space: modes that are independent in energy.
    int n_modes = 0;
};

/// u = g + V a with V^T K V a = V^T (f - K g): K and f assembled on the predicted geometry, V the
/// displacement modes without the held unknowns, g what supports prescribe.
///
/// @param evaluation  of the point
/// @param problem     at that point: linear elastic
/// @param load_case   a single one, no combination
/// @throws InputError  for a hyperelastic material, a problem that is not elastic, a load case that
///                     there is not, and as `iga::solve_linear_static`
/// @throws GeometryError  if the predicted geometry is folded: patch, place, value
[[nodiscard]] GalerkinSolution solve_galerkin(const ReducedModel& model,
                                              const Evaluation& evaluation,
                                              const iga::Problem& problem,
                                              const std::string& load_case = "",
                                              std::optional<int> n_gauss_points = {});

/// The same in the space of given fields on a member's own geometry, for all load cases of a
/// problem: what stands for its full solutions where the fields are those of its neighbours.
///
/// @param fields  3 n_nodes x n_fields
/// @return 3 n_nodes x n_load_cases, in the order of problem.load_cases()
/// @throws InputError  for another number of values, and as solve_galerkin
[[nodiscard]] MatrixX projected_displacements(const iga::Space<3>& member, const MatrixX& fields,
                                              const iga::Problem& problem,
                                              std::optional<int> n_gauss_points = {});

}  // namespace couture::rom
