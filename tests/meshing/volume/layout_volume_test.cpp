#include "meshing/volume/layout_volume.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "iga/topology/side_patch.h"
#include "tests/meshing/volume/sampled_layouts.h"

namespace couture::meshing {

namespace {

using Catch::Matchers::Contains;

/// Neighbours share control points: nothing but rounding of the evaluation is left.
constexpr double exactly = 1e-12;

MappedLayout cylinder(int n) {
    return o_grid(n, false,
                  [](double x, double y, double along) { return Vector3(x, y, 2.0 * along); });
}

/// A quarter turn about the z axis over a height of 2.
Vector3 twisted(const Vector3& x) {
    const double angle = 0.5 * std::numbers::pi * x[2];
    const Eigen::AngleAxisd turn(angle, Vector3::UnitZ());
    return turn * Vector3(x[0] - 0.5, x[1] - 0.5, 2.0 * x[2]);
}

double distance_from_torus(const Vector3& x) {
    return std::abs(std::hypot(std::hypot(x[0], x[1]) - torus_radius, x[2]) - tube_radius);
}

iga::Validity worst_validity(const iga::MultiPatch<3>& volume) {
    iga::Validity worst = iga::Validity::valid;
    for (const auto& patch : volume.patches) {
        const auto certificate = iga::certify<3>(patch);
        CHECK(certificate.orientation == 1);
        worst = std::max(worst, certificate.validity);
    }
    return worst;
}

/// Largest of a function over all named sides.
double largest_on(const iga::MultiPatch<3>& volume, const std::string& set,
                  const std::function<double(const Vector3&)>& function) {
    double largest = 0.0;
    constexpr int n = 23;
    for (const auto& side : volume.boundary_set(set)) {
        const auto face = iga::entity_patch<3, 2>(volume.patches[side.patch], side.position);
        for (int i = 0; i <= n * n; ++i) {
            const Vector2 xi(static_cast<double>(i % n) / (n - 1),
                             std::min(1.0, i / n / (n - 1.0)));
            largest = std::max(largest, function(face.point(xi)));
        }
    }
    return largest;
}

struct Body {
    std::string name;
    MappedLayout layout;
    int euler_characteristic;
};

std::vector<Body> bodies() {
    return {{"cube", mapped_box({1, 1, 1}, [](const Vector3& x) { return x; }), 1},
            {"27 cuboids", mapped_box({3, 3, 3}, [](const Vector3& x) { return x; }), 1},
            {"cylinder", cylinder(2), 1},
            {"torus", torus_of_20(), 0},
            {"twisted box", mapped_box({1, 1, 1}, twisted), 1},
            {"twisted block", mapped_box({2, 2, 2}, twisted), 1}};
}

}  // namespace

TEST_CASE("make_layout_volume: samples of solids become certified volumes", "[volume]") {
    for (const int degree : {2, 3}) {
        for (const Body& body : bodies()) {
            const Timer timer;
            const LayoutVolume result = make_layout_volume(
                body.layout.layout, sample(body.layout, 12), {.degree = degree, .n_elements = {4}});
            const auto& report = result.report;
            UNSCOPED_INFO(
                fmt::format("{} degree {}: scaled Jacobian {:.4f} -> {:.4f}, mean {:.4f}, {} + {} "
                            "rounds, {:.2f} s",
                            body.name, degree, report.parameterization.min_scaled_jacobian_before,
                            report.quality.min_scaled_jacobian, report.quality.mean_scaled_jacobian,
                            report.parameterization.untangling_rounds,
                            report.parameterization.rounds, timer.seconds()));
            CHECK(report.euler_characteristic == body.euler_characteristic);
            CHECK_NOTHROW(iga::check(result.volume, exactly));
            CHECK(report.parameterization.validity == iga::Validity::valid);
            CHECK(worst_validity(result.volume) == iga::Validity::valid);
            CHECK(report.quality.min_scaled_jacobian > 0.2);
            CHECK(report.quality.min_scaled_jacobian ==
                  Approx(report.parameterization.min_scaled_jacobian_after));
            CHECK(worst_validity(
                      iga::refine<3>(result.volume, std::nullopt, std::array<int, 3>{8, 8, 8})) ==
                  iga::Validity::valid);
        }
    }
}

TEST_CASE("make_layout_volume: boundaries converge with h^(degree + 1)", "[volume]") {
    LayoutVolumeOptions options;
    options.parameterization.max_rounds = 0;
    options.parameterization.max_untangling_rounds = 0;
    const MappedLayout torus = torus_of_20();
    const MappedLayout tube = cylinder(1);
    const auto off_axis = [](const Vector3& x) { return std::abs(std::hypot(x[0], x[1]) - 1.0); };
    for (const int degree : {1, 2, 3}) {
        options.degree = degree;
        std::array<double, 2> before{};
        for (const int n : {2, 4, 8}) {
            options.n_elements = {n};
            const auto ring = make_layout_volume(torus.layout, sample(torus, 3 * n), options);
            const auto bar = make_layout_volume(tube.layout, sample(tube, 3 * n), options);
            const std::array<double, 2> error{largest_on(ring.volume, "wall", distance_from_torus),
                                              largest_on(bar.volume, "wall", off_axis)};
            CAPTURE(degree, n, options.fit.n_corrections, error, before);
            // Samples are on the surfaces: they can't be nearer than the splines are.
            CHECK(ring.report.max_distance < 1.5 * error[0]);
            CHECK(ring.report.rms_distance <= ring.report.max_distance);
            if (n == 8) {
                CHECK(std::log2(before[0] / error[0]) > degree + 0.6);
                CHECK(std::log2(before[1] / error[1]) > degree + 0.6);
            }
            before = error;
        }
    }
}

TEST_CASE("make_layout_volume: elements by sheet, sets and boundary of the layout", "[volume]") {
    const MappedLayout body = mapped_box({2, 1, 1}, twisted);
    const LayoutCells cells = make_layout_cells(body.layout);
    REQUIRE(cells.n_sheets() == 4);
    LayoutVolumeOptions options;
    options.n_elements = {1, 2, 3, 4};
    const LayoutVolume result = make_layout_volume(body.layout, sample(body, 8), options);
    for (int c = 0; c < 2; ++c) {
        for (int k = 0; k < 3; ++k) {
            CHECK(result.volume.patches[c].knots(k).n_elements() ==
                  options.n_elements[cells.sheets[cells.cuboid_edges[c][4 * k]]]);
        }
    }
    CHECK(result.volume.boundary_set("bottom").size() == 2);
    CHECK(result.volume.outer_sides().size() == 10);
    REQUIRE(result.volume.interfaces.size() == 1);
    CHECK_NOTHROW(iga::check(result.volume, exactly));
    // Turned sections of a prism: the sides are ruled, the splines close to them.
    CHECK(iga::volume(result.volume) == Approx(2.0).epsilon(0.01));
}

TEST_CASE("make_layout_volume: quads of the samples in any order and rotation", "[volume]") {
    const MappedLayout body = mapped_box({2, 1, 1}, twisted);
    LayoutVolumeOptions options;
    options.n_elements = {3};
    const LayoutSamples straight = sample(body, 6);
    LayoutSamples other = straight;
    std::vector<std::array<int, 4>> quads;
    const int n = 7;
    for (int q = straight.layout.n_quads(); q-- > 0;) {
        const auto& nodes = straight.layout.quads()[q];
        quads.push_back({nodes[1], nodes[2], nodes[3], nodes[0]});
        MatrixX points(3, n * n);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                points.col(i + n * j) = straight.quads[q].col(n - 1 - j + n * i);
            }
        }
        other.quads[straight.layout.n_quads() - 1 - q] = points;
    }
    other.layout = QuadLayout(straight.layout.n_nodes(), quads);
    const LayoutVolume a = make_layout_volume(body.layout, straight, options);
    const LayoutVolume b = make_layout_volume(body.layout, other, options);
    for (int p = 0; p < 2; ++p) {
        CHECK(a.volume.patches[p].control_points() == b.volume.patches[p].control_points());
    }
}

