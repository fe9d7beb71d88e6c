#include "meshing/surface/open_pant.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "iga/core/error.h"
#include "meshing/surface/harmonic_map.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// The square of make_square(n), n a multiple of 5, without two square holes of a fifth of its size,
// side by side: a pant whose boundary 0 is the outer one.
TriangleSoup make_square_with_holes(int n) {
    TriangleSoup soup = make_square(n);
    const int fifth = n / 5;
    std::erase_if(soup.triangles, [&](const std::array<int, 3>& triangle) {
        const Vector3 centre =
            (soup.points[triangle[0]] + soup.points[triangle[1]] + soup.points[triangle[2]]) / 3.0;
        const int column = static_cast<int>(centre.x() * n) / fifth;
        const int row = static_cast<int>(centre.y() * n) / fifth;
        return row == 2 && (column == 1 || column == 3);
    });
    return soup;
}

// Boundary 0 is the outer one.
double perimeter(int n_boundary) { return n_boundary == 0 ? 4.0 : 0.8; }

}  // namespace

TEST_CASE("open_pant: a disc with eight corners; the sides are boundaries and seams",
          "[meshing][surface]") {
    const CutSurface pant(make_square_with_holes(20));
    REQUIRE(pant.boundary_loops().size() == 3);
    for (int middle = 0; middle < 3; ++middle) {
        const int first = (middle + 1) % 3;
        const int last = (middle + 2) % 3;
        CutSurface disc = pant;
        const auto corners = open_pant(disc, first, middle, last);
        REQUIRE(disc.euler_characteristic() == 1);
        const auto loops = disc.boundary_loops();
        REQUIRE(loops.size() == 1);
        // Lengths of the eight parts.
        std::vector<double> lengths(8, 0.0);
        std::size_t at = 0;
        while (disc.origin(loops[0][at]) != corners[0]) ++at;
        int part = -1;
        for (std::size_t i = 0; i < loops[0].size(); ++i) {
            const int h = loops[0][(at + i) % loops[0].size()];
            if (part < 7 && disc.origin(h) == corners[part + 1]) ++part;
            lengths[part] += disc.length(h);
        }
        REQUIRE(part == 7);
        CHECK(lengths[0] == Approx(perimeter(first)));
        CHECK(lengths[4] == Approx(perimeter(last)));
        CHECK(lengths[2] + lengths[6] == Approx(perimeter(middle)));
        // Holes are a fifth apart from each other and from the sides.
        for (const int seam : {1, 3, 5, 7}) CHECK(lengths[seam] == Approx(0.2));
    }
}

TEST_CASE("open_pant: of the three seams the longest one is left out", "[meshing][surface]") {
    // Holes moved towards the left: the seams at the left hole are shorter.
    TriangleSoup soup = make_square_with_holes(20);
    for (Vector3& point : soup.points) {
        point = Vector3(point.x() * (1.0 + point.x()), 2.0 * point.y(), 0.0);
    }
    CutSurface disc(soup);
    const auto corners = open_pant(disc);
    CHECK(disc.euler_characteristic() == 1);
    // From the outer boundary to the left hole 0.24, on to the right one 0.4, from there outwards
    // 0.56.
    double length = 0.0;
    const auto loop = disc.boundary_loops().front();
    for (const int h : loop) length += disc.length(h);
    double boundary = 0.0;
    for (const auto& old : CutSurface(soup).boundary_loops()) {
        for (const int h : old) boundary += CutSurface(soup).length(h);
    }
    CHECK(length - boundary == Approx(2.0 * (0.24 + 0.4)));
    CHECK(std::set<int>(corners.begin(), corners.end()).size() == 8);
}

TEST_CASE("map_opened_pant: one-to-one, seam copies at the same height", "[meshing][surface]") {
    CutSurface disc(make_square_with_holes(15));
    const auto corners = open_pant(disc, 1, 0, 2);
    const HarmonicMap map = map_opened_pant(disc, corners, 2.0, 3.0);
    CHECK(flipped_triangles(disc, map.parameters).empty());
    CHECK(map.parameters[corners[0]] == Vector2(0.0, 0.0));
    CHECK(map.parameters[corners[1]] == Vector2(2.0, 0.0));
    CHECK(map.parameters[corners[4]] == Vector2(2.0, 3.0));
    CHECK(map.parameters[corners[5]] == Vector2(0.0, 3.0));
    std::map<int, std::vector<int>> copies;
    for (int v = 0; v < disc.n_vertices(); ++v) {
        if (disc.outgoing(v) >= 0) copies[disc.original(v)].push_back(v);
    }
    int n_seam_vertices = 0;
    for (const auto& [original, both] : copies) {
        if (both.size() < 2) continue;
        ++n_seam_vertices;
        REQUIRE(both.size() == 2);
        CHECK(map.parameters[both[0]].y() == map.parameters[both[1]].y());
        CHECK(std::abs(map.parameters[both[0]].x() - map.parameters[both[1]].x()) == 2.0);
    }
    CHECK(n_seam_vertices >= 8);
    double area = 0.0;
    for (int f = 0; f < disc.n_faces(); ++f) {
        const auto [a, b, c] = disc.triangle(f);
        const Vector2 u = map.parameters[b] - map.parameters[a];
        const Vector2 v = map.parameters[c] - map.parameters[a];
        area += 0.5 * (u.x() * v.y() - u.y() * v.x());
    }
    CHECK(area == Approx(6.0));
}

TEST_CASE("open_pant: so coarse that seams need new edges", "[meshing][surface]") {
    CutSurface disc(make_square_with_holes(5));
    const auto corners = open_pant(disc);
    CHECK(disc.euler_characteristic() == 1);
    const HarmonicMap map = map_opened_pant(disc, corners, 1.0, 1.0);
    CHECK(flipped_triangles(disc, map.parameters).empty());
}

TEST_CASE("open_pant, map_opened_pant: errors say what is wrong", "[meshing][surface]") {
    CutSurface square(make_square(3));
    REQUIRE_THROWS_WITH(open_pant(square),
                        "open_pant: the piece has 1 components, 1 boundaries and Euler "
                        "characteristic 1; a pant has 1, 3 and -1");
    CutSurface pant(make_square_with_holes(10));
    REQUIRE_THROWS_WITH(open_pant(pant, 0, 1, 1),
                        "open_pant: boundaries 0, 1 and 1; name each of 0, 1 and 2 once");
    REQUIRE_THROWS_WITH(open_pant(pant, 0, 1, 3),
                        "open_pant: boundaries 0, 1 and 3; name each of 0, 1 and 2 once");
    auto corners = open_pant(pant);
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    REQUIRE_THROWS_WITH(map_opened_pant(pant, corners, 1.0, 1.0),
                        Catch::Contains("map_opened_pant: the sides of the seam") &&
                            Catch::Contains("don't match point by point"));
}
