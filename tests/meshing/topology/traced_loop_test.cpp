#include "meshing/topology/traced_loop.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/topology/pants.h"
#include "tests/meshing/topology/part_members.h"

using namespace couture;
using namespace couture::meshing;
using couture::testing::make_member;
using couture::testing::Member;

namespace {

// Circle of radius r around (x, 0, 0) in the plane of y and z.
GuideLoop circle_across(double x, double y, double r, int n) {
    GuideLoop guide;
    for (int k = 0; k < n; ++k) {
        const double t = 2.0 * std::numbers::pi * k / n;
        guide.points.emplace_back(x, y + r * std::cos(t), r * std::sin(t));
    }
    return guide;
}

GuideLoop guide_of(const SurfaceMesh& mesh, const PantsCurve& curve) {
    GuideLoop guide;
    for (const VertexHandle v : curve.curve.vertices) guide.points.push_back(mesh.point(v));
    return guide;
}

Vector3 highest(const SurfaceMesh& mesh) {
    Vector3 high = mesh.point(VertexHandle(0));
    for (const auto vertex : mesh.vertices()) high = high.cwiseMax(mesh.point(vertex));
    return high;
}

Vector3 nearest_point(const SurfaceMesh& mesh, const Vector3& target) {
    return *std::min_element(mesh.points(), mesh.points() + mesh.n_vertices(),
                             [&](const Vector3& a, const Vector3& b) {
                                 return (a - target).norm() < (b - target).norm();
                             });
}

// A tube about the x axis, open at both ends; its meridians are circles of radius 1.
SurfaceMesh make_tube(int around, int along) {
    TriangleSoup soup;
    for (int i = 0; i <= along; ++i) {
        for (int k = 0; k < around; ++k) {
            const double t = 2.0 * std::numbers::pi * k / around;
            soup.points.emplace_back(6.0 * i / along, std::cos(t), std::sin(t));
        }
    }
    for (int i = 0; i < along; ++i) {
        for (int k = 0; k < around; ++k) {
            const int a = i * around + k;
            const int b = i * around + (k + 1) % around;
            soup.triangles.push_back({a, b, b + around});
            soup.triangles.push_back({a, b + around, a + around});
        }
    }
    return make_surface_mesh(soup);
}

// Of the double torus: between its two holes, in the plane of symmetry.
GuideLoop waist(const SurfaceMesh& mesh) {
    double low = 0.0;
    double high = 0.0;
    for (const auto vertex : mesh.vertices()) {
        const Vector3& x = mesh.point(vertex);
        if (std::abs(x.x()) > default_edge_length("double_torus")) continue;
        low = std::min(low, x.y());
        high = std::max(high, x.y());
    }
    return circle_across(0.0, 0.5 * (high + low), 0.5 * (high - low), 12);
}

}  // namespace

TEST_CASE("trace_loop: a circle on a tube is followed, and its direction kept", "[topology]") {
    SurfaceMesh mesh = make_tube(24, 48);
    const GuideLoop guide = circle_across(2.5, 0.0, 1.0, 10);
    const SurfaceCurve curve = trace_loop(mesh, guide, 0.1);
    REQUIRE(curve.is_closed);
    REQUIRE(curve.vertices.size() == 24);
    REQUIRE(curve_length(mesh, curve) ==
            Approx(24 * 2.0 * std::sin(std::numbers::pi / 24)).epsilon(1e-12));
    for (const VertexHandle vertex : curve.vertices) REQUIRE(mesh.point(vertex).x() == Approx(2.5));
    GuideLoop backwards = guide;
    std::reverse(backwards.points.begin(), backwards.points.end());
    const SurfaceCurve other = trace_loop(mesh, backwards, 0.1);
    const auto turn = [&](const SurfaceCurve& c) {
        return mesh.point(c.vertices[0]).cross(mesh.point(c.vertices[1])).x();
    };
    REQUIRE(turn(curve) * turn(other) < 0.0);
}