TEST_CASE("make_layout_volume: a sliding boundary keeps the shape and betters it", "[volume]") {
    // Elements crowd to one end of the cube's faces.
    const MappedLayout body = mapped_box({2, 2, 1}, [](const Vector3& x) {
        return Vector3(x[0] + 0.35 * std::sin(std::numbers::pi * x[0]) * (x[1] - 0.5), x[1], x[2]);
    });
    LayoutVolumeOptions options;
    const LayoutVolume held = make_layout_volume(body.layout, sample(body, 8), options);
    options.slide_boundary = true;
    const LayoutVolume slid = make_layout_volume(body.layout, sample(body, 8), options);
    CHECK(slid.report.quality.max_shape_ratio < 0.9 * held.report.quality.max_shape_ratio);
    CHECK(iga::volume(slid.volume) == Approx(1.0).epsilon(1e-9));
    CHECK(worst_validity(slid.volume) == iga::Validity::valid);
}

TEST_CASE("make_layout_volume: what does not fit is refused", "[volume]") {
    const MappedLayout body = mapped_box({1, 1, 1}, twisted);
    const LayoutSamples samples = sample(body, 6);
    const auto attempt = [&](const LayoutSamples& changed, LayoutVolumeOptions options) {
        options.parameterization.max_rounds = 0;
        (void)make_layout_volume(body.layout, changed, options);
    };
    CHECK_THROWS_WITH(attempt(samples, {.n_elements = {4}}),
                      Contains("has 6 cells for 4 spline elements") && Contains("sample finer"));
    CHECK_THROWS_WITH(attempt(samples, {.n_elements = {1, 2}}),
                      Contains("2 numbers of elements; give one, or one for each of the 3 sheets"));
    CHECK_THROWS_WITH(attempt(samples, {.n_elements = {0}}), Contains("0 elements in a sheet"));
    CHECK_THROWS_WITH(attempt(samples, {.n_elements = {2}, .fit = {.fairness = -1.0}}),
                      Contains("fairness = -1"));
    CHECK_THROWS_WITH(attempt(samples, {.n_elements = {2}, .fit = {.n_corrections = 21}}),
                      Contains("n_corrections = 21"));

    LayoutSamples changed = samples;
    changed.quads[2].col(3) += Vector3(0.0, 0.0, 1e-9);
    CHECK_THROWS_WITH(attempt(changed, {.n_elements = {2}}),
                      Contains("quad 2 and arc") && Contains("other points"));
    changed = samples;
    changed.arcs[4].col(0) += Vector3(0.0, 0.0, 1e-9);
    CHECK_THROWS_WITH(attempt(changed, {.n_elements = {2}}),
                      Contains("end at different points in node") || Contains("arc 4"));
    changed = samples;
    changed.quads[5](1, 17) = std::nan("");
    CHECK_THROWS_WITH(attempt(changed, {.n_elements = {2}}),
                      Contains("quad 5") && Contains("finite"));
    changed = samples;
    changed.n_cells.pop_back();
    CHECK_THROWS_WITH(attempt(changed, {.n_elements = {2}}), Contains("for 11 arcs"));
    const MappedLayout more = mapped_box({2, 1, 1}, twisted);
    CHECK_THROWS_AS(attempt(sample(more, 6), {.n_elements = {2}}), TopologyError);
    changed = samples;
    auto quads = samples.layout.quads();
    quads.pop_back();
    changed.layout = QuadLayout(8, quads);
    changed.quads.pop_back();
    CHECK_THROWS_WITH(attempt(changed, {.n_elements = {2}}),
                      Contains("5 quads, the layout 6 outer sides"));

    // Two cuboids that touch along an edge are no solid.
    VolumetricLayout touching{14, {{0, 1, 2, 3, 4, 5, 6, 7}, {3, 8, 9, 10, 7, 11, 12, 13}}, {}};
    CHECK_THROWS_AS(make_layout_volume(touching, samples), TopologyError);
}

}  // namespace couture::meshing
