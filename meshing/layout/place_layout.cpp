#include "meshing/layout/place_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/disc_cuts.h"
#include "meshing/layout/feature_crossings.h"
#include "meshing/layout/feature_ties.h"
#include "meshing/layout/padded_ties.h"
#include "meshing/layout/tied_nodes.h"

namespace couture::meshing {

namespace {

// Nodes in the place of old ones lie there; others on the boundary amid their neighbours, nearer to
// those in place.
std::vector<Vector3> padded_positions(const std::vector<Vector3>& positions,
                                      const std::vector<int>& node_in_place,
                                      const QuadLayout& boundary) {
    std::vector<Vector3> padded(boundary.n_nodes(), Vector3::Zero());
    std::vector<bool> is_known(boundary.n_nodes(), false);
    for (std::size_t n = 0; n < node_in_place.size(); ++n) {
        padded[node_in_place[n]] = positions[n];
        is_known[node_in_place[n]] = true;
    }
    constexpr int n_sweeps = 100;
    // A sheet that ends on a side leaves most of it to the strips' neighbours: strips as wide as
    // these have slim corners beside them.
    constexpr double weight_of_known = 4.0;
    for (int sweep = 0; sweep < n_sweeps; ++sweep) {
        std::vector<Vector3> sums(boundary.n_nodes(), Vector3::Zero());
        std::vector<double> weights(boundary.n_nodes(), 0.0);
        const auto add = [&](int node, int other) {
            const double weight = is_known[other] ? weight_of_known : 1.0;
            sums[node] += weight * padded[other];
            weights[node] += weight;
        };
        for (const QuadLayout::Arc& arc : boundary.arcs()) {
            add(arc.from, arc.to);
            add(arc.to, arc.from);
        }
        for (int n = 0; n < boundary.n_nodes(); ++n) {
            if (!is_known[n] && weights[n] > 0.0) padded[n] = sums[n] / weights[n];
        }
    }
    return padded;
}

// Ties and what else cuts the surface into discs.
std::vector<LayoutTie> complete_ties(SurfaceMesh& mesh, const QuadLayout& layout,
                                     const std::vector<Vector3>& positions,
                                     std::vector<LayoutTie> ties) {
    const std::vector<VertexHandle> vertices = place_tied_nodes(mesh, layout, ties);
    ArcPaths paths(mesh, layout);
    for (int node = 0; node < layout.n_nodes(); ++node) {
        if (vertices[node].is_valid()) paths.place(node, vertices[node]);
    }
    for (const LayoutTie& tie : ties) paths.draw(tie);
    cut_into_discs(mesh, layout, positions, paths);
    return paths.take_ties();
}

// Cuboids of which each is numbered the wrong way round lie inside out.
void check_right_handed(const QuadLayout& boundary, const std::vector<Vector3>& positions) {
    double volume = 0.0;
    for (const auto& [a, b, c, d] : boundary.quads()) {
        for (const auto& [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}}) {
            volume += positions[p].dot(positions[q].cross(positions[r])) / 6.0;
        }
    }
    if (volume > 0.0) return;
    throw GeometryError(
        "layout: its cuboids have the volume {:.4g} and lie inside out; corners must be numbered "
        "right-handed: exchange the first four of each with the other four",
        volume);
}

// Without features the surface takes nodes wherever they are; those of a layout in other units or
// at another place lie far from it. Where there are features, an arc must lie along one.
void check_is_near(const SurfaceMesh& mesh, const QuadLayout& layout,
                   const std::vector<Vector3>& positions) {
    const bool has_features =
        std::ranges::any_of(mesh.edges(), [&](auto edge) { return mesh.data(edge).feature >= 0; });
    if (has_features) {
        throw TopologyError(
            "layout: no sharp edge of the surface runs along an arc of the layout; the layout's "
            "nodes must lie near the surface's corners and sharp edges, in the same units");
    }
    constexpr double reach = 0.25;
    const double diagonal = bounding_box_diagonal(mesh);
    const std::vector<int> valences = layout.valences();
    for (int node = 0; node < layout.n_nodes(); ++node) {
        if (valences[node] == 0) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto v : mesh.vertices()) {
            nearest = std::min(nearest, (mesh.point(v) - positions[node]).norm());
        }
        if (nearest <= reach * diagonal) continue;
        throw TopologyError(
            "layout: node {} at ({:.6g}, {:.6g}, {:.6g}) lies {:.3g} from the surface, more than a "
            "quarter of its diagonal {:.3g}; the layout's nodes must lie near the surface, in the "
            "same units",
            layout.node_name(node), positions[node].x(), positions[node].y(), positions[node].z(),
            nearest, diagonal);
    }
}

double path_length(const SurfaceMesh& mesh, const std::vector<VertexHandle>& path) {
    double length = 0.0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        length += (mesh.point(path[k + 1]) - mesh.point(path[k])).norm();
    }
    return length;
}

// Those of the surface along features, elsewhere those of the layout.
std::vector<double> wanted_lengths(const CuboidDecomposition& drawn,
                                   const std::vector<Vector3>& positions) {
    const EmbeddedLayout& surface = drawn.surface;
    std::vector<double> lengths;
    for (int a = 0; a < surface.layout.n_arcs(); ++a) {
        const auto& [from, to] = surface.layout.arcs()[a];
        double length = (positions[from] - positions[to]).norm();
        if (surface.is_feature_arc[a]) length = path_length(drawn.mesh, surface.arcs[a]);
        lengths.push_back(length);
    }
    return lengths;
}