TEST_CASE("trace_loop: mistakes are explained", "[topology]") {
    SurfaceMesh mesh = make_tube(12, 24);
    REQUIRE_THROWS_WITH(trace_loop(mesh, {{{0, 1, 0}, {0, 0, 1}}, {}}, 0.1),
                        "loop: 2 points; a closed curve needs at least 3");
    GuideLoop far = circle_across(3.0, 0.0, 1.0, 8);
    far.points[2].z() = 9.0;
    REQUIRE_THROWS_WITH(trace_loop(mesh, far, 0.1), Catch::Contains("point 2 at (3, ") &&
                                                        Catch::Contains("away from the nearest"));
    GuideLoop nan = circle_across(3.0, 0.0, 1.0, 8);
    nan.points[1].x() = std::nan("");
    REQUIRE_THROWS_WITH(trace_loop(mesh, nan, 0.1), "loop: point 1 is not finite");
    GuideLoop normals = circle_across(3.0, 0.0, 1.0, 8);
    normals.normals.emplace_back(1, 0, 0);
    REQUIRE_THROWS_WITH(trace_loop(mesh, normals, 0.1),
                        "loop: 1 normals for 8 points; give one each or none");
    REQUIRE_THROWS_WITH(trace_loop(mesh, circle_across(3.0, 0.0, 1.0, 8), 0.0),
                        "loop: width 0; it must be positive");
    GuideLoop tiny;
    tiny.points = {{3.0, 1.0, 0.0}, {3.0, 1.0, 1e-3}, {3.001, 1.0, 0.0}};
    REQUIRE_THROWS_WITH(trace_loop(mesh, tiny, 0.1), Catch::Contains("it shrinks to"));
}

TEST_CASE("pants: loops that are given are cut first", "[topology][parts]") {
    Member member = make_member("double_torus", {}, 0.0, false);
    const PantsDecomposition plain = decompose_into_pants(member.mesh);
    REQUIRE(plain.curves.size() == 3);
    Member fresh = make_member("double_torus", {}, 0.0, false);
    PantsOptions options;
    options.loops.push_back(waist(member.mesh));
    const PantsDecomposition pants = decompose_into_pants(fresh.mesh, options);
    REQUIRE(pants.curves.size() == 3);
    REQUIRE(pants.curves[0].kind == PantsCurveKind::cycle);
    REQUIRE(!pants.curves[0].around);
    REQUIRE(pants.curves[1].kind == PantsCurveKind::handle);
    REQUIRE(pants.curves[2].kind == PantsCurveKind::handle);
    for (const VertexHandle vertex : pants.curves[0].curve.vertices) {
        REQUIRE(std::abs(fresh.mesh.point(vertex).x()) < 4.0 * default_edge_length("double_torus"));
    }
    // Each hole's handle joins a pant with itself.
    REQUIRE(pants.patches.size() == 2);
    for (const PantsPatch& patch : pants.patches) {
        REQUIRE(patch.boundary.size() == 3);
        REQUIRE(patch.boundary[0].curve == 0);
        REQUIRE(patch.boundary[1].curve == patch.boundary[2].curve);
    }
}

