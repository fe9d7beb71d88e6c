#pragma once

#include <vector>

#include "meshing/layout/quad_layout.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A layout drawn on a surface: nodes are vertices, arcs are edge paths that meet at nodes only,
/// quads are the discs between them.
struct EmbeddedLayout {
    QuadLayout layout;
    /// For each node; invalid for nodes inside a volume.
    std::vector<VertexHandle> nodes;
    /// For each arc the vertices from its first node to its second, both included.
    std::vector<std::vector<VertexHandle>> arcs;
    /// For each face of the mesh.
    std::vector<int> quad_of_face;
    /// For each node whether it lies on a feature corner and must stay there.
    std::vector<bool> is_corner_node;
    /// For each arc whether it runs along a feature curve and must stay on it.
    std::vector<bool> is_feature_arc;
};

}  // namespace couture::meshing
