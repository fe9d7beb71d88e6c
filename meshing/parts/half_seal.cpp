#include "meshing/parts/half_seal.h"

#include <array>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

constexpr int n_ring_cuboids = 9;
constexpr int arm = n_ring_cuboids;

/// Elements at one division, per cut and direction.
constexpr int n_radial = 2;
constexpr std::array<int, 3> n_around = {6, 3, 6};
/// Beside the arm, elements around are larger at its sides and at the cuts by this part, and
/// smaller in the middle, where the ring folds when the arm is pushed in.
constexpr double grading = 0.3;
constexpr std::array<int, 3> n_along_z = {1, 2, 1};
constexpr int n_along_arm = 4;

void check_whole(const PartValues& values, const std::string& name) {
    if (values.at(name) != std::round(values.at(name))) {
        throw InputError("half_seal: {} = {} is not a whole number; take {} or {}", name,
                         values.at(name), std::floor(values.at(name)), std::ceil(values.at(name)));
    }
}

iga::MultiPatch<3> make_cuboids(const PartValues& values) {
    constexpr double right_angle = std::numbers::pi / 2;
    const double inner = values.at("inner_radius");
    const double outer = values.at("outer_radius");
    const double arm_angle = std::asin(values.at("arm_half_width") / outer);
    const std::array<double, 4> angles = {-right_angle, -arm_angle, arm_angle, right_angle};
    const double arm_top = values.at("arm_height") / 2;
    const double ring_top = values.at("ring_height") / 2;
    const std::array<double, 4> heights = {-ring_top, -arm_top, arm_top, ring_top};
    iga::MultiPatch<3> cuboids;
    for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) {
            const double sweep = angles[j + 1] - angles[j];
            const iga::Surface sector = blend<1>(iga::make_arc(inner, angles[j], sweep),
                                                 iga::make_arc(outer, angles[j], sweep));
            cuboids.patches.push_back(make_slab(sector, heights[k], heights[k + 1]));
        }
    }
    // The cap has the weights of the arc: a line of the arm keeps its y.
    const iga::Curve foot = iga::make_arc(outer, -arm_angle, 2 * arm_angle);
    const double cap = values.at("arm_length");
    const iga::Curve end =
        mapped<1>(foot, [cap](const VectorX& x) -> VectorX { return Vector2(cap, x[1]); });
    cuboids.patches.push_back(make_slab(blend<1>(foot, end), -arm_top, arm_top));
    return cuboids;
}

void add_sets(iga::MultiPatch<3>& seal, const PartValues& values) {
    const double tolerance = place_tolerance(seal);
    const double half_width = values.at("arm_half_width");
    const double arm_top = values.at("arm_height") / 2;
    const double ring_top = values.at("ring_height") / 2;
    const Place cut = on_plane(0, 0.0, tolerance);
    name_outer_sides(seal, "cap", on_plane(0, values.at("arm_length"), tolerance));
    name_outer_sides(seal, "cut_low", [&](const Vector3& x) { return cut(x) && x[1] < 0.0; });
    name_outer_sides(seal, "cut_high", [&](const Vector3& x) { return cut(x) && x[1] > 0.0; });
    name_outer_sides(seal, "cuts", cut);
    name_outer_sides(seal, "inner", on_cylinder(2, values.at("inner_radius"), tolerance));
    name_outer_sides(seal, "outer", on_cylinder(2, values.at("outer_radius"), tolerance));
    name_outer_sides(seal, "bottom", on_plane(2, -ring_top, tolerance));
    name_outer_sides(seal, "top", on_plane(2, ring_top, tolerance));
    name_outer_sides(seal, "arm_left", on_plane(1, half_width, tolerance));
    name_outer_sides(seal, "arm_right", on_plane(1, -half_width, tolerance));
    name_outer_sides(seal, "arm_bottom", on_plane(2, -arm_top, tolerance));
    name_outer_sides(seal, "arm_top", on_plane(2, arm_top, tolerance));
    for (const iga::End end : {iga::End::low, iga::End::high}) {
        seal.boundary_sets["root"].push_back({arm, {iga::End::low, end, iga::End::free}});
        seal.boundary_sets["root"].push_back({arm, {iga::End::low, iga::End::free, end}});
    }
}

/// The breakpoints moved towards the middle.
iga::KnotVector graded(const iga::KnotVector& knots) {
    std::vector<double> moved;
    for (const double at : knots.knots()) {
        const double u = (at - knots.front()) / (knots.back() - knots.front());
        const double v =
            u + grading / (2.0 * std::numbers::pi) * std::sin(2.0 * std::numbers::pi * u);
        const bool is_end = at == knots.front() || at == knots.back();
        moved.push_back(is_end ? at : knots.front() + v * (knots.back() - knots.front()));
    }
    return {knots.degree(), std::move(moved)};
}

void divide(iga::MultiPatch<3>& seal, int divisions) {
    for (int p = 0; p < seal.n_patches(); ++p) {
        const std::array<int, 3> n_elements =
            p == arm ? std::array{n_along_arm, n_around[1], n_along_z[1]}
                     : std::array{n_radial, n_around[p % 3], n_along_z[p / 3]};
        iga::TensorSpace<3> space = seal.patches[p].space();
        for (int k = 0; k < 3; ++k) {
            iga::KnotVector& knots = space.knots[k];
            knots = iga::refine(knots, knots.degree(), divisions * n_elements[k]).knots;
            if (k == 1 && p != arm && p % 3 != 1) {
                knots = graded(knots);
            }
        }
        seal.patches[p] = iga::refine_to(seal.patches[p], space);
    }
}

iga::MultiPatch<3> make_half_seal(const PartValues& values) {
    check_whole(values, "divisions");
    iga::MultiPatch<3> seal = make_cuboids(values);
    iga::find_interfaces(seal, interface_tolerance);
    add_sets(seal, values);
    const int divisions = static_cast<int>(values.at("divisions"));
    if (divisions > 0) {
        divide(seal, divisions);
    }
    return seal;
}

}  // namespace

std::vector<PartDefinition> half_seal_parts() {
    return {{{"half_seal",
              "The x >= 0 half of a ring about z with one arm along x, in mm: nine cuboids of the "
              "ring and the arm. Sets: cap (x = arm_length), cut_low and cut_high (x = 0, y < 0 "
              "and y > 0), cuts (both), inner, outer, bottom, top, arm_left and arm_right (y = +- "
              "arm_half_width), arm_bottom, arm_top; root: re-entrant edges where the arm meets "
              "the ring.",
              {{"arm_half_width", 13.0, 11.0, 15.0, "half the arm's size along y, mm"},
               {"inner_radius", 25.0, 20.0, 30.0, "radius of the hole, mm"},
               {"outer_radius", 40.0, 35.0, 45.0, "outer radius of the ring, mm"},
               {"ring_height", 31.5, 28.0, 35.0, "the ring's size along z, mm"},
               {"arm_height", 13.0, 10.0, 16.0, "the arm's size along z, mm"},
               {"arm_length", 65.0, 50.0, 80.0, "from the axis to the cap, mm"},
               {"divisions", 1.0, 0.0, 20.0,
                "whole number k: 144 k^3 elements, finest where the ring folds; 0: the cuboids"}},
              3},
             make_half_seal}};
}

}  // namespace couture::meshing
