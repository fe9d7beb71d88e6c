#include "tests/meshing/parameterization/layout_surfaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>

#include "iga/core/error.h"
#include "meshing/parameterization/layout_map.h"
#include "tests/meshing/surface/surface_samples.h"

namespace couture::meshing {

namespace {

// Vertices of arcs so far are passed by.
std::vector<VertexHandle> shortest_path(const SurfaceMesh& mesh, VertexHandle from, VertexHandle to,
                                        const std::vector<char>& is_taken) {
    std::vector<double> distance(mesh.n_vertices(), 1e300);
    std::vector<VertexHandle> before(mesh.n_vertices());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[from.idx()] = 0.0;
    queue.emplace(0.0, from.idx());
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        for (const VertexHandle next : mesh.vv_range(VertexHandle(v))) {
            if (is_taken[next.idx()] != 0 && next != to) continue;
            const double far = d + (mesh.point(next) - mesh.point(VertexHandle(v))).norm();
            if (far < distance[next.idx()]) {
                distance[next.idx()] = far;
                before[next.idx()] = VertexHandle(v);
                queue.emplace(far, next.idx());
            }
        }
    }
    if (!before[to.idx()].is_valid()) {
        throw TopologyError("lay_out: no way from vertex {} to {} between the arcs so far",
                            from.idx(), to.idx());
    }
    std::vector<VertexHandle> path{to};
    while (path.back() != from) path.push_back(before[path.back().idx()]);
    std::reverse(path.begin(), path.end());
    return path;
}

// Faces on the left of each quad's sides, and all that they reach without crossing an arc.
void flood_quads(const SurfaceMesh& mesh, EmbeddedLayout& embedding) {
    std::vector<bool> is_arc(mesh.n_edges(), false);
    for (const auto& path : embedding.arcs) {
        for (std::size_t i = 1; i < path.size(); ++i) {
            const HalfedgeHandle h = mesh.find_halfedge(path[i - 1], path[i]);
            if (!h.is_valid()) {
                throw TopologyError("lay_out: no edge joins the vertices {} and {} of an arc",
                                    path[i - 1].idx(), path[i].idx());
            }
            is_arc[mesh.edge_handle(h).idx()] = true;
        }
    }
    embedding.quad_of_face.assign(mesh.n_faces(), -1);
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        const QuadLayout::Side side = embedding.layout.sides(q)[0];
        const auto& path = embedding.arcs[side.arc];
        const HalfedgeHandle first = side.is_forward ? mesh.find_halfedge(path[0], path[1])
                                                     : mesh.find_halfedge(path[1], path[0]);
        std::vector<FaceHandle> stack{mesh.face_handle(first)};
        embedding.quad_of_face[stack.back().idx()] = q;
        while (!stack.empty()) {
            const FaceHandle face = stack.back();
            stack.pop_back();
            for (const HalfedgeHandle h : mesh.fh_range(face)) {
                const FaceHandle next = mesh.face_handle(mesh.opposite_halfedge_handle(h));
                if (is_arc[mesh.edge_handle(h).idx()] || !next.is_valid() ||
                    embedding.quad_of_face[next.idx()] >= 0) {
                    continue;
                }
                embedding.quad_of_face[next.idx()] = q;
                stack.push_back(next);
            }
        }
    }
}

