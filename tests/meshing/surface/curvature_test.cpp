#include "meshing/surface/curvature.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/features.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double pi = std::numbers::pi;

struct TorusError {
    double minimum = 0.0;
    double maximum = 0.0;
    double direction = 0.0;
};

// Mean deviation from the curvatures of the smooth torus (1 / tube, cos / ring) over all vertices.
TorusError torus_error(int n, double radius) {
    const double ring = 2.0;
    const double tube = 0.8;
    const int n_tube = n;
    const int n_around = 2 * n;
    const SurfaceMesh mesh = make_surface_mesh(make_torus(n_around, n_tube, ring, tube));
    const auto curvatures = principal_curvatures(mesh, {.radius = radius});
    TorusError error;
    for (const auto vertex : mesh.vertices()) {
        const double angle = 2.0 * pi * (vertex.idx() % n_tube) / n_tube;
        const double around = 2.0 * pi * (vertex.idx() / n_tube) / n_around;
        const PrincipalCurvatures& at = curvatures[vertex.idx()];
        const double expected = std::cos(angle) / (ring + tube * std::cos(angle));
        error.minimum += std::abs(at.minimum - expected);
        error.maximum += std::abs(at.maximum - 1.0 / tube);
        const Vector3 along(-std::sin(around), std::cos(around), 0.0);
        error.direction += 1.0 - std::abs(at.minimum_direction.dot(along));
    }
    const auto n_vertices = static_cast<double>(mesh.n_vertices());
    return {error.minimum / n_vertices, error.maximum / n_vertices, error.direction / n_vertices};
}

}  // namespace

TEST_CASE("Curvature: corners of a cube hold pi/2 each, all else is flat", "[meshing][surface]") {
    const SurfaceMesh mesh = make_surface_mesh(make_cube(4));
    const auto curvature = gaussian_curvature(mesh);
    int n_corners = 0;
    for (const auto vertex : mesh.vertices()) {
        const double K = curvature[vertex.idx()];
        const Vector3& x = mesh.point(vertex);
        const bool is_corner = ((x.array() == 0.0) || (x.array() == 1.0)).all();
        REQUIRE(K == Approx(is_corner ? pi / 2 : 0.0).margin(1e-14));
        if (!is_corner) {
            REQUIRE(classify_curvature(K) == CurvatureClass::euclidean);
            continue;
        }
        ++n_corners;
        REQUIRE(classify_curvature(K) == CurvatureClass::spherical);
        REQUIRE(expected_index(classify_curvature(K)) == 1);
    }
    REQUIRE(n_corners == 8);
    for (const double k : geodesic_curvature(mesh)) REQUIRE(k == 0.0);
}

TEST_CASE("Curvature: inner corners of a plate with holes are hyperbolic and indices sum to 4 chi",
          "[meshing][surface]") {
    for (const int genus : {1, 2, 3}) {
        const SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(genus, 2));
        int n_hyperbolic = 0;
        int sum = 0;
        for (const double K : gaussian_curvature(mesh)) {
            const auto curvature_class = classify_curvature(K);
            n_hyperbolic += curvature_class == CurvatureClass::hyperbolic;
            sum += expected_index(curvature_class).value();
        }
        REQUIRE(n_hyperbolic == 8 * genus);
        REQUIRE(sum == 4 * (2 - 2 * genus));
    }
}

TEST_CASE("Curvature: a square's corners turn its boundary by pi/2 each", "[meshing][surface]") {
    const SurfaceMesh mesh = make_surface_mesh(make_square(3));
    for (const double K : gaussian_curvature(mesh)) REQUIRE(K == Approx(0.0).margin(1e-14));
    const auto curvature = geodesic_curvature(mesh);
    REQUIRE(std::accumulate(curvature.begin(), curvature.end(), 0.0) == Approx(2.0 * pi));
    for (const int corner : {0, 3, 12, 15}) REQUIRE(curvature[corner] == Approx(pi / 2));
}

TEST_CASE("Curvature: classes take the nearest of six values", "[meshing][surface]") {
    using enum CurvatureClass;
    const std::vector<std::pair<double, CurvatureClass>> cases{{2.0 * pi, sharp},
                                                               {1.3 * pi, sharp},
                                                               {1.2 * pi, spherical},
                                                               {0.5 * pi, spherical},
                                                               {0.26 * pi, spherical},
                                                               {0.25 * pi, euclidean},
                                                               {0.0, euclidean},
                                                               {-0.25 * pi, euclidean},
                                                               {-0.26 * pi, hyperbolic},
                                                               {-0.5 * pi, hyperbolic},
                                                               {-0.76 * pi, ultrahyperbolic},
                                                               {-pi, ultrahyperbolic},
                                                               {-1.6 * pi, solid_angle},
                                                               {-9.0 * pi, solid_angle}};
    for (const auto& [curvature, expected] : cases) {
        CAPTURE(curvature / pi);
        REQUIRE(to_string(classify_curvature(curvature)) == to_string(expected));
    }
    REQUIRE(expected_index(spherical) == 1);
    REQUIRE(expected_index(euclidean) == 0);
    REQUIRE(expected_index(hyperbolic) == -1);
    REQUIRE(expected_index(ultrahyperbolic) == -2);
    REQUIRE_FALSE(expected_index(sharp).has_value());
    REQUIRE_FALSE(expected_index(solid_angle).has_value());
}

