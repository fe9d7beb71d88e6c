#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <set>

#include "meshing/topology/handle_tunnel_loops.h"
#include "tests/meshing/topology/knot_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

std::vector<Vector3> points_of(const CutSurface& surface, const HomologyLoop& loop) {
    std::vector<Vector3> points;
    for (const int v : loop.vertices) points.push_back(surface.point(v));
    return points;
}

// Linking numbers of loops (rows) with the solid's cores. A handle bounds inside the solid and
// counts how often its disc is pierced; a tunnel bounds outside, where no core is.
IntegerMatrix linking_with_cores(const KnottedSolid& solid, const CutSurface& surface,
                                 const std::vector<HomologyLoop>& loops) {
    IntegerMatrix linking;
    for (const HomologyLoop& loop : loops) {
        auto& row = linking.emplace_back();
        for (const auto& core : solid.cores) {
            const double number = gauss_linking_number(points_of(surface, loop), core);
            // Rounding of some 1e5 solid angles.
            REQUIRE(number == Approx(std::round(number)).margin(1e-6));
            row.push_back(std::llround(number));
        }
    }
    return linking;
}

void require_loops(const KnottedSolid& solid) {
    const CutSurface surface(solid.surface);
    const int genus = static_cast<int>(solid.cores.size());
    REQUIRE(surface.euler_characteristic() == 2 - 2 * genus);
    const HandleTunnelLoops loops = find_handle_tunnel_loops(surface);
    REQUIRE(loops.genus == genus);
    REQUIRE(std::llabs(loops.determinant) == 1);
    REQUIRE(static_cast<int>(loops.handles.size()) == genus);
    REQUIRE(static_cast<int>(loops.tunnels.size()) == genus);
    const auto handles = linking_with_cores(solid, loops.surface, loops.handles);
    REQUIRE(std::llabs(determinant(handles)) == 1);
    const auto tunnels = linking_with_cores(solid, loops.surface, loops.tunnels);
    REQUIRE(tunnels == IntegerMatrix(genus, std::vector<long long>(genus, 0)));
    for (const auto* kind : {&loops.handles, &loops.tunnels}) {
        std::set<int> seen;
        for (const HomologyLoop& loop : *kind) {
            for (std::size_t k = 0; k < loop.vertices.size(); ++k) {
                const int v = loop.vertices[k];
                REQUIRE(seen.insert(v).second);
                REQUIRE(loops.surface.find_halfedge(
                            v, loop.vertices[(k + 1) % loop.vertices.size()]) >= 0);
            }
        }
    }
}

}  // namespace

TEST_CASE("linking number: of two circles through each other, and of two apart",
          "[meshing][topology]") {
    std::vector<Vector3> a;
    std::vector<Vector3> through;
    std::vector<Vector3> apart;
    for (int i = 0; i < 7; ++i) {
        const double c = std::cos(0.9 * i);
        const double s = std::sin(0.9 * i);
        a.emplace_back(c, s, 0.0);
        through.emplace_back(1.0 + c, 0.01, s);
        apart.emplace_back(3.0 + c, 0.01, s);
    }
    CHECK(std::abs(gauss_linking_number(a, through)) == Approx(1.0).epsilon(1e-12));
    CHECK(gauss_linking_number(a, apart) == Approx(0.0).margin(1e-12));
}

TEST_CASE("handle and tunnel loops: tubes around knots", "[meshing][topology]") {
    SECTION("trefoil") { require_loops(make_closed_tube(make_torus_knot(2, 3, 120), 8, 0.4)); }
    SECTION("its mirror image") {
        require_loops(make_closed_tube(make_torus_knot(2, -3, 120), 8, 0.4));
    }
    SECTION("T(2, 5)") { require_loops(make_closed_tube(make_torus_knot(2, 5, 160), 8, 0.3)); }
    SECTION("T(3, 4)") { require_loops(make_closed_tube(make_torus_knot(3, 4, 200), 8, 0.25)); }
    SECTION("figure eight") {
        require_loops(make_closed_tube(make_figure_eight_knot(160), 8, 0.25));
    }
}

TEST_CASE("handle and tunnel loops: inside out, the handle of a knotted tube is the longitude",
          "[meshing][topology]") {
    KnottedSolid solid = make_closed_tube(make_torus_knot(2, 3, 120), 8, 0.4);
    for (auto& triangle : solid.surface.triangles) std::swap(triangle[1], triangle[2]);
    const auto loops = find_handle_tunnel_loops(CutSurface(solid.surface));
    CHECK(linking_with_cores(solid, loops.surface, loops.handles) == IntegerMatrix{{0}});
    CHECK(std::llabs(linking_with_cores(solid, loops.surface, loops.tunnels)[0][0]) == 1);
}

TEST_CASE("handle and tunnel loops: a trefoil with an arch, down to coarse ones",
          "[meshing][topology]") {
    for (const int n_around : {4, 5, 8}) {
        for (const int n_along : {60, 120}) {
            INFO(n_around << " x " << n_along);
            require_loops(make_trefoil_with_arch(n_around, n_along));
        }
    }
}

TEST_CASE("handle and tunnel loops: a trefoil of ten thousand triangles", "[meshing][topology]") {
    require_loops(make_closed_tube(make_torus_knot(2, 3, 400), 12, 0.4));
}
