#pragma once

#include "iga/mechanics/problem.h"
#include "iga/topology/locator.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Work of all loads of a case, thermal strains included, on the functions: n_dofs x components.
///
/// @throws InputError     for a load that can't hold: a moment on a set that carries none, a point
///                        outside the body, a pressure on an edge
/// @throws TopologyError  for a set that does not exist
template <int d>
[[nodiscard]] MatrixX assemble_loads(const Space<d>& space, const Problem& problem,
                                     const std::string& load_case,
                                     std::optional<int> n_gauss_points = {});

/// Where a point load with a place acts.
///
/// @throws InputError  if that is outside the body
template <int d>
[[nodiscard]] Location<d> locate_load(const MultiPatch<d>& geometry, const PointLoad& load);

/// Adds a force at a place to the work on the functions, n_dofs x components.
template <int d>
void add_force(const Space<d>& space, const Location<d>& place, const Vector3& force, MatrixX& f);

/// Stiffness of the foundations, over unknowns n_components * dof + component; both triangles.
template <int d>
[[nodiscard]] SparseMatrix assemble_foundations(const Space<d>& space, const Problem& problem,
                                                std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
