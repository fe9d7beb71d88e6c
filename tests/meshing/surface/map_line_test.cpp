#include "meshing/surface/map_line.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "iga/core/error.h"
#include "meshing/surface/harmonic_map.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr InsertLineOptions exact{.snap_fraction = 0.0};

std::vector<Vector2> plane_parameters(const CutSurface& surface) {
    std::vector<Vector2> parameters;
    for (int v = 0; v < surface.n_vertices(); ++v) {
        parameters.emplace_back(surface.point(v).x(), surface.point(v).y());
    }
    return parameters;
}

double distance_from_line(const Vector2& point, const Vector2& a, const Vector2& b) {
    const Vector2 direction = (b - a).normalized();
    const Vector2 x = point - a;
    return std::abs(direction.x() * x.y() - direction.y() * x.x());
}

// Vertices of a path that starts at `from`, whatever the direction of its halfedges.
std::vector<int> path_vertices(const CutSurface& surface, const std::vector<int>& path, int from) {
    std::vector<int> vertices{from};
    for (const int h : path) {
        REQUIRE(h >= 0);
        const int last = vertices.back();
        REQUIRE((surface.origin(h) == last || surface.target(h) == last));
        vertices.push_back(surface.origin(h) == last ? surface.target(h) : surface.origin(h));
    }
    REQUIRE(std::set<int>(vertices.begin(), vertices.end()).size() == vertices.size());
    return vertices;
}

double path_length(const std::vector<Vector2>& parameters, const std::vector<int>& vertices) {
    double length = 0.0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        length += (parameters[vertices[i]] - parameters[vertices[i - 1]]).norm();
    }
    return length;
}

}  // namespace

TEST_CASE("trace_line: crossings and vertices of a regular square", "[meshing][surface]") {
    // Squares with diagonals from lower left to upper right, 4 x 4.
    const CutSurface surface(make_square(4));
    const auto parameters = plane_parameters(surface);
    SECTION("along diagonals: vertices only") {
        const auto line = trace_line(surface, parameters, 0, 24);
        REQUIRE(line.size() == 5);
        for (int i = 0; i < 5; ++i) CHECK(line[i].vertex == 6 * i);
    }
    SECTION("along the boundary, either way") {
        for (const bool is_forward : {true, false}) {
            const auto line =
                trace_line(surface, parameters, is_forward ? 0 : 4, is_forward ? 4 : 0);
            REQUIRE(line.size() == 5);
            for (int i = 0; i < 5; ++i) CHECK(line[i].vertex == (is_forward ? i : 4 - i));
        }
    }
    SECTION("across diagonals: halves of edges, and vertices") {
        const auto line = trace_line(surface, parameters, 4, 20);
        REQUIRE(line.size() == 9);
        for (int i = 0; i < 9; ++i) {
            if (i % 2 == 0) {
                CHECK(line[i].vertex == 4 + 4 * (i / 2));
            } else {
                CHECK(line[i].vertex == -1);
                CHECK(line[i].fraction == 0.5);
            }
        }
    }
    SECTION("in general: the origin of each crossed halfedge is right of the line") {
        const auto line = trace_line(surface, parameters, 5, 19);
        REQUIRE(line.size() > 2);
        const Vector2 direction = parameters[19] - parameters[5];
        for (const LineNode& node : line) {
            if (node.vertex >= 0) continue;
            const Vector2 x = parameters[surface.origin(node.halfedge)] - parameters[5];
            CHECK(direction.x() * x.y() - direction.y() * x.x() < 0.0);
            const Vector2 crossing =
                (1.0 - node.fraction) * parameters[surface.origin(node.halfedge)] +
                node.fraction * parameters[surface.target(node.halfedge)];
            CHECK(distance_from_line(crossing, parameters[5], parameters[19]) < 1e-15);
        }
    }
}

