#include "meshing/surface/harmonic_map.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/stl_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

template <typename Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

void require_one_to_one(const CutSurface& surface, const HarmonicMap& map) {
    REQUIRE(map.parameters.size() == static_cast<std::size_t>(surface.n_vertices()));
    REQUIRE(flipped_triangles(surface, map.parameters).empty());
    REQUIRE(map.report.distortion.smallest_area_ratio > 0.0);
}

double area_in_plane(const CutSurface& surface, const std::vector<Vector2>& parameters) {
    double area = 0.0;
    for (int f = 0; f < surface.n_faces(); ++f) {
        const auto [a, b, c] = surface.triangle(f);
        const Vector2 u = parameters[b] - parameters[a];
        const Vector2 v = parameters[c] - parameters[a];
        area += 0.5 * (u.x() * v.y() - u.y() * v.x());
    }
    return area;
}

}  // namespace

TEST_CASE("map_disc_to_polygon: a plane piece on its own outline stays as it is",
          "[meshing][surface]") {
    for (const unsigned seed : {1U, 2U, 3U}) {
        CutSurface surface(make_jittered_square(20, seed));
        const HarmonicMap map =
            map_disc_to_polygon(surface, square_corner_vertices(20), square_corners());
        require_one_to_one(surface, map);
        CHECK(map.report.route == MapRoute::mean_value);
        for (int v = 0; v < surface.n_vertices(); ++v) {
            const Vector2 expected(surface.point(v).x(), surface.point(v).y());
            // Rounding of 400 unknowns.
            REQUIRE((map.parameters[v] - expected).norm() < 1e-12);
        }
        CHECK(map.report.distortion.largest_angle_change < 1e-9);
        CHECK(map.report.distortion.largest_area_ratio == Approx(1.0));
        CHECK(map.report.n_flipped_mean_value == 0);
        CHECK(map.report.n_flipped_uniform == -1);
        CHECK(map.report.residual < 1e-14);
    }
}

TEST_CASE("map_disc_to_polygon: sides by arc length, area filled once", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(16, 0.5));
    const auto corners = square_corner_vertices(16);
    const HarmonicMap map = map_disc_to_polygon(surface, corners, rectangle_corners(3.0, 2.0));
    require_one_to_one(surface, map);
    CHECK(area_in_plane(surface, map.parameters) == Approx(6.0));
    // Along the lower side x is proportional to the length.
    double length = 0.0;
    for (int i = 0; i < 16; ++i) length += (surface.point(i + 1) - surface.point(i)).norm();
    double along = 0.0;
    for (int i = 0; i <= 16; ++i) {
        CHECK(map.parameters[i].x() == Approx(3.0 * along / length).margin(1e-13));
        CHECK(map.parameters[i].y() == 0.0);
        if (i < 16) along += (surface.point(i + 1) - surface.point(i)).norm();
    }
}

TEST_CASE("map_disc_to_polygon: any convex polygon, any weights", "[meshing][surface]") {
    for (const int n : {3, 5, 8}) {
        for (const auto weights : {HarmonicWeights::mean_value, HarmonicWeights::uniform}) {
            CutSurface surface(make_bumpy_square(12, 0.8));
            const auto corners = spread_corners(surface, n);
            const HarmonicMap map =
                map_disc_to_polygon(surface, corners, regular_polygon_corners(n), {weights});
            require_one_to_one(surface, map);
            CHECK(area_in_plane(surface, map.parameters) ==
                  Approx(0.5 * n * std::sin(2.0 * std::numbers::pi / n)));
            CHECK((map.report.route == MapRoute::uniform) == (weights == HarmonicWeights::uniform));
        }
    }
}

TEST_CASE("map_disc_to_circle: the boundary on the circle by arc length", "[meshing][surface]") {
    CutSurface surface(make_finger(24, 6, 1.0, 2.0));
    const HarmonicMap map = map_disc_to_circle(surface, 0);
    require_one_to_one(surface, map);
    const int tip = surface.n_vertices() - 1;
    // By symmetry.
    CHECK(map.parameters[tip].norm() < 1e-13);
    CHECK((map.parameters[0] - Vector2(1.0, 0.0)).norm() < 1e-15);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        if (!surface.is_boundary_vertex(v)) continue;
        CHECK(map.parameters[v].norm() == Approx(1.0));
        CHECK(map.parameters[v].x() == Approx(surface.point(v).x()).margin(1e-12));
    }
}

