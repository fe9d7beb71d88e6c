#pragma once

#include "iga/mechanics/problem.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Forces of the pressures of a problem that turn and stretch with the body.
struct FollowerPressure {
    /// n_dofs x d.
    MatrixX forces;
    /// Minus the derivative of the forces by the unknowns d * dof + component. Symmetric between
    /// free unknowns where the pressure's rim is held or lies in planes of symmetry.
    SparseMatrix stiffness;
};

/// The pressures with `follows_body` at a displacement n_dofs x d: force -p n da on the deformed
/// side, p taken at the undeformed place.
///
/// @throws TopologyError  for a set that does not exist
template <int d>
[[nodiscard]] FollowerPressure assemble_follower_pressure(const Space<d>& space,
                                                          const Problem& problem,
                                                          const MatrixX& displacement,
                                                          std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