// A layout with the arcs that run along features.
struct TiedLayout {
    PlacedLayout placed;
    LayoutBoundary boundary;
    std::vector<LayoutTie> ties;
};

TiedLayout tie_layout(SurfaceMesh& mesh, const Features& features, PlacedLayout placed,
                      double most_reach) {
    TiedLayout tied{std::move(placed), {}, {}};
    tied.boundary = layout_boundary(tied.placed.layout);
    tied.ties =
        tie_features(mesh, features, tied.boundary.layout, tied.placed.positions, most_reach);
    return tied;
}

double drawn_length(const SurfaceMesh& mesh, const TiedLayout& tied) {
    double length = 0.0;
    for (const LayoutTie& tie : tied.ties) length += path_length(mesh, tie.vertices);
    return length;
}

// Points along the arcs that run along features.
EdgePaths paths_of_ties(const SurfaceMesh& mesh, const std::vector<LayoutTie>& ties) {
    EdgePaths paths;
    for (const LayoutTie& tie : ties) {
        const auto [from, to] = std::minmax(tie.nodes.front(), tie.nodes.back());
        std::vector<Vector3>& path = paths[{from, to}];
        for (const VertexHandle vertex : tie.vertices) path.push_back(mesh.point(vertex));
        if (from != tie.nodes.front()) std::ranges::reverse(path);
    }
    return paths;
}

// Divides sheets of cuboids that features cross from end to end, so that arcs run along these too,
// as often as that makes much more of them drawn.
void divide_at_features(SurfaceMesh& mesh, const Features& features, double most_reach,
                        TiedLayout& tied) {
    constexpr int max_rounds = 4;
    for (int round = 0; round < max_rounds && !tied.ties.empty(); ++round) {
        // Nodes keep their places on features.
        PlacedLayout placed = tied.placed;
        for (const LayoutTie& tie : tied.ties) {
            placed.positions[tie.nodes.front()] = mesh.point(tie.vertices.front());
            placed.positions[tie.nodes.back()] = mesh.point(tie.vertices.back());
        }
        const EdgePlaces places =
            feature_crossings(mesh, tied.boundary.layout, placed.positions, tied.ties);
        if (places.empty()) return;
        PlacedLayout divided_layout = divide_sheets(placed, places, paths_of_ties(mesh, tied.ties));
        TiedLayout divided = tie_layout(mesh, features, std::move(divided_layout), most_reach);
        // More cuboids are thinner ones: they must be worth it.
        constexpr double least_gain = 0.05;
        if (drawn_length(mesh, divided) < (1.0 + least_gain) * drawn_length(mesh, tied)) return;
        tied = std::move(divided);
    }
}

}  // namespace

CuboidDecomposition place_layout(const SurfaceMesh& mesh, const Features& features,
                                 const PlacedLayout& placed, const PlaceLayoutOptions& options) {
    const LayoutBoundary boundary = layout_boundary(placed.layout);
    const int chi = static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
                    static_cast<int>(mesh.n_faces());
    if (boundary.layout.euler_characteristic() != chi) {
        throw TopologyError(
            "layout: its boundary has Euler characteristic {}, the surface {}; they must have the "
            "same genus",
            boundary.layout.euler_characteristic(), chi);
    }
    check_right_handed(boundary.layout, placed.positions);
    CuboidDecomposition result;
    result.mesh = mesh;
    TiedLayout tied = tie_layout(result.mesh, features, placed, options.most_reach);
    if (tied.ties.empty()) check_is_near(result.mesh, boundary.layout, placed.positions);
    if (options.divides_sheets) {
        divide_at_features(result.mesh, features, options.most_reach, tied);
    }
    // Nodes on features stay: on a closed curve nothing else keeps them from turning away from
    // those of the other side of a wall.
    std::set<VertexHandle> held;
    for (const LayoutTie& tie : tied.ties) {
        held.insert({tie.vertices.front(), tie.vertices.back()});
    }
    PaddedTies padded = pad_with_ties(tied.placed.layout, std::move(tied.ties));
    const QuadLayout outside = layout_boundary(padded.volume).layout;
    const std::vector<Vector3> positions =
        padded_positions(tied.placed.positions, padded.node_in_place, outside);
    const std::vector<LayoutTie> ties =
        complete_ties(result.mesh, outside, positions, std::move(padded.ties));
    draw_decomposition(std::move(padded.volume), ties, result);
    for (std::size_t n = 0; n < result.surface.nodes.size(); ++n) {
        if (held.contains(result.surface.nodes[n])) result.surface.is_corner_node[n] = true;
    }
    result.arc_lengths = wanted_lengths(result, positions);
    return result;
}

double untied_length(const CuboidDecomposition& decomposition) {
    double length = 0.0;
    for (const auto edge : decomposition.mesh.edges()) {
        const auto& data = decomposition.mesh.data(edge);
        if (data.feature >= 0 && data.curve < 0) length += edge_length(decomposition.mesh, edge);
    }
    return length;
}

}  // namespace couture::meshing
