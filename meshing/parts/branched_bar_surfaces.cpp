#include "meshing/parts/branched_bar_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace couture::meshing {

namespace {

constexpr double half_section = 20.0;
/// The pant: from the origin to the caps of legs 1 and 2, and of leg 3.
constexpr double pant_reach_x = 110.0;
constexpr double pant_reach_y = 130.0;
/// Radius of curvature of what is flat.
constexpr double flat = 1e9;

/// A leg along +-x or +y. Its directions are where it goes and, across it in the plane z = 0, y or
/// x; the third is z.
struct Leg {
    /// Centre of its root.
    Vector2 root = Vector2::Zero();
    Vector2 along = Vector2::UnitX();
    Vector2 across = Vector2::UnitY();
    double length = 0.0;
    /// How far the cap is moved in the directions `across` and z.
    double offset_across = 0.0;
    double offset_z = 0.0;

    /// Part of the offset at the distance s from the root.
    [[nodiscard]] double shift(double s) const {
        const double t = std::clamp(s / length, 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }

    /// Radius of curvature of the curve (s, offset shift(s)).
    [[nodiscard]] double radius(double s, double offset) const {
        const double t = std::clamp(s / length, 0.0, 1.0);
        const double slope = offset / length * 6.0 * t * (1.0 - t);
        const double bend = std::abs(offset) / (length * length) * std::abs(6.0 - 12.0 * t);
        return std::pow(1.0 + slope * slope, 1.5) / std::max(bend, 1.0 / flat);
    }

    /// @param a, z  of the section, in [-half_section, half_section]
    [[nodiscard]] Vector3 point(double s, double a, double z) const {
        const Vector2 plane = root + s * along + (a + offset_across * shift(s)) * across;
        return {plane.x(), plane.y(), z + offset_z * shift(s)};
    }
};

/// Arc length of the curve (s, offset shift(s)), and its inverse, by a table.
class ShiftedLength {
  public:
    ShiftedLength(const Leg& leg, double offset) : step_(leg.length / n_steps) {
        lengths_.push_back(0.0);
        for (int i = 0; i < n_steps; ++i) {
            const double rise = offset * (leg.shift((i + 1) * step_) - leg.shift(i * step_));
            lengths_.push_back(lengths_.back() + std::hypot(step_, rise));
        }
    }

    [[nodiscard]] double length_at(double s) const {
        const double at = s / step_;
        const int i = std::clamp(static_cast<int>(at), 0, n_steps - 1);
        return lengths_[i] + (at - i) * (lengths_[i + 1] - lengths_[i]);
    }

    /// Within the leg.
    [[nodiscard]] double place_at(double length) const {
        const auto above = std::upper_bound(lengths_.begin(), lengths_.end(), length);
        const int i = std::clamp(static_cast<int>(above - lengths_.begin()) - 1, 0, n_steps - 1);
        const double part = (length - lengths_[i]) / (lengths_[i + 1] - lengths_[i]);
        return (i + std::clamp(part, 0.0, 1.0)) * step_;
    }