TEST_CASE("map_disc_to_polygon: chords of one side are split, others are not",
          "[meshing][surface]") {
    // One row of squares: every inner edge is a chord. With the corners of the strip, no chord
    // lies within one side.
    TriangleSoup strip;
    for (int i = 0; i <= 5; ++i) {
        strip.points.emplace_back(i, 0.0, 0.0);
        strip.points.emplace_back(i, 1.0, 0.0);
    }
    for (int i = 0; i < 5; ++i) {
        strip.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        strip.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    CutSurface kept(strip);
    const HarmonicMap map =
        map_disc_to_polygon(kept, std::vector<int>{0, 10, 11, 1}, square_corners());
    CHECK(map.report.n_split_chords == 0);
    require_one_to_one(kept, map);

    // With all corners of a triangle near one end, the rest of the outline is one side.
    CutSurface split(strip);
    const HarmonicMap narrow =
        map_disc_to_polygon(split, std::vector<int>{0, 2, 1}, regular_polygon_corners(3));
    CHECK(narrow.report.n_split_chords > 0);
    CHECK(split.n_vertices() == kept.n_vertices() + narrow.report.n_split_chords);
    require_one_to_one(split, narrow);
    CHECK(area_in_plane(split, narrow.parameters) ==
          Approx(1.5 * std::sin(2.0 * std::numbers::pi / 3.0)));
}

TEST_CASE("map_disc_to_polygon: nearly degenerate triangles are mapped", "[meshing][surface]") {
    TriangleSoup soup = make_square(10);
    // A row of triangles of aspect 1e6 and a column of them.
    for (int i = 0; i <= 10; ++i) {
        soup.points[11 * 4 + i].y() = soup.points[11 * 3 + i].y() + 1e-7;
        soup.points[11 * i + 6].x() = soup.points[11 * i + 5].x() + 1e-7;
    }
    CutSurface surface(soup);
    const HarmonicMap map =
        map_disc_to_polygon(surface, square_corner_vertices(10), square_corners());
    require_one_to_one(surface, map);
    CHECK(map.report.route == MapRoute::mean_value);
    // Still linear precision.
    for (int v = 0; v < surface.n_vertices(); ++v) {
        CHECK((map.parameters[v] - Vector2(surface.point(v).x(), surface.point(v).y())).norm() <
              1e-9);
    }
}

TEST_CASE("map_disc_to_polygon: fingers too long for harmonic maps are divided",
          "[meshing][surface]") {
    // The harmonic map of a finger shrinks by e per radius.
    const auto map_finger = [](int length) {
        CutSurface surface(make_finger(12, 2 * length, 1.0, length));
        HarmonicMap map =
            map_disc_to_polygon(surface, spread_corners(surface, 4), square_corners());
        require_one_to_one(surface, map);
        CHECK(area_in_plane(surface, map.parameters) == Approx(1.0));
        return map;
    };
    CHECK(map_finger(10).report.route == MapRoute::mean_value);
    const HarmonicMap map = map_finger(100);
    CHECK(map.report.route == MapRoute::divided);
    CHECK(map.report.n_flipped_mean_value > 0);
    CHECK(map.report.n_flipped_uniform > 0);
    CHECK(map.report.n_divisions > 0);
    // The same again, bit by bit.
    CHECK(map_finger(100).parameters == map.parameters);
}

TEST_CASE("map_opened_annulus: a cylinder maps to its development", "[meshing][surface]") {
    const int n_around = 10;
    const int n_along = 6;
    for (const bool is_periodic : {false, true}) {
        CutSurface surface(make_tube(n_around, n_along, 1.0, 3.0));
        std::vector<int> path;
        for (int i = 0; i < n_along; ++i) {
            path.push_back(surface.find_halfedge(n_around * i, n_around * (i + 1)));
        }
        const auto corners = open_annulus(surface, path);
        CHECK(surface.euler_characteristic() == 1);
        const double width = 2.0 * std::numbers::pi;
        const AnnulusMap annulus = map_opened_annulus(surface, corners, width, 3.0, is_periodic);
        require_one_to_one(surface, annulus.map);
        CHECK(annulus.is_periodic == is_periodic);
        CHECK(annulus.period == Approx(width));
        for (int v = 0; v < surface.n_vertices(); ++v) {
            const Vector3& point = surface.point(v);
            const Vector2& x = annulus.map.parameters[v];
            CHECK(x.y() == Approx(point.z()).margin(1e-12));
            CHECK(std::cos(x.x()) == Approx(point.x()).margin(1e-10));
            CHECK(std::sin(x.x()) == Approx(point.y()).margin(1e-10));
        }
        CHECK(annulus.map.parameters[corners[0]] == Vector2(0.0, 0.0));
        CHECK(annulus.map.parameters[corners[2]] == Vector2(annulus.period, 3.0));
    }
}

TEST_CASE(
    "map_opened_annulus: copies of the seam differ by the period exactly, and the cylinder "
    "map does not depend on the seam",
    "[meshing][surface]") {
    const int n_around = 12;
    TriangleSoup soup = make_tube(n_around, 5, 1.0, 2.0);
    for (Vector3& p : soup.points) {
        p.x() += 0.3 * std::sin(2.0 * p.z());
        p.y() *= 1.0 + 0.4 * p.z() * p.x();
    }
    // From vertex 0 to vertex 60: straight, and around three columns and back.
    const std::vector<std::vector<int>> seams{{0, 12, 24, 36, 48, 60},
                                              {0, 12, 13, 14, 26, 27, 39, 38, 37, 36, 48, 60}};
    std::vector<std::vector<Vector2>> maps;
    for (const auto& seam : seams) {
        CutSurface surface(soup);
        std::vector<int> path;
        for (std::size_t i = 0; i + 1 < seam.size(); ++i) {
            path.push_back(surface.find_halfedge(seam[i], seam[i + 1]));
        }
        const auto corners = open_annulus(surface, path);
        const AnnulusMap annulus = map_opened_annulus(surface, corners, 1.0, 0.7, true);
        require_one_to_one(surface, annulus.map);
        REQUIRE(annulus.is_periodic);
        REQUIRE(annulus.period == 1.0);
        std::vector<Vector2> by_parent(soup.points.size(), Vector2(1e9, 0.0));
        int n_copies = 0;
        for (int v = 0; v < surface.n_vertices(); ++v) {
            if (surface.parent(v) < 0) continue;
            const Vector2& x = annulus.map.parameters[v];
            Vector2& first = by_parent[surface.parent(v)];
            if (first.x() < 1e8) {
                ++n_copies;
                REQUIRE(std::abs(x.x() - first.x()) == 1.0);
                REQUIRE(x.y() == first.y());
            }
            first = x;
        }
        CHECK(n_copies == static_cast<int>(seam.size()));
        CHECK(annulus.map.report.n_split_chords == 0);
        maps.push_back(by_parent);
    }
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        CHECK(maps[0][v].y() == Approx(maps[1][v].y()).margin(1e-11));
        const double turns = maps[0][v].x() - maps[1][v].x();
        // The seam's parameters are rounded to 40 binary digits.
        CHECK(turns == Approx(std::round(turns)).margin(1e-11));
    }
}

