#include "meshing/surface/caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "iga/core/error.h"
#include "meshing/surface/hole_filling.h"

namespace couture::meshing {

namespace {

// Squared distance from x to a triangle.
double squared_distance(const Vector3& x, const std::array<Vector3, 3>& corners) {
    const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    bool is_above = normal.squaredNorm() > 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vector3& a = corners[k];
        const Vector3 along = corners[(k + 1) % 3] - a;
        is_above = is_above && normal.cross(along).dot(x - a) >= 0.0;
        const double length = along.squaredNorm();
        const double t = length > 0.0 ? std::clamp((x - a).dot(along) / length, 0.0, 1.0) : 0.0;
        least = std::min(least, (x - a - t * along).squaredNorm());
    }
    if (!is_above) return least;
    const double height = normal.dot(x - corners[0]);
    return std::min(least, height * height / normal.squaredNorm());
}

void check_cap(const Features& features, const Cap& cap) {
    const int n = static_cast<int>(features.regions.size());
    if (cap.region < 0 || cap.region >= n) {
        throw InputError("cap '{}': there is no face {}; there are {} smooth faces", cap.name,
                         cap.region, n);
    }
    const FeatureRegion& region = features.regions[cap.region];
    const Vector3& x = region.centroid;
    if (!region.is_planar) {
        throw TopologyError(
            "cap '{}': the face around ({:.6g}, {:.6g}, {:.6g}) is not plane; only plane faces can "
            "be opened{}",
            cap.name, x.x(), x.y(), x.z(),
            features.regions.size() == 1
                ? " (no edge is sharp enough to bound a face: take a smaller feature angle)"
                : "");
    }
    if (!region.is_disc()) {
        throw TopologyError(
            "cap '{}': the plane face around ({:.6g}, {:.6g}, {:.6g}) has {} boundary loops; a cap "
            "has one",
            cap.name, x.x(), x.y(), x.z(), region.n_loops);
    }
}

// The vertices between the two old ends of a boundary edge that was split, by these ends in the
// direction of the triangles that close the boundary.
using RimSplits = std::map<std::pair<int, int>, std::vector<int>>;

RimSplits rim_splits(const SurfaceMesh& opened, int n_old) {
    RimSplits splits;
    for (const auto h : opened.halfedges()) {
        if (!opened.is_boundary(h) || opened.from_vertex_handle(h).idx() >= n_old) continue;
        std::vector<int> between;
        HalfedgeHandle last = h;
        while (opened.to_vertex_handle(last).idx() >= n_old) {
            between.push_back(opened.to_vertex_handle(last).idx());
            last = opened.next_halfedge_handle(last);
        }
        if (between.empty()) continue;
        splits[{opened.from_vertex_handle(h).idx(), opened.to_vertex_handle(last).idx()}] =
            std::move(between);
    }
    return splits;
}

// A triangle, divided where its edges were.
void add_split(const std::array<int, 3>& triangle, RimSplits& splits,
               std::vector<std::array<int, 3>>& triangles) {
    for (int k = 0; k < 3; ++k) {
        const auto [a, b, c] =
            std::array{triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]};
        const auto split = splits.find({a, b});
        if (split == splits.end()) continue;
        const int first = split->second.front();
        std::vector<int> rest(split->second.begin() + 1, split->second.end());
        splits.erase(split);
        if (!rest.empty()) splits[{first, b}] = std::move(rest);
        add_split({a, first, c}, splits, triangles);
        add_split({first, b, c}, splits, triangles);
        return;
    }
    triangles.push_back(triangle);
}

}  // namespace

int region_near(const SurfaceMesh& mesh, const Vector3& x) {
    double least = std::numeric_limits<double>::infinity();
    int region = -1;
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        const double distance = squared_distance(x, {mesh.point(a), mesh.point(b), mesh.point(c)});
        if (distance < least) {
            least = distance;
            region = mesh.data(face).region;
        }
    }
    return region;
}

std::vector<int> regions_facing(const Features& features, const Vector3& direction, double angle) {
    if (!direction.allFinite() || direction.norm() == 0.0) {
        throw InputError("caps: direction ({}, {}, {}); it must be finite and have a length",
                         direction.x(), direction.y(), direction.z());
    }
    std::vector<int> regions;
    for (std::size_t r = 0; r < features.regions.size(); ++r) {
        const FeatureRegion& region = features.regions[r];
        if (!region.is_planar || !region.is_disc()) continue;
        if (region.normal.dot(direction.normalized()) >= std::cos(angle)) {
            regions.push_back(static_cast<int>(r));
        }
    }
    return regions;
}

