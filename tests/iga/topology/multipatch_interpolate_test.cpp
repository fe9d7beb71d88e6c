#include "iga/topology/multipatch_interpolate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "iga/topology/space.h"
#include "tests/iga/topology/test_patches.h"

namespace couture::iga {

namespace {

using std::numbers::pi;

constexpr double rounding = 1e-14;

/// Ring between radii 1 and 2 from 0 to `sweep`, one patch: C0 at each quarter turn.
Surface make_sector(double start, double sweep) {
    return make_ruled(make_arc(2.0, start, sweep), make_arc(1.0, start, sweep));
}

/// Three quarters of a ring; the last one read backwards and turned.
MultiPatch<2> make_ring() {
    MultiPatch<2> ring;
    ring.patches = {make_sector(0.0, pi / 2), make_sector(pi / 2, pi / 2),
                    reoriented<2>(make_sector(pi, pi / 2), {1, 0}, {true, true})};
    find_interfaces(ring, 1e-10);
    ring.boundary_sets["inner"] = {make_side<2>(0, 3), make_side<2>(1, 3)};
    return ring;
}

/// Largest distance of points of equal parameters.
double largest_distance(const MultiPatch<2>& a, const MultiPatch<2>& b) {
    double largest = 0.0;
    constexpr int n = 97;
    for (int p = 0; p < a.n_patches(); ++p) {
        for (int i = 0; i <= n; ++i) {
            const Vector2 xi(static_cast<double>(i) / n, static_cast<double>(i * 31 % n) / n);
            largest = std::max(largest, (a.patches[p].point(xi) - b.patches[p].point(xi)).norm());
        }
    }
    return largest;
}

}  // namespace

TEST_CASE("interpolate: the error of a ring falls with h^(degree + 1)", "[topology]") {
    const MultiPatch<2> ring = make_ring();
    for (int degree = 1; degree <= 4; ++degree) {
        CAPTURE(degree);
        const auto error = [&](int n) {
            return largest_distance(ring, interpolate<2>(ring, degree, std::array{n, n}));
        };
        const double order = std::log2(error(8) / error(16));
        CHECK(order > degree + 0.7);
    }
}

TEST_CASE("interpolate: at degree 1 every control point is on the ring", "[topology]") {
    const MultiPatch<2> ring = make_ring();
    const MultiPatch<2> polygons = interpolate<2>(ring, 1, std::array{6, 6});
    for (int p = 0; p < ring.n_patches(); ++p) {
        const Surface& patch = polygons.patches[p];
        CHECK_FALSE(patch.is_rational());
        CHECK(patch.space().degrees() == std::array{1, 1});
        for (int i = 0; i < patch.space().n_basis(); ++i) {
            const auto [j, k] = patch.space().indices(i);
            const Vector2 xi(patch.knots(0).greville()[j], patch.knots(1).greville()[k]);
            const Vector2 x = patch.control_points().row(i).transpose();
            CHECK((x - ring.patches[p].point(xi)).norm() < rounding);
        }
    }
}

TEST_CASE("interpolate: interfaces and sets are kept, shared control points are equal",
          "[topology]") {
    const MultiPatch<2> ring = make_ring();
    REQUIRE(ring.interfaces.size() == 2);
    for (int degree = 1; degree <= 3; ++degree) {
        CAPTURE(degree);
        const MultiPatch<2> result = interpolate<2>(ring, degree, std::array{3, 4});
        CHECK(result.interfaces == ring.interfaces);
        CHECK(result.boundary_sets == ring.boundary_sets);
        // 4 elements of two patches and 3 of the one that reads its directions turned make 6.
        CHECK(result.patches[0].space().n_elements() == std::array{3, 6});
        CHECK(result.patches[2].space().n_elements() == std::array{6, 4});
        for (const Interface<2>& interface : result.interfaces) {
            const Surface& first = result.patches[interface.first_patch];
            const Surface& second = result.patches[interface.second_patch];
            const auto here =
                functions_on<2>(first.space(), make_side<2>(0, interface.first_side).position);
            const auto there = matching_functions<2>(second.space(), interface);
            for (std::size_t i = 0; i < here.size(); ++i) {
                CHECK(first.control_points().row(here[i]) == second.control_points().row(there[i]));
            }
        }
        const Space<2> space(result);
        CHECK(space.is_isoparametric());
    }
}

TEST_CASE("interpolate: splines of the geometry's own space are reproduced", "[topology]") {
    MultiPatch<3> box;
    const KnotVector quadratic(2, {0, 0, 0, 0.3, 1, 1, 1});
    const KnotVector kinked(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1});
    const KnotVector linear = KnotVector::uniform(1, 2);
    box.patches = {make_mapped_patch<3>(
        TensorSpace<3>{{quadratic, kinked, linear}}, [](const Vector3& xi) -> VectorX {
            return Vector3(xi[0] + 0.2 * xi[1] * xi[1], xi[1] - 0.1 * xi[0] * xi[2], xi[2]);
        })};
    const MultiPatch<3> result = interpolate<3>(box, {}, {});
    CHECK(result.patches[0].space() == box.patches[0].space());
    CHECK((result.patches[0].control_points() - box.patches[0].control_points()).norm() < 1e-13);
    const MultiPatch<3> raised = interpolate<3>(box, 3, std::array{2, 4, 2});
    const MultiPatch<3> refined = refine<3>(box, 3, std::array{2, 4, 2});
    for (const Vector3& xi : {Vector3(0.1, 0.55, 0.9), Vector3(0.7, 0.2, 0.3)}) {
        CHECK((raised.patches[0].point(xi) - refined.patches[0].point(xi)).norm() < 1e-13);
    }
}

TEST_CASE("interpolate: at the geometry's breakpoints no smoother than the geometry",
          "[topology]") {
    MultiPatch<2> half;
    half.patches = {make_sector(0.0, pi)};
    for (int degree = 1; degree <= 4; ++degree) {
        CAPTURE(degree);
        const KnotVector knots = interpolate<2>(half, degree, std::array{4, 1}).patches[0].knots(0);
        CHECK(knots.multiplicities() == std::vector<int>{degree + 1, 1, degree, 1, degree + 1});
    }
}

TEST_CASE("interpolate: straight sides stay straight", "[topology]") {
    const MultiPatch<2> result = interpolate<2>(make_ring(), 2, std::array{5, 5});
    const Surface& first = result.patches[0];
    for (const int i : functions_on<2>(first.space(), make_side<2>(0, 0).position)) {
        CHECK(std::abs(first.control_points()(i, 1)) < rounding);
    }
}

TEST_CASE("interpolate: degrees out of range are refused", "[topology]") {
    CHECK_THROWS_WITH(interpolate<2>(make_ring(), 0, {}),
                      "interpolate: degree 0 is out of range; it must lie in [1, 8]");
    CHECK_THROWS_AS(interpolate<2>(make_ring(), 9, {}), InputError);
    CHECK_THROWS_AS(interpolate<2>(make_ring(), 1, std::array{0, 1}), InputError);
}

}  // namespace couture::iga
