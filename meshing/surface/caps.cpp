#include "meshing/surface/caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "iga/core/error.h"

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

}  // namespace couture::meshing
