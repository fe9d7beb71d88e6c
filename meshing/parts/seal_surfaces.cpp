#include "meshing/parts/seal_surfaces.h"

#include <array>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

using std::numbers::pi;

struct SealSizes {
    double arm_half_width;
    double inner_radius;
    double outer_radius;
    double ring_height;
    double arm_height;
    double arm_length;
};

struct ArmNames {
    std::string cap;
    std::string left;
    std::string right;
    std::string bottom;
    std::string top;
};

/// An arm along direction x (sign +1 or -1) without its root.
///
/// @return the curves in which it meets the ring
std::vector<int> add_arm(PartSurfaceBuilder& builder, const SealSizes& sizes, int sign,
                         const ArmNames& names) {
    const double y = sizes.arm_half_width;
    const double z = sizes.arm_height / 2;
    const double root = std::sqrt(sizes.outer_radius * sizes.outer_radius - y * y);
    // Around the section, seen against x: (y, z) low low, high low, high high, low high.
    const std::array<std::array<double, 2>, 4> section = {{{-y, -z}, {y, -z}, {y, z}, {-y, z}}};
    std::vector<int> roots;
    std::vector<int> ends;
    for (const auto& [y_at, z_at] : section) {
        roots.push_back(builder.add_vertex({sign * root, y_at, z_at}));
        ends.push_back(builder.add_vertex({sign * sizes.arm_length, y_at, z_at}));
    }
    const double sweep = sign * 2 * std::asin(y / sizes.outer_radius);
    const int bottom_arc = builder.add_arc(roots[0], roots[1], {0.0, 0.0, -z}, sweep);
    const int top_arc = builder.add_arc(roots[3], roots[2], {0.0, 0.0, z}, sweep);
    const auto face = [&](const std::string& name) {
        return builder.add_face(name, PartFaceKind::plane);
    };
    const int bottom = face(names.bottom);
    const int top = face(names.top);
    const int left = face(names.left);
    const int right = face(names.right);
    const int cap = builder.add_face(names.cap, PartFaceKind::plane, true);
    const auto add_flat = [&](int plane, int arc, int i, int j, int normal) {
        builder.add_plane_sheet(
            plane,
            {arc, builder.add_line(roots[i], ends[i]), builder.add_line(ends[i], ends[j]),
             builder.add_line(ends[j], roots[j])},
            2, normal);
    };
    add_flat(bottom, bottom_arc, 0, 1, -1);
    add_flat(top, top_arc, 3, 2, 1);
    builder.add_polygon(left, {roots[1], ends[1], ends[2], roots[2]}, 1, 1);
    builder.add_polygon(right, {roots[0], ends[0], ends[3], roots[3]}, 1, -1);
    builder.add_polygon(cap, ends, 0, sign);
    return {bottom_arc, builder.add_line(roots[1], roots[2]), top_arc,
            builder.add_line(roots[3], roots[0])};
}

void build_seal(const PartValues& values, PartSurfaceBuilder& builder) {
    const SealSizes sizes = {values.at("R1"), values.at("R2"), values.at("R3"),
                             values.at("H1"), values.at("H2"), values.at("L1")};
    const int inner = builder.add_face("inner", PartFaceKind::cylinder);
    const int outer = builder.add_face("outer", PartFaceKind::cylinder);
    const int bottom = builder.add_face("bottom", PartFaceKind::plane);
    const int top = builder.add_face("top", PartFaceKind::plane);
    const auto names = [](const std::string& arm) {
        return ArmNames{"cap_" + arm, "arm_" + arm + "_y_high", "arm_" + arm + "_y_low",
                        "arm_" + arm + "_bottom", "arm_" + arm + "_top"};
    };
    const std::vector<int> low_root = add_arm(builder, sizes, -1, names("x_low"));
    const std::vector<int> high_root = add_arm(builder, sizes, 1, names("x_high"));
    const auto circle = [&](double radius, double z) {
        return builder.add_circle({0.0, 0.0, z}, radius, -pi / 2);
    };
    const double z = sizes.ring_height / 2;
    const auto inner_low = circle(sizes.inner_radius, -z);
    const auto inner_high = circle(sizes.inner_radius, z);
    const auto outer_low = circle(sizes.outer_radius, -z);
    const auto outer_high = circle(sizes.outer_radius, z);
    builder.add_cylinder(inner, inner_low, inner_high, Facing::inwards);
    builder.add_cylinder(outer, outer_low, outer_high, Facing::outwards, {high_root, low_root});
    builder.add_plane_sheet(
        bottom, {outer_low.arcs[0], outer_low.arcs[1], inner_low.arcs[0], inner_low.arcs[1]}, 2,
        -1);
    builder.add_plane_sheet(
        top, {outer_high.arcs[0], outer_high.arcs[1], inner_high.arcs[0], inner_high.arcs[1]}, 2,
        1);
}

