#include "meshing/parameterization/sample_quality.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "meshing/field/face_frames.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// One quad of n x n square cells on the unit square.
LayoutSamples square_grid(int n) {
    LayoutSamples samples;
    samples.layout = QuadLayout(4, {{0, 1, 2, 3}}, {"a", "b", "c", "d"});
    samples.n_cells.assign(4, n);
    MatrixX& points = samples.quads.emplace_back(3, (n + 1) * (n + 1));
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            points.col(j * (n + 1) + i) =
                Vector3(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0);
        }
    }
    return samples;
}

}  // namespace

TEST_CASE("angle of quads to a field: on a plane that by which the field is turned",
          "[parameterization]") {
    const double turn = GENERATE(0.0, 0.2, 0.7, -0.5, 1.4);
    const SurfaceMesh mesh = make_surface_mesh(make_square(5));
    const FaceFrames frames(mesh);
    std::vector<double> angles;
    for (const FaceHandle face : mesh.faces()) {
        angles.push_back(frames.angle_of(face, Vector3(std::cos(turn), std::sin(turn), 0.0)));
    }
    const DirectionField field = field_of_angles(mesh, std::move(angles), 4);
    // Crosses repeat after a quarter turn.
    const double quarter = 0.5 * std::acos(-1.0);
    const double expected = std::min(std::abs(turn), quarter - std::abs(turn));
    CHECK(mean_angle_to_field(square_grid(3), mesh, field) == Approx(expected).margin(1e-12));
}

TEST_CASE("turned corners: the worst is found with its quad", "[parameterization]") {
    const SurfaceMesh mesh = make_surface_mesh(make_square(5));
    LayoutSamples samples = square_grid(4);
    CHECK_FALSE(worst_turned_corner(samples, mesh));
    // The middle point, pushed over its neighbour to the right.
    const Vector3 pushed(0.9, 0.5, 0.0);
    samples.quads[0].col(2 * 5 + 2) = pushed;
    const auto worst = worst_turned_corner(samples, mesh);
    REQUIRE(worst);
    CHECK(worst->quad == 0);
    CHECK((worst->place - pushed).norm() < 0.3);
    CHECK(samples.layout.quad_name(worst->quad) == "'a', 'b', 'c', 'd'");
}
