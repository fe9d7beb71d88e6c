#include "meshing/surface/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// (1 - fraction) a + fraction b, by the vertices of the first surface.
SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b, double fraction) {
    std::vector<std::pair<int, double>> terms;
    const auto add = [&](const SurfacePoint& point, double factor) {
        for (int i = 0; i < 3; ++i) {
            if (point.vertices[i] < 0) continue;
            const auto same = std::find_if(terms.begin(), terms.end(), [&](const auto& term) {
                return term.first == point.vertices[i];
            });
            if (same != terms.end()) {
                same->second += factor * point.weights[i];
            } else {
                terms.emplace_back(point.vertices[i], factor * point.weights[i]);
            }
        }
    };
    add(a, 1.0 - fraction);
    add(b, fraction);
    std::sort(terms.begin(), terms.end());
    if (terms.size() > 3) {
        throw TopologyError(
            "split_edge: the ends of an edge lie in no common triangle of the "
            "surface that was read");
    }
    SurfacePoint point;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        point.vertices[i] = terms[i].first;
        point.weights[i] = terms[i].second;
    }
    return point;
}

}  // namespace

SurfaceMesh make_surface_mesh(const TriangleSoup& soup) {
    const int n_points = static_cast<int>(soup.points.size());
    SurfaceMesh mesh;
    mesh.reserve(soup.points.size(), soup.triangles.size() * 3 / 2 + 16, soup.triangles.size());
    for (int i = 0; i < n_points; ++i) {
        const VertexHandle vertex = mesh.add_vertex(soup.points[i]);
        mesh.data(vertex).source = SurfacePoint{{i, -1, -1}, {1.0, 0.0, 0.0}};
    }
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        const auto [a, b, c] = soup.triangles[i];
        if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= n_points || a == b || b == c ||
            c == a) {
            throw InputError(
                "SurfaceMesh: triangle {} has vertices {}, {}, {}; they must be three different "
                "numbers below {}",
                i, a, b, c, n_points);
        }
        // add_face would complain on the error stream.
        const auto is_free = [&](int from, int to) {
            const HalfedgeHandle halfedge =
                mesh.find_halfedge(VertexHandle(from), VertexHandle(to));
            return !halfedge.is_valid() || mesh.is_boundary(halfedge);
        };
        const auto has_room = [&](int v) {
            const VertexHandle vertex(v);
            return !mesh.halfedge_handle(vertex).is_valid() || mesh.is_boundary(vertex);
        };
        if (!is_free(a, b) || !is_free(b, c) || !is_free(c, a) || !has_room(a) || !has_room(b) ||
            !has_room(c)) {
            throw TopologyError(
                "SurfaceMesh: triangle {} (vertices {}, {}, {}) does not continue an oriented "
                "manifold; each edge must belong to at most two triangles that run along it in "
                "opposite directions: repair the surface first",
                i, a, b, c);
        }
        const FaceHandle face = mesh.add_face(VertexHandle(a), VertexHandle(b), VertexHandle(c));
        if (!face.is_valid()) {
            throw TopologyError(
                "SurfaceMesh: triangle {} (vertices {}, {}, {}) touches others at a vertex only; "
                "the triangles around a vertex must form one fan: repair the surface first",
                i, a, b, c);
        }
        mesh.data(face).source = static_cast<int>(i);
    }
    return mesh;
}

TriangleSoup to_soup(const SurfaceMesh& mesh) {
    TriangleSoup soup;
    soup.points.reserve(mesh.n_vertices());
    soup.triangles.reserve(mesh.n_faces());
    for (const auto vertex : mesh.vertices()) soup.points.push_back(mesh.point(vertex));
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        soup.triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
    return soup;
}

std::array<VertexHandle, 3> face_vertices(const SurfaceMesh& mesh, FaceHandle face) {
    const HalfedgeHandle first = mesh.halfedge_handle(face);
    const HalfedgeHandle second = mesh.next_halfedge_handle(first);
    return {mesh.from_vertex_handle(first), mesh.to_vertex_handle(first),
            mesh.to_vertex_handle(second)};
}