  private:
    static constexpr int n_steps = 400;
    double step_;
    std::vector<double> lengths_;
};

/// Straight middle with the legs' roots on it: leg 1 at x low, leg 2 at x high, others on y high.
struct Bar {
    double half_length = 0.0;
    std::vector<Leg> legs;
};

/// How far a place with coordinates s (along), a (across) is from being in a straight leg.
double distance_outside(const Leg& leg, double s, double a) {
    return std::max({std::abs(a) - half_section, -s, s - leg.length});
}

/// The leg that a place is in, given the coordinates in each; -1: the middle.
int region_of(const Bar& bar, const Vector2& plane, const std::vector<Vector2>& coordinates) {
    int best = -1;
    double best_distance =
        std::max(std::abs(plane.x()) - bar.half_length, std::abs(plane.y()) - half_section);
    for (int i = 0; i < static_cast<int>(bar.legs.size()); ++i) {
        const double distance =
            distance_outside(bar.legs[i], coordinates[i].x(), coordinates[i].y());
        if (distance < best_distance) {
            best = i;
            best_distance = distance;
        }
    }
    return best;
}

/// The top (sign 1) or the bottom (-1): each leg unrolled along its length, side by side with the
/// middle.
SheetMap flat_map(const Bar& bar, int sign) {
    std::vector<ShiftedLength> lengths;
    for (const Leg& leg : bar.legs) {
        lengths.emplace_back(leg, leg.offset_z);
    }
    const double z = sign * half_section;
    const auto mirrored = [sign](const Vector2& p) { return Vector2(sign * p.x(), p.y()); };
    // The leg (-1: the middle), and its s and a, of an unrolled place.
    const auto place_of = [=](const Vector2& plane) -> std::tuple<int, double, double> {
        std::vector<Vector2> coordinates;
        for (std::size_t i = 0; i < bar.legs.size(); ++i) {
            const Leg& leg = bar.legs[i];
            const double length = (plane - leg.root).dot(leg.along);
            // Outside the leg its coordinate goes on.
            const double s = length < 0.0
                                 ? length
                                 : std::max(lengths[i].place_at(length),
                                            length - lengths[i].length_at(leg.length) + leg.length);
            const double a = (plane - leg.root).dot(leg.across) - leg.offset_across * leg.shift(s);
            coordinates.emplace_back(s, a);
        }
        const int i = region_of(bar, plane, coordinates);
        return i < 0 ? std::tuple(-1, 0.0, 0.0)
                     : std::tuple(i, coordinates[i].x(), coordinates[i].y());
    };
    return {[=](const Vector3& x) -> Vector2 {
                const Vector2 plane(x.x(), x.y());
                std::vector<Vector2> coordinates;
                for (const Leg& leg : bar.legs) {
                    const double s = (plane - leg.root).dot(leg.along);
                    const double a =
                        (plane - leg.root).dot(leg.across) - leg.offset_across * leg.shift(s);
                    coordinates.emplace_back(s, a);
                }
                const int i = region_of(bar, plane, coordinates);
                if (i < 0) {
                    return mirrored(plane);
                }
                const double s = coordinates[i].x();
                return mirrored(plane + (lengths[i].length_at(s) - s) * bar.legs[i].along);
            },
            [=](const Vector2& p) -> Vector3 {
                const auto [i, s, a] = place_of(mirrored(p));
                return i < 0 ? Vector3(sign * p.x(), p.y(), z) : bar.legs[i].point(s, a, z);
            },
            nullptr,
            [=](const Vector2& p) {
                const auto [i, s, a] = place_of(mirrored(p));
                return i < 0 ? flat : bar.legs[i].radius(s, bar.legs[i].offset_z);
            }};
}

/// A leg's side at `across` = side * half_section, unrolled.
SheetMap side_map(const Leg& leg, int side) {
    const ShiftedLength lengths(leg, leg.offset_across);
    // Along x z is the outside where along x across points to z.
    const double turn = leg.along.x() * leg.across.y() - leg.along.y() * leg.across.x();
    const double sign = -side * turn;
    return {[=](const Vector3& x) {
                const double s = (Vector2(x.x(), x.y()) - leg.root).dot(leg.along);
                return Vector2(sign * lengths.length_at(s), x.z());
            },
            [=](const Vector2& p) {
                const double s = lengths.place_at(sign * p.x());
                return leg.point(s, side * half_section, p.y() - leg.offset_z * leg.shift(s));
            },
            nullptr,
            [=](const Vector2& p) {
                return leg.radius(lengths.place_at(sign * p.x()), leg.offset_across);
            }};
}

/// The whole side at y low: leg 1, the middle, leg 2.
SheetMap back_map(const Bar& bar) {
    const Leg& low = bar.legs[0];
    const Leg& high = bar.legs[1];
    const ShiftedLength low_lengths(low, low.offset_across);
    const ShiftedLength high_lengths(high, high.offset_across);
    const double half = bar.half_length;
    return {[=](const Vector3& x) {
                double u = x.x();
                if (u < -half) {
                    u = -half - low_lengths.length_at(-half - u);
                } else if (u > half) {
                    u = half + high_lengths.length_at(u - half);
                }
                return Vector2(u, x.z());
            },
            [=](const Vector2& p) -> Vector3 {
                if (p.x() < -half) {
                    const double s = low_lengths.place_at(-half - p.x());
                    return low.point(s, -half_section, p.y() - low.offset_z * low.shift(s));
                }
                if (p.x() > half) {
                    const double s = high_lengths.place_at(p.x() - half);
                    return high.point(s, -half_section, p.y() - high.offset_z * high.shift(s));
                }
                return {p.x(), -half_section, p.y()};
            },
            nullptr,
            [=](const Vector2& p) {
                if (std::abs(p.x()) < half) {
                    return flat;
                }
                return p.x() < 0.0
                           ? low.radius(low_lengths.place_at(-half - p.x()), low.offset_across)
                           : high.radius(high_lengths.place_at(p.x() - half), high.offset_across);
            }};
}

/// Vertices and edges of a leg: [across low, high][z low, high].
struct LegEdges {
    std::array<std::array<int, 2>, 2> roots;
    std::array<std::array<int, 2>, 2> ends;
    std::array<std::array<int, 2>, 2> edges;
};

using Roots = std::array<std::array<int, 2>, 2>;

LegEdges add_edges(PartSurfaceBuilder& builder, const Leg& leg, const Roots& roots) {
    LegEdges result{roots, {}, {}};
    for (int j = 0; j < 2; ++j) {
        for (int k = 0; k < 2; ++k) {
            const double a = (2 * j - 1) * half_section;
            const double z = (2 * k - 1) * half_section;
            result.ends[j][k] = builder.add_vertex(leg.point(leg.length, a, z));
            result.edges[j][k] = builder.add_curve(roots[j][k], result.ends[j][k], [&](double t) {
                return leg.point(t * leg.length, a, z);
            });
        }
    }
    return result;
}

std::vector<int> lines_around(PartSurfaceBuilder& builder, const Roots& section) {
    return {builder.add_line(section[0][0], section[1][0]),
            builder.add_line(section[1][0], section[1][1]),
            builder.add_line(section[1][1], section[0][1]),
            builder.add_line(section[0][1], section[0][0])};
}

/// What is between neighbouring legs: the edges of top and bottom (k = 0, 1) around the bar.
struct Outline {
    std::array<std::vector<int>, 2> curves;

