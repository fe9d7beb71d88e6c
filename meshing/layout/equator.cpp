#include "meshing/layout/equator.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "meshing/topology/traced_loop.h"

namespace couture::meshing {

namespace {

// Points of the section that the path is led by, and how near to it, by the diagonal.
constexpr std::size_t n_guides = 24;
constexpr double guide_width = 0.02;

struct Plane {
    Vector3 centre;
    Vector3 normal;

    [[nodiscard]] double height(const Vector3& x) const { return (x - centre).dot(normal); }
};

Vector3 centroid(const SurfaceMesh& mesh, FaceHandle face) {
    const auto [a, b, c] = face_vertices(mesh, face);
    return (mesh.point(a) + mesh.point(b) + mesh.point(c)) / 3.0;
}

// Triangles count as their centroids.
Plane middle_plane(const SurfaceMesh& mesh) {
    double area = 0.0;
    Vector3 moment = Vector3::Zero();
    for (const auto face : mesh.faces()) {
        area += face_area(mesh, face);
        moment += face_area(mesh, face) * centroid(mesh, face);
    }
    const Vector3 centre = moment / area;
    Matrix<3, 3> spread = Matrix<3, 3>::Zero();
    for (const auto face : mesh.faces()) {
        const Vector3 arm = centroid(mesh, face) - centre;
        spread += face_area(mesh, face) * arm * arm.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> axes(spread);
    return {centre, axes.eigenvectors().col(2)};
}

// Whether a halfedge goes from below the plane to above it.
bool rises(const SurfaceMesh& mesh, const Plane& plane, HalfedgeHandle h) {
    return plane.height(mesh.point(mesh.from_vertex_handle(h))) < 0.0 &&
           plane.height(mesh.point(mesh.to_vertex_handle(h))) >= 0.0;
}

// Where the plane cuts the edges around the section that passes a halfedge which rises.
std::vector<Vector3> section_from(const SurfaceMesh& mesh, const Plane& plane, HalfedgeHandle start,
                                  std::set<int>& is_seen) {
    std::vector<Vector3> points;
    HalfedgeHandle h = start;
    do {
        is_seen.insert(h.idx());
        const Vector3& low = mesh.point(mesh.from_vertex_handle(h));
        const Vector3& high = mesh.point(mesh.to_vertex_handle(h));
        const double t = plane.height(low) / (plane.height(low) - plane.height(high));
        points.push_back(low + t * (high - low));
        // The triangle on the left sinks through the plane over another of its sides.
        const HalfedgeHandle next = mesh.next_halfedge_handle(h);
        const HalfedgeHandle over_next = mesh.opposite_halfedge_handle(next);
        h = rises(mesh, plane, over_next)
                ? over_next
                : mesh.opposite_halfedge_handle(mesh.next_halfedge_handle(next));
    } while (h != start);
    return points;
}

double closed_length(const std::vector<Vector3>& points) {
    double length = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        length += (points[(k + 1) % points.size()] - points[k]).norm();
    }
    return length;
}

// Points of a closed polyline at even distances along it.
std::vector<Vector3> spread_evenly(const std::vector<Vector3>& points, std::size_t n) {
    const double step = closed_length(points) / static_cast<double>(n);
    std::vector<Vector3> even;
    double passed = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vector3 along = points[(k + 1) % points.size()] - points[k];
        const double length = along.norm();
        while (even.size() < n && static_cast<double>(even.size()) * step < passed + length) {
            even.push_back(points[k] +
                           (static_cast<double>(even.size()) * step - passed) / length * along);
        }
        passed += length;
    }
    return even;
}

}  // namespace

SurfaceCurve trace_equator(SurfaceMesh& mesh) {
    const Plane plane = middle_plane(mesh);
    std::set<int> is_seen;
    std::vector<Vector3> longest;
    for (const auto h : mesh.halfedges()) {
        if (is_seen.contains(h.idx()) || !rises(mesh, plane, h)) continue;
        std::vector<Vector3> section = section_from(mesh, plane, h, is_seen);
        if (closed_length(section) > closed_length(longest)) longest = std::move(section);
    }
    return trace_loop(mesh, {spread_evenly(longest, n_guides), {}},
                      guide_width * bounding_box_diagonal(mesh));
}

}  // namespace couture::meshing
