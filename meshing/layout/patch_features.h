#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/surface/features.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

/// Feature curves of a patch of a decomposition as a graph: what a template must have arcs for.
struct PatchFeatures {
    struct Node {
        VertexHandle vertex;
        /// Of a node on the patch's boundary: its loop; -1 of a corner inside.
        int loop = -1;
        /// Feature curves inside that end here, counter-clockwise; on a boundary from the first one
        /// beside the loop's way on. Twice the number of the curve, plus 1 at its end.
        std::vector<int> curve_ends;
        /// Of a corner of a part, see Features::corner_names; else empty.
        std::string name = {};
    };
    struct Curve {
        int from = -1;
        int to = -1;
        /// Of the interior angle along most of it: below pi or above.
        ArcKind kind = ArcKind::convex;
        /// From node to node, both included.
        std::vector<VertexHandle> vertices;
        /// See FeatureCurve::name.
        std::string name = {};
    };
    struct Loop {
        CurveSide side;
        /// In order, the patch on the left, from the first vertex of the decomposition's curve.
        std::vector<VertexHandle> vertices;
        /// Nodes on it, in order.
        std::vector<int> nodes;
    };
    std::vector<Node> nodes;
    std::vector<Curve> curves;
    /// In the order of the patch's boundary.
    std::vector<Loop> loops;

    /// A sphere without sharp edges.
    [[nodiscard]] bool is_bare() const { return loops.empty() && nodes.empty(); }
};

/// Whether the surface is convex or reflex along most of an edge path.
[[nodiscard]] ArcKind kind_along(const SurfaceMesh& mesh, std::span<const VertexHandle> path);

/// Feature curves of all patches. Parts of feature curves along cuts and boundaries are not among
/// them.
///
/// @param mesh  with numbers of features and of the decomposition's curves on its edges
/// @throws TopologyError  for a closed feature curve inside a patch that has no corner: none of its
///                        vertices could be told from another (names a vertex)
[[nodiscard]] std::vector<PatchFeatures> find_patch_features(const SurfaceMesh& mesh,
                                                             const Features& features,
                                                             const PantsDecomposition& pants);

}  // namespace couture::meshing