void build_half_seal(const PartValues& values, PartSurfaceBuilder& builder) {
    const SealSizes sizes = {values.at("arm_half_width"), values.at("inner_radius"),
                             values.at("outer_radius"),   values.at("ring_height"),
                             values.at("arm_height"),     values.at("arm_length")};
    const int inner = builder.add_face("inner", PartFaceKind::cylinder);
    const int outer = builder.add_face("outer", PartFaceKind::cylinder);
    const std::array<int, 2> flat = {builder.add_face("bottom", PartFaceKind::plane),
                                     builder.add_face("top", PartFaceKind::plane)};
    const int cut_low = builder.add_face("cut_low", PartFaceKind::plane, true);
    const int cut_high = builder.add_face("cut_high", PartFaceKind::plane, true);
    const std::vector<int> root =
        add_arm(builder, sizes, 1, {"cap", "arm_left", "arm_right", "arm_bottom", "arm_top"});
    // Around the cut at y < 0 and at y > 0: [inner, outer][bottom, top].
    std::array<std::array<int, 2>, 2> low{};
    std::array<std::array<int, 2>, 2> high{};
    std::array<std::array<int, 2>, 2> arcs{};
    const std::array<double, 2> radii = {sizes.inner_radius, sizes.outer_radius};
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            const double z = (j - 0.5) * sizes.ring_height;
            low[i][j] = builder.add_vertex({0.0, -radii[i], z});
            high[i][j] = builder.add_vertex({0.0, radii[i], z});
            arcs[i][j] = builder.add_arc(low[i][j], high[i][j], {0.0, 0.0, z}, pi);
        }
    }
    const auto add_wall = [&](int face, int i, Facing facing, const std::vector<int>& hole) {
        std::vector<int> curves = {arcs[i][0], builder.add_line(high[i][0], high[i][1]), arcs[i][1],
                                   builder.add_line(low[i][0], low[i][1])};
        curves.insert(curves.end(), hole.begin(), hole.end());
        builder.add_sheet(face, curves, cylinder_map(Vector3::Zero(), radii[i], 0.0, facing));
    };
    add_wall(inner, 0, Facing::inwards, {});
    add_wall(outer, 1, Facing::outwards, root);
    for (int j = 0; j < 2; ++j) {
        builder.add_plane_sheet(flat[j],
                                {arcs[1][j], builder.add_line(high[1][j], high[0][j]), arcs[0][j],
                                 builder.add_line(low[0][j], low[1][j])},
                                2, j == 1 ? 1 : -1);
    }
    builder.add_polygon(cut_low, {low[0][0], low[1][0], low[1][1], low[0][1]}, 0, -1);
    builder.add_polygon(cut_high, {high[0][0], high[1][0], high[1][1], high[0][1]}, 0, -1);
}

}  // namespace

std::vector<PartSurfaceDefinition> seal_surfaces() {
    return {{{"seal",
              "Ring about z with a hole through it and arms along +-x, in mm. Faces: inner, outer, "
              "bottom, top of the ring; arm_x_low_y_low, arm_x_low_y_high, arm_x_low_bottom, "
              "arm_x_low_top, the same of arm_x_high; caps cap_x_low, cap_x_high.",
              {{"R1", 13.0, 11.0, 15.0, "half the arms' size along y, mm"},
               {"R2", 25.0, 20.0, 30.0, "radius of the hole, mm"},
               {"R3", 40.0, 35.0, 45.0, "outer radius of the ring, mm"},
               {"H1", 31.5, 28.0, 35.0, "the ring's size along z, mm"},
               {"H2", 13.0, 10.0, 16.0, "the arms' size along z, mm"},
               {"L1", 65.0, 50.0, 80.0, "from the axis to the caps, mm"}}},
             2.1,
             build_seal},
            {{"half_seal",
              "The x >= 0 half of a ring about z with one arm along x, in mm, as the spline part. "
              "Faces: inner, outer, bottom, top, arm_left and arm_right (y = +- arm_half_width), "
              "arm_bottom, arm_top; caps cut_low and cut_high (x = 0, y < 0 and y > 0), cap (x = "
              "arm_length).",
              {{"arm_half_width", 13.0, 11.0, 15.0, "half the arm's size along y, mm"},
               {"inner_radius", 25.0, 20.0, 30.0, "radius of the hole, mm"},
               {"outer_radius", 40.0, 35.0, 45.0, "outer radius of the ring, mm"},
               {"ring_height", 31.5, 28.0, 35.0, "the ring's size along z, mm"},
               {"arm_height", 13.0, 10.0, 16.0, "the arm's size along z, mm"},
               {"arm_length", 65.0, 50.0, 80.0, "from the axis to the cap, mm"}}},
             2.0,
             build_half_seal}};
}

}  // namespace couture::meshing
