#include "meshing/topology/shells.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

TriangleSoup scaled(TriangleSoup soup, double factor, const Vector3& shift) {
    for (auto& point : soup.points) point = factor * point + shift;
    return soup;
}

TriangleSoup reversed(TriangleSoup soup) {
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return soup;
}

}  // namespace

TEST_CASE("Shells: a ball, a torus and a plate are solids without cavities",
          "[meshing][topology]") {
    const Solid cube = make_solid(make_cube(2));
    REQUIRE(cube.shells.size() == 1);
    REQUIRE(cube.volume == Approx(1.0));
    REQUIRE(cube.betti == std::array{1, 0, 0});
    REQUIRE_FALSE(cube.shells[0].is_reversed);
    REQUIRE(make_solid(reversed(make_cube(2))).shells[0].is_reversed);
    const Solid plate = make_solid(make_plate_with_holes(3, 2));
    REQUIRE(plate.betti == std::array{1, 3, 0});
    REQUIRE(plate.euler_characteristic == -2);
}

TEST_CASE("Shells: nested shells are cavities, whichever way they turn and come",
          "[meshing][topology]") {
    const TriangleSoup outer = scaled(make_cube(2), 10.0, Vector3(-5, -5, -5));
    const TriangleSoup ring = make_torus(12, 8, 2.0, 0.7);
    const TriangleSoup box = scaled(make_cube(1), 1.0, Vector3(3, 3, 3));
    const Solid solid = make_solid(join(join(reversed(ring), outer), box));
    REQUIRE(solid.shells.size() == 3);
    REQUIRE_FALSE(solid.shells[0].is_cavity);
    REQUIRE(solid.shells[0].triangles.front() == static_cast<int>(ring.triangles.size()));
    REQUIRE(solid.shells[0].volume == Approx(1000.0));
    REQUIRE(solid.shells[1].is_cavity);
    REQUIRE(solid.shells[1].genus == 1);
    REQUIRE_FALSE(solid.shells[1].is_reversed);
    REQUIRE(solid.shells[2].is_reversed);
    REQUIRE(solid.betti == std::array{1, 1, 2});
    // chi = b0 - b1 + b2.
    REQUIRE(solid.euler_characteristic == 2);
    REQUIRE(solid.volume == Approx(1000.0 - 1.0 - solid.shells[1].volume));
}

TEST_CASE("Shells: winding numbers are those of inside and outside", "[meshing][topology]") {
    const TriangleSoup torus = make_torus(12, 8, 2.0, 0.7);
    REQUIRE(winding_number(torus, Vector3(2, 0, 0)) == Approx(1.0));
    REQUIRE(winding_number(torus, Vector3(0, 0, 0)) == Approx(0.0).margin(1e-12));
    REQUIRE(winding_number(reversed(torus), Vector3(0, 2, 0.1)) == Approx(-1.0));
    const TriangleSoup cube = make_cube(1);
    REQUIRE(winding_number(cube, Vector3(0.3, 0.4, 1.0)) == Approx(0.5));
}

TEST_CASE("Shells: what is not one solid is refused", "[meshing][topology]") {
    const TriangleSoup cube = make_cube(2);
    const TriangleSoup apart = join(cube, scaled(cube, 0.5, Vector3(3, 0, 0)));
    REQUIRE_THROWS_AS(make_solid(apart), TopologyError);
    REQUIRE_THROWS_WITH(make_solid(apart), Catch::Contains("centre (3.25, 0.25, 0.25)") &&
                                               Catch::Contains("lies outside"));
    // Inside the bounding box, but in the hole.
    const TriangleSoup in_hole =
        join(make_torus(12, 8, 2.0, 0.7), scaled(cube, 0.2, Vector3(0, 0, 0)));
    REQUIRE_THROWS_WITH(make_solid(in_hole), Catch::Contains("lies outside"));
    const TriangleSoup island =
        join(join(scaled(cube, 10.0, Vector3(0, 0, 0)), scaled(cube, 5.0, Vector3(2, 2, 2))),
             scaled(cube, 1.0, Vector3(4, 4, 4)));
    REQUIRE_THROWS_AS(make_solid(island), TopologyError);
    REQUIRE_THROWS_WITH(make_solid(island), Catch::Contains("lies in the cavity of"));
    REQUIRE_THROWS_AS(make_solid(make_tube(6, 2, 1.0, 1.0)), TopologyError);
    REQUIRE_THROWS_WITH(make_solid(make_tube(6, 2, 1.0, 1.0)), Catch::Contains("has 1 triangles;"));
    TriangleSoup turned = cube;
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    REQUIRE_THROWS_WITH(make_solid(turned), Catch::Contains("in the same direction"));
    REQUIRE_THROWS_WITH(make_solid({}), Catch::Contains("there are no triangles"));
    REQUIRE_THROWS_AS(make_solid(scaled(cube, 0.0, Vector3(1, 1, 1))), GeometryError);
    REQUIRE_THROWS_WITH(make_solid(scaled(cube, 0.0, Vector3(1, 1, 1))),
                        Catch::Contains("must enclose some"));
    // A cavity that breaks out through the corner of the torus' box stays inside the box.
    const TriangleSoup crossing =
        join(make_torus(16, 12, 2.0, 0.7), scaled(cube, 0.6, Vector3(1.2, -0.3, -0.3)));
    REQUIRE_THROWS_AS(make_solid(crossing), GeometryError);
    REQUIRE_THROWS_WITH(make_solid(crossing), Catch::Contains("crosses or touches"));
    // Two tetrahedra with one vertex in common.
    TriangleSoup pinched = join(make_tetrahedron(), make_tetrahedron());
    for (std::size_t i = 4; i < 8; ++i)
        pinched.points[i] = 2.0 * pinched.points[0] - pinched.points[i];
    for (std::size_t t = 4; t < 8; ++t) {
        for (int& v : pinched.triangles[t]) v = v == 4 ? 0 : v;
        std::swap(pinched.triangles[t][0], pinched.triangles[t][1]);
    }
    REQUIRE_THROWS_WITH(make_solid(pinched), Catch::Contains("touch at a vertex"));
}