TEST_CASE("pants: loops that are no cuts are refused", "[topology][parts]") {
    Member member = make_member("double_torus", {}, 0.0, false);
    const PantsDecomposition plain = decompose_into_pants(member.mesh);
    SECTION("around a hole") {
        PantsOptions options;
        GuideLoop tunnel;
        for (const Vector3& x : plain.tunnels.front()) tunnel.points.push_back(x);
        options.loops = {tunnel};
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                            Catch::Contains("bounds no surface inside the solid: it runs around a "
                                            "hole"));
    }
    SECTION("beside each other") {
        PantsOptions options;
        const GuideLoop loop = guide_of(member.mesh, plain.curves[0]);
        GuideLoop beside = loop;
        for (Vector3& x : beside.points) x.x() += 3.0 * default_edge_length("double_torus");
        options.loops = {loop, beside};
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                            Catch::Contains("a cylinder is cut off by curve 0, 1"));
    }
    SECTION("twice") {
        PantsOptions options;
        const GuideLoop loop = guide_of(member.mesh, plain.curves[0]);
        GuideLoop turned = loop;
        std::rotate(turned.points.begin(), turned.points.begin() + 2, turned.points.end());
        std::reverse(turned.points.begin(), turned.points.end());
        options.loops = {loop, turned};
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                            "pants: curves 0 and 1 are the same loop; give it once");
    }
    SECTION("across each other") {
        PantsOptions options;
        // The outline, seen from above, passes the waist twice.
        GuideLoop outline;
        const Vector3 high = highest(member.mesh);
        for (int k = 0; k < 40; ++k) {
            const double t = 2.0 * std::numbers::pi * k / 40;
            const Vector3 target(2.0 * high.x() * std::cos(t), 2.0 * high.y() * std::sin(t), 0.0);
            outline.points.push_back(nearest_point(member.mesh, target));
        }
        options.loops = {waist(member.mesh), outline};
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                            Catch::Contains("pants: curve 1: loop: point ") &&
                                Catch::Contains("lies on the other side of curve 0") &&
                                Catch::Contains("must not cross"));
    }
    SECTION("too few, if no others are to be made") {
        PantsOptions options;
        const auto handle = std::find_if(
            plain.curves.begin(), plain.curves.end(),
            [](const PantsCurve& curve) { return curve.kind == PantsCurveKind::handle; });
        options.loops = {guide_of(member.mesh, *handle)};
        options.only_given_loops = true;
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(
            decompose_into_pants(fresh.mesh, options),
            Catch::Contains("the cuts leave 1 of 2 handles") && Catch::Contains("add 1"));
    }
    SECTION("around a disc") {
        PantsOptions options;
        const Vector3 top =
            *std::max_element(member.mesh.points(), member.mesh.points() + member.mesh.n_vertices(),
                              [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); });
        GuideLoop loop;
        const double r = 2.0 * default_edge_length("double_torus");
        for (int k = 0; k < 8; ++k) {
            const double t = 0.25 * std::numbers::pi * k;
            loop.points.emplace_back(top + r * Vector3(std::cos(t), std::sin(t), 0.0));
        }
        options.loops = {loop};
        options.loop_width = 1e-3;
        Member fresh = make_member("double_torus", {}, 0.0, false);
        REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                            Catch::Contains("a disc is cut off by curve 0"));
    }
    SECTION("on a torus") {
        Member torus = make_member("torus", {}, 0.0, false);
        PantsOptions options;
        options.cycles_through = {{Vector3::Zero()}};
        REQUIRE_THROWS_WITH(decompose_into_pants(torus.mesh, options),
                            Catch::Contains("Euler characteristic 0"));
    }
}

TEST_CASE("pants: a cycle passes the sharp points that are given", "[topology][parts]") {
    // The corners of the double T's middle bar, at one end.
    Member member = make_member("double_t", {}, 0.0, true);
    std::vector<Vector3> points;
    for (const auto& [name, x] : member.landmarks.corners) {
        CAPTURE(name);
        const bool is_inner = name.find("middle") != std::string::npos && x.x() < 0.0;
        if (is_inner) points.push_back(x);
    }
    REQUIRE(points.size() == 2);
    // And the edges below them: a section of the bar, 40 x 40.
    points.emplace_back(-30.0, -20.0, -20.0);
    points.emplace_back(-30.0, -20.0, 20.0);
    PantsOptions options;
    options.cycles_through = {points};
    const PantsDecomposition pants = decompose_into_pants(member.mesh, options);
    const PantsCurve& cycle = pants.curves.back();
    REQUIRE(cycle.kind == PantsCurveKind::cycle);
    // Along the edges of triangles.
    REQUIRE(cycle.length >= 160.0);
    REQUIRE(cycle.length < 1.15 * 160.0);
    const double step = default_edge_length("double_t");
    for (const Vector3& x : points) {
        const auto& vertices = cycle.curve.vertices;
        REQUIRE(std::any_of(vertices.begin(), vertices.end(), [&](VertexHandle v) {
            return (member.mesh.point(v) - x).norm() < 0.6 * step;
        }));
    }
    options.cycles_through = {{Vector3::Constant(1e4)}};
    Member fresh = make_member("double_t", {}, 0.0, true);
    REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                        Catch::Contains("away from the surface"));
    options.cycles_through = {{}};
    REQUIRE_THROWS_WITH(decompose_into_pants(fresh.mesh, options),
                        "pants: a cycle through no points; give at least one");
}