LaidOutSurface finish(SurfaceMesh mesh, QuadLayout layout, std::vector<VertexHandle> nodes,
                      std::vector<std::vector<VertexHandle>> arcs,
                      const std::function<bool(const std::vector<Vector3>&)>& is_feature) {
    LaidOutSurface result{std::move(mesh), {}};
    EmbeddedLayout& embedding = result.embedding;
    embedding.layout = std::move(layout);
    embedding.nodes = std::move(nodes);
    embedding.arcs = std::move(arcs);
    std::vector<int> n_features(embedding.layout.n_nodes(), 0);
    for (int a = 0; a < embedding.layout.n_arcs(); ++a) {
        std::vector<Vector3> points;
        for (const VertexHandle v : embedding.arcs[a]) points.push_back(result.mesh.point(v));
        embedding.is_feature_arc.push_back(is_feature(points));
        if (!is_feature(points)) continue;
        ++n_features[embedding.layout.arcs()[a].from];
        ++n_features[embedding.layout.arcs()[a].to];
    }
    for (const int n : n_features) embedding.is_corner_node.push_back(n > 2);
    flood_quads(result.mesh, embedding);
    split_layout_chords(result.mesh, embedding);
    return result;
}

}  // namespace

LaidOutSurface lay_out(const TriangleSoup& soup, const std::vector<std::array<int, 4>>& quads,
                       const std::vector<int>& vertices_of_nodes,
                       const std::function<bool(const std::vector<Vector3>&)>& is_feature) {
    SurfaceMesh mesh = make_surface_mesh(soup);
    QuadLayout layout(static_cast<int>(vertices_of_nodes.size()), quads);
    std::vector<VertexHandle> nodes;
    std::vector<char> is_taken(mesh.n_vertices(), 0);
    for (const int v : vertices_of_nodes) {
        nodes.emplace_back(v);
        is_taken[v] = 1;
    }
    std::vector<std::vector<VertexHandle>> arcs;
    for (const auto& [from, to] : layout.arcs()) {
        arcs.push_back(shortest_path(mesh, nodes[from], nodes[to], is_taken));
        for (const VertexHandle v : arcs.back()) is_taken[v.idx()] = 1;
    }
    return finish(std::move(mesh), std::move(layout), std::move(nodes), std::move(arcs),
                  is_feature);
}

LaidOutSurface make_cube_layout(
    int n, const std::function<Vector3(const Vector3&)>& move,
    const std::function<bool(const std::vector<Vector3>&)>& is_feature) {
    TriangleSoup soup = make_cube(n);
    std::vector<int> nodes(8, -1);
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        for (int k = 0; k < 8; ++k) {
            const Vector3 corner(k & 1, k >> 1 & 1, k >> 2 & 1);
            if ((soup.points[v] - corner).norm() < 1e-9) nodes[k] = static_cast<int>(v);
        }
    }
    // Paths on the cube, where edges are straight.
    LaidOutSurface result = lay_out(
        soup, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}},
        nodes, is_feature);
    for (const VertexHandle v : result.mesh.vertices()) {
        const Vector3 p = 2.0 * result.mesh.point(v) - Vector3::Ones();
        result.mesh.set_point(v, move(p));
    }
    return result;
}

LaidOutSurface make_sphere_layout(int n, const Vector3& centre) {
    return make_cube_layout(
        n, [&](const Vector3& p) { return Vector3((p.normalized() + centre).normalized()); },
        [](const auto&) { return false; });
}

LaidOutSurface make_can_layout(int n, double turn) {
    return make_cube_layout(
        n,
        [&](const Vector3& p) {
            const Vector2 q = p.head<2>();
            const double radius = q.cwiseAbs().maxCoeff();
            const double angle = std::atan2(q.y(), q.x()) + 0.5 * turn * (1.0 + p.z());
            return Vector3(radius * std::cos(angle), radius * std::sin(angle), p.z());
        },
        [](const std::vector<Vector3>& path) {
            return std::abs(path.front().z() - path.back().z()) < 1e-9;
        });
}

