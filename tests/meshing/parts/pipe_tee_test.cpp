#include "meshing/parts/pipe_tee.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/meshing/parts/part_probe.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// Three pipes up to the axes' crossing, less what each mitre cuts off.
double exact_volume(double r_i, double r_o, double L, double H) {
    return (r_o * r_o - r_i * r_i) * pi * (2 * L + H) -
           8.0 / 3.0 * (r_o * r_o * r_o - r_i * r_i * r_i);
}

/// Number of edges of patches whose middle is at `point`.
int n_edges_at(const iga::MultiPatch<3>& part, const Vector3& point) {
    int count = 0;
    for (int patch = 0; patch < part.n_patches(); ++patch) {
        for (const auto& edge : iga::entities_of_patch<3>(patch, 1)) {
            for_each_parameter<3>(part, edge, 3, [&](const Vector3& xi) {
                const bool is_here = (part.patches[patch].point(xi) - point).norm() < 1e-12;
                count += is_here ? 1 : 0;
            });
        }
    }
    return count;
}

}  // namespace

TEST_CASE("pipe_tee: 12 patches, 18 interfaces, 36 outer sides", "[parts]") {
    const iga::MultiPatch<3> tee = make_solid_part("pipe_tee");
    CHECK(tee.n_patches() == 12);
    CHECK(tee.interfaces.size() == 18);
    CHECK(tee.outer_sides().size() == 36);
    CHECK(tee.boundary_set("inner").size() == 12);
    CHECK(tee.boundary_set("outer").size() == 12);
    CHECK(tee.boundary_set("run_end_low").size() == 4);
    CHECK(tee.boundary_set("run_end_high").size() == 4);
    CHECK(tee.boundary_set("branch_end").size() == 4);
    CHECK(tee.boundary_set("mid_plane").size() == 6);
}

TEST_CASE("pipe_tee: two edges carry six patches", "[parts]") {
    const iga::MultiPatch<3> tee = make_solid_part("pipe_tee");
    CHECK(n_edges_at(tee, {0, 0.85, 0}) == 6);
    CHECK(n_edges_at(tee, {0, -0.85, 0}) == 6);
    CHECK(n_edges_at(tee, {0, 0, -0.85}) == 4);
    CHECK(n_edges_at(tee, {0.85, 0, 0.85}) == 4);
}

TEST_CASE("pipe_tee: the volume is exact", "[parts]") {
    constexpr double rounding = 1e-14;
    CHECK(iga::volume(make_solid_part("pipe_tee")) ==
          Approx(exact_volume(0.7, 1.0, 2.5, 2.5)).epsilon(rounding));
    const iga::MultiPatch<3> other = make_solid_part("pipe_tee", {{"inner_radius", 30},
                                                                  {"outer_radius", 36},
                                                                  {"run_half_length", 90},
                                                                  {"branch_length", 60}});
    CHECK(iga::volume(other) == Approx(exact_volume(30, 36, 90, 60)).epsilon(rounding));
}

TEST_CASE("pipe_tee: walls are exact cylinders, ends and the plane of symmetry are plane",
          "[parts]") {
    const iga::MultiPatch<3> tee = make_solid_part("pipe_tee");
    constexpr double rounding = 1e-14;
    const auto off_wall = [](double radius) {
        return [radius](const VectorX& x) {
            const double from_run = std::abs(std::hypot(x[1], x[2]) - radius);
            const double from_branch = std::abs(std::hypot(x[0], x[1]) - radius);
            return std::min(from_run, from_branch);
        };
    };
    CHECK(largest_on<3>(tee, "inner", off_wall(0.7)) < rounding);
    CHECK(largest_on<3>(tee, "outer", off_wall(1.0)) < rounding);
    CHECK(largest_on<3>(tee, "run_end_low", [](const VectorX& x) { return x[0] + 2.5; }) <
          rounding);
    CHECK(largest_on<3>(tee, "run_end_high", [](const VectorX& x) { return x[0] - 2.5; }) <
          rounding);
    CHECK(largest_on<3>(tee, "branch_end", [](const VectorX& x) { return x[2] - 2.5; }) < rounding);
    CHECK(largest_on<3>(tee, "mid_plane", [](const VectorX& x) { return x[1]; }) < rounding);
}

TEST_CASE("pipe_tee: quality is that of the mitre", "[parts]") {
    const iga::MultiPatch<3> tee = make_solid_part("pipe_tee");
    // At the inner crotch: wall 0.3, arc sqrt 2 * 0.7, axis 2.5 - 0.7.
    CHECK(smallest_jacobian(tee, false) == Approx(0.3 * std::sqrt(2.0) * 0.7 * 1.8));
    // On the mitre at angle t: 1 / sqrt((1 + sin^2 t)(1 + cos^2 t)), smallest at 45 degrees.
    CHECK(smallest_jacobian(tee, true) == Approx(2.0 / 3.0));
}

}  // namespace couture::meshing
