#include "meshing/parts/wheel_surface.h"

#include <array>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// How far the boss stands out of the hub on each side, mm.
constexpr double boss_rise = 4.0;

using Circle = PartSurfaceBuilder::Circle;

std::vector<int> both(const Circle& a, const Circle& b) {
    return {a.arcs[0], a.arcs[1], b.arcs[0], b.arcs[1]};
}

/// Where web and windows meet hub and web, at z = -H2 / 2 or H2 / 2.
struct WebLevel {
    /// Corners at the hub and at the outer wall of the windows: [x < 0, x > 0][y < 0, y > 0].
    std::array<std::array<int, 2>, 2> at_hub;
    std::array<std::array<int, 2>, 2> outside;
    /// On the hub, [y < 0, y > 0]; on the outer wall of the windows, [x < 0, x > 0].
    std::array<int, 2> hub_arcs;
    std::array<int, 2> outer_arcs;
};

WebLevel add_web_level(PartSurfaceBuilder& builder, const PartValues& values, double z) {
    const double y = values.at("L1") / 2;
    const double hub = values.at("R3");
    const double outer = values.at("R4");
    const double hub_x = std::sqrt(hub * hub - y * y);
    const double outer_x = std::sqrt(outer * outer - y * y);
    WebLevel level{};
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            level.at_hub[i][j] = builder.add_vertex({(2 * i - 1) * hub_x, (2 * j - 1) * y, z});
            level.outside[i][j] = builder.add_vertex({(2 * i - 1) * outer_x, (2 * j - 1) * y, z});
        }
    }
    const Vector3 centre(0.0, 0.0, z);
    const double hub_sweep = pi - 2 * std::asin(y / hub);
    const double outer_sweep = 2 * std::asin(y / outer);
    level.hub_arcs = {
        builder.add_arc(level.at_hub[0][0], level.at_hub[1][0], centre, hub_sweep, "y_low"),
        builder.add_arc(level.at_hub[1][1], level.at_hub[0][1], centre, hub_sweep, "y_high")};
    level.outer_arcs = {
        builder.add_arc(level.outside[0][1], level.outside[0][0], centre, outer_sweep),
        builder.add_arc(level.outside[1][0], level.outside[1][1], centre, outer_sweep)};
    return level;
}

/// Walls of the windows that are not the hub's.
void add_windows(PartSurfaceBuilder& builder, const PartValues& values,
                 const std::array<WebLevel, 2>& levels) {
    constexpr std::array<const char*, 2> ends = {"low", "high"};
    for (int i = 0; i < 2; ++i) {
        const std::string name = std::string("window_x_") + ends[i];
        for (int j = 0; j < 2; ++j) {
            const int side = builder.add_face(name + "_y_" + ends[j], PartFaceKind::plane);
            builder.add_polygon(side,
                                {levels[0].at_hub[i][j], levels[0].outside[i][j],
                                 levels[1].outside[i][j], levels[1].at_hub[i][j]},
                                1, j == 1 ? -1 : 1);
        }
        const int outer = builder.add_face(name + "_outer", PartFaceKind::cylinder);
        builder.add_sheet(
            outer,
            {levels[0].outer_arcs[i], levels[1].outer_arcs[i],
             builder.add_line(levels[0].outside[i][0], levels[1].outside[i][0]),
             builder.add_line(levels[0].outside[i][1], levels[1].outside[i][1])},
            cylinder_map(Vector3::Zero(), values.at("R4"), i == 1 ? 0.0 : pi, Facing::inwards));
    }
}

/// Web face at one level, inside a circle of the rim.
void add_web_face(PartSurfaceBuilder& builder, int face, const WebLevel& level, const Circle& rim,
                  int sign) {
    std::vector<int> curves = rim.arcs;
    for (int i = 0; i < 2; ++i) {
        curves.push_back(level.hub_arcs[i]);
        curves.push_back(level.outer_arcs[i]);
        for (int j = 0; j < 2; ++j) {
            curves.push_back(builder.add_line(level.at_hub[i][j], level.outside[i][j]));
        }
    }
    builder.add_plane_sheet(face, curves, 2, sign);
}