    void add_pair(const std::array<int, 2>& pair) {
        for (int k = 0; k < 2; ++k) {
            curves[k].push_back(pair[k]);
        }
    }
};

class BarSurface {
  public:
    BarSurface(PartSurfaceBuilder& builder, const Bar& bar)
        : builder_(builder), bar_(bar), n_legs_(static_cast<int>(bar.legs.size())) {}

    void build() {
        const std::array<int, 2> flats = {builder_.add_face("bottom", PartFaceKind::swept),
                                          builder_.add_face("top", PartFaceKind::swept)};
        const int back = builder_.add_face("back", PartFaceKind::swept);
        for (int i = 0; i < n_legs_; ++i) {
            edges_.push_back(add_edges(builder_, bar_.legs[i], roots_of(i)));
        }
        add_back(back);
        for (int i = 0; i < n_legs_; ++i) {
            add_leg(i);
        }
        add_middle();
        for (int k = 0; k < 2; ++k) {
            builder_.add_sheet(flats[k], outline_.curves[k], flat_map(bar_, 2 * k - 1));
        }
    }

  private:
    /// The vertical pair (z low, high) at a place of the middle's outline.
    std::array<int, 2> vertical(double x, double y) {
        const auto [entry, is_new] = verticals_.try_emplace({x, y});
        if (is_new) {
            entry->second = {builder_.add_vertex({x, y, -half_section}),
                             builder_.add_vertex({x, y, half_section})};
        }
        return entry->second;
    }

    Roots roots_of(int i) {
        const Leg& leg = bar_.legs[i];
        const Vector2 low = leg.root - half_section * leg.across;
        const Vector2 high = leg.root + half_section * leg.across;
        return {vertical(low.x(), low.y()), vertical(high.x(), high.y())};
    }

    std::array<int, 2> add_lines(const std::array<int, 2>& from, const std::array<int, 2>& to) {
        return {builder_.add_line(from[0], to[0]), builder_.add_line(from[1], to[1])};
    }

    void add_back(int face) {
        const LegEdges& low = edges_[0];
        const LegEdges& high = edges_[1];
        const std::array<int, 2> middle = add_lines(low.roots[0], high.roots[0]);
        builder_.add_sheet(face,
                           {low.edges[0][0], low.edges[0][1], high.edges[0][0], high.edges[0][1],
                            middle[0], middle[1], builder_.add_line(low.ends[0][0], low.ends[0][1]),
                            builder_.add_line(high.ends[0][0], high.ends[0][1])},
                           back_map(bar_));
        outline_.add_pair(low.edges[0]);
        outline_.add_pair(high.edges[0]);
        outline_.add_pair(middle);
    }

    /// Sides and cap; the sides at y low of legs 1 and 2 are the back.
    void add_leg(int i) {
        const Leg& leg = bar_.legs[i];
        const LegEdges& edges = edges_[i];
        for (int j = i < 2 ? 1 : 0; j < 2; ++j) {
            const std::string end = j == 0 ? "_x_low" : "_x_high";
            const int face = builder_.add_face(
                fmt::format("leg_{}_side{}", i + 1, i < 2 ? "" : end), PartFaceKind::swept);
            builder_.add_sheet(face,
                               {edges.edges[j][0], edges.edges[j][1],
                                builder_.add_line(edges.roots[j][0], edges.roots[j][1]),
                                builder_.add_line(edges.ends[j][0], edges.ends[j][1])},
                               side_map(leg, 2 * j - 1));
            outline_.add_pair(edges.edges[j]);
        }
        const int cap = builder_.add_face(fmt::format("cap_{}", i + 1), PartFaceKind::plane, true);
        const bool is_along_x = leg.along.x() != 0.0;
        builder_.add_plane_sheet(cap, lines_around(builder_, edges.ends), is_along_x ? 0 : 1,
                                 leg.along.sum() > 0.0 ? 1 : -1);
        outline_.add_pair({builder_.add_line(edges.ends[0][0], edges.ends[1][0]),
                           builder_.add_line(edges.ends[0][1], edges.ends[1][1])});
    }