TEST_CASE("insert_line: the path lies on the straight line and nothing else changes",
          "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(15, 0.5));
    auto parameters =
        map_disc_to_polygon(surface, square_corner_vertices(15), square_corners()).parameters;
    std::mt19937 generator(11);
    for (int trial = 0; trial < 60; ++trial) {
        const int n = surface.n_vertices();
        const int from = static_cast<int>(generator() % n);
        const int to = static_cast<int>(generator() % n);
        if (from == to) continue;
        const auto old_parameters = parameters;
        const int chi = surface.euler_characteristic();
        std::vector<Vector3> old_points;
        for (int v = 0; v < n; ++v) old_points.push_back(surface.point(v));

        const auto path = insert_line(surface, parameters, from, to, exact);

        REQUIRE(parameters.size() == static_cast<std::size_t>(surface.n_vertices()));
        for (int v = 0; v < n; ++v) {
            REQUIRE(parameters[v] == old_parameters[v]);
            REQUIRE(surface.point(v) == old_points[v]);
        }
        REQUIRE(surface.euler_characteristic() == chi);
        REQUIRE(flipped_triangles(surface, parameters).empty());
        const auto vertices = path_vertices(surface, path, from);
        REQUIRE(vertices.back() == to);
        for (const int v : vertices) {
            REQUIRE(distance_from_line(parameters[v], parameters[from], parameters[to]) < 1e-12);
        }
        REQUIRE(path_length(parameters, vertices) ==
                Approx((parameters[to] - parameters[from]).norm()).epsilon(1e-12));
        // New vertices lie on the edges that they split, as in the map.
        for (std::size_t i = 0; i < surface.splits().size(); ++i) {
            const auto& split = surface.splits()[i];
            const Vector2 expected = (1.0 - split.fraction) * parameters[split.from] +
                                     split.fraction * parameters[split.to];
            REQUIRE((parameters[split.vertex] - expected).norm() < 1e-15);
        }
    }
}

TEST_CASE("insert_line: through vertices and along edges nothing is split", "[meshing][surface]") {
    CutSurface surface(make_square(6));
    auto parameters = plane_parameters(surface);
    const int n = surface.n_vertices();
    for (const auto& [from, to] : {std::pair(0, 48), std::pair(8, 40), std::pair(7, 13),
                                   std::pair(0, 6), std::pair(6, 0), std::pair(3, 45)}) {
        const auto path = insert_line(surface, parameters, from, to, exact);
        CHECK(path_vertices(surface, path, from).back() == to);
    }
    CHECK(surface.n_vertices() == n);
}

TEST_CASE("insert_line: a line that is there already is followed", "[meshing][surface]") {
    CutSurface surface(make_jittered_square(9, 4));
    auto parameters = plane_parameters(surface);
    const auto first = insert_line(surface, parameters, 11, 97, exact);
    const auto first_vertices = path_vertices(surface, first, 11);
    const int n = surface.n_vertices();
    const auto second = insert_line(surface, parameters, 97, 11, exact);
    auto second_vertices = path_vertices(surface, second, 97);
    std::reverse(second_vertices.begin(), second_vertices.end());
    CHECK(second_vertices == first_vertices);
    CHECK(surface.n_vertices() == n);
}

TEST_CASE("insert_line: two lines that cross share one vertex", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(10, 0.5));
    const auto corners = square_corner_vertices(10);
    auto parameters = map_disc_to_polygon(surface, corners, square_corners()).parameters;
    static_cast<void>(insert_line(surface, parameters, corners[0], corners[2], exact));
    const auto b_path = insert_line(surface, parameters, corners[1], corners[3]);
    const auto b = path_vertices(surface, b_path, corners[1]);
    int n_common = 0;
    for (const int v : b) {
        n_common += distance_from_line(parameters[v], parameters[corners[0]],
                                       parameters[corners[2]]) < 1e-12;
    }
    CHECK(n_common == 1);
    // Sliced along the second one there are two discs.
    std::vector<int> path;
    for (std::size_t i = 0; i + 1 < b.size(); ++i) {
        path.push_back(surface.find_halfedge(b[i], b[i + 1]));
    }
    surface.slice(path);
    CHECK(surface.euler_characteristic() == 2);
}

TEST_CASE("insert_line: snapping keeps clear of slivers, and paths simple", "[meshing][surface]") {
    for (const double snap : {0.05, 0.2, 0.5}) {
        CutSurface surface(make_jittered_square(12, 8));
        auto parameters = plane_parameters(surface);
        std::mt19937 generator(2);
        for (int trial = 0; trial < 30; ++trial) {
            const int n = surface.n_vertices();
            const int from = static_cast<int>(generator() % n);
            const int to = static_cast<int>(generator() % n);
            if (from == to) continue;
            const auto n_splits = surface.splits().size();
            const auto path = insert_line(surface, parameters, from, to, {.snap_fraction = snap});
            REQUIRE(flipped_triangles(surface, parameters).empty());
            REQUIRE(surface.euler_characteristic() == 1);
            const auto vertices = path_vertices(surface, path, from);
            REQUIRE(vertices.back() == to);
            for (std::size_t i = n_splits; i < surface.splits().size(); ++i) {
                const auto& split = surface.splits()[i];
                const bool is_clear = split.fraction >= snap && split.fraction <= 1.0 - snap;
                const int nearer = split.fraction < 0.5 ? split.from : split.to;
                REQUIRE((is_clear || surface.is_boundary_vertex(nearer)));
            }
            for (const int v : vertices) {
                // No farther than the snapped part of the longest edge, about 0.2.
                REQUIRE(distance_from_line(parameters[v], parameters[from], parameters[to]) <
                        0.2 * snap + 1e-12);
            }
        }
    }
}