/// Hub and boss. Edges where the hub meets the web bound holes in its wall.
void add_hub(PartSurfaceBuilder& builder, const PartValues& values,
             const std::array<WebLevel, 2>& levels) {
    const int bore = builder.add_face("bore", PartFaceKind::cylinder);
    const int hub = builder.add_face("hub", PartFaceKind::cylinder);
    const double z = values.at("H1") / 2;
    std::array<Circle, 2> bore_circles;
    std::array<Circle, 2> hub_circles;
    for (int k = 0; k < 2; ++k) {
        const int sign = 2 * k - 1;
        const std::string end = k == 0 ? "_bottom" : "_top";
        const int boss_flat = builder.add_face("boss" + end, PartFaceKind::plane);
        const int boss_wall = builder.add_face("boss_wall" + end, PartFaceKind::cylinder);
        const int hub_flat = builder.add_face("hub" + end, PartFaceKind::plane);
        const auto circle = [&](const char* radius, double height) {
            return builder.add_circle({0.0, 0.0, sign * height}, values.at(radius));
        };
        bore_circles[k] = circle("R1", z + boss_rise);
        const Circle boss_end = circle("R2", z + boss_rise);
        const Circle boss_foot = circle("R2", z);
        hub_circles[k] = circle("R3", z);
        builder.add_plane_sheet(boss_flat, both(boss_end, bore_circles[k]), 2, sign);
        builder.add_cylinder(boss_wall, boss_foot, boss_end, Facing::outwards);
        builder.add_plane_sheet(hub_flat, both(hub_circles[k], boss_foot), 2, sign);
    }
    builder.add_cylinder(bore, bore_circles[0], bore_circles[1], Facing::inwards);
    std::array<std::vector<int>, 2> holes;
    for (int j = 0; j < 2; ++j) {
        holes[j] = {levels[0].hub_arcs[j], levels[1].hub_arcs[j],
                    builder.add_line(levels[0].at_hub[0][j], levels[1].at_hub[0][j]),
                    builder.add_line(levels[0].at_hub[1][j], levels[1].at_hub[1][j])};
    }
    builder.add_cylinder(hub, hub_circles[0], hub_circles[1], Facing::outwards,
                         {holes[1], holes[0]});
}

void build_wheel(const PartValues& values, PartSurfaceBuilder& builder) {
    const double web_z = values.at("H2") / 2;
    const double rim_z = values.at("H1") / 2;
    const std::array<WebLevel, 2> levels = {add_web_level(builder, values, -web_z),
                                            add_web_level(builder, values, web_z)};
    add_hub(builder, values, levels);
    add_windows(builder, values, levels);
    const int tread = builder.add_face("rim", PartFaceKind::cylinder);
    std::array<Circle, 2> tread_circles;
    for (int k = 0; k < 2; ++k) {
        const int sign = 2 * k - 1;
        const std::string end = k == 0 ? "_bottom" : "_top";
        const int web = builder.add_face("web" + end, PartFaceKind::plane);
        const int wall = builder.add_face("rim_wall" + end, PartFaceKind::cylinder);
        const int flat = builder.add_face("rim" + end, PartFaceKind::plane);
        const Circle foot = builder.add_circle({0.0, 0.0, sign * web_z}, values.at("R5"));
        const Circle edge = builder.add_circle({0.0, 0.0, sign * rim_z}, values.at("R5"));
        tread_circles[k] = builder.add_circle({0.0, 0.0, sign * rim_z}, values.at("R6"));
        add_web_face(builder, web, levels[k], foot, sign);
        builder.add_cylinder(wall, foot, edge, Facing::inwards);
        builder.add_plane_sheet(flat, both(tread_circles[k], edge), 2, sign);
    }
    builder.add_cylinder(tread, tread_circles[0], tread_circles[1], Facing::outwards);
}

}  // namespace

std::vector<PartSurfaceDefinition> wheel_surfaces() {
    return {{{"wheel",
              "Wheel about z, z = 0 in its middle, in mm. Faces: bore; boss_top, boss_wall_top (a "
              "boss stands 4 mm out of the hub), hub_top, the same at the bottom; hub; web_top, "
              "web_bottom; window_x_low_y_low, window_x_low_y_high, window_x_low_outer, the same "
              "of window_x_high; rim_wall_top, rim_wall_bottom (towards the axis), rim_top, "
              "rim_bottom, rim.",
              {{"R1", 8.775, 7.8, 9.75, "radius of the bore, mm"},
               {"R2", 14.95, 13.65, 16.25, "radius of the boss, mm"},
               {"R3", 27.625, 25.35, 29.9, "radius of the hub, mm"},
               {"R4", 65.0, 62.725, 67.275, "from the axis to the outer wall of the windows, mm"},
               {"R5", 77.025, 73.775, 80.275, "inner radius of the rim, mm"},
               {"R6", 89.3, 86.625, 91.975, "outer radius of the rim, mm"},
               {"H1", 29.25, 26.0, 32.5, "the hub's and the rim's size along z, mm"},
               {"H2", 8.9375, 8.125, 9.75, "thickness of the web, mm"},
               {"L1", 41.4375, 39.0, 43.875, "the windows' size along y, mm"}}},
             2.7,
             build_wheel}};
}

}  // namespace couture::meshing
