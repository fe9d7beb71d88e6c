#include "meshing/parts/part_dimensions.h"

#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

#include "meshing/parts/part_definition.h"
#include "meshing/parts/part_surface.h"

namespace couture::meshing {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

const Vector3 x_axis = Vector3::UnitX();
const Vector3 y_axis = Vector3::UnitY();
const Vector3 z_axis = Vector3::UnitZ();

struct End {
    /// Most ends are points of the surface.
    template <typename Derived>
    // NOLINTNEXTLINE(google-explicit-constructor)
    End(const Eigen::MatrixBase<Derived>& place) : point(place) {}
    End(const Vector3& place, DimensionEnd what) : point(place), kind(what) {}

    Vector3 point;
    DimensionEnd kind = DimensionEnd::surface;
};

End axis(double x, double y, double z) { return {{x, y, z}, DimensionEnd::axis}; }

/// Name of a parameter (empty: fixed) and its value.
struct Size {
    std::string parameter;
    double value = 0.0;
};

Size fixed(double value) { return {"", value}; }

/// Takes up the dimensions of a part.
class DimensionList {
  public:
    explicit DimensionList(const PartValues& values) : values_(values) {}

    [[nodiscard]] double value(const std::string& name) const { return values_.at(name); }
    [[nodiscard]] Size size(const std::string& name) const { return {name, values_.at(name)}; }

    void add(const Size& size, const End& from, const End& to, const Vector3& along,
             const Vector3& offset, DimensionKind kind = DimensionKind::length) {
        dimensions_.push_back({size.parameter, size.value, kind, from.point, to.point, from.kind,
                               to.kind, along, offset});
    }

    void add_radius(const Size& size, const Vector3& centre, double angle) {
        const Vector3 along(std::cos(angle), std::sin(angle), 0.0);
        dimensions_.push_back({size.parameter, size.value, DimensionKind::radius, centre,
                               centre + size.value * along, DimensionEnd::axis,
                               DimensionEnd::surface, along});
    }

    void add_diameter(const Size& size, const Vector3& centre, double angle) {
        const Vector3 along(std::cos(angle), std::sin(angle), 0.0);
        const Vector3 radius = size.value / 2.0 * along;
        dimensions_.push_back({size.parameter, size.value, DimensionKind::diameter, centre - radius,
                               centre + radius, DimensionEnd::surface, DimensionEnd::surface,
                               along});
    }

    [[nodiscard]] const std::vector<PartDimension>& dimensions() const { return dimensions_; }