    /// The sides at y high between two branches.
    void add_middle() {
        for (int i = 2; i + 1 < n_legs_; ++i) {
            const int face = builder_.add_face("middle", PartFaceKind::plane);
            const std::array<int, 2> from = edges_[i].roots[1];
            const std::array<int, 2> to = edges_[i + 1].roots[0];
            builder_.add_polygon(face, {from[0], to[0], to[1], from[1]}, 1, 1);
            outline_.add_pair(add_lines(from, to));
        }
    }

    PartSurfaceBuilder& builder_;
    const Bar& bar_;
    int n_legs_;
    std::vector<LegEdges> edges_;
    std::map<std::pair<double, double>, std::array<int, 2>> verticals_;
    Outline outline_;
};

Leg make_run_leg(int sign, double half_length, double length, double y, double z) {
    return {{sign * half_length, 0.0}, {sign, 0.0}, Vector2::UnitY(), length, y, z};
}

Leg make_branch(double x, double length, double offset_x, double z) {
    return {{x, half_section}, Vector2::UnitY(), Vector2::UnitX(), length, offset_x, z};
}

void build_pant(const PartValues& values, PartSurfaceBuilder& builder) {
    const double run = pant_reach_x - half_section;
    const double branch = pant_reach_y - half_section;
    const Bar bar = {
        half_section,
        {make_run_leg(-1, half_section, run - values.at("X1"), values.at("Y1"), values.at("Z1")),
         make_run_leg(1, half_section, run + values.at("X2"), values.at("Y2"), values.at("Z2")),
         make_branch(0.0, branch + values.at("Y3"), values.at("X3"), values.at("Z3"))}};
    BarSurface(builder, bar).build();
}

/// @param spread  how far the branches' caps move apart, and the run's caps to y low
void build_double_t(PartSurfaceBuilder& builder, double spread) {
    constexpr double half_length = 70.0;
    constexpr double branch_x = half_length - half_section;
    constexpr double run = 60.0;
    constexpr double branch = 90.0;
    const Bar bar = {
        half_length,
        {make_run_leg(-1, half_length, run, -spread, 0.0),
         make_run_leg(1, half_length, run, -spread, 0.0),
         make_branch(-branch_x, branch, -spread, 0.0), make_branch(branch_x, branch, spread, 0.0)}};
    BarSurface(builder, bar).build();
}

PartParameter offset_parameter(const std::string& axis, int boundary) {
    const double largest = axis == "Z" ? 35.0 : 40.0;
    return {fmt::format("{}{}", axis, boundary), 0.0, -largest, largest,
            fmt::format("how far cap {} is moved along {}, mm", boundary,
                        axis == "X" ? "x" : (axis == "Y" ? "y" : "z"))};
}

}  // namespace

std::vector<PartSurfaceDefinition> branched_bar_surfaces() {
    PartInfo pant = {
        "pant",
        "Three legs of square section 40 x 40 that meet in the cube |x|, |y|, |z| <= 20, in mm; "
        "centres of the caps (-110, 0, 0), (110, 0, 0), (0, 130, 0), each moved by its X, Y, Z. "
        "Faces: bottom, top, back (y low, of legs 1 and 2), leg_1_side, leg_2_side (y high), "
        "leg_3_side_x_low, leg_3_side_x_high; caps cap_1, cap_2, cap_3.",
        {}};
    for (int boundary = 1; boundary <= 3; ++boundary) {
        for (const char* axis : {"X", "Y", "Z"}) {
            pant.parameters.push_back(offset_parameter(axis, boundary));
        }
    }
    const std::string double_t_faces =
        "Faces: bottom, top, back (y low), leg_1_side, leg_2_side (y high), leg_3_side_x_low, "
        "leg_3_side_x_high, the same of leg_4, middle (between legs 3 and 4); caps cap_1 (x low), "
        "cap_2 (x high), cap_3, cap_4.";
    return {{pant, 3.3, build_pant},
            {{"double_t",
              "A bar of section 40 x 40 from x = -130 to 130 with two branches at x = -50 and 50 "
              "up to y = 110, in mm. " +
                  double_t_faces,
              {}},
             4.0,
             [](const PartValues& /*values*/, PartSurfaceBuilder& builder) {
                 build_double_t(builder, 0.0);
             }},
            {{"double_curved_t",
              "As double_t, but the ends of the bar are bent to y low and the branches apart, by "
              "30 mm, along smooth centre lines. " +
                  double_t_faces,
              {}},
             4.0,
             [](const PartValues& /*values*/, PartSurfaceBuilder& builder) {
                 build_double_t(builder, 30.0);
             }}};
}

}  // namespace couture::meshing
