#pragma once

#include <span>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Spanning trees of the faces of a mesh, one for each component, of fewest steps from the root.
struct DualTree {
    /// Each behind the one that it is reached from.
    std::vector<FaceHandle> order;
    /// For each face the halfedge of the face before it that is crossed; invalid for roots.
    std::vector<HalfedgeHandle> crossed;
};

/// @param roots  the first of them in each component is its root; the smallest face if none is
/// there
[[nodiscard]] DualTree make_dual_tree(const SurfaceMesh& mesh,
                                      std::span<const FaceHandle> roots = {});

}  // namespace couture::meshing