TEST_CASE("Curvature: the tensor of a torus converges to the smooth one", "[meshing][surface]") {
    // Radius ~ sqrt(h): it shrinks while it holds more and more edges. The error goes with its
    // square, so that it halves each time.
    const TorusError coarse = torus_error(20, 0.8);
    const TorusError middle = torus_error(40, 0.56);
    const TorusError fine = torus_error(80, 0.4);
    CAPTURE(coarse.minimum, middle.minimum, fine.minimum);
    CAPTURE(coarse.maximum, middle.maximum, fine.maximum);
    REQUIRE(middle.minimum < 0.6 * coarse.minimum);
    REQUIRE(fine.minimum < 0.6 * middle.minimum);
    REQUIRE(middle.maximum < 0.75 * coarse.maximum);
    REQUIRE(fine.maximum < 0.75 * middle.maximum);
    REQUIRE(fine.minimum < 0.05);
    REQUIRE(fine.maximum < 0.02);
    REQUIRE(fine.direction < 1e-3);
}

TEST_CASE("Curvature: the tensor of a tube converges to 0 and 1 / radius", "[meshing][surface]") {
    const double tube_radius = 2.0;
    double last = 1.0;
    for (const int n : {24, 96}) {
        const SurfaceMesh mesh = make_surface_mesh(make_tube(n, n, tube_radius, 12.0));
        const double disc = 2.0 * std::sqrt(24.0 / n);
        const auto curvatures = principal_curvatures(mesh, {.radius = disc});
        double error = 0.0;
        for (const auto vertex : mesh.vertices()) {
            const double z = mesh.point(vertex).z();
            if (z < disc || z > 12.0 - disc) continue;
            const auto& at = curvatures[vertex.idx()];
            error =
                std::max({error, std::abs(at.maximum - 1.0 / tube_radius), std::abs(at.minimum)});
            REQUIRE(std::abs(at.minimum_direction.z()) > 0.99);
            const Vector3 radial(mesh.point(vertex).x(), mesh.point(vertex).y(), 0.0);
            REQUIRE(at.normal.dot(radial) > 0.99 * tube_radius);
        }
        CAPTURE(n, error);
        REQUIRE(error < 0.6 * last);
        last = error;
    }
    REQUIRE(last < 0.02);
}

TEST_CASE("Curvature: discs end at sharp edges", "[meshing][surface]") {
    const PartSurface part = make_part_surface("cylinder");
    SurfaceMesh mesh = make_surface_mesh(part.soup);
    static_cast<void>(detect_features(mesh));
    double radius = 0.0;
    for (const auto vertex : mesh.vertices()) {
        radius = std::max(radius, mesh.point(vertex).head<2>().norm());
    }
    const auto within = principal_curvatures(mesh);
    const auto across = principal_curvatures(mesh, {.crosses_features = true});
    // Between a flat end and the wall: one of both, not a mean of them and the rim.
    double largest_across = 0.0;
    for (const auto vertex : mesh.vertices()) {
        const auto& at = within[vertex.idx()];
        const bool is_wall = std::abs(at.normal.z()) < 0.5;
        REQUIRE(at.maximum == Approx(is_wall ? 1.0 / radius : 0.0).margin(0.1 / radius));
        REQUIRE(std::abs(at.minimum) < 0.1 / radius);
        if (is_wall) REQUIRE(std::abs(at.minimum_direction.z()) > 0.999);
        largest_across = std::max(largest_across, across[vertex.idx()].maximum);
    }
    REQUIRE(largest_across > 2.0 / radius);
}

TEST_CASE(
    "Curvature: principal frames are right-handed, curvatures scale with 1 / length and turn "
    "their signs with the surface",
    "[meshing][surface]") {
    TriangleSoup soup = make_torus(24, 16, 2.0, 0.8);
    const auto curvatures = principal_curvatures(make_surface_mesh(soup));
    for (auto& point : soup.points) point *= 4.0;
    const auto scaled = principal_curvatures(make_surface_mesh(soup));
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    const auto turned = principal_curvatures(make_surface_mesh(soup));
    for (std::size_t i = 0; i < curvatures.size(); ++i) {
        const auto& at = curvatures[i];
        REQUIRE((at.minimum_direction.cross(at.maximum_direction) - at.normal).norm() < 1e-12);
        REQUIRE(at.minimum <= at.maximum);
        REQUIRE(at.mean() == Approx(0.5 * (at.minimum + at.maximum)));
        REQUIRE(at.gaussian() == Approx(at.minimum * at.maximum));
        REQUIRE(scaled[i].minimum == Approx(at.minimum / 4.0).margin(1e-10));
        REQUIRE(scaled[i].maximum == Approx(at.maximum / 4.0).margin(1e-10));
        REQUIRE(turned[i].minimum == Approx(-scaled[i].maximum).margin(1e-10));
        REQUIRE((turned[i].normal + scaled[i].normal).norm() < 1e-10);
    }
}

TEST_CASE("Curvature: radii must be positive", "[meshing][surface]") {
    const SurfaceMesh mesh = make_surface_mesh(make_tetrahedron());
    REQUIRE_THROWS_AS(principal_curvatures(mesh, {.radius = 0.0}), InputError);
    REQUIRE_THROWS_WITH(principal_curvatures(mesh, {.radius = -2.0}),
                        "principal_curvatures: the radius of the disc is -2; it must be positive");
    REQUIRE_THROWS_WITH(
        principal_curvatures(mesh, {.radius = std::nullopt, .edges_per_radius = 0.0}),
        "principal_curvatures: 0 edge lengths per radius; the number must be positive");
}
