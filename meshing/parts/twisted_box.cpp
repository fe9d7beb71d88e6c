#include "meshing/parts/twisted_box.h"

#include <cmath>
#include <numbers>

#include "iga/spline/shapes.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

iga::MultiPatch<3> make_twisted_box(const PartValues& values) {
    constexpr int section_degree = 2;
    constexpr int axis_degree = 3;
    const double width = values.at("width");
    const double length = values.at("length");
    const iga::TensorSpace<3> space{{iga::KnotVector::uniform(section_degree, 1),
                                     iga::KnotVector::uniform(section_degree, 1),
                                     iga::KnotVector::uniform(axis_degree, 1)}};
    MatrixX control_points(space.n_basis(), 3);
    for (int index = 0; index < space.n_basis(); ++index) {
        const auto i = space.indices(index);
        const double x = width * (i[0] / double(section_degree) - 0.5);
        const double y = width * (i[1] / double(section_degree) - 0.5);
        const double zeta = i[2] / double(axis_degree);
        const double angle = values.at("twist") * zeta;
        const double shift = values.at("bow") * 4.0 * zeta * (1.0 - zeta);
        control_points.row(index) << std::cos(angle) * x - std::sin(angle) * y + shift,
            std::sin(angle) * x + std::cos(angle) * y, length * zeta;
    }
    iga::MultiPatch<3> box;
    box.patches.emplace_back(space, control_points);
    box.boundary_sets = {
        {"x_low", {iga::make_side<3>(0, 0)}}, {"x_high", {iga::make_side<3>(0, 1)}},
        {"y_low", {iga::make_side<3>(0, 2)}}, {"y_high", {iga::make_side<3>(0, 3)}},
        {"z_low", {iga::make_side<3>(0, 4)}}, {"z_high", {iga::make_side<3>(0, 5)}}};
    return box;
}

}  // namespace

std::vector<PartDefinition> twisted_box_parts() {
    return {
        {{"twisted_box",
          "Square bar along z, 0 <= z <= length, twisted about z and bowed along x, one polynomial "
          "patch of degrees (2, 2, 3). Sets: x_low, x_high, y_low, y_high (before the twist), "
          "z_low, "
          "z_high.",
          {length_parameter("width", 1.0, "side of the square section"),
           length_parameter("length", 2.0, "size along z"),
           {"twist", 0.6, -std::numbers::pi / 2, std::numbers::pi / 2,
            "angle between the end sections, radians"},
           {"bow", 0.2, -10.0, 10.0, "4/3 of the axis' shift along x at half length, a length"}},
          3},
         make_twisted_box}};
}

}  // namespace couture::meshing
