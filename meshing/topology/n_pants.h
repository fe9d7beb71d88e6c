#pragma once

#include "meshing/topology/pants.h"

namespace couture::meshing {

/// The tube around a cut between two patches: as far as circles at the same distance from the cut
/// hang together on either side.
struct Tube {
    double length = 0.0;
    /// Of a circle as long as the cut.
    double diameter = 0.0;
};

/// The tube around a curve of a decomposition. O(n log n) in the faces of its two patches.
///
/// @throws InputError  if the curve does not exist or lies on the boundary of the surface
[[nodiscard]] Tube measure_tube(const SurfaceMesh& mesh, const PantsDecomposition& pants,
                                int curve);

/// Puts neighbouring patches together to n-pants (shirt: 4 boundary loops, suit: 5, spacesuit: 6)
/// by removing cuts, the shortest tube by its diameter first, as long as that is below `ratio` and
/// the patch has no more than `most_boundaries`. A cut with the same patch on both sides stays.
/// Curves and patches are numbered anew, in their order.
///
/// Source: [Maquart19] Sec. 3.3. Differs: the text puts patches together by hand.
void merge_pants(SurfaceMesh& mesh, PantsDecomposition& pants, int most_boundaries, double ratio);

}  // namespace couture::meshing
