#pragma once

#include "meshing/topology/homology_basis.h"
#include "meshing/topology/integer_lattice.h"

namespace couture::meshing {

/// Linking numbers A_ij = lk(b_i pushed inwards, b*_j pushed outwards) of a homology basis,
/// exactly. For a surface embedded in space A is a projector of trace `genus`, and for a class x
///   x A = 0  iff it is a handle (it bounds inside),    x A = x  iff it is a tunnel.
///
/// Crossings in a random projection (fixed seed) are counted with exact signs; where b_i and b*_i
/// touch, b*_i is moved outwards by an infinitesimal.
///
/// @return 2 genus x 2 genus, negated once if its trace asks for it
/// @throws TopologyError  if A is no projector of that trace: the surface intersects itself (or the
///                        caps that close its holes cut through it)
///
/// Source: [Rolfsen76] Sec. 5.D. Differs from [Maquart19] Sec. 2.1.2.4, which asks for a disc that
/// the loop spans: that fails for knotted holes.
[[nodiscard]] IntegerMatrix linking_projector(const HomologyBasis& basis);

}  // namespace couture::meshing