double edge_length(const SurfaceMesh& mesh, EdgeHandle edge) {
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    return (mesh.point(mesh.to_vertex_handle(halfedge)) -
            mesh.point(mesh.from_vertex_handle(halfedge)))
        .norm();
}

namespace {

Vector3 area_vector(const SurfaceMesh& mesh, FaceHandle face) {
    const auto [a, b, c] = face_vertices(mesh, face);
    return 0.5 * (mesh.point(b) - mesh.point(a)).cross(mesh.point(c) - mesh.point(a));
}

}  // namespace

double face_area(const SurfaceMesh& mesh, FaceHandle face) {
    return area_vector(mesh, face).norm();
}

Vector3 face_normal(const SurfaceMesh& mesh, FaceHandle face) {
    const Vector3 area = area_vector(mesh, face);
    const double norm = area.norm();
    return norm > 0.0 ? Vector3(area / norm) : Vector3::Zero();
}

Vector3 vertex_normal(const SurfaceMesh& mesh, VertexHandle vertex) {
    Vector3 sum = Vector3::Zero();
    for (const FaceHandle face : mesh.vf_range(vertex)) {
        sum += face_area(mesh, face) * face_normal(mesh, face);
    }
    const double length = sum.norm();
    return length > 0.0 ? Vector3(sum / length) : Vector3(Vector3::Zero());
}

double corner_angle(const SurfaceMesh& mesh, HalfedgeHandle halfedge) {
    const Vector3& corner = mesh.point(mesh.from_vertex_handle(halfedge));
    const Vector3 a = mesh.point(mesh.to_vertex_handle(halfedge)) - corner;
    const Vector3 b =
        mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(halfedge))) - corner;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double surface_area(const SurfaceMesh& mesh) {
    double area = 0.0;
    for (const auto face : mesh.faces()) area += face_area(mesh, face);
    return area;
}

double signed_volume(const SurfaceMesh& mesh) {
    double volume = 0.0;
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        volume += mesh.point(a).dot(mesh.point(b).cross(mesh.point(c))) / 6.0;
    }
    return volume;
}

double bounding_box_diagonal(const SurfaceMesh& mesh) {
    if (mesh.n_vertices() == 0) return 0.0;
    Vector3 low = mesh.point(VertexHandle(0));
    Vector3 high = low;
    for (const auto vertex : mesh.vertices()) {
        low = low.cwiseMin(mesh.point(vertex));
        high = high.cwiseMax(mesh.point(vertex));
    }
    return (high - low).norm();
}

VertexHandle split_edge(SurfaceMesh& mesh, HalfedgeHandle halfedge, double fraction) {
    const VertexHandle from = mesh.from_vertex_handle(halfedge);
    const VertexHandle to = mesh.to_vertex_handle(halfedge);
    const EdgeHandle edge = mesh.edge_handle(halfedge);
    const auto edge_data = mesh.data(edge);
    const auto point = Vector3((1.0 - fraction) * mesh.point(from) + fraction * mesh.point(to));
    const SurfacePoint source = between(mesh.data(from).source, mesh.data(to).source, fraction);

    // Face and opposite vertex on either side.
    std::vector<std::pair<FaceHandle, VertexHandle>> sides;
    for (const HalfedgeHandle side : {halfedge, mesh.opposite_halfedge_handle(halfedge)}) {
        if (mesh.is_boundary(side)) continue;
        sides.emplace_back(mesh.face_handle(side),
                           mesh.to_vertex_handle(mesh.next_halfedge_handle(side)));
    }
    const VertexHandle vertex = mesh.split(edge, point);
    mesh.data(vertex).source = source;
    for (const VertexHandle end : {from, to}) {
        mesh.data(mesh.edge_handle(mesh.find_halfedge(vertex, end))) = edge_data;
    }
    for (const auto& [old_face, apex] : sides) {
        const HalfedgeHandle spoke = mesh.find_halfedge(vertex, apex);
        for (const HalfedgeHandle side : {spoke, mesh.opposite_halfedge_handle(spoke)}) {
            mesh.data(mesh.face_handle(side)) = mesh.data(old_face);
        }
    }
    return vertex;
}

}  // namespace couture::meshing