  private:
    const PartValues& values_;
    std::vector<PartDimension> dimensions_;
};

/// Half the square section of bars.
constexpr double half = 20.0;

void measure_pant(DimensionList& list) {
    const std::array<Vector3, 3> unmoved = {Vector3(-110.0, 0.0, 0.0), Vector3(110.0, 0.0, 0.0),
                                            Vector3(0.0, 130.0, 0.0)};
    // Where the lines for X, Y and Z of each cap go.
    const std::array<std::array<Vector3, 3>, 3> offsets = {
        {{-y_axis, -x_axis, -x_axis}, {-y_axis, x_axis, x_axis}, {y_axis, x_axis, y_axis}}};
    const std::array<std::string, 3> names = {"X", "Y", "Z"};
    for (int i = 0; i < 3; ++i) {
        Vector3 moved = unmoved[i];
        for (int k = 0; k < 3; ++k) {
            moved[k] += list.value(names[k] + std::to_string(i + 1));
        }
        const End from(unmoved[i], DimensionEnd::unmoved_cap);
        for (int k = 0; k < 3; ++k) {
            list.add(list.size(names[k] + std::to_string(i + 1)), from, moved, Vector3::Unit(k),
                     offsets[i][k], DimensionKind::displacement);
        }
        // From the middle of the part, which is seen in the middle of its top.
        const double reach = unmoved[i].norm();
        list.add(fixed(reach), Vector3(half * z_axis), from, unmoved[i] / reach,
                 i < 2 ? Vector3(-y_axis) : Vector3(-x_axis));
        const Vector3 across = i < 2 ? y_axis : x_axis;
        const Vector3 low = moved - half * across + half * z_axis;
        const Vector3 offset = i == 0 ? Vector3(-x_axis) : (i == 1 ? x_axis : y_axis);
        list.add(fixed(2.0 * half), low, low + 2.0 * half * across, across, offset);
    }
    const Vector3 low(110.0 + list.value("X2"), list.value("Y2") - half, list.value("Z2") - half);
    list.add(fixed(2.0 * half), low, low + 2.0 * half * z_axis, z_axis, x_axis);
}

/// @param spread  how far the ends are bent
void measure_double_t(DimensionList& list, double spread) {
    constexpr double end_x = 130.0;
    constexpr double end_y = 110.0;
    constexpr double branch_x = 50.0;
    const double low_y = -half - spread;
    const double x = branch_x + spread;
    list.add(fixed(2.0 * end_x), Vector3(-end_x, low_y, half), Vector3(end_x, low_y, half), x_axis,
             -y_axis);
    list.add(fixed(2.0 * x), Vector3(-x, end_y, 0.0), Vector3(x, end_y, 0.0), x_axis, y_axis);
    list.add(fixed(2.0 * half), Vector3(-x - half, end_y, half), Vector3(-x + half, end_y, half),
             x_axis, y_axis);
    list.add(fixed(end_y + half), Vector3(0.0, -half, half), Vector3(x + half, end_y, half), y_axis,
             x_axis);
    list.add(fixed(2.0 * half), Vector3(-end_x, low_y, half),
             Vector3(-end_x, low_y + 2.0 * half, half), y_axis, -x_axis);
    list.add(fixed(2.0 * half), Vector3(end_x, low_y, -half), Vector3(end_x, low_y, half), z_axis,
             x_axis);
    if (spread > 0.0) {
        list.add(fixed(spread), Vector3(end_x, low_y, half), Vector3(0.0, -half, half), y_axis,
                 x_axis);
        list.add(fixed(2.0 * branch_x), Vector3(-branch_x, half, half),
                 Vector3(branch_x, half, half), x_axis, -y_axis);
    }
}

/// The parameters of a seal in the order arm half-width, radii, ring height, arm height and length.
void measure_seal(DimensionList& list, const std::array<std::string, 6>& names, bool is_half) {
    const auto& [half_width, inner, outer, ring_height, arm_height, length] = names;
    const double y = list.value(half_width);
    const double ring_z = list.value(ring_height) / 2.0;
    const double arm_z = list.value(arm_height) / 2.0;
    const double end = list.value(length);
    list.add(list.size(half_width), Vector3(end, 0.0, arm_z), Vector3(end, y, arm_z), y_axis,
             x_axis);
    list.add_radius(list.size(inner), {0.0, 0.0, ring_z}, 60.0 * degree);
    list.add_radius(list.size(outer), {0.0, 0.0, ring_z}, 40.0 * degree);
    // On the left of the view from y low.
    const Vector3 ring_low = is_half ? Vector3(0.0, -list.value(outer), -ring_z)
                                     : Vector3(-list.value(outer), 0.0, -ring_z);
    list.add(list.size(ring_height), ring_low, ring_low + 2.0 * ring_z * z_axis, z_axis, -x_axis);
    const Vector3 arm_low(end, -y, -arm_z);
    list.add(list.size(arm_height), arm_low, arm_low + 2.0 * arm_z * z_axis, z_axis, x_axis);
    list.add(list.size(length), axis(0.0, 0.0, 0.0), arm_low, x_axis, -y_axis);
}

void measure_wheel(DimensionList& list) {
    constexpr double boss_rise = 4.0;
    const double rim_z = list.value("H1") / 2.0;
    const double web_z = list.value("H2") / 2.0;
    const auto add_radius = [&](const char* name, double z) {
        list.add(list.size(name), axis(0.0, 0.0, rim_z), Vector3(0.0, list.value(name), z), y_axis,
                 -z_axis, DimensionKind::radius);
    };
    add_radius("R1", -rim_z - boss_rise);
    add_radius("R2", -rim_z - boss_rise);
    add_radius("R3", -rim_z);
    list.add_radius(list.size("R4"), {0.0, 0.0, web_z}, 10.0 * degree);
    add_radius("R5", -rim_z);
    add_radius("R6", -rim_z);
    const Vector3 rim(0.0, list.value("R6"), -rim_z);
    list.add(list.size("H1"), rim, rim + 2.0 * rim_z * z_axis, z_axis, y_axis);
    const Vector3 web(0.0, -list.value("R5"), -web_z);
    list.add(list.size("H2"), web, web + 2.0 * web_z * z_axis, z_axis, -y_axis);
    const double y = list.value("L1") / 2.0;
    const double x = -std::sqrt(list.value("R4") * list.value("R4") - y * y);
    list.add(list.size("L1"), Vector3(x, -y, web_z), Vector3(x, y, web_z), y_axis, -x_axis);
    const Vector3 hub(0.0, list.value("R2"), rim_z);
    list.add(fixed(boss_rise), hub, hub + boss_rise * z_axis, z_axis, y_axis);
}

void measure_casting(DimensionList& list) {
    constexpr double bolt_radius = 12.0;
    const double flange_z = list.value("height_B");
    const double hub_z = list.value("height_H");
    const double flange = list.value("radius_B");
    const auto add_radius = [&](const char* name, double z, const Vector3& offset) {
        list.add(list.size(name), axis(0.0, 0.0, hub_z - z), Vector3(list.value(name), 0.0, z),
                 x_axis, offset, DimensionKind::radius);
    };
    list.add(list.size("length"), axis(0.0, 0.0, 0.0), axis(list.value("length"), 0.0, 0.0), x_axis,
             -z_axis);
    add_radius("radius_B", 0.0, -z_axis);
    add_radius("radius_H", hub_z, z_axis);
    add_radius("radius_I", hub_z, z_axis);
    list.add(list.size("height_B"), Vector3(flange, 0.0, 0.0), Vector3(flange, 0.0, flange_z),
             z_axis, x_axis);
    list.add(list.size("height_H"), Vector3(-flange, 0.0, 0.0),
             Vector3(-list.value("radius_H"), 0.0, hub_z), z_axis, -x_axis);
    list.add_radius(fixed(bolt_radius), {0.0, list.value("length"), flange_z}, 45.0 * degree);
}

struct RoundHole {
    Size height;
    Size diameter;
};

void measure_plate(DimensionList& list, const std::vector<RoundHole>& holes) {
    constexpr double x = 50.0;
    constexpr double height = 200.0;
    constexpr double thickness = 10.0;
    for (const RoundHole& hole : holes) {
        const double y = hole.height.value;
        list.add_diameter(hole.diameter, {0.0, y, thickness}, 45.0 * degree);
        list.add(hole.height, Vector3(x, 0.0, thickness), axis(0.0, y, thickness), y_axis, x_axis);
    }
    list.add(fixed(2.0 * x), Vector3(-x, 0.0, thickness), Vector3(x, 0.0, thickness), x_axis,
             -y_axis);
    list.add(fixed(height), Vector3(-x, 0.0, thickness), Vector3(-x, height, thickness), y_axis,
             -x_axis);
    list.add(fixed(thickness), Vector3(x, 0.0, 0.0), Vector3(x, 0.0, thickness), z_axis, x_axis);
}

void measure_torus(DimensionList& list) {
    const double radius = list.value("radius");
    const double tube = list.value("tube_radius");
    list.add(list.size("radius"), axis(0.0, 0.0, -tube), Vector3(radius, 0.0, tube), x_axis, z_axis,
             DimensionKind::radius);
    list.add(list.size("tube_radius"), Vector3(radius + tube, 0.0, 0.0), Vector3(radius, 0.0, tube),
             z_axis, x_axis, DimensionKind::radius);
}

void measure_double_torus(DimensionList& list) {
    constexpr double axis_x = 35.0;
    constexpr double radius = 30.0;
    constexpr double tube = 10.0;
    list.add(fixed(2.0 * axis_x), axis(-axis_x, 0.0, 0.0), axis(axis_x, 0.0, 0.0), x_axis, -y_axis);
    list.add(fixed(radius), axis(axis_x, 0.0, 0.0), Vector3(axis_x, radius, tube), y_axis, x_axis,
             DimensionKind::radius);
    list.add(fixed(tube), Vector3(axis_x + radius + tube, 0.0, 0.0),
             Vector3(axis_x + radius, 0.0, tube), z_axis, x_axis, DimensionKind::radius);
}

void measure_cube(DimensionList& list) {
    list.add(list.size("length"), Vector3::Zero(), Vector3(list.value("length"), 0.0, 0.0), x_axis,
             -z_axis);
}

void measure_cylinder(DimensionList& list) {
    const double radius = list.value("radius");
    const double length = list.value("length");
    list.add(list.size("radius"), axis(0.0, 0.0, 0.0), Vector3(radius, 0.0, length), x_axis, z_axis,
             DimensionKind::radius);
    list.add(list.size("length"), Vector3(radius, 0.0, 0.0), Vector3(radius, 0.0, length), z_axis,
             x_axis);
}

struct PartMeasures {
    PartInfo info;
    std::function<void(DimensionList&)> measure;
};

std::function<void(DimensionList&)> measures_of(const std::string& name) {
    static const std::map<std::string, std::function<void(DimensionList&)>> all = {
        {"pant", measure_pant},
        {"double_t", [](DimensionList& list) { measure_double_t(list, 0.0); }},
        {"double_curved_t", [](DimensionList& list) { measure_double_t(list, 30.0); }},
        {"seal",
         [](DimensionList& list) {
             measure_seal(list, {"R1", "R2", "R3", "H1", "H2", "L1"}, false);
         }},
        {"half_seal",
         [](DimensionList& list) {
             measure_seal(list,
                          {"arm_half_width", "inner_radius", "outer_radius", "ring_height",
                           "arm_height", "arm_length"},
                          true);
         }},
        {"wheel", measure_wheel},
        {"casting", measure_casting},
        {"plate",
         [](DimensionList& list) {
             measure_plate(list, {{list.size("P2"), list.size("P1")}});
         }},
        {"plate_with_two_holes",
         [](DimensionList& list) {
             measure_plate(list, {{fixed(50.0), fixed(50.0)}, {fixed(150.0), fixed(50.0)}});
         }},
        {"torus", measure_torus},
        {"double_torus", measure_double_torus},
        {"cube", measure_cube},
        {"cylinder", measure_cylinder},
        {"sierpinski", measure_cube}};
    assert(all.contains(name));
    return all.at(name);
}

const std::vector<PartMeasures>& all_measures() {
    static const std::vector<PartMeasures> all = [] {
        std::vector<PartMeasures> list;
        for (const PartInfo& info : part_surfaces()) {
            list.push_back({info, measures_of(info.name)});
        }
        return list;
    }();
    return all;
}

}  // namespace

double measured_distance(const PartDimension& dimension) {
    return (dimension.to - dimension.from).dot(dimension.along);
}

std::vector<PartDimension> part_dimensions(const std::string& name,
                                           const std::map<std::string, double>& parameters) {
    const PartMeasures& part = find_definition("part_dimensions", all_measures(), name);
    const PartValues values = complete_values(part.info, parameters);
    DimensionList list(values);
    part.measure(list);
    return list.dimensions();
}

}  // namespace couture::meshing
