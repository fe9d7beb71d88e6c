#pragma once

#include "iga/mechanics/problem.h"
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

/// Stiffness of the foundations, over unknowns n_components * dof + component; both triangles.
template <int d>
[[nodiscard]] SparseMatrix assemble_foundations(const Space<d>& space, const Problem& problem,
                                                std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
