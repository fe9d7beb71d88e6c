#include "meshing/surface/planar_map.h"

#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "meshing/surface/harmonic_map.h"
#include "tests/meshing/surface/map_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

PlanarMap map_of(CutSurface& surface, int n) {
    auto parameters =
        map_disc_to_polygon(surface, square_corner_vertices(n), square_corners()).parameters;
    return {surface, std::move(parameters)};
}

}  // namespace

TEST_CASE("PlanarMap: locating is the inverse of the map", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(20, 0.5));
    const PlanarMap map = map_of(surface, 20);
    std::mt19937 generator(5);
    for (int i = 0; i < 2000; ++i) {
        const Vector2 point(generator() / 4294967296.0, generator() / 4294967296.0);
        const auto place = map.locate(point);
        REQUIRE(place);
        REQUIRE(place->weights.minCoeff() >= 0.0);
        REQUIRE(place->weights.sum() == Approx(1.0));
        REQUIRE((map.parameters_at(*place) - point).norm() < 1e-14);
    }
    // And the other way round: from places on the surface.
    for (int f = 0; f < surface.n_faces(); ++f) {
        const MapPoint place{f, {0.2, 0.3, 0.5}};
        const auto found = map.locate(map.parameters_at(place));
        REQUIRE(found);
        REQUIRE(found->face == f);
        REQUIRE((map.point(*found) - map.point(place)).norm() < 1e-10);
    }
}

TEST_CASE("PlanarMap: vertices and boundary points are found exactly", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(12, 0.5));
    const PlanarMap map = map_of(surface, 12);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        const auto place = map.locate(map.parameters()[v]);
        REQUIRE(place);
        REQUIRE(place->weights.maxCoeff() == 1.0);
        REQUIRE(map.point(*place) == surface.point(v));
        // Of the triangles at the vertex the first one.
        int first = surface.n_faces();
        for (int h = 0; h < surface.n_halfedges(); ++h) {
            if (surface.origin(h) == v) first = std::min(first, CutSurface::face(h));
        }
        REQUIRE(place->face == first);
    }
    for (int i = 0; i <= 40; ++i) {
        const double t = i / 40.0;
        for (const Vector2& point :
             {Vector2(t, 0.0), Vector2(1.0, t), Vector2(t, 1.0), Vector2(0.0, t)}) {
            const auto place = map.locate(point);
            REQUIRE(place);
            REQUIRE(place->weights.minCoeff() == 0.0);
        }
    }
}

TEST_CASE("PlanarMap: nothing outside, the nearest place within the tolerance",
          "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(6, 0.5));
    const PlanarMap map = map_of(surface, 6);
    CHECK_FALSE(map.locate({1.01, 0.5}));
    CHECK_FALSE(map.locate({1.01, 0.5}, 0.0099));
    const auto place = map.locate({1.01, 0.37}, 0.0101);
    REQUIRE(place);
    CHECK((map.parameters_at(*place) - Vector2(1.0, 0.37)).norm() < 1e-14);
    const auto corner = map.locate({-0.003, -0.004}, 0.00501);
    REQUIRE(corner);
    CHECK(map.parameters_at(*corner) == Vector2(0.0, 0.0));
    CHECK_FALSE(map.locate({std::nan(""), 0.5}, 1.0));
    CHECK((map.point_at({1.0 + 1e-13, 0.5}) - map.point_at({1.0, 0.5})).norm() < 1e-12);
}

TEST_CASE("PlanarMap: errors say what is wrong", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(4, 0.5));
    const PlanarMap map = map_of(surface, 4);
    REQUIRE_THROWS_WITH(map.point_at({2.0, 0.5}),
                        "PlanarMap: (2, 0.5) lies outside the map, whose bounding box is [0, 1] x "
                        "[0, 1]");
    REQUIRE_THROWS_WITH(PlanarMap(surface, std::vector<Vector2>(3)),
                        "PlanarMap: 3 parameters for 25 vertices; each vertex needs one");
    REQUIRE_THROWS_WITH(PlanarMap(CutSurface(), {}).point_at({0.0, 0.0}),
                        "PlanarMap: the map has no triangles");
}
