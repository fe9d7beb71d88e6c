#include "meshing/layout/embed_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>

#include "iga/core/error.h"
#include "meshing/layout/layout_region.h"
#include "meshing/layout/tied_nodes.h"
#include "meshing/surface/cut_surface.h"
#include "meshing/surface/harmonic_map.h"
#include "meshing/surface/map_line.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/surface/surface_curves.h"

namespace couture::meshing {

namespace {

// Two arcs along features that turn by more meet in a corner.
constexpr double largest_turn = std::numbers::pi / 4.0;

// Draws arcs on the mesh, region by region.
class Drawing {
  public:
    Drawing(SurfaceMesh& mesh, const QuadLayout& layout, std::span<const LayoutTie> ties)
        : mesh_(mesh), layout_(layout), ties_(ties.begin(), ties.end()) {
        for (const auto edge : mesh.edges()) mesh.data(edge).curve = -1;
        embedded_.layout = layout;
        embedded_.arcs.resize(layout.n_arcs());
        embedded_.is_feature_arc.assign(layout.n_arcs(), false);
        embedded_.is_corner_node.assign(layout.n_nodes(), false);
    }

    EmbeddedLayout run() {
        embedded_.nodes = place_tied_nodes(mesh_, layout_, ties_);
        for (const LayoutTie& tie : ties_) draw_tie(tie);
        split_chords_between_curves(mesh_);
        regions_of_ties();
        embedded_.quad_of_face.assign(mesh_.n_faces(), -1);
        while (!open_.empty()) {
            LayoutRegion region = std::move(open_.back());
            open_.pop_back();
            draw_region(region);
        }
        number_faces();
        find_corner_nodes();
        return std::move(embedded_);
    }

  private:
    [[nodiscard]] bool is_drawn(int arc) const { return !embedded_.arcs[arc].empty(); }

    // Vertices of an arc in the direction of a side of a quad.
    [[nodiscard]] std::vector<VertexHandle> path_along(const QuadLayout::Side& side) const {
        std::vector<VertexHandle> path = embedded_.arcs[side.arc];
        if (!side.is_forward) std::ranges::reverse(path);
        return path;
    }

    // The face left of a quad's side.
    [[nodiscard]] FaceHandle face_beside(const QuadLayout::Side& side) const {
        const std::vector<VertexHandle> path = path_along(side);
        return mesh_.face_handle(mesh_.find_halfedge(path[0], path[1]));
    }

    void draw_tie(const LayoutTie& tie) {
        std::size_t start = 0;
        for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
            const VertexHandle end = embedded_.nodes[tie.nodes[k + 1]];
            std::size_t stop = start + 1;
            while (stop < tie.vertices.size() && tie.vertices[stop] != end) ++stop;
            if (stop == tie.vertices.size()) {
                throw TopologyError("{}: node {} of the layout lies elsewhere or out of order",
                                    tie.name, layout_.node_name(tie.nodes[k + 1]));
            }
            const int arc = draw_arc(tie.nodes[k], tie.nodes[k + 1],
                                     {tie.vertices.begin() + static_cast<std::ptrdiff_t>(start),
                                      tie.vertices.begin() + static_cast<std::ptrdiff_t>(stop) + 1},
                                     tie.name);
            embedded_.is_feature_arc[arc] = tie.is_feature;
            start = stop;
        }
    }

    int draw_arc(int from, int to, std::vector<VertexHandle> path, const std::string& who) {
        const int arc = layout_.find_arc(from, to);
        if (is_drawn(arc)) {
            throw TopologyError("{}: the arc of nodes {} is drawn already", who,
                                layout_.arc_name(arc));
        }
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            int& curve =
                mesh_.data(mesh_.edge_handle(mesh_.find_halfedge(path[k], path[k + 1]))).curve;
            if (curve >= 0) {
                throw TopologyError("{}: vertices {} and {} lie on the arc of nodes {} too", who,
                                    path[k].idx(), path[k + 1].idx(), layout_.arc_name(curve));
            }
            curve = arc;
        }
        for (std::size_t k = 1; k + 1 < path.size(); ++k) {
            int n_curves = 0;
            for (const auto edge : mesh_.ve_range(path[k])) {
                n_curves += mesh_.data(edge).curve >= 0 ? 1 : 0;
            }
            if (n_curves != 2) {
                throw TopologyError("{}: it meets another arc at vertex {}, where no node lies",
                                    who, path[k].idx());
            }
        }
        if (from > to) std::ranges::reverse(path);
        embedded_.arcs[arc] = std::move(path);
        return arc;
    }

