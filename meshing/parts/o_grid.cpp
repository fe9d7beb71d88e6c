#include "meshing/parts/o_grid.h"

#include <cmath>
#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

Vector2 corner(double radius, int i) {
    const double angle = pi / 4 + i * pi / 2;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

iga::MultiPatch<2> make_disc(double radius, double core_radius) {
    iga::MultiPatch<2> disc;
    // The core between two opposite edges, of degree 2 in both directions as the arcs ask for.
    const iga::Curve south = make_segment(corner(core_radius, 2), corner(core_radius, 3), 2);
    const iga::Curve north = make_segment(corner(core_radius, 1), corner(core_radius, 0), 2);
    const iga::Curve west = make_segment(corner(core_radius, 2), corner(core_radius, 1), 2);
    const iga::Curve east = make_segment(corner(core_radius, 3), corner(core_radius, 0), 2);
    disc.patches.push_back(iga::make_coons(south, north, west, east));
    for (int i = 0; i < 4; ++i) {
        const iga::Curve edge = make_segment(corner(core_radius, i), corner(core_radius, i + 1), 2);
        disc.patches.push_back(blend<1>(edge, iga::make_arc(radius, pi / 4 + i * pi / 2, pi / 2)));
    }
    return disc;
}

iga::MultiPatch<3> make_cylinder(const PartValues& values) {
    const double radius = values.at("radius");
    const double length = values.at("length");
    iga::MultiPatch<3> cylinder =
        make_slabs(make_disc(radius, values.at("core") * radius), 0.0, length);
    iga::find_interfaces(cylinder, interface_tolerance);
    const double tolerance = place_tolerance(cylinder);
    name_outer_sides(cylinder, "wall", on_cylinder(2, radius, tolerance));
    name_outer_sides(cylinder, "z_low", on_plane(2, 0.0, tolerance));
    name_outer_sides(cylinder, "z_high", on_plane(2, length, tolerance));
    return cylinder;
}

}  // namespace

std::vector<PartDefinition> o_grid_parts() {
    return {
        {{"cylinder_o_grid",
          "Solid cylinder about z, 0 <= z <= length, of five patches. Sets: wall, z_low, z_high.",
          {length_parameter("radius", 1.0, "radius"),
           length_parameter("length", 2.0, "size along z"),
           {"core", 0.5, 0.1, 0.9, "half diagonal of the square core over the radius"}},
          3},
         make_cylinder}};
}

}  // namespace couture::meshing
