#include "meshing/parts/cylindrical_shell.h"

#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// The sector 0 <= angle <= sweep, 0 <= y <= length / 2.
iga::Volume make_sector(const std::string& part, const PartValues& values, double sweep) {
    const double R = values.at("radius");
    const double t = values.at("thickness");
    if (t >= 2.0 * R) {
        throw InputError(
            "{}: thickness = {} is not smaller than twice the radius = {}; make it "
            "smaller",
            part, t, R);
    }
    const iga::Surface section =
        blend<1>(iga::make_arc(R - t / 2, 0.0, sweep), iga::make_arc(R + t / 2, 0.0, sweep));
    const auto at_y = [&](double y) {
        return mapped<2>(section,
                         [y](const VectorX& zx) -> VectorX { return Vector3(zx[1], y, zx[0]); });
    };
    return iga::make_ruled(at_y(0.0), at_y(values.at("length") / 2));
}

iga::MultiPatch<3> make_scordelis_lo(const PartValues& values) {
    const double sweep = values.at("half_angle");
    iga::MultiPatch<3> roof;
    roof.patches.push_back(make_sector("scordelis_lo", values, sweep));
    roof.boundary_sets = {
        {"inner", {iga::make_side<3>(0, 0)}},     {"outer", {iga::make_side<3>(0, 1)}},
        {"crown", {iga::make_side<3>(0, 2)}},     {"free_edge", {iga::make_side<3>(0, 3)}},
        {"diaphragm", {iga::make_side<3>(0, 4)}}, {"mid_span", {iga::make_side<3>(0, 5)}}};
    return roof;
}

iga::MultiPatch<3> make_pinched_cylinder(const PartValues& values) {
    iga::MultiPatch<3> cylinder;
    cylinder.patches.push_back(make_sector("pinched_cylinder", values, pi / 2));
    using iga::End;
    cylinder.boundary_sets = {{"inner", {iga::make_side<3>(0, 0)}},
                              {"outer", {iga::make_side<3>(0, 1)}},
                              {"cut_x", {iga::make_side<3>(0, 2)}},
                              {"cut_z", {iga::make_side<3>(0, 3)}},
                              {"diaphragm", {iga::make_side<3>(0, 4)}},
                              {"mid_span", {iga::make_side<3>(0, 5)}},
                              {"load_line", {{0, {End::free, End::low, End::high}}}},
                              {"load_point", {{0, {End::high, End::low, End::high}}}}};
    return cylinder;
}

}  // namespace

std::vector<PartDefinition> cylindrical_shell_parts() {
    constexpr double roof_half_angle = 40.0 * pi / 180.0;
    constexpr double smallest_angle = 0.01;
    constexpr double largest_angle = 3.0;
    return {{{"scordelis_lo",
              "Quarter of the Scordelis-Lo roof as a solid: (r sin t, y, r cos t), 0 <= t <= "
              "half_angle, "
              "0 <= y <= length / 2. Sets: diaphragm (y = 0), mid_span, crown (x = 0), free_edge, "
              "inner, "
              "outer.",
              {length_parameter("radius", 25.0, "radius of the middle surface"),
               length_parameter("length", 50.0, "length of the whole roof along y"),
               length_parameter("thickness", 0.25, "thickness"),
               {"half_angle", roof_half_angle, smallest_angle, largest_angle,
                "angle from crown to free edge, radians"}},
              3},
             make_scordelis_lo},
            {{"pinched_cylinder",
              "Octant of a cylindrical shell as a solid: (r sin t, y, r cos t), 0 <= t <= pi / 2, "
              "0 <= y <= length / 2. Sets: diaphragm (y = 0), mid_span, cut_x (x = 0), cut_z (z = "
              "0), inner, "
              "outer; load_line (edge through the thickness), load_point (its outer corner).",
              {length_parameter("radius", 300.0, "radius of the middle surface"),
               length_parameter("length", 600.0, "length of the whole cylinder along y"),
               length_parameter("thickness", 3.0, "thickness")},
              3},
             make_pinched_cylinder}};
}

}  // namespace couture::meshing
