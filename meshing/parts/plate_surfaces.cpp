#include "meshing/parts/plate_surfaces.h"

#include <fmt/format.h>

#include <array>

namespace couture::meshing {

namespace {

constexpr double width = 100.0;
constexpr double height = 200.0;
constexpr double thickness = 10.0;

struct RoundHole {
    std::string name;
    double y = 0.0;
    double radius = 0.0;
};

void build_plate(const std::vector<RoundHole>& holes, PartSurfaceBuilder& builder) {
    const auto face = [&](const char* name) { return builder.add_face(name, PartFaceKind::plane); };
    const std::array<int, 2> x_faces = {face("x_low"), face("x_high")};
    const std::array<int, 2> y_faces = {face("y_low"), face("y_high")};
    const std::array<int, 2> z_faces = {face("z_low"), face("z_high")};
    // [x][y][z]
    std::array<std::array<std::array<int, 2>, 2>, 2> corner{};
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            for (int k = 0; k < 2; ++k) {
                corner[i][j][k] =
                    builder.add_vertex({(i - 0.5) * width, j * height, k * thickness});
            }
        }
    }
    std::array<std::vector<int>, 2> circles;
    for (const RoundHole& hole : holes) {
        const int wall = builder.add_face(hole.name, PartFaceKind::cylinder);
        const auto low = builder.add_circle({0.0, hole.y, 0.0}, hole.radius);
        const auto high = builder.add_circle({0.0, hole.y, thickness}, hole.radius);
        builder.add_cylinder(wall, low, high, Facing::inwards);
        circles[0].insert(circles[0].end(), low.arcs.begin(), low.arcs.end());
        circles[1].insert(circles[1].end(), high.arcs.begin(), high.arcs.end());
    }
    for (int e = 0; e < 2; ++e) {
        const int sign = e == 1 ? 1 : -1;
        const auto& x = corner[e];
        builder.add_polygon(x_faces[e], {x[0][0], x[1][0], x[1][1], x[0][1]}, 0, sign);
        builder.add_polygon(y_faces[e],
                            {corner[0][e][0], corner[1][e][0], corner[1][e][1], corner[0][e][1]}, 1,
                            sign);
        builder.add_polygon(z_faces[e],
                            {corner[0][0][e], corner[1][0][e], corner[1][1][e], corner[0][1][e]}, 2,
                            sign, circles[e]);
    }
}

}  // namespace

std::vector<PartSurfaceDefinition> plate_surfaces() {
    constexpr double two_hole_radius = 25.0;
    return {{{"plate",
              "Plate of 100 x 200 x 10 mm, -50 <= x <= 50, y and z from 0, with a round hole on x "
              "= 0. Faces: x_low, x_high, y_low, y_high, z_low, z_high, hole.",
              {{"P1", 35.0, 20.0, 50.0, "diameter of the hole, mm"},
               {"P2", 100.0, 70.0, 130.0, "height y of the hole's axis, mm"}}},
             4.0,
             [](const PartValues& values, PartSurfaceBuilder& builder) {
                 build_plate({{"hole", values.at("P2"), values.at("P1") / 2}}, builder);
             }},
            {{"plate_with_two_holes",
              "Plate of 100 x 200 x 10 mm, -50 <= x <= 50, y and z from 0, with round holes of "
              "radius 25 about (0, 50) and (0, 150). Faces: x_low, x_high, y_low, y_high, z_low, "
              "z_high, hole_1, hole_2.",
              {}},
             4.0,
             [](const PartValues& /*values*/, PartSurfaceBuilder& builder) {
                 build_plate({{"hole_1", height / 4, two_hole_radius},
                              {"hole_2", 3 * height / 4, two_hole_radius}},
                             builder);
             }}};
}

}  // namespace couture::meshing
