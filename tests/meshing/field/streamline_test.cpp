#include "meshing/field/streamline.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double rounding = 1e-9;

// The cross of each face along a vector.
DirectionField field_along(const SurfaceMesh& mesh, const Vector3& vector) {
    const FaceFrames frames(mesh);
    std::vector<double> angles;
    for (const FaceHandle face : mesh.faces()) angles.push_back(frames.angle_of(face, vector));
    return field_of_angles(mesh, std::move(angles), 4);
}

double length_of(const std::vector<Vector3>& points) {
    double length = 0.0;
    for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
    return length;
}

}  // namespace

TEST_CASE("streamline: straight along a tube, in a ring around it", "[field]") {
    const SurfaceMesh tube = make_surface_mesh(make_tube(24, 6, 1.0, 3.0));
    const FaceFrames frames(tube);
    const DirectionField field = field_along(tube, Vector3::UnitZ());
    const FaceHandle start(20);
    const Vector3 center = tube.calc_face_centroid(start);
    // Up to the boundary.
    const auto up = trace_streamline(tube, frames, field, start, 0, 100.0);
    CHECK(up.back().z() == Approx(3.0));
    for (const Vector3& p : up) {
        CHECK((p - center).head<2>().norm() < rounding);
    }
    // A ring of 24 chords: it comes back to where it began.
    const double ring = 24.0 * 2.0 * std::sin(std::acos(-1.0) / 24.0);
    const auto around = trace_streamline(tube, frames, field, start, 1, ring);
    CHECK(length_of(around) == Approx(ring));
    CHECK((around.back() - center).norm() < 1e-6);
    const auto half = trace_streamline(tube, frames, field, start, 5, 0.5 * ring);
    CHECK(half.back().z() == Approx(center.z()));
    CHECK((half.back().head<2>() + center.head<2>()).norm() < 1e-6);
}
