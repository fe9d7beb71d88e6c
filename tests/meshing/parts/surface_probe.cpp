#include "tests/meshing/parts/surface_probe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

double angle_between(const Vector3& a, const Vector3& b) {
    return degrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

Vector3 normal_of(const PartSurface& part, int triangle) {
    const auto& [a, b, c] = part.soup.triangles[triangle];
    const std::vector<Vector3>& x = part.soup.points;
    return (x[b] - x[a]).cross(x[c] - x[a]);
}

using Edge = std::pair<int, int>;

std::map<Edge, std::vector<int>> find_edges(const PartSurface& part) {
    std::map<Edge, std::vector<int>> edges;
    for (int t = 0; t < static_cast<int>(part.soup.triangles.size()); ++t) {
        const auto& triangle = part.soup.triangles[t];
        for (int k = 0; k < 3; ++k) {
            edges[std::minmax(triangle[k], triangle[(k + 1) % 3])].push_back(t);
        }
    }
    return edges;
}

std::map<Edge, int> feature_edges(const PartSurface& part) {
    std::map<Edge, int> count;
    for (const PartCurve& curve : part.feature_curves) {
        const std::size_t n = curve.vertices.size();
        for (std::size_t i = 0; i + (curve.is_closed ? 0 : 1) < n; ++i) {
            ++count[std::minmax(curve.vertices[i], curve.vertices[(i + 1) % n])];
        }
    }
    return count;
}

void measure_triangles(const PartSurface& part, SurfaceFigures& figures) {
    for (const auto& triangle : part.soup.triangles) {
        double smallest = 180.0;
        for (int k = 0; k < 3; ++k) {
            const Vector3& a = part.soup.points[triangle[k]];
            const Vector3& b = part.soup.points[triangle[(k + 1) % 3]];
            const Vector3& c = part.soup.points[triangle[(k + 2) % 3]];
            smallest = std::min(smallest, angle_between(b - a, c - a));
        }
        figures.smallest_angle = std::min(figures.smallest_angle, smallest);
        figures.part_below_15 += smallest < 15.0 ? 1.0 : 0.0;
        figures.part_below_25 += smallest < 25.0 ? 1.0 : 0.0;
    }
    figures.part_below_15 /= figures.n_triangles;
    figures.part_below_25 /= figures.n_triangles;
}

void measure_planes(const PartSurface& part, SurfaceFigures& figures) {
    std::map<int, int> first;
    for (int t = 0; t < figures.n_triangles; ++t) {
        const int face = part.face_of_triangle[t];
        if (part.faces[face].kind != PartFaceKind::plane) {
            continue;
        }
        const int base = first.try_emplace(face, t).first->second;
        const Vector3 normal = normal_of(part, base).normalized();
        const Vector3& origin = part.soup.points[part.soup.triangles[base][0]];
        for (const int v : part.soup.triangles[t]) {
            figures.largest_bulge = std::max(figures.largest_bulge,
                                             std::abs((part.soup.points[v] - origin).dot(normal)));
        }
    }
}

}  // namespace

SurfaceFigures measure(const PartSurface& part) {
    const SurfaceMesh mesh = make_surface_mesh(part.soup);
    for (const auto halfedge : mesh.halfedges()) {
        if (halfedge.is_boundary()) {
            throw TopologyError("measure: the surface has a boundary");
        }
    }
    for (const auto vertex : mesh.vertices()) {
        if (vertex.valence() == 0 || !mesh.is_manifold(vertex)) {
            throw TopologyError("measure: vertex {} is loose or not manifold", vertex.idx());
        }
    }
    SurfaceFigures figures;
    figures.n_triangles = static_cast<int>(mesh.n_faces());
    figures.euler_characteristic = static_cast<int>(mesh.n_vertices()) -
                                   static_cast<int>(mesh.n_edges()) +
                                   static_cast<int>(mesh.n_faces());
    figures.volume = signed_volume(mesh);
    measure_triangles(part, figures);
    measure_planes(part, figures);
    const std::map<Edge, std::vector<int>> edges = find_edges(part);
    const std::map<Edge, int> features = feature_edges(part);
    for (const auto& [edge, count] : features) {
        figures.n_wrong_feature_edges += count != 1 || !edges.contains(edge) ? 1 : 0;
    }
    DisjointSets regions(figures.n_triangles);
    for (const auto& [edge, triangles] : edges) {
        const double length = (part.soup.points[edge.first] - part.soup.points[edge.second]).norm();
        figures.mean_edge += length / static_cast<double>(edges.size());
        figures.longest_edge = std::max(figures.longest_edge, length);
        const double angle =
            angle_between(normal_of(part, triangles[0]), normal_of(part, triangles[1]));
        const bool is_between_faces =
            part.face_of_triangle[triangles[0]] != part.face_of_triangle[triangles[1]];
        const bool is_feature = features.contains(edge);
        figures.n_misplaced_edges += is_between_faces != is_feature ? 1 : 0;
        if (is_feature) {
            figures.smallest_at_features = std::min(figures.smallest_at_features, angle);
        } else {
            figures.largest_elsewhere = std::max(figures.largest_elsewhere, angle);
            regions.join(triangles[0], triangles[1]);
        }
    }
    std::set<int> roots;
    for (int t = 0; t < figures.n_triangles; ++t) {
        roots.insert(regions.find(t));
    }
    figures.n_regions = static_cast<int>(roots.size());
    return figures;
}

std::vector<std::string> names_of(const PartSurface& part) {
    std::vector<std::string> names;
    for (const PartFace& face : part.faces) {
        names.push_back(fmt::format("face {} {} {}", face.name, static_cast<int>(face.kind),
                                    face.is_cap ? "cap" : ""));
    }
    for (const PartCorner& corner : part.corners) {
        names.push_back("corner " + corner.name);
    }
    for (const PartCurve& curve : part.feature_curves) {
        names.push_back(
            fmt::format("curve {} {}", curve.name, curve.is_closed ? "closed" : "open"));
    }
    return names;
}

std::set<int> vertices_of_face(const PartSurface& part, const std::string& name) {
    std::set<int> vertices;
    for (std::size_t t = 0; t < part.soup.triangles.size(); ++t) {
        if (part.faces[part.face_of_triangle[t]].name == name) {
            vertices.insert(part.soup.triangles[t].begin(), part.soup.triangles[t].end());
        }
    }
    return vertices;
}

}  // namespace couture::meshing