TEST_CASE("map_opened_annulus: a seam in steps around the tube meets itself at the same heights",
          "[meshing][surface]") {
    CutSurface surface(make_tube(9, 8, 1.0, 2.0));
    std::vector<int> path;
    // One step up and one around in turn.
    int v = 0;
    for (int i = 0; i < 8; ++i) {
        const int up = 9 * (i + 1) + v % 9;
        path.push_back(surface.find_halfedge(v, up));
        v = up;
        if (i == 7) break;
        const int around = 9 * (i + 1) + (v % 9 + 1) % 9;
        path.push_back(surface.find_halfedge(v, around));
        v = around;
    }
    const auto corners = open_annulus(surface, path);
    const AnnulusMap annulus = map_opened_annulus(surface, corners, 2.0, 1.0, false);
    require_one_to_one(surface, annulus.map);
    CHECK_FALSE(annulus.is_periodic);
    std::vector<Vector2> first(surface.n_vertices(), Vector2(1e9, 0.0));
    for (int w = 0; w < surface.n_vertices(); ++w) {
        const int parent = surface.parent(w);
        if (parent < 0) continue;
        const Vector2& x = annulus.map.parameters[w];
        if (first[parent].x() < 1e8) {
            REQUIRE(std::abs(x.x() - first[parent].x()) == 2.0);
            REQUIRE(x.y() == first[parent].y());
        }
        first[parent] = x;
    }
}