TEST_CASE("insert_line: crossings that coincide with a vertex in double precision are moved there",
          "[meshing][surface]") {
    TriangleSoup soup = make_square(2);
    // The middle vertex next to the diagonal by one digit.
    soup.points[4].x() = std::nextafter(0.5, 1.0);
    CutSurface surface(soup);
    auto parameters = plane_parameters(surface);
    for (const auto& [from, to] : {std::pair(0, 8), std::pair(6, 2), std::pair(1, 7)}) {
        const auto path = insert_line(surface, parameters, from, to, exact);
        CHECK(path_vertices(surface, path, from).back() == to);
        CHECK(flipped_triangles(surface, parameters).empty());
    }
}

TEST_CASE("insert_point: inside, on edges, at vertices", "[meshing][surface]") {
    CutSurface surface(make_square(3));
    auto parameters = plane_parameters(surface);
    CHECK(insert_point(surface, parameters, parameters[5], exact) == 5);
    CHECK(insert_point(surface, parameters, parameters[5] + Vector2(1e-6, 2e-6)) == 5);
    CHECK(surface.n_vertices() == 16);
    const int on_side = insert_point(surface, parameters, {0.5, 0.0}, exact);
    CHECK(on_side == 16);
    CHECK(parameters[on_side] == Vector2(0.5, 0.0));
    CHECK(surface.is_boundary_vertex(on_side));
    std::mt19937 generator(7);
    for (int i = 0; i < 50; ++i) {
        const Vector2 point(generator() / 4294967296.0, generator() / 4294967296.0);
        const int v = insert_point(surface, parameters, point, exact);
        REQUIRE((parameters[v] - point).norm() < 1e-14);
        REQUIRE((surface.point(v) - Vector3(point.x(), point.y(), 0.0)).norm() < 1e-14);
        REQUIRE(flipped_triangles(surface, parameters).empty());
        REQUIRE(surface.euler_characteristic() == 1);
    }
}

TEST_CASE("insert_polyline: lines from point to point", "[meshing][surface]") {
    CutSurface surface(make_bumpy_square(8, 0.4));
    auto parameters =
        map_disc_to_polygon(surface, square_corner_vertices(8), square_corners()).parameters;
    const std::vector<Vector2> points{{0.1, 0.1}, {0.83, 0.21}, {0.6, 0.77}, {0.2, 0.9}};
    const auto path = insert_polyline(surface, parameters, points, exact);
    REQUIRE_FALSE(path.empty());
    const int start = insert_point(surface, parameters, points[0]);
    const auto vertices = path_vertices(surface, path, start);
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    CHECK(path_length(parameters, vertices) == Approx(length).epsilon(1e-12));
    CHECK(flipped_triangles(surface, parameters).empty());
}

TEST_CASE("trace_line, insert_line: errors say what is wrong", "[meshing][surface]") {
    CutSurface surface(make_square(2));
    auto parameters = plane_parameters(surface);
    REQUIRE_THROWS_WITH(trace_line(surface, parameters, 3, 3),
                        "trace_line: both ends, vertices 3 and 3, lie at (0, 0.5); a line has two "
                        "ends");
    REQUIRE_THROWS_WITH(trace_line(surface, parameters, 3, 9),
                        "trace_line: vertex 9 has no triangles or does not exist; there are 9");
    REQUIRE_THROWS_WITH(insert_line(surface, parameters, 0, 8, {.snap_fraction = 0.6}),
                        "insert_line: snap fraction 0.6; it must lie in [0, 0.5]");
    REQUIRE_THROWS_WITH(insert_point(surface, parameters, {1.5, 0.5}),
                        "insert_point: (1.5, 0.5) lies outside the map");
    REQUIRE_THROWS_WITH(insert_polyline(surface, parameters, std::vector<Vector2>{{0.5, 0.5}}),
                        "insert_polyline: 1 points; a line has at least 2");
    // An L: the straight way from one arm to the other leads outside.
    TriangleSoup corner = make_square(2);
    corner.triangles.resize(6);
    CutSurface l_shape(corner);
    auto l_parameters = plane_parameters(l_shape);
    REQUIRE_THROWS_WITH(trace_line(l_shape, l_parameters, 7, 2),
                        Catch::Contains("the line from vertex 7 at (0.5, 1) to vertex 2 at (1, 0) "
                                        "leaves the map at"));
}
