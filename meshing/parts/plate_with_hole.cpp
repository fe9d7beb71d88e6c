#include "meshing/parts/plate_with_hole.h"

#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// Two patches between the hole's arc of 45 degrees and one outer side each.
iga::MultiPatch<2> make_patches(const PartValues& values) {
    const double radius = values.at("hole_radius");
    const double half_width = values.at("half_width");
    const Vector2 corner(half_width, half_width);
    iga::MultiPatch<2> plate;
    plate.patches.push_back(blend<1>(iga::make_arc(radius, 0.0, pi / 4),
                                     make_segment(Vector2(half_width, 0.0), corner, 2)));
    plate.patches.push_back(blend<1>(iga::make_arc(radius, pi / 4, pi / 4),
                                     make_segment(corner, Vector2(0.0, half_width), 2)));
    return plate;
}

template <int d>
void join_and_name(iga::MultiPatch<d>& plate, const PartValues& values) {
    iga::find_interfaces(plate, interface_tolerance);
    const double tolerance = place_tolerance(plate);
    const double half_width = values.at("half_width");
    name_outer_sides(plate, "hole", on_cylinder(2, values.at("hole_radius"), tolerance));
    name_outer_sides(plate, "cut_x", on_plane(0, 0.0, tolerance));
    name_outer_sides(plate, "cut_y", on_plane(1, 0.0, tolerance));
    name_outer_sides(plate, "x_high", on_plane(0, half_width, tolerance));
    name_outer_sides(plate, "y_high", on_plane(1, half_width, tolerance));
}

iga::MultiPatch<2> make_plate(const PartValues& values) {
    check_less("plate_with_hole", values, "hole_radius", "half_width");
    iga::MultiPatch<2> plate = make_patches(values);
    join_and_name(plate, values);
    return plate;
}

iga::MultiPatch<3> make_plate_3d(const PartValues& values) {
    check_less("plate_with_hole_3d", values, "hole_radius", "half_width");
    const double thickness = values.at("thickness");
    iga::MultiPatch<3> plate = make_slabs(make_patches(values), 0.0, thickness);
    join_and_name(plate, values);
    const double tolerance = place_tolerance(plate);
    name_outer_sides(plate, "z_low", on_plane(2, 0.0, tolerance));
    name_outer_sides(plate, "z_high", on_plane(2, thickness, tolerance));
    return plate;
}

}  // namespace

std::vector<PartDefinition> plate_with_hole_parts() {
    const std::vector<PartParameter> plane = {
        length_parameter("hole_radius", 1.0, "radius of the hole"),
        length_parameter("half_width", 4.0,
                         "from the hole's centre to an outer side, larger than the radius")};
    std::vector<PartParameter> solid = plane;
    solid.push_back(length_parameter("thickness", 1.0, "size along z"));
    return {{{"plate_with_hole",
              "First quadrant of a square plate with a hole about the origin. Sets: hole, cut_x (x "
              "= 0), "
              "cut_y (y = 0), x_high, y_high.",
              plane, 2},
             make_plate},
            {{"plate_with_hole_3d",
              "The same with a thickness, 0 <= z <= thickness. Sets: hole, cut_x, cut_y, x_high, "
              "y_high, "
              "z_low, z_high.",
              solid, 3},
             make_plate_3d}};
}

}  // namespace couture::meshing
