#include "meshing/field/face_frames.h"

#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

FaceFrames::FaceFrames(const SurfaceMesh& mesh)
    : angles_(mesh.n_halfedges(), 0.0),
      rotations_(mesh.n_halfedges(), 0.0),
      x_(mesh.n_faces()),
      y_(mesh.n_faces()) {
    for (const FaceHandle face : mesh.faces()) {
        const HalfedgeHandle h = mesh.halfedge_handle(face);
        x_[face.idx()] = mesh.calc_edge_vector(h).normalized();
        y_[face.idx()] = face_normal(mesh, face).cross(x_[face.idx()]);
        // By the angles of corners, so that sums around vertices agree with their curvature.
        const HalfedgeHandle next = mesh.next_halfedge_handle(h);
        const HalfedgeHandle last = mesh.next_halfedge_handle(next);
        angles_[next.idx()] = pi - corner_angle(mesh, next);
        angles_[last.idx()] = angles_[next.idx()] + pi - corner_angle(mesh, last);
    }
    for (const HalfedgeHandle h : mesh.halfedges()) {
        if (mesh.is_boundary(mesh.edge_handle(h))) continue;
        const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(h);
        const double rotation = angle(opposite) + pi - angle(h);
        rotations_[h.idx()] = rotation - 2.0 * pi * std::ceil((rotation - pi) / (2.0 * pi));
    }
}

Vector3 FaceFrames::direction(FaceHandle face, double angle) const {
    return std::cos(angle) * x_[face.idx()] + std::sin(angle) * y_[face.idx()];
}

double FaceFrames::angle_of(FaceHandle face, const Vector3& vector) const {
    return std::atan2(vector.dot(y_[face.idx()]), vector.dot(x_[face.idx()]));
}

}  // namespace couture::meshing
