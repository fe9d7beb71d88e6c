#include "meshing/topology/invariants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "iga/core/error.h"
#include "meshing/surface/curvature.h"
#include "meshing/surface/soup_sides.h"

namespace couture::meshing {

namespace {

constexpr double pi = std::numbers::pi;

// Fills in what follows from the counts.
void complete(SurfaceInvariants& invariants, int n_closed) {
    invariants.euler_characteristic =
        invariants.n_vertices - invariants.n_edges + invariants.n_faces;
    const int twice_genus =
        2 * invariants.n_components - invariants.n_boundaries - invariants.euler_characteristic;
    if (twice_genus < 0 || twice_genus % 2 != 0) {
        throw TopologyError(
            "compute_invariants: chi = {} with {} components and {} boundaries; chi = 2 components "
            "- 2 genus - boundaries has no solution: the mesh is no surface, repair it first",
            invariants.euler_characteristic, invariants.n_components, invariants.n_boundaries);
    }
    invariants.genus = twice_genus / 2;
    const int n_loops = invariants.n_components + n_closed - invariants.euler_characteristic;
    invariants.betti = {invariants.n_components, n_loops, n_closed};
}

// Fans at a vertex beyond the first begin at boundary halfedges of their own.
void check_fans(const SurfaceMesh& mesh) {
    std::vector<int> n_starts(mesh.n_vertices(), 0);
    for (const auto halfedge : mesh.halfedges()) {
        if (!mesh.is_boundary(halfedge)) continue;
        const int v = mesh.from_vertex_handle(halfedge).idx();
        if (++n_starts[v] > 1) {
            throw TopologyError(
                "compute_invariants: the triangles around vertex {} at ({:.6g}, {:.6g}, {:.6g}) "
                "form more than one fan; a surface has one at each vertex: repair it first",
                v, mesh.point(VertexHandle(v)).x(), mesh.point(VertexHandle(v)).y(),
                mesh.point(VertexHandle(v)).z());
        }
    }
}

}  // namespace

std::vector<int> face_components(const SurfaceMesh& mesh) {
    std::vector<int> component(mesh.n_faces(), -1);
    std::vector<FaceHandle> stack;
    int n_components = 0;
    for (const auto start : mesh.faces()) {
        if (component[start.idx()] >= 0) continue;
        component[start.idx()] = n_components;
        stack.push_back(start);
        while (!stack.empty()) {
            const FaceHandle face = stack.back();
            stack.pop_back();
            for (const auto neighbour : mesh.ff_range(face)) {
                if (component[neighbour.idx()] >= 0) continue;
                component[neighbour.idx()] = n_components;
                stack.push_back(neighbour);
            }
        }
        ++n_components;
    }
    return component;
}

std::vector<SurfaceInvariants> component_invariants(const SurfaceMesh& mesh) {
    check_fans(mesh);
    const std::vector<int> component = face_components(mesh);
    const int n_components =
        component.empty() ? 0 : *std::max_element(component.begin(), component.end()) + 1;
    std::vector<SurfaceInvariants> result(n_components);
    for (auto& invariants : result) invariants.n_components = 1;
    const auto of_halfedge = [&](HalfedgeHandle halfedge) -> SurfaceInvariants& {
        const FaceHandle face = mesh.is_boundary(halfedge) ? mesh.opposite_face_handle(halfedge)
                                                           : mesh.face_handle(halfedge);
        return result[component[face.idx()]];
    };
    for (const int i : component) ++result[i].n_faces;
    for (const auto edge : mesh.edges()) ++of_halfedge(mesh.halfedge_handle(edge, 0)).n_edges;
    for (const auto vertex : mesh.vertices()) {
        if (!mesh.is_isolated(vertex)) ++of_halfedge(mesh.halfedge_handle(vertex)).n_vertices;
    }
    for (const auto& loop : boundary_loops(mesh)) {
        ++of_halfedge(mesh.halfedge_handle(loop.vertices.front())).n_boundaries;
    }
    for (auto& invariants : result) complete(invariants, invariants.n_boundaries == 0 ? 1 : 0);
    return result;
}

SurfaceInvariants compute_invariants(const SurfaceMesh& mesh) {
    SurfaceInvariants total;
    int n_closed = 0;
    for (const auto& part : component_invariants(mesh)) {
        total.n_vertices += part.n_vertices;
        total.n_edges += part.n_edges;
        total.n_faces += part.n_faces;
        total.n_boundaries += part.n_boundaries;
        ++total.n_components;
        n_closed += part.betti[2];
    }
    complete(total, n_closed);
    return total;
}

std::string surface_name(int genus, int n_boundaries) {
    if (genus < 0 || n_boundaries < 0) {
        throw InputError("surface_name: genus {} with {} boundaries; neither can be negative",
                         genus, n_boundaries);
    }
    if (genus == 0 && n_boundaries == 0) return "sphere";
    if (genus == 0 && n_boundaries == 1) return "disc";
    if (genus == 0 && n_boundaries == 2) return "cylinder";
    if (genus == 0 && n_boundaries == 3) return "pant";
    if (genus == 0) return fmt::format("{}-pant", n_boundaries);
    if (genus == 1 && n_boundaries == 0) return "torus";
    if (n_boundaries == 0) return fmt::format("genus {}", genus);
    return fmt::format("genus {} with {} {}", genus, n_boundaries,
                       n_boundaries == 1 ? "boundary" : "boundaries");
}

std::string surface_name(const SurfaceMesh& mesh) {
    const auto parts = component_invariants(mesh);
    if (parts.size() == 1) return surface_name(parts[0].genus, parts[0].n_boundaries);
    std::string name = fmt::format("{} components", parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        name += i == 0 ? ": " : ", ";
        name += surface_name(parts[i].genus, parts[i].n_boundaries);
    }
    return name;
}

PantsCount count_pants(int genus, int n_boundaries) {
    const std::string name = surface_name(genus, n_boundaries);
    const int chi = 2 - 2 * genus - n_boundaries;
    if (chi > -1) {
        throw TopologyError(
            "count_pants: a {} (genus {}, {} boundaries) has chi = {}; only surfaces with chi <= "
            "-1 can be cut into pants: use a template of its own",
            name, genus, n_boundaries, chi);
    }
    return {.n_pants = -chi, .n_curves = 3 * genus + n_boundaries - 3};
}

std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& mesh) {
    std::vector<BoundaryLoop> loops;
    std::vector<bool> is_seen(mesh.n_halfedges(), false);
    for (const auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || is_seen[start.idx()]) continue;
        // A boundary halfedge has the hole on its left: go backwards.
        auto& loop = loops.emplace_back();
        for (HalfedgeHandle h = start; !is_seen[h.idx()]; h = mesh.prev_halfedge_handle(h)) {
            is_seen[h.idx()] = true;
            loop.vertices.push_back(mesh.to_vertex_handle(h));
        }
        std::rotate(loop.vertices.begin(),
                    std::min_element(loop.vertices.begin(), loop.vertices.end()),
                    loop.vertices.end());
        for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
            const Vector3& a = mesh.point(loop.vertices[i]);
            const Vector3& b = mesh.point(loop.vertices[(i + 1) % loop.vertices.size()]);
            const double length = (b - a).norm();
            loop.length += length;
            loop.center += 0.5 * length * (a + b);
        }
        if (loop.length > 0.0) loop.center /= loop.length;
    }
    std::sort(loops.begin(), loops.end(), [](const BoundaryLoop& a, const BoundaryLoop& b) {
        return a.vertices.front() < b.vertices.front();
    });
    return loops;
}