TEST_CASE("map_disc_to_polygon: measured surfaces", "[meshing][surface]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    SECTION("a ventricle is a disc") {
        for (const int n : {3, 4, 6}) {
            CutSurface surface(read_stl(*folder / "surfaces/vampy_ventricle.stl"));
            const HarmonicMap map = map_disc_to_polygon(surface, spread_corners(surface, n),
                                                        regular_polygon_corners(n));
            require_one_to_one(surface, map);
            CHECK(map.report.route == MapRoute::mean_value);
        }
        CutSurface surface(read_stl(*folder / "surfaces/vampy_ventricle.stl"));
        const int start = surface.origin(surface.boundary_loops().front().front());
        require_one_to_one(surface, map_disc_to_circle(surface, start));
    }
    SECTION("a vein is a tube with angles down to 0.07 degrees") {
        for (const bool is_periodic : {false, true}) {
            CutSurface surface(read_stl(*folder / "surfaces/vampy_vein.stl"));
            surface.split_chords();
            const auto corners = open_annulus(surface, path_between_boundaries(surface, 0, 1));
            const AnnulusMap annulus = map_opened_annulus(surface, corners, 1.0, 1.0, is_periodic);
            require_one_to_one(surface, annulus.map);
            CHECK(annulus.is_periodic == is_periodic);
            CHECK(annulus.map.report.route == MapRoute::mean_value);
        }
    }
    SECTION("an artery is a pant, a disc after two cuts") {
        for (const int n : {4, 6}) {
            CutSurface surface(read_stl(*folder / "surfaces/vampy_artery.stl"));
            for (int cut = 0; cut < 2; ++cut) {
                surface.split_chords();
                surface.slice(path_between_boundaries(surface, 0, 1));
            }
            const HarmonicMap map = map_disc_to_polygon(surface, spread_corners(surface, n),
                                                        regular_polygon_corners(n));
            require_one_to_one(surface, map);
            CHECK(map.report.route == MapRoute::mean_value);
            CHECK(map.report.n_split_chords > 0);
        }
    }
}

