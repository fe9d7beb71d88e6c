#include "meshing/parts/box.h"

#include "iga/spline/shapes.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

iga::MultiPatch<2> make_rectangle(const PartValues& values) {
    const Vector2 size(values.at("length_x"), values.at("length_y"));
    iga::MultiPatch<2> rectangle;
    rectangle.patches.push_back(iga::make_box<2>(size));
    rectangle.boundary_sets = {{"x_low", {iga::make_side<2>(0, 0)}},
                               {"x_high", {iga::make_side<2>(0, 1)}},
                               {"y_low", {iga::make_side<2>(0, 2)}},
                               {"y_high", {iga::make_side<2>(0, 3)}}};
    return rectangle;
}

iga::MultiPatch<3> make_solid_box(const Vector3& size) {
    iga::MultiPatch<3> box;
    box.patches.push_back(iga::make_box<3>(size));
    box.boundary_sets = {
        {"x_low", {iga::make_side<3>(0, 0)}}, {"x_high", {iga::make_side<3>(0, 1)}},
        {"y_low", {iga::make_side<3>(0, 2)}}, {"y_high", {iga::make_side<3>(0, 3)}},
        {"z_low", {iga::make_side<3>(0, 4)}}, {"z_high", {iga::make_side<3>(0, 5)}}};
    return box;
}

iga::MultiPatch<3> make_cantilever(const PartValues& values) {
    iga::MultiPatch<3> beam =
        make_solid_box(Vector3(values.at("length"), values.at("width"), values.at("height")));
    beam.boundary_sets = {
        {"clamped", {iga::make_side<3>(0, 0)}}, {"tip", {iga::make_side<3>(0, 1)}},
        {"front", {iga::make_side<3>(0, 2)}},   {"back", {iga::make_side<3>(0, 3)}},
        {"bottom", {iga::make_side<3>(0, 4)}},  {"top", {iga::make_side<3>(0, 5)}}};
    return beam;
}

}  // namespace

std::vector<PartDefinition> box_parts() {
    return {
        {{"rectangle",
          "Rectangle [0, length_x] x [0, length_y]. Sets: x_low, x_high, y_low, y_high.",
          {length_parameter("length_x", 1.0, "size along x"),
           length_parameter("length_y", 1.0, "size along y")},
          2},
         make_rectangle},
        {{"box",
          "Box from the origin to (length_x, length_y, length_z). Sets: x_low, x_high, y_low, "
          "y_high, "
          "z_low, z_high.",
          {length_parameter("length_x", 1.0, "size along x"),
           length_parameter("length_y", 1.0, "size along y"),
           length_parameter("length_z", 1.0, "size along z")},
          3},
         [](const PartValues& values) {
             return make_solid_box(
                 {values.at("length_x"), values.at("length_y"), values.at("length_z")});
         }},
        {{"cantilever",
          "Straight beam from x = 0 (clamped) to x = length (tip), width along y, height along z. "
          "Sets: clamped, tip, front (y = 0), back, bottom (z = 0), top.",
          {length_parameter("length", 10.0, "size along x"),
           length_parameter("width", 1.0, "size along y"),
           length_parameter("height", 1.0, "size along z")},
          3},
         make_cantilever},
    };
}

}  // namespace couture::meshing
