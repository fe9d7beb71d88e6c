#pragma once

#include <span>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/patch_features.h"

namespace couture::meshing {

/// A template laid on a patch.
struct TemplateMatch {
    /// For each boundary loop of the patch the template's cap.
    std::vector<int> caps;
    /// For each loop the template's nodes along it, in the loop's direction: from the one at the
    /// loop's first feature node, or, if it has none, from the one nearest to its first vertex.
    std::vector<std::vector<int>> loop_nodes;
    /// For each feature node of the patch the template's node.
    std::vector<int> nodes;
    /// For each feature curve of the patch the template's nodes along it.
    std::vector<std::vector<int>> curves;
    /// Cuboids, plus what the template has for sharp edges where the patch has none, plus how far
    /// the template's shape is from the patch's.
    double cost = 0.0;
};

/// Evenly spread vertices of a closed loop, the first one its first vertex, as positions in it.
///
/// @param n  at most as many as the loop has vertices
[[nodiscard]] std::vector<int> even_places(const SurfaceMesh& mesh,
                                           const std::vector<VertexHandle>& loop, int n);

struct MatchOptions {
    /// For each cuboid.
    double cuboid_cost = 1.0;
    /// For each arc that is made for a sharp edge and lies on none.
    double unused_edge_cost = 1.0;
    /// For the distance of the patch's places from those of the template, moved, turned and scaled
    /// to fit best, over their mean distance from their centre.
    double misfit_cost = 10.0;
    /// No more than the best so many are kept for a template.
    int max_matches = 64;
};

/// All ways to lay a template on a patch so that every feature curve runs along arcs made for edges
/// of its kind, feature curves around each node come in the same order, and feature nodes lie on
/// different nodes; the cheapest first.
///
/// Source: [Maquart19] Sec. 3.2.3, where this is done by hand.
[[nodiscard]] std::vector<TemplateMatch> match_template(const SurfaceMesh& mesh,
                                                        const PatchFeatures& patch,
                                                        const CuboidTemplate& shape,
                                                        const MatchOptions& options = {});

}  // namespace couture::meshing
