#include "meshing/field/streamline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace couture::meshing {

namespace {

// Where a straight line leaves a face.
struct Exit {
    HalfedgeHandle halfedge;
    double distance = std::numeric_limits<double>::infinity();
};

Exit find_exit(const SurfaceMesh& mesh, FaceHandle face, const Vector3& from,
               const Vector3& direction) {
    const Vector3 normal = face_normal(mesh, face);
    Exit exit;
    for (const HalfedgeHandle h : mesh.fh_range(face)) {
        const Vector3& a = mesh.point(mesh.from_vertex_handle(h));
        const Vector3 outwards = (mesh.point(mesh.to_vertex_handle(h)) - a).cross(normal);
        const double speed = direction.dot(outwards);
        if (!(speed > 0.0)) continue;
        const double distance = std::max((a - from).dot(outwards) / speed, 0.0);
        if (distance < exit.distance) exit = {h, distance};
    }
    return exit;
}

}  // namespace

std::vector<Vector3> trace_streamline(const SurfaceMesh& mesh, const FaceFrames& frames,
                                      const DirectionField& field, FaceHandle face, int direction,
                                      double length) {
    const double part = 2.0 * std::numbers::pi / field.symmetry;
    double angle = field.angles[face.idx()] + part * direction;
    std::vector<Vector3> points{mesh.calc_face_centroid(face)};
    HalfedgeHandle entered;
    while (length > 0.0 && points.size() <= mesh.n_faces()) {
        const Vector3 along = frames.direction(face, angle);
        const Exit exit = find_exit(mesh, face, points.back(), along);
        if (!exit.halfedge.is_valid() || exit.halfedge == entered) break;
        const double step = std::min(length, exit.distance);
        points.emplace_back(points.back() + step * along);
        length -= step;
        entered = mesh.opposite_halfedge_handle(exit.halfedge);
        if (mesh.is_boundary(entered)) break;
        face = mesh.face_handle(entered);
        const double carried = angle + frames.rotation(exit.halfedge);
        const double own = field.angles[face.idx()];
        angle = own + part * std::round((carried - own) / part);
    }
    return points;
}

}  // namespace couture::meshing
