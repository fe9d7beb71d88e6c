#include "meshing/parts/annulus.h"

#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

iga::Surface make_sector(const PartValues& values, double start, double sweep) {
    return blend<1>(iga::make_arc(values.at("inner_radius"), start, sweep),
                    iga::make_arc(values.at("outer_radius"), start, sweep));
}

iga::MultiPatch<2> make_quarter(const PartValues& values) {
    iga::MultiPatch<2> quarter;
    quarter.patches.push_back(make_sector(values, 0.0, pi / 2));
    quarter.boundary_sets = {{"inner", {iga::make_side<2>(0, 0)}},
                             {"outer", {iga::make_side<2>(0, 1)}},
                             {"cut_y", {iga::make_side<2>(0, 2)}},
                             {"cut_x", {iga::make_side<2>(0, 3)}}};
    return quarter;
}

iga::MultiPatch<3> make_quarter_3d(const PartValues& values) {
    iga::MultiPatch<3> quarter = make_slabs(make_quarter(values), 0.0, values.at("length"));
    quarter.boundary_sets = {
        {"inner", {iga::make_side<3>(0, 0)}}, {"outer", {iga::make_side<3>(0, 1)}},
        {"cut_y", {iga::make_side<3>(0, 2)}}, {"cut_x", {iga::make_side<3>(0, 3)}},
        {"z_low", {iga::make_side<3>(0, 4)}}, {"z_high", {iga::make_side<3>(0, 5)}}};
    return quarter;
}

iga::MultiPatch<2> make_half(const PartValues& values) {
    iga::MultiPatch<2> half;
    half.patches = {make_sector(values, -pi / 2, pi / 2), make_sector(values, 0.0, pi / 2)};
    iga::find_interfaces(half, interface_tolerance);
    half.boundary_sets = {{"inner", {iga::make_side<2>(0, 0), iga::make_side<2>(1, 0)}},
                          {"outer", {iga::make_side<2>(0, 1), iga::make_side<2>(1, 1)}},
                          {"axis", {iga::make_side<2>(0, 2), iga::make_side<2>(1, 3)}}};
    return half;
}

std::vector<PartParameter> radii() {
    return {length_parameter("inner_radius", 1.0, "inner radius"),
            length_parameter("outer_radius", 2.0, "outer radius, larger than the inner")};
}

PartDefinition plane_part(const std::string& name) {
    return {
        {name,
         "Quarter ring in the first quadrant. Sets: inner, outer, cut_x (x = 0), cut_y (y = 0).",
         radii(), 2},
        [name](const PartValues& values) {
            check_less(name, values, "inner_radius", "outer_radius");
            return make_quarter(values);
        }};
}

PartDefinition solid_part(const std::string& name) {
    std::vector<PartParameter> parameters = radii();
    parameters.push_back(length_parameter("length", 1.0, "size along z"));
    return {
        {name,
         "Quarter pipe about z in the first quadrant, 0 <= z <= length. Sets: inner, outer, cut_x "
         "(x = 0), cut_y (y = 0), z_low, z_high.",
         parameters, 3},
        [name](const PartValues& values) {
            check_less(name, values, "inner_radius", "outer_radius");
            return make_quarter_3d(values);
        }};
}

}  // namespace

std::vector<PartDefinition> annulus_parts() {
    return {
        plane_part("quarter_annulus"),
        solid_part("quarter_annulus_3d"),
        plane_part("thick_cylinder"),
        solid_part("thick_cylinder_3d"),
        {{"half_annulus",
          "Half ring x >= 0: meridian of a hollow sphere for axisymmetric problems (x radius, y "
          "axis). "
          "Sets: inner, outer, axis (x = 0).",
          radii(), 2},
         [](const PartValues& values) {
             check_less("half_annulus", values, "inner_radius", "outer_radius");
             return make_half(values);
         }},
    };
}

}  // namespace couture::meshing