    [[nodiscard]] std::vector<bool> drawn() const {
        std::vector<bool> is_drawn(layout_.n_arcs());
        for (int a = 0; a < layout_.n_arcs(); ++a) is_drawn[a] = this->is_drawn(a);
        return is_drawn;
    }

    // The regions of the layout between ties, compared with those of the surface.
    void regions_of_ties() {
        const std::vector<int> faces = regions_between_curves(mesh_);
        std::map<int, int> layout_region;
        std::vector<LayoutRegion> regions = layout_regions(layout_, drawn());
        for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
            std::optional<int> region;
            for (const auto& loop : regions[r].loops()) {
                for (const auto& place : loop) {
                    const QuadLayout::Side& side = layout_.sides(place.quad)[place.side];
                    const int here = faces[face_beside(side).idx()];
                    if (region.value_or(here) != here) throw_regions_differ(side);
                    region = here;
                }
            }
            if (!region) {
                throw TopologyError(
                    "layout: no tie runs along the quads around node {}; each part of the layout "
                    "needs one",
                    layout_.node_name(layout_.quads()[regions[r].quads()[0]][0]));
            }
            if (!layout_region.emplace(*region, r).second) {
                const auto& place = regions[r].loops()[0][0];
                throw_regions_differ(layout_.sides(place.quad)[place.side]);
            }
        }
        const int n_regions = faces.empty() ? 0 : *std::ranges::max_element(faces) + 1;
        if (n_regions != static_cast<int>(regions.size())) {
            throw TopologyError(
                "layout: ties cut the surface into {} regions, the layout into {}; they must "
                "correspond",
                n_regions, regions.size());
        }
        open_ = std::move(regions);
    }

    [[noreturn]] void throw_regions_differ(const QuadLayout::Side& side) const {
        throw TopologyError(
            "layout: the ties around the region beside the arc of nodes {} bound one region of the "
            "layout, but not one of the surface",
            layout_.arc_name(side.arc));
    }

    void draw_region(const LayoutRegion& region) {
        const CutSurface piece = cut_piece(region);
        check_same_topology(region, piece);
        if (region.loops().size() > 1) {
            draw_seam(region, piece);
        } else if (region.quads().size() > 1) {
            divide_disc(region, piece);
        } else {
            return;
        }
        for (LayoutRegion& part : region.parts(drawn())) open_.push_back(std::move(part));
    }

    // Faces of a region, cut open along what is drawn.
    [[nodiscard]] CutSurface cut_piece(const LayoutRegion& region) const {
        const auto& place = region.loops()[0][0];
        std::vector<FaceHandle> faces{face_beside(layout_.sides(place.quad)[place.side])};
        std::vector<bool> is_seen(mesh_.n_faces(), false);
        is_seen[faces[0].idx()] = true;
        for (std::size_t k = 0; k < faces.size(); ++k) {
            for (const auto h : mesh_.fh_range(faces[k])) {
                if (mesh_.data(mesh_.edge_handle(h)).curve >= 0) continue;
                const FaceHandle next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
                if (!next.is_valid() || is_seen[next.idx()]) continue;
                is_seen[next.idx()] = true;
                faces.push_back(next);
            }
        }
        std::ranges::sort(faces, {}, [](FaceHandle f) { return f.idx(); });
        return CutSurface(mesh_, faces, curve_seams(mesh_));
    }

    void check_same_topology(const LayoutRegion& region, const CutSurface& piece) const {
        const int n_loops = static_cast<int>(piece.boundary_loops().size());
        if (n_loops == static_cast<int>(region.loops().size()) &&
            piece.euler_characteristic() == region.euler_characteristic()) {
            return;
        }
        const auto& place = region.loops()[0][0];
        throw TopologyError(
            "layout: beside the arc of nodes {} the layout has a region with {} boundary loops and "
            "Euler characteristic {}, the surface one with {} and {}",
            layout_.arc_name(layout_.sides(place.quad)[place.side].arc), region.loops().size(),
            region.euler_characteristic(), n_loops, piece.euler_characteristic());
    }

    // The vertex of the piece at which a side of the region's boundary starts.
    [[nodiscard]] int start_in(const CutSurface& piece, const LayoutRegion::Place& place) const {
        const std::vector<VertexHandle> path = path_along(layout_.sides(place.quad)[place.side]);
        const FaceHandle face = mesh_.face_handle(mesh_.find_halfedge(path[0], path[1]));
        for (const int h : halfedges_of(piece, face)) {
            if (piece.parent(piece.origin(h)) == path[0].idx() &&
                piece.parent(piece.target(h)) == path[1].idx()) {
                return piece.origin(h);
            }
        }
        throw TopologyError("layout: the region's boundary is not that of its faces at vertex {}",
                            path[0].idx());
    }

    [[nodiscard]] static std::vector<int> halfedges_of(const CutSurface& piece, FaceHandle face) {
        std::vector<int> halfedges;
        for (int f = 0; f < piece.n_faces(); ++f) {
            if (piece.parent_face(f) != face.idx()) continue;
            for (int k = 0; k < 3; ++k) halfedges.push_back(3 * f + k);
        }
        return halfedges;
    }

    // Joins two boundary loops of a region by the arcs whose ends are nearest to each other.
    void draw_seam(const LayoutRegion& region, CutSurface piece) {
        const std::vector<LayoutRegion::Path> candidates = region.paths_between_loops();
        const LayoutRegion::Path* best = nullptr;
        double distance = 0.0;
        for (const LayoutRegion::Path& path : candidates) {
            const double d = (mesh_.point(embedded_.nodes[region.node(path.front())]) -
                              mesh_.point(embedded_.nodes[region.node(path.back())]))
                                 .norm();
            if (best == nullptr || d < distance * (1.0 - 1e-9)) {
                best = &path;
                distance = d;
            }
        }
        if (best == nullptr) {
            throw TopologyError("layout: no arcs join two boundary loops of a region");
        }
        draw_shortest(region, *best, piece);
    }

    // Draws a path of arcs between two places of the boundary as a shortest path; nodes on the way
    // are spread evenly.
    void draw_shortest(const LayoutRegion& region, const LayoutRegion::Path& path,
                       CutSurface& piece) {
        const int from = start_in(piece, region.place_of(path.front()));
        const int to = start_in(piece, region.place_of(path.back()));
        piece.split_chords();
        std::vector<char> is_blocked(piece.n_vertices());
        for (int v = 0; v < piece.n_vertices(); ++v) is_blocked[v] = piece.is_boundary_vertex(v);
        std::vector<char> is_target(piece.n_vertices(), 0);
        is_target[to] = 1;
        ShortestPaths paths(piece);
        const std::array<int, 1> sources{from};
        paths.run({.sources = sources, .is_blocked = &is_blocked, .is_target = &is_target});
        std::vector<int> vertices = paths.vertices_to(to);
        if (vertices.size() < 2) {
            throw GeometryError("layout: there is no way from node {} to node {} on the surface",
                                layout_.node_name(region.node(path.front())),
                                layout_.node_name(region.node(path.back())));
        }
        while (vertices.size() - 1 < 2 * (path.size() - 1)) {
            std::size_t longest = 0;
            for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
                const auto length = [&](std::size_t i) {
                    return (piece.point(vertices[i]) - piece.point(vertices[i + 1])).norm();
                };
                if (length(k) > length(longest) * (1.0 + 1e-9)) longest = k;
            }
            int h = piece.find_halfedge(vertices[longest], vertices[longest + 1]);
            vertices.insert(vertices.begin() + static_cast<std::ptrdiff_t>(longest) + 1,
                            piece.split_edge(h));
        }
        std::vector<std::size_t> stops{0};
        for (std::size_t k = 1; k + 1 < path.size(); ++k) {
            stops.push_back(k * (vertices.size() - 1) / (path.size() - 1));
        }
        stops.push_back(vertices.size() - 1);
        draw_path(region, path, piece, vertices, stops);
    }

    // A path of the piece as arcs of the mesh, with nodes at some of its vertices.
    void draw_path(const LayoutRegion& region, const LayoutRegion::Path& path,
                   const CutSurface& piece, const std::vector<int>& vertices,
                   const std::vector<std::size_t>& stops) {
        const std::vector<VertexHandle> handles = embed_splits(mesh_, piece);
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            std::vector<VertexHandle> arc;
            for (std::size_t i = stops[k]; i <= stops[k + 1]; ++i) {
                arc.push_back(handles[vertices[i]]);
            }
            const int from = region.node(path[k]);
            const int to = region.node(path[k + 1]);
            if (k > 0) embedded_.nodes[from] = arc.front();
            draw_arc(from, to, std::move(arc),
                     fmt::format("arc of nodes {}", layout_.arc_name(layout_.find_arc(from, to))));
        }
    }

    void divide_disc(const LayoutRegion& region, CutSurface piece) {
        const auto& loop = region.loops()[0];
        std::vector<int> corners;
        for (const auto& place : loop) corners.push_back(start_in(piece, place));
        const LayoutRegion::Path path = region.dividing_path();
        const std::vector<Vector2> polygon =
            regular_polygon_corners(static_cast<int>(corners.size()));
        CutSurface untouched = piece;
        try {
            HarmonicMap map = map_disc_to_polygon(piece, corners, polygon);
            const std::vector<Vector2> drawn = region.tutte_embedding(polygon);
            std::vector<int> stops{corners[region.index_on_loop(path.front())]};
            for (std::size_t k = 1; k + 1 < path.size(); ++k) {
                stops.push_back(insert_point(piece, map.parameters, drawn[path[k]]));
            }
            stops.push_back(corners[region.index_on_loop(path.back())]);
            const auto vertices = line_through(piece, map.parameters, stops);
            if (vertices) {
                draw_path(region, path, piece, vertices->first, vertices->second);
                return;
            }
        } catch (const GeometryError&) {
            // The map is too thin somewhere: arcs are drawn as shortest paths.
        }
        draw_shortest(region, path, untouched);
    }

    // Lines of a map from stop to stop, and where among their vertices the stops lie; nothing if
    // they touch the boundary or each other.
    [[nodiscard]] static std::optional<std::pair<std::vector<int>, std::vector<std::size_t>>>
    line_through(CutSurface& piece, std::vector<Vector2>& parameters,
                 const std::vector<int>& stops) {
        std::vector<std::vector<int>> lines;
        for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
            std::vector<int> line{stops[k]};
            for (const int h : insert_line(piece, parameters, stops[k], stops[k + 1])) {
                line.push_back(piece.origin(h) == line.back() ? piece.target(h) : piece.origin(h));
            }
            lines.push_back(std::move(line));
        }
        std::vector<int> vertices{stops[0]};
        std::vector<std::size_t> places{0};
        for (const std::vector<int>& line : lines) {
            vertices.insert(vertices.end(), line.begin() + 1, line.end());
            places.push_back(vertices.size() - 1);
        }
        std::vector<int> sorted = vertices;
        std::ranges::sort(sorted);
        if (std::ranges::adjacent_find(sorted) != sorted.end()) return std::nullopt;
        for (std::size_t k = 1; k + 1 < vertices.size(); ++k) {
            if (piece.is_boundary_vertex(vertices[k])) return std::nullopt;
        }
        for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
            if (piece.find_halfedge(vertices[k], vertices[k + 1]) < 0) return std::nullopt;
        }
        return std::pair{std::move(vertices), std::move(places)};
    }

    void number_faces() {
        embedded_.quad_of_face.assign(mesh_.n_faces(), -1);
        for (int q = 0; q < layout_.n_quads(); ++q) {
            std::vector<FaceHandle> stack{face_beside(layout_.sides(q)[0])};
            while (!stack.empty()) {
                const FaceHandle face = stack.back();
                stack.pop_back();
                int& quad = embedded_.quad_of_face[face.idx()];
                if (quad == q) continue;
                if (quad >= 0) {
                    throw GeometryError(
                        "layout: the quads of nodes {} and of {} hang together on the surface",
                        layout_.quad_name(quad), layout_.quad_name(q));
                }
                quad = q;
                for (const auto h : mesh_.fh_range(face)) {
                    if (mesh_.data(mesh_.edge_handle(h)).curve >= 0) continue;
                    stack.push_back(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
                }
            }
        }
    }

    // Nodes where other than two arcs along features meet, or two that turn.
    void find_corner_nodes() {
        std::vector<std::vector<Vector3>> directions(layout_.n_nodes());
        for (int a = 0; a < layout_.n_arcs(); ++a) {
            if (!embedded_.is_feature_arc[a]) continue;
            const auto& path = embedded_.arcs[a];
            const auto direction = [&](VertexHandle from, VertexHandle to) {
                return (mesh_.point(to) - mesh_.point(from)).normalized();
            };
            directions[layout_.arcs()[a].from].push_back(direction(path[0], path[1]));
            directions[layout_.arcs()[a].to].push_back(
                direction(path[path.size() - 1], path[path.size() - 2]));
        }
        for (int n = 0; n < layout_.n_nodes(); ++n) {
            const auto& at = directions[n];
            embedded_.is_corner_node[n] =
                at.size() == 1 || at.size() > 2 ||
                (at.size() == 2 && at[0].dot(at[1]) > -std::cos(largest_turn));
        }
    }

    SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    std::vector<LayoutTie> ties_;
    EmbeddedLayout embedded_;
    std::vector<LayoutRegion> open_;
};

}  // namespace

EmbeddedLayout embed_layout(SurfaceMesh& mesh, const QuadLayout& layout,
                            std::span<const LayoutTie> ties) {
    return Drawing(mesh, layout, ties).run();
}

}  // namespace couture::meshing
