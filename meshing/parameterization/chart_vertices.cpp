#include "meshing/parameterization/chart_vertices.h"

#include <algorithm>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_sizes(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    const QuadLayout& layout = embedding.layout;
    const auto check = [](std::size_t n, std::size_t n_wanted, const char* what, const char* of) {
        if (n != n_wanted) {
            throw InputError("EmbeddedLayout: {} {} for {} {}; there must be one for each", n, what,
                             n_wanted, of);
        }
    };
    check(embedding.nodes.size(), layout.n_nodes(), "vertices", "nodes");
    check(embedding.is_corner_node.size(), layout.n_nodes(), "corner flags", "nodes");
    check(embedding.arcs.size(), layout.n_arcs(), "paths", "arcs");
    check(embedding.is_feature_arc.size(), layout.n_arcs(), "feature flags", "arcs");
    check(embedding.quad_of_face.size(), mesh.n_faces(), "quads", "faces");
    for (std::size_t f = 0; f < embedding.quad_of_face.size(); ++f) {
        const int quad = embedding.quad_of_face[f];
        if (quad < 0 || quad >= layout.n_quads()) {
            throw InputError("EmbeddedLayout: face {} lies in quad {}; there are {} quads", f, quad,
                             layout.n_quads());
        }
    }
}

}  // namespace

std::vector<LayoutPlace> layout_places(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    check_sizes(mesh, embedding);
    const QuadLayout& layout = embedding.layout;
    std::vector<LayoutPlace> places(mesh.n_vertices());
    for (const auto& arc : layout.arcs()) {
        for (const int node : {arc.from, arc.to}) {
            const VertexHandle vertex = embedding.nodes[node];
            if (!vertex.is_valid() ||
                (places[vertex.idx()].node >= 0 && places[vertex.idx()].node != node)) {
                throw TopologyError(
                    "EmbeddedLayout: node {} has vertex {}; each node of an arc needs one of its "
                    "own",
                    layout.node_name(node), vertex.idx());
            }
            places[vertex.idx()].node = node;
        }
    }
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto& path = embedding.arcs[a];
        const auto& [from, to] = layout.arcs()[a];
        if (path.size() < 2 || path.front() != embedding.nodes[from] ||
            path.back() != embedding.nodes[to]) {
            throw TopologyError(
                "EmbeddedLayout: arc {} does not run from node {} (vertex {}) to node {} (vertex "
                "{})",
                a, layout.node_name(from), embedding.nodes[from].idx(), layout.node_name(to),
                embedding.nodes[to].idx());
        }
        for (std::size_t i = 1; i < path.size(); ++i) {
            if (!mesh.find_halfedge(path[i - 1], path[i]).is_valid()) {
                throw TopologyError("EmbeddedLayout: arc {}: no edge joins its vertices {} and {}",
                                    a, path[i - 1].idx(), path[i].idx());
            }
            if (i + 1 == path.size()) break;
            LayoutPlace& place = places[path[i].idx()];
            if (place.node >= 0 || place.arc >= 0) {
                throw TopologyError(
                    "EmbeddedLayout: arc {} touches {} {} at vertex {}; arcs meet at their ends "
                    "only",
                    a, place.node >= 0 ? "node" : "arc", std::max(place.node, place.arc),
                    path[i].idx());
            }
            place.arc = a;
        }
    }
    return places;
}

std::vector<int> arcs_of_edges(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    std::vector<int> arcs(mesh.n_edges(), -1);
    for (int a = 0; a < embedding.layout.n_arcs(); ++a) {
        const auto& path = embedding.arcs[a];
        for (std::size_t i = 1; i < path.size(); ++i) {
            arcs[mesh.edge_handle(mesh.find_halfedge(path[i - 1], path[i])).idx()] = a;
        }
    }
    return arcs;
}

ChartVertices::ChartVertices(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                             const LayoutCharts& charts)
    : chart_(mesh.n_vertices(), -1),
      transitions_(mesh.n_faces()),
      is_fixed_(mesh.n_vertices(), {false, false}) {
    const QuadLayout& layout = embedding.layout;
    const std::vector<LayoutPlace> places = layout_places(mesh, embedding);
    for (const VertexHandle vertex : mesh.vertices()) {
        const LayoutPlace& place = places[vertex.idx()];
        if (place.node >= 0) is_fixed_[vertex.idx()] = {true, true};
        if (place.arc < 0) continue;
        const auto& [left, right] = layout.arc_quads(place.arc);
        const auto& own = left.quad >= 0 ? left : right;
        chart_[vertex.idx()] = own.quad;
        if (embedding.is_feature_arc[place.arc] || layout.is_boundary_arc(place.arc)) {
            is_fixed_[vertex.idx()][own.side % 2 == 0 ? 1 : 0] = true;
        }
    }
    for (const FaceHandle face : mesh.faces()) {
        const int quad = embedding.quad_of_face[face.idx()];
        const auto vertices = face_vertices(mesh, face);
        for (int k = 0; k < 3; ++k) {
            const LayoutPlace& place = places[vertices[k].idx()];
            ChartTransition& transition = transitions_[face.idx()][k];
            int& chart = chart_[vertices[k].idx()];
            bool is_near = true;
            if (place.node >= 0) {
                const auto& nodes = layout.quads()[quad];
                const auto at = std::find(nodes.begin(), nodes.end(), place.node);
                is_near = at != nodes.end();
                transition.shift = charts.corner(quad, static_cast<int>(at - nodes.begin()));
            } else if (place.arc >= 0) {
                const auto& [left, right] = layout.arc_quads(place.arc);
                is_near = quad == left.quad || quad == right.quad;
                if (quad != chart) transition = charts.across(place.arc);
            } else {
                is_near = chart < 0 || chart == quad;
                chart = quad;
            }
            if (!is_near) {
                throw TopologyError(
                    "EmbeddedLayout: face {} lies in quad {}, but its vertex {} belongs to {} {}; "
                    "quads must be divided by arcs",
                    face.idx(), quad, vertices[k].idx(),
                    place.node >= 0  ? "node"
                    : place.arc >= 0 ? "arc"
                                     : "quad",
                    place.node >= 0  ? place.node
                    : place.arc >= 0 ? place.arc
                                     : chart);
            }
        }
    }
}

}  // namespace couture::meshing
