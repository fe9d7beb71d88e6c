#pragma once

#include "iga/assembly/constraints.h"
#include "iga/distributed/distributed_space.h"

namespace couture::iga {

/// `make_constraints` of the whole, for the functions of a rank's pieces. Every rank works on whole
/// layers of elements beside the supports that it has functions of, so that all agree; nothing is
/// exchanged.
///
/// @throws InputError, TopologyError  as `make_constraints`, on ranks that have the functions
template <int d>
[[nodiscard]] Constraints<d> constraints_on(RefinedGeometry<d>& geometry,
                                            const PieceSpace<d>& pieces, const Problem& problem,
                                            const std::vector<std::string>& load_cases,
                                            Functions functions = Functions::refined);

/// @throws InputError  if rigid-body motions are free: names them. Looks at the geometry's own
///                     functions, whose rigid motions are held if and only if the refined ones'
///                     are.
template <int d>
void require_held(const MultiPatch<d>& geometry, const Problem& problem);

/// This rank's share of `assemble_loads`: n_dofs x components over its pieces.
///
/// @param on_pieces  the problem on the rank's pieces
/// @param is_owner  whether forces that are not shared out by elements (resultants, point loads)
///                  count here, by function
template <int d>
[[nodiscard]] MatrixX loads_on(RefinedGeometry<d>& geometry, const PieceSpace<d>& pieces,
                               const std::vector<char>& is_owner, const Problem& problem,
                               const Problem& on_pieces, const std::string& load_case,
                               std::optional<int> n_gauss_points);

}  // namespace couture::iga
