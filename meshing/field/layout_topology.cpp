#include "meshing/field/layout_topology.h"

#include <numbers>
#include <optional>

#include "iga/core/error.h"
#include "meshing/field/face_frames.h"

namespace couture::meshing {

namespace {

constexpr double quarter = 0.5 * std::numbers::pi;

// A place on a side of a quad, larger further along the side.
struct SidePlace {
    int quad;
    int side;
    int position;
};

class ArcEdges {
  public:
    ArcEdges(const SurfaceMesh& mesh, const EmbeddedLayout& embedding)
        : mesh_(mesh),
          layout_(embedding.layout),
          arcs_(mesh.n_halfedges(), -1),
          positions_(mesh.n_halfedges(), 0) {
        for (int a = 0; a < layout_.n_arcs(); ++a) {
            const auto& path = embedding.arcs[a];
            for (int i = 0; i + 1 < static_cast<int>(path.size()); ++i) {
                const HalfedgeHandle h = mesh.find_halfedge(path[i], path[i + 1]);
                if (!h.is_valid()) {
                    throw TopologyError(
                        "EmbeddedLayout: arc {}: no edge joins its vertices {} and {}", a,
                        path[i].idx(), path[i + 1].idx());
                }
                // Forwards from 1, backwards from -1: along the side either way.
                set(h, a, i + 1);
                set(mesh.opposite_halfedge_handle(h), a, -i - 1);
                check_quads(embedding, h);
            }
        }
    }

    [[nodiscard]] int arc(HalfedgeHandle h) const { return arcs_[h.idx()]; }
    /// Where the side on the left of a halfedge of an arc has it.
    [[nodiscard]] SidePlace place(HalfedgeHandle h) const {
        const int position = positions_[h.idx()];
        const QuadLayout::ArcQuad& at = layout_.arc_quads(arc(h))[position > 0 ? 0 : 1];
        return {at.quad, at.side, position};
    }

  private:
    void set(HalfedgeHandle h, int arc, int position) {
        arcs_[h.idx()] = arc;
        positions_[h.idx()] = position;
    }
    void check_quads(const EmbeddedLayout& embedding, HalfedgeHandle forward) const {
        for (const HalfedgeHandle h : {forward, mesh_.opposite_halfedge_handle(forward)}) {
            const FaceHandle face = mesh_.face_handle(h);
            const int quad = face.is_valid() ? embedding.quad_of_face[face.idx()] : -1;
            if (place(h).quad == quad) continue;
            throw TopologyError(
                "EmbeddedLayout: beside arc {} lies quad {} in the layout, but {} on the mesh",
                arc(h), place(h).quad, quad);
        }
    }

    const SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    std::vector<int> arcs_;
    std::vector<int> positions_;
};

// Quarter turns to the left of a path that crosses a quad.
int turns_in_quad(const SidePlace& entry, const SidePlace& exit) {
    if (entry.side != exit.side) return (exit.side - entry.side + 4) % 4 - 2;
    return exit.position < entry.position ? 2 : -2;
}

int turns_of_generator(const SurfaceMesh& mesh, const ArcEdges& edges, const DualCycle& cycle) {
    int turns = 0;
    std::optional<SidePlace> first_exit;
    std::optional<SidePlace> entry;
    for (const HalfedgeHandle h : cycle.crossed) {
        if (edges.arc(h) < 0) continue;
        const SidePlace exit = edges.place(h);
        if (entry) {
            turns += turns_in_quad(*entry, exit);
        } else {
            first_exit = exit;
        }
        entry = edges.place(mesh.opposite_halfedge_handle(h));
    }
    if (!entry) {
        throw TopologyError(
            "EmbeddedLayout: a loop that does not bound a disc crosses no arc; each quad is a disc "
            "of faces");
    }
    return turns + turns_in_quad(*entry, *first_exit);
}

}  // namespace

FieldTopology topology_of_layout(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                 const DualCycles& cycles) {
    const ArcEdges edges(mesh, embedding);
    const std::vector<int> valences = embedding.layout.valences();
    std::vector<int> node_of_vertex(mesh.n_vertices(), -1);
    for (int n = 0; n < embedding.layout.n_nodes(); ++n) {
        if (valences[n] > 0) node_of_vertex[embedding.nodes[n].idx()] = n;
    }
    FieldTopology topology;
    for (const VertexHandle v : cycles.inner_vertices) {
        const int node = node_of_vertex[v.idx()];
        if (node < 0 || valences[node] == 4) continue;
        topology.singularities.push_back({v.idx(), 4 - valences[node]});
    }
    for (const BoundaryLoop& loop : boundary_loops(mesh)) {
        int turns = 0;
        for (const VertexHandle v : loop.vertices) {
            const int node = node_of_vertex[v.idx()];
            if (node >= 0) turns += 3 - valences[node];
        }
        topology.boundary_turns.push_back(turns);
    }
    for (const DualCycle& cycle : cycles.generators) {
        topology.generator_turns.push_back(turns_of_generator(mesh, edges, cycle));
    }
    return topology;
}

std::vector<ArcOffset> offsets_of_arcs(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                       const Connection& connection, const DualTree& tree,
                                       double angle_at_root) {
    const ArcEdges edges(mesh, embedding);
    const FaceFrames frames(mesh);
    // Of the path from the first arc into a face.
    struct Arrival {
        HalfedgeHandle entry;
        SidePlace place;
        // Offset that a cross along the arcs had there.
        double offset;
        // Quarter turns to the left in quads that were left again.
        int turns;
    };
    std::vector<Arrival> arrivals(mesh.n_faces());
    std::vector<ArcOffset> offsets;
    for (const FaceHandle face : tree.order) {
        Arrival& arrival = arrivals[face.idx()];
        if (!tree.crossed[face.idx()].is_valid()) {
            for (const HalfedgeHandle h : mesh.fh_range(face)) {
                if (edges.arc(h) >= 0) arrival.entry = h;
            }
            arrival.place = edges.place(arrival.entry);
            arrival.offset = frames.angle(arrival.entry) - angle_at_root;
            arrival.turns = 0;
        }
        for (const HalfedgeHandle h : mesh.fh_range(face)) {
            const bool is_entry = h == arrival.entry;
            const double turned =
                is_entry ? 0.0
                         : turn_between(mesh, mesh.opposite_halfedge_handle(arrival.entry), h);
            Arrival next = arrival;
            next.entry = mesh.opposite_halfedge_handle(h);
            next.offset += turned;
            if (edges.arc(h) >= 0) {
                if (!is_entry) next.turns += turns_in_quad(arrival.place, edges.place(h));
                offsets.push_back({edges.arc(h), face, next.offset - quarter * next.turns,
                                   edge_length(mesh, mesh.edge_handle(h))});
            }
            const FaceHandle other = mesh.face_handle(next.entry);
            if (!other.is_valid() || tree.crossed[other.idx()] != h) continue;
            if (edges.arc(h) >= 0) next.place = edges.place(next.entry);
            next.offset -= connection(mesh, h);
            arrivals[other.idx()] = next;
        }
    }
    return offsets;
}

std::vector<FaceHandle> faces_at_arcs(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    const ArcEdges edges(mesh, embedding);
    std::vector<FaceHandle> faces;
    for (const FaceHandle face : mesh.faces()) {
        for (const HalfedgeHandle h : mesh.fh_range(face)) {
            if (edges.arc(h) < 0) continue;
            faces.push_back(face);
            break;
        }
    }
    return faces;
}

}  // namespace couture::meshing