OpenedSurface open_caps(const SurfaceMesh& mesh, const Features& features,
                        std::span<const Cap> caps) {
    std::vector<int> cap_of_region(features.regions.size(), -1);
    for (std::size_t c = 0; c < caps.size(); ++c) {
        check_cap(features, caps[c]);
        int& known = cap_of_region[caps[c].region];
        if (known >= 0) {
            throw InputError("caps '{}' and '{}' are the same face; name it once", caps[known].name,
                             caps[c].name);
        }
        known = static_cast<int>(c);
    }
    std::vector<int> cap_of_vertex(mesh.n_vertices(), -1);
    for (std::size_t c = 0; c < caps.size(); ++c) {
        for (const FaceHandle face : features.regions[caps[c].region].faces) {
            for (const VertexHandle vertex : face_vertices(mesh, face)) {
                const Vector3& x = mesh.point(vertex);
                int& known = cap_of_vertex[vertex.idx()];
                if (mesh.is_boundary(vertex)) {
                    throw TopologyError(
                        "cap '{}' touches the boundary of the surface at ({:.6g}, {:.6g}, {:.6g})",
                        caps[c].name, x.x(), x.y(), x.z());
                }
                if (known >= 0 && known != static_cast<int>(c)) {
                    throw TopologyError(
                        "caps '{}' and '{}' touch at ({:.6g}, {:.6g}, {:.6g}); open one of them",
                        caps[known].name, caps[c].name, x.x(), x.y(), x.z());
                }
                known = static_cast<int>(c);
            }
        }
    }
    OpenedSurface opened;
    std::vector<int> number(mesh.n_vertices(), -1);
    for (const auto face : mesh.faces()) {
        const int region = mesh.data(face).region;
        if (region >= 0 && cap_of_region[region] >= 0) continue;
        auto& triangle = opened.soup.triangles.emplace_back();
        opened.triangles.push_back(face.idx());
        const auto vertices = face_vertices(mesh, face);
        for (int k = 0; k < 3; ++k) {
            int& n = number[vertices[k].idx()];
            if (n < 0) {
                n = static_cast<int>(opened.soup.points.size());
                opened.soup.points.push_back(mesh.point(vertices[k]));
                opened.vertices.push_back(vertices[k].idx());
                opened.cap_of_vertex.push_back(cap_of_vertex[vertices[k].idx()]);
            }
            triangle[k] = n;
        }
    }
    if (opened.soup.triangles.empty()) {
        throw TopologyError("caps: nothing is left of the surface when all {} are opened",
                            caps.size());
    }
    return opened;
}

ClosingCaps caps_of(const SurfaceMesh& closed, const OpenedSurface& opened) {
    ClosingCaps caps;
    caps.n_vertices = static_cast<int>(opened.vertices.size());
    std::vector<int> number(closed.n_vertices(), -1);
    for (int v = 0; v < caps.n_vertices; ++v) number[opened.vertices[v]] = v;
    std::vector<bool> is_kept(closed.n_faces(), false);
    for (const int triangle : opened.triangles) is_kept[triangle] = true;
    for (const auto face : closed.faces()) {
        if (is_kept[face.idx()]) continue;
        auto& triangle = caps.triangles.emplace_back();
        const auto vertices = face_vertices(closed, face);
        for (int k = 0; k < 3; ++k) {
            int& n = number[vertices[k].idx()];
            if (n < 0) {
                n = caps.n_vertices + static_cast<int>(caps.points.size());
                caps.points.push_back(closed.point(vertices[k]));
            }
            triangle[k] = n;
        }
    }
    return caps;
}

ClosingCaps fill_boundaries(const SurfaceMesh& surface) {
    ClosingCaps caps;
    caps.n_vertices = static_cast<int>(surface.n_vertices());
    std::vector<bool> is_seen(surface.n_halfedges(), false);
    for (const auto start : surface.halfedges()) {
        if (!surface.is_boundary(start) || is_seen[start.idx()]) continue;
        // The way of a boundary halfedge has what fills the loop on its left.
        std::vector<int> rim;
        std::vector<Vector3> points;
        for (HalfedgeHandle h = start; !is_seen[h.idx()]; h = surface.next_halfedge_handle(h)) {
            is_seen[h.idx()] = true;
            rim.push_back(surface.from_vertex_handle(h).idx());
            points.push_back(surface.point(surface.from_vertex_handle(h)));
        }
        const auto triangles = fill_loop(points);
        if (triangles.empty()) {
            throw TopologyError(
                "caps: the boundary loop of {} vertices at ({:.6g}, {:.6g}, {:.6g}) can't be "
                "filled",
                rim.size(), points[0].x(), points[0].y(), points[0].z());
        }
        for (const auto& [a, b, c] : triangles) caps.triangles.push_back({rim[a], rim[b], rim[c]});
    }
    return caps;
}

SurfaceMesh close_caps(const SurfaceMesh& opened, const ClosingCaps& caps) {
    TriangleSoup soup = to_soup(opened);
    const int behind = static_cast<int>(soup.points.size());
    soup.points.insert(soup.points.end(), caps.points.begin(), caps.points.end());
    RimSplits splits = rim_splits(opened, caps.n_vertices);
    for (auto triangle : caps.triangles) {
        for (int& v : triangle) {
            if (v >= caps.n_vertices) v += behind - caps.n_vertices;
        }
        add_split(triangle, splits, soup.triangles);
    }
    SurfaceMesh closed = make_surface_mesh(soup);
    for (const auto v : closed.vertices()) {
        if (!closed.is_boundary(v)) continue;
        const Vector3& x = closed.point(v);
        throw TopologyError("caps: the surface stays open at ({:.6g}, {:.6g}, {:.6g})", x.x(),
                            x.y(), x.z());
    }
    return closed;
}

}  // namespace couture::meshing
