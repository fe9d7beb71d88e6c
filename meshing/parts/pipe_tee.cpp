#include "meshing/parts/pipe_tee.h"

#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

/// One of the four quarters of a pipe's section: a right-handed surface (radius, angle) in the
/// plane across the pipe.
iga::Surface make_section(const PartValues& values, int quadrant) {
    constexpr double right_angle = std::numbers::pi / 2;
    const double start = quadrant * right_angle;
    return blend<1>(iga::make_arc(values.at("inner_radius"), start, right_angle),
                    iga::make_arc(values.at("outer_radius"), start, right_angle));
}

/// Puts the section's plane (y, z) into space at x = slope_z * z + offset.
iga::Surface across_run(const iga::Surface& section, double slope_z, double offset) {
    return mapped<2>(section, [=](const VectorX& yz) -> VectorX {
        return Vector3(slope_z * yz[1] + offset, yz[0], yz[1]);
    });
}

/// Puts the section's plane (x, y) into space at z = slope_x * x + offset.
iga::Surface across_branch(const iga::Surface& section, double slope_x, double offset) {
    return mapped<2>(section, [=](const VectorX& xy) -> VectorX {
        return Vector3(xy[0], xy[1], slope_x * xy[0] + offset);
    });
}

void add_sets(iga::MultiPatch<3>& tee, const PartValues& values) {
    const double tolerance = place_tolerance(tee);
    const double L = values.at("run_half_length");
    const double H = values.at("branch_length");
    // A wall side lies on the run's or on the branch's cylinder, never on both.
    const auto name_wall = [&](const std::string& name, double radius) {
        name_outer_sides(tee, name, on_cylinder(0, radius, tolerance));
        name_outer_sides(tee, name, on_cylinder(2, radius, tolerance));
    };
    name_wall("inner", values.at("inner_radius"));
    name_wall("outer", values.at("outer_radius"));
    name_outer_sides(tee, "run_end_low", on_plane(0, -L, tolerance));
    name_outer_sides(tee, "run_end_high", on_plane(0, L, tolerance));
    name_outer_sides(tee, "branch_end", on_plane(2, H, tolerance));
    name_entities(tee, "mid_plane", 2, on_plane(1, 0.0, tolerance));
}

iga::MultiPatch<3> make_pipe_tee(const PartValues& values) {
    check_less("pipe_tee", values, "inner_radius", "outer_radius");
    check_less("pipe_tee", values, "outer_radius", "run_half_length");
    check_less("pipe_tee", values, "outer_radius", "branch_length");
    const double L = values.at("run_half_length");
    const double H = values.at("branch_length");
    iga::MultiPatch<3> tee;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const iga::Surface section = make_section(values, quadrant);
        // The run's upper quadrants end on the mitre, x = -z and x = z; its lower ones on x = 0.
        const double slope = quadrant < 2 ? 1.0 : 0.0;
        tee.patches.push_back(
            iga::make_ruled(across_run(section, 0.0, -L), across_run(section, -slope, 0.0)));
        tee.patches.push_back(
            iga::make_ruled(across_run(section, slope, 0.0), across_run(section, 0.0, L)));
    }
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const iga::Surface section = make_section(values, quadrant);
        // z = |x|: x is positive in the first and the last quadrant.
        const double slope = quadrant == 0 || quadrant == 3 ? 1.0 : -1.0;
        tee.patches.push_back(
            iga::make_ruled(across_branch(section, slope, 0.0), across_branch(section, 0.0, H)));
    }
    iga::find_interfaces(tee, interface_tolerance);
    add_sets(tee, values);
    return tee;
}

}  // namespace

std::vector<PartDefinition> pipe_tee_parts() {
    return {
        {{"pipe_tee",
          "Equal tee of thick pipes: run along x from -run_half_length to run_half_length, branch "
          "along z up to branch_length; 12 quarter pipes. Sets: inner, outer, run_end_low, "
          "run_end_high, branch_end; mid_plane (y = 0, interfaces inside the solid).",
          {length_parameter("inner_radius", 0.7, "inner radius of run and branch"),
           length_parameter("outer_radius", 1.0, "outer radius, larger than the inner"),
           length_parameter("run_half_length", 2.5,
                            "from the branch's axis to a run end, larger than the outer radius"),
           length_parameter("branch_length", 2.5,
                            "from the run's axis to the branch end, larger than the outer radius")},
          3},
         make_pipe_tee}};
}

}  // namespace couture::meshing