TEST_CASE("map_disc_to_polygon: errors say what is wrong", "[meshing][surface]") {
    const auto square = square_corners();
    const auto map = [&](const CutSurface& piece, const std::vector<int>& corners,
                         const std::vector<Vector2>& polygon) {
        return message_of([&] {
            CutSurface copy = piece;
            static_cast<void>(map_disc_to_polygon(copy, corners, polygon));
        });
    };
    const CutSurface disc(make_square(2));
    CHECK(map(CutSurface(make_tube(5, 3, 1.0, 1.0)), {0, 1, 2, 3}, square) ==
          "map_disc_to_polygon: the piece has 1 components, 2 boundaries and Euler characteristic "
          "0; a disc has 1, 1 and 1: cut it open first");
    CHECK(map(CutSurface(make_torus(5, 5, 2.0, 0.5)), {0, 1, 2, 3}, square) ==
          "map_disc_to_polygon: the piece has 1 components, 0 boundaries and Euler characteristic "
          "0; a disc has 1, 1 and 1: cut it open first");
    CHECK(map(CutSurface(join(make_square(2), make_square(1))), {0, 2, 8, 6}, square) ==
          "map_disc_to_polygon: the piece has 2 components, 2 boundaries and Euler characteristic "
          "2; a disc has 1, 1 and 1: cut it open first");
    CHECK(map(disc, {0, 2, 4, 6}, square) ==
          "map_disc_to_polygon: corner 2 is vertex 4, which does not lie on the boundary; corners "
          "are boundary vertices");
    CHECK(map(disc, {0, 2, 99, 6}, square) ==
          "map_disc_to_polygon: corner 2 is vertex 99, which does not lie on the boundary; corners "
          "are boundary vertices");
    CHECK(map(disc, {0, 6, 8, 2}, square) ==
          "map_disc_to_polygon: corner 2 (vertex 8) does not follow corner 1 (vertex 6) along the "
          "boundary; name different vertices counter-clockwise, with the surface on the left");
    CHECK(map(disc, {0, 2, 2, 6}, square) ==
          "map_disc_to_polygon: corner 2 (vertex 2) does not follow corner 1 (vertex 2) along the "
          "boundary; name different vertices counter-clockwise, with the surface on the left");
    CHECK(map(disc, {0, 2}, {{0.0, 0.0}, {1.0, 0.0}}) ==
          "map_disc_to_polygon: 2 corners for a polygon of 2; there must be as many, and at least "
          "3");
    CHECK(map(disc, {0, 2, 8}, square) ==
          "map_disc_to_polygon: 3 corners for a polygon of 4; there must be as many, and at least "
          "3");
    CHECK(map(disc, {0, 2, 8, 6}, {{0, 0}, {1, 0}, {2, 0}, {1, 1}}) ==
          "map_disc_to_polygon: the polygon does not turn left at its corner 1 = (1, 0); it must "
          "be strictly convex and counter-clockwise");
    // A star with five points turns left everywhere.
    std::vector<Vector2> star;
    for (int k = 0; k < 5; ++k) star.push_back(regular_polygon_corners(5)[2 * k % 5]);
    CHECK_THAT(map(disc, {0, 1, 2, 8, 6}, star), Catch::Contains("does not turn left"));
    TriangleSoup pinched = make_square(2);
    pinched.points[1] = pinched.points[0];
    CHECK(map(CutSurface(pinched), {0, 2, 8, 6}, square) ==
          "map_disc_to_polygon: the boundary edge from vertex 0 to 1 has no length, so that both "
          "would share a parameter; merge them first");
    CHECK(message_of([] { static_cast<void>(regular_polygon_corners(2)); }) ==
          "regular_polygon_corners: 2 corners; there must be 3 or more");
    CHECK(message_of([] { static_cast<void>(rectangle_corners(1.0, 0.0)); }) ==
          "rectangle_corners: width 1 and height 0; both must be positive");
}

TEST_CASE("open_annulus, map_opened_annulus: errors say what is wrong", "[meshing][surface]") {
    const CutSurface tube(make_tube(5, 2, 1.0, 1.0));
    const auto open = [&](const CutSurface& piece, const std::vector<int>& vertices) {
        return message_of([&] {
            CutSurface copy = piece;
            std::vector<int> path;
            for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
                path.push_back(copy.find_halfedge(vertices[i], vertices[i + 1]));
            }
            static_cast<void>(open_annulus(copy, path));
        });
    };
    CHECK(open(CutSurface(make_square(2)), {0, 4}) ==
          "open_annulus: the piece has 1 boundaries and Euler characteristic 1; an annulus has 2 "
          "and 0");
    CHECK(open(tube, {0}) == "open_annulus: the path is empty");
    CHECK(open(tube, {0, 5}) ==
          "open_annulus: the path runs from vertex 0 on boundary 0 to vertex 5 on no boundary; it "
          "must join the two boundaries");
    CHECK(open(tube, {0, 1, 6, 11}) ==
          "open_annulus: halfedge 0 of the path (from vertex 0) lies on the boundary; the path "
          "must be simple, joined and inside but for its ends");
    CHECK_THAT(open(tube, {0, 5, 6, 5, 10}), Catch::Contains("returns to a vertex"));

    CutSurface surface = tube;
    const std::vector<int> path{surface.find_halfedge(0, 5), surface.find_halfedge(5, 10)};
    const auto corners = open_annulus(surface, path);
    CHECK_THAT(message_of([&] {
                   static_cast<void>(map_opened_annulus(
                       surface, {corners[1], corners[2], corners[3], corners[0]}, 1.0, 1.0, true));
               }),
               Catch::Contains("map_opened_annulus: the sides of the seam, 5 edges from vertex") &&
                   Catch::Contains("don't match point by point"));
}