double gauss_bonnet_defect(const SurfaceMesh& mesh) {
    const auto gaussian = gaussian_curvature(mesh);
    const auto geodesic = geodesic_curvature(mesh);
    double sum = 0.0;
    for (std::size_t i = 0; i < gaussian.size(); ++i) sum += gaussian[i] + geodesic[i];
    return sum - 2.0 * pi * compute_invariants(mesh).euler_characteristic;
}

void check_gauss_bonnet(const SurfaceMesh& mesh) {
    const double defect = gauss_bonnet_defect(mesh);
    const double bound = 1e-9 * std::max(1.0, static_cast<double>(mesh.n_vertices()) / 1000.0);
    if (std::abs(defect) <= bound) return;
    std::string where = "no single triangle is to blame";
    for (const auto face : mesh.faces()) {
        double sum = 0.0;
        for (const auto halfedge : mesh.fh_range(face)) sum += corner_angle(mesh, halfedge);
        if (std::abs(sum - pi) <= bound) continue;
        const auto [a, b, c] = face_vertices(mesh, face);
        where = fmt::format("the angles of triangle {} (vertices {}, {}, {}) sum to {:.6g}",
                            face.idx(), a.idx(), b.idx(), c.idx(), sum);
        break;
    }
    throw TopologyError(
        "check_gauss_bonnet: total curvature - 2 pi chi = {:.3e} rad, beyond {:.0e}; {}: remove "
        "triangles without extent",
        defect, bound, where);
}

Orientation orientation_of(const TriangleSoup& soup) {
    const std::vector<SoupSide> sides = sorted_sides(soup);
    // Neighbours across edges, and whether one of the two must be turned.
    struct Link {
        int to;
        bool is_turned;
    };
    std::vector<std::vector<Link>> links(soup.triangles.size());
    for (const auto& edge : edges_of(sides)) {
        if (edge.size() > 2) return Orientation::impossible;
        if (edge.size() < 2) continue;
        const SoupSide& a = edge[0];
        const SoupSide& b = edge[1];
        links[a.triangle].push_back({b.triangle, a.is_forward == b.is_forward});
        links[b.triangle].push_back({a.triangle, a.is_forward == b.is_forward});
    }
    std::vector<std::optional<bool>> is_turned(soup.triangles.size());
    std::vector<int> stack;
    auto result = Orientation::consistent;
    for (std::size_t start = 0; start < soup.triangles.size(); ++start) {
        if (is_turned[start]) continue;
        is_turned[start] = false;
        stack.push_back(static_cast<int>(start));
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (const Link& link : links[t]) {
                if (link.is_turned) result = Orientation::inconsistent;
                const bool turned = *is_turned[t] != link.is_turned;
                if (!is_turned[link.to]) {
                    is_turned[link.to] = turned;
                    stack.push_back(link.to);
                } else if (*is_turned[link.to] != turned) {
                    return Orientation::impossible;
                }
            }
        }
    }
    return result;
}

}  // namespace couture::meshing
