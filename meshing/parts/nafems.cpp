#include "meshing/parts/nafems.h"

#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

/// The quarter ring: radius from ellipse AD to ellipse BC, angle from y = 0 to x = 0.
iga::Surface make_elliptic_ring(const std::string& part, const PartValues& values) {
    check_less(part, values, "inner_x", "outer_x");
    check_less(part, values, "inner_y", "outer_y");
    constexpr double right_angle = std::numbers::pi / 2;
    return blend<1>(
        iga::make_ellipse_arc(values.at("inner_x"), values.at("inner_y"), 0.0, right_angle),
        iga::make_ellipse_arc(values.at("outer_x"), values.at("outer_y"), 0.0, right_angle));
}

iga::MultiPatch<2> make_le1(const PartValues& values) {
    iga::MultiPatch<2> membrane;
    membrane.patches.push_back(make_elliptic_ring("le1_membrane", values));
    membrane.boundary_sets = {{"ad", {iga::make_side<2>(0, 0)}},
                              {"bc", {iga::make_side<2>(0, 1)}},
                              {"cd", {iga::make_side<2>(0, 2)}},
                              {"ab", {iga::make_side<2>(0, 3)}}};
    return membrane;
}

iga::MultiPatch<3> make_le10(const PartValues& values) {
    const iga::Surface ring = make_elliptic_ring("le10_plate", values);
    const double thickness = values.at("thickness");
    iga::MultiPatch<3> plate;
    plate.patches = {make_slab(ring, 0.0, thickness / 2),
                     make_slab(ring, thickness / 2, thickness)};
    iga::find_interfaces(plate, interface_tolerance);
    const auto both = [](int side) {
        return iga::BoundarySet<3>{iga::make_side<3>(0, side), iga::make_side<3>(1, side)};
    };
    using iga::End;
    plate.boundary_sets = {{"adad", both(0)},
                           {"bcbc", both(1)},
                           {"dcdc", both(2)},
                           {"abab", both(3)},
                           {"bottom", {iga::make_side<3>(0, 4)}},
                           {"top", {iga::make_side<3>(1, 5)}},
                           {"mid_line", {{0, {End::high, End::free, End::high}}}}};
    return plate;
}

}  // namespace

std::vector<PartDefinition> nafems_parts() {
    const std::vector<PartParameter> plane = {
        length_parameter("inner_x", 2.0, "half axis OD of the inner ellipse along x"),
        length_parameter("inner_y", 1.0, "half axis OA of the inner ellipse along y"),
        length_parameter("outer_x", 3.25, "half axis OC of the outer ellipse, larger than inner_x"),
        length_parameter("outer_y", 2.75,
                         "half axis OB of the outer ellipse, larger than inner_y")};
    std::vector<PartParameter> solid = plane;
    solid.push_back(length_parameter("thickness", 0.6, "size along z"));
    return {{{"le1_membrane",
              "Quarter elliptic ring of NAFEMS LE1. Sets: ab (x = 0), bc (outer ellipse), cd (y = "
              "0), ad "
              "(inner ellipse).",
              plane, 2},
             make_le1},
            {{"le10_plate",
              "Quarter elliptic thick plate of NAFEMS LE10, 0 <= z <= thickness, two patches. "
              "Sets: dcdc "
              "(y = 0), abab (x = 0), bcbc (outer ellipse), adad (inner ellipse), bottom, top, "
              "mid_line "
              "(edge of bcbc at mid-thickness).",
              solid, 3},
             make_le10}};
}

}  // namespace couture::meshing
