#include "meshing/parts/torus_surfaces.h"

#include <array>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

using std::numbers::pi;

// Two meridians and both equators cut it into four sheets.
void build_torus(const PartValues& values, PartSurfaceBuilder& builder) {
    const double radius = values.at("radius");
    const double tube_radius = values.at("tube_radius");
    const int face = builder.add_face("torus", PartFaceKind::torus);
    const auto outer = builder.add_circle(Vector3::Zero(), radius + tube_radius);
    const auto inner = builder.add_circle(Vector3::Zero(), radius - tube_radius);
    // [at theta 0 and pi][upper, lower], from the outer to the inner equator
    std::array<std::array<int, 2>, 2> meridians{};
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            meridians[i][j] =
                builder.add_curve(outer.vertices[i], inner.vertices[i], [&](double t) {
                    return torus_point(Vector3::Zero(), radius, tube_radius, i * pi,
                                       (j == 0 ? pi : -pi) * t);
                });
        }
    }
    for (int half = 0; half < 2; ++half) {
        for (int j = 0; j < 2; ++j) {
            builder.add_sheet(
                face, {outer.arcs[half], meridians[1][j], inner.arcs[half], meridians[0][j]},
                torus_map(Vector3::Zero(), radius, tube_radius,
                          {(half + 0.5) * pi, (j == 0 ? 0.5 : -0.5) * pi}));
        }
    }
}

constexpr double ring_radius = 30.0;
constexpr double ring_tube_radius = 10.0;
/// Distance of each axis from the plane x = 0.
constexpr double axis_distance = ring_radius + 0.5 * ring_tube_radius;

/// Point of the oval in which the tori meet, at an angle in the plane x = 0 from y to z: on the
/// ray, the one zero of (sqrt(c^2 + y^2) - R)^2 + z^2 - r^2, which grows along it as c > R.
Vector3 oval_point(double angle) {
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    double low = 0.0;
    double high = ring_radius + 2.0 * ring_tube_radius;
    for (double middle = high / 2; low < middle && middle < high; middle = (low + high) / 2) {
        const double rho = std::hypot(axis_distance, middle * cosine) - ring_radius;
        const double z = middle * sine;
        (rho * rho + z * z < ring_tube_radius * ring_tube_radius ? low : high) = middle;
    }
    return {0.0, high * cosine, high * sine};
}

struct Oval {
    /// At y > 0 and y < 0, on z = 0.
    std::array<int, 2> vertices;
    /// Between them, z > 0 and z < 0.
    std::array<int, 2> arcs;
};

/// A ring about the line along z through x = -axis_distance (side = -1) or axis_distance (+1).
void add_ring(PartSurfaceBuilder& builder, int face, int side, const Oval& oval) {
    const Vector3 centre(side * axis_distance, 0.0, 0.0);
    const double outer_radius = ring_radius + ring_tube_radius;
    const double inner_radius = ring_radius - ring_tube_radius;
    // Towards the plane x = 0.
    const double front = side < 0 ? 0.0 : pi;
    const double opening = std::acos(axis_distance / outer_radius);
    const auto place = [&](double radius, double angle) -> Vector3 {
        return centre + radius * Vector3(std::cos(front + angle), std::sin(front + angle), 0.0);
    };
    // On the left (counter-clockwise) and on the right of the oval, seen from the axis.
    const std::array<int, 2> oval_ends = {oval.vertices[side < 0 ? 0 : 1],
                                          oval.vertices[side < 0 ? 1 : 0]};
    std::array<int, 2> outer{};
    std::array<int, 2> inner{};
    std::array<std::array<int, 2>, 2> meridians{};
    for (int i = 0; i < 2; ++i) {
        const double angle = i == 0 ? pi / 2 : -pi / 2;
        outer[i] = builder.add_vertex(place(outer_radius, angle));
        inner[i] = builder.add_vertex(place(inner_radius, angle));
        for (int j = 0; j < 2; ++j) {
            meridians[i][j] = builder.add_curve(outer[i], inner[i], [&](double t) {
                return torus_point(centre, ring_radius, ring_tube_radius, front + angle,
                                   (j == 0 ? pi : -pi) * t);
            });
        }
    }
    const int left = builder.add_arc(oval_ends[0], outer[0], centre, pi / 2 - opening);
    const int right = builder.add_arc(oval_ends[1], outer[1], centre, opening - pi / 2);
    const int back = builder.add_arc(outer[0], outer[1], centre, pi);
    const int inner_front = builder.add_arc(inner[1], inner[0], centre, pi);
    const int inner_back = builder.add_arc(inner[0], inner[1], centre, pi);
    for (int j = 0; j < 2; ++j) {
        const double phi = (j == 0 ? 0.5 : -0.5) * pi;
        builder.add_sheet(
            face, {right, oval.arcs[j], left, meridians[0][j], inner_front, meridians[1][j]},
            torus_map(centre, ring_radius, ring_tube_radius, {front, phi}));
        builder.add_sheet(face, {back, meridians[0][j], inner_back, meridians[1][j]},
                          torus_map(centre, ring_radius, ring_tube_radius, {front + pi, phi}));
    }
}

void build_double_torus(const PartValues& /*values*/, PartSurfaceBuilder& builder) {
    const int low = builder.add_face("ring_x_low", PartFaceKind::torus);
    const int high = builder.add_face("ring_x_high", PartFaceKind::torus);
    Oval oval{};
    oval.vertices = {builder.add_vertex(oval_point(0.0)), builder.add_vertex(oval_point(pi))};
    for (int j = 0; j < 2; ++j) {
        oval.arcs[j] = builder.add_curve(oval.vertices[0], oval.vertices[1], [j](double t) {
            return oval_point((j == 0 ? pi : -pi) * t);
        });
    }
    add_ring(builder, low, -1, oval);
    add_ring(builder, high, 1, oval);
}

}  // namespace

std::vector<PartSurfaceDefinition> torus_surfaces() {
    return {{{"torus",
              "Torus about z, centred, in mm. Face: torus; no feature curve.",
              {{"radius", 60.0, 50.0, 100.0, "of the tube's centre line, mm"},
               {"tube_radius", 20.0, 5.0, 40.0, "radius of the tube, mm"}}},
             4.0,
             build_torus},
            {{"double_torus",
              "Two tori of radius 30 and tube radius 10 about the lines along z through x = -35 "
              "and 35, united, in mm. Faces: ring_x_low, ring_x_high, which meet in an oval.",
              {}},
             2.2,
             build_double_torus}};
}

}  // namespace couture::meshing
