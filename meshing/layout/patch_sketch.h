#pragma once

#include <string>
#include <vector>

#include "meshing/layout/patch_features.h"

namespace couture::meshing {

/// Feature curves of a patch as PatchFeatures, without a mesh: what tells those of one member of a
/// family from those of another.
struct PatchSketch {
    struct Node {
        /// Of a corner of a part; or empty.
        std::string name;
        int loop = -1;
        std::vector<int> curve_ends;
        Vector3 place = Vector3::Zero();
    };
    struct Curve {
        /// Of a curve of a part; or empty.
        std::string name;
        int from = -1;
        int to = -1;
        ArcKind kind = ArcKind::convex;
        /// Half way along it.
        Vector3 middle = Vector3::Zero();
    };
    std::vector<Node> nodes;
    std::vector<Curve> curves;
    /// For each boundary loop its nodes, in order.
    std::vector<std::vector<int>> loops;
};

[[nodiscard]] PatchSketch sketch_patch(const SurfaceMesh& mesh, const PatchFeatures& patch);

/// For each node and curve of one sketch its partner on another.
struct SketchMatch {
    std::vector<int> nodes;
    std::vector<int> curves;
    /// For each curve whether it runs against its partner.
    std::vector<bool> is_reversed;
};

/// Which nodes and curves of two members' patches are the same: loops lie on loops of the same
/// number, curves on curves of the same kind and name, corners on corners of the same name, curves
/// around each node come in the same order; a nameless one may lie on one whose name the other
/// sketch lacks. Of several such ways the one that lies nearest is taken, for each connected part
/// by itself.
///
/// @param first  with places carried over to the second member
/// @throws TopologyError  if there is none: says what is there in other numbers, or which named
///                        curve or which place has no partner
[[nodiscard]] SketchMatch match_sketches(const PatchSketch& first, const PatchSketch& second);

/// A patch with its nodes and curves in the order and direction of a sketch that it matches.
[[nodiscard]] PatchFeatures in_order_of(const PatchSketch& sketch, const SketchMatch& match,
                                        const PatchFeatures& patch);

}  // namespace couture::meshing