LaidOutSurface make_torus_layout(int m, const std::vector<int>& sections,
                                 const std::vector<int>& turns) {
    const int n_around = 8 * m;
    const int n_tube = 4 * m;
    const int n_sections = static_cast<int>(sections.size());
    const auto vertex = [&](int i, int j) {
        return VertexHandle(n_tube * (i % n_around) + (j + n_tube) % n_tube);
    };
    std::vector<VertexHandle> nodes;
    std::vector<std::array<int, 4>> quads;
    for (int s = 0; s < n_sections; ++s) {
        for (int k = 0; k < 4; ++k) {
            nodes.push_back(vertex(sections[s], k * m + turns[s]));
            const int next = (s + 1) % n_sections;
            quads.push_back({4 * s + k, 4 * next + k, 4 * next + (k + 1) % 4, 4 * s + (k + 1) % 4});
        }
    }
    QuadLayout layout(4 * n_sections, quads);
    std::vector<std::vector<VertexHandle>> arcs(layout.n_arcs());
    const auto add = [&](int from, int to, std::vector<VertexHandle> path) {
        if (from > to) std::reverse(path.begin(), path.end());
        arcs[layout.find_arc(from, to)] = std::move(path);
    };
    for (int s = 0; s < n_sections; ++s) {
        const int next = (s + 1) % n_sections;
        const int n_steps = (sections[next] - sections[s] + n_around) % n_around;
        const int rise = turns[next] - turns[s];
        if (n_steps < 2 || std::abs(rise) >= m) {
            throw InputError(
                "make_torus_layout: sections {} and {} are {} vertices apart and turned by {}; "
                "they must be 2 or more apart and turned by less than {}",
                s, next, n_steps, rise, m);
        }
        for (int k = 0; k < 4; ++k) {
            std::vector<VertexHandle> along;
            int j = k * m + turns[s];
            for (int i = 0; i <= n_steps; ++i) {
                along.push_back(vertex(sections[s] + i, j));
                // The way is turned between the sections, whose own arcs lie along them.
                const int wanted =
                    k * m + turns[s] + std::min(i, n_steps - 1) * rise / (n_steps - 1);
                while (j != wanted) {
                    j += j < wanted ? 1 : -1;
                    along.push_back(vertex(sections[s] + i, j));
                }
            }
            add(4 * s + k, 4 * next + k, along);
            std::vector<VertexHandle> around;
            for (int i = 0; i <= m; ++i) {
                around.push_back(vertex(sections[s], k * m + turns[s] + i));
            }
            add(4 * s + k, 4 * s + (k + 1) % 4, around);
        }
    }
    return finish(make_surface_mesh(make_torus(n_around, n_tube, 1.0, 0.4)), std::move(layout),
                  std::move(nodes), std::move(arcs), [](const auto&) { return false; });
}

LaidOutSurface make_tube_layout(int m, bool is_zigzag) {
    const int n = 4 * m;
    SurfaceMesh mesh = make_surface_mesh(make_tube(n, m, 1.0, 2.0));
    QuadLayout layout(8, {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
    const auto vertex = [&](int row, int column) {
        return VertexHandle(n * row + (column + n) % n);
    };
    std::vector<VertexHandle> nodes;
    for (int k = 0; k < 8; ++k) nodes.push_back(vertex(k < 4 ? 0 : m, k % 4 * m));
    std::vector<std::vector<VertexHandle>> arcs;
    for (const auto& [from, to] : layout.arcs()) {
        auto& path = arcs.emplace_back();
        if (to == from + 4) {
            // Edges lean to one side only: a step aside after each rise.
            for (int row = 0; row <= m; ++row) {
                path.push_back(vertex(row, from * m));
                if (is_zigzag && row % 4 == 1 && row + 1 < m) {
                    path.push_back(vertex(row, from * m + 1));
                    path.push_back(vertex(row + 1, from * m + 1));
                }
            }
        } else {
            const int row = from < 4 ? 0 : m;
            const int start = to == from + 1 ? from % 4 : 3;
            for (int i = 0; i <= m; ++i) path.push_back(vertex(row, start * m + i));
            if (to != from + 1) std::reverse(path.begin(), path.end());
        }
    }
    return finish(std::move(mesh), std::move(layout), std::move(nodes), std::move(arcs),
                  [](const auto&) { return false; });
}

}  // namespace couture::meshing
