#include "meshing/parts/part_dimensions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "meshing/parts/part_surface.h"
#include "tests/meshing/parts/surface_probe.h"

namespace couture::meshing {

using Catch::Matchers::Contains;
using Values = std::map<std::string, double>;

namespace {

constexpr double rounding = 1e-12;
/// Relative to the part's size.
constexpr double on_surface = 1e-6;

Values random_values(const PartInfo& info) {
    Values values;
    double part = 0.37;
    for (const PartParameter& parameter : info.parameters) {
        values[parameter.name] = parameter.min + part * (parameter.max - parameter.min);
        part = std::fmod(part + 0.618, 1.0);
    }
    return values;
}

double distance_to_triangle(const Vector3& p, const Vector3& a, const Vector3& b,
                            const Vector3& c) {
    const Vector3 normal = (b - a).cross(c - a).normalized();
    const Vector3 foot = p - (p - a).dot(normal) * normal;
    const std::array<Vector3, 3> x = {a, b, c};
    bool is_inside = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vector3 edge = x[(k + 1) % 3] - x[k];
        is_inside = is_inside && edge.cross(foot - x[k]).dot(normal) >= 0.0;
        const double t = std::clamp((p - x[k]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - x[k] - t * edge).norm());
    }
    return is_inside ? (p - foot).norm() : nearest;
}

/// A cylinder about a line along z, from its triangles' vertices.
struct Circle {
    Vector2 centre = Vector2::Zero();
    double radius = 0.0;
};

Circle circle_of(const PartSurface& part, const std::string& face) {
    // x^2 + y^2 = 2 a x + 2 b y + c.
    const std::set<int> vertices = vertices_of_face(part, face);
    MatrixX rows(static_cast<Eigen::Index>(vertices.size()), 3);
    VectorX right(rows.rows());
    Eigen::Index i = 0;
    for (const int v : vertices) {
        const Vector3& x = part.soup.points[v];
        rows.row(i) << 2.0 * x.x(), 2.0 * x.y(), 1.0;
        right[i++] = x.head<2>().squaredNorm();
    }
    const Vector3 solution = (rows.transpose() * rows).ldlt().solve(rows.transpose() * right);
    const Vector2 centre = solution.head<2>();
    return {centre, std::sqrt(solution.z() + centre.squaredNorm())};
}

struct Torus {
    Vector3 centre = Vector3::Zero();
    double radius = 30.0;
    double tube_radius = 10.0;

    /// From the surface.
    [[nodiscard]] double distance(const Vector3& p) const {
        const double rho = (p - centre).head<2>().norm() - radius;
        return std::abs(std::hypot(rho, p.z()) - tube_radius);
    }
};

/// A part with the cylinders and tori that its faces are.
struct Shape {
    PartSurface part;
    std::map<std::string, Circle> cylinders;
    std::map<std::string, Torus> tori;
};

Shape make_shape(const std::string& name, const Values& values) {
    Shape shape{make_part_surface(name, values, 2.0 * default_edge_length(name)), {}, {}};
    for (const PartFace& face : shape.part.faces) {
        if (face.kind == PartFaceKind::cylinder) {
            shape.cylinders[face.name] = circle_of(shape.part, face.name);
        }
        if (face.name == "torus") {
            shape.tori["torus"] = {Vector3::Zero(), values.at("radius"), values.at("tube_radius")};
        } else if (face.kind == PartFaceKind::torus) {
            shape.tori[face.name].centre.x() = face.name == "ring_x_low" ? -35.0 : 35.0;
        }
    }
    return shape;
}

/// Distance from the surface itself, not from its triangles; that of a swept face is only small
/// at vertices and on straight lines.
double distance_from_surface(const Shape& shape, const Vector3& p) {
    double nearest = std::numeric_limits<double>::infinity();
    const std::vector<Vector3>& x = shape.part.soup.points;
    for (std::size_t t = 0; t < shape.part.soup.triangles.size(); ++t) {
        const auto& [a, b, c] = shape.part.soup.triangles[t];
        const double distance = distance_to_triangle(p, x[a], x[b], x[c]);
        const std::string& face = shape.part.faces[shape.part.face_of_triangle[t]].name;
        const auto cylinder = shape.cylinders.find(face);
        const auto torus = shape.tori.find(face);
        // Edges turn by 20 degrees or so: triangles are at most r (1 - cos 11 degrees) off.
        constexpr double facets = 0.02;
        if (cylinder != shape.cylinders.end()) {
            const auto& [centre, radius] = cylinder->second;
            if (distance < facets * radius) {
                nearest = std::min(nearest, std::abs((p.head<2>() - centre).norm() - radius));
            }
        } else if (torus != shape.tori.end()) {
            if (distance < facets * torus->second.tube_radius) {
                nearest = std::min(nearest, torus->second.distance(p));
            }
        } else {
            nearest = std::min(nearest, distance);
        }
    }
    return nearest;
}

bool is_on_axis(const Shape& shape, const Vector3& p) {
    constexpr double near = 1e-6;
    return std::any_of(shape.cylinders.begin(), shape.cylinders.end(),
                       [&](const auto& entry) {
                           return (entry.second.centre - p.head<2>()).norm() < near;
                       }) ||
           std::any_of(shape.tori.begin(), shape.tori.end(), [&](const auto& entry) {
               return (entry.second.centre - p).template head<2>().norm() < near;
           });
}

}  // namespace

TEST_CASE("part_dimensions: every parameter is shown, and what is measured is its value",
          "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        CAPTURE(info.name);
        std::set<std::string> shown;
        for (const PartDimension& dimension : part_dimensions(info.name, random_values(info))) {
            CAPTURE(dimension.parameter, dimension.value);
            shown.insert(dimension.parameter);
            if (!dimension.parameter.empty()) {
                CHECK(dimension.value == random_values(info).at(dimension.parameter));
            }
            CHECK(std::abs(measured_distance(dimension) - dimension.value) <
                  rounding * std::max(100.0, std::abs(dimension.value)));
            CHECK(std::abs(dimension.along.norm() - 1.0) < rounding);
            CHECK(std::abs(dimension.along.dot(dimension.offset)) < rounding);
            CHECK(
                (dimension.offset.isZero() || std::abs(dimension.offset.norm() - 1.0) < rounding));
            // A line through both ends is as long as it says.
            if (dimension.offset.isZero()) {
                CHECK((dimension.to - dimension.from).norm() == Approx(dimension.value));
                CHECK(dimension.along.z() == 0.0);
            }
        }
        CHECK_FALSE(part_dimensions(info.name).empty());
        for (const PartParameter& parameter : info.parameters) {
            CAPTURE(parameter.name);
            CHECK(shown.contains(parameter.name));
        }
    }
}

TEST_CASE("part_dimensions: a parameter changes what it is shown by and nothing else", "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        const auto before = part_dimensions(info.name);
        for (const PartParameter& parameter : info.parameters) {
            const double step = 0.25 * (parameter.max - parameter.value);
            const auto after =
                part_dimensions(info.name, {{parameter.name, parameter.value + step}});
            REQUIRE(after.size() == before.size());
            for (std::size_t i = 0; i < before.size(); ++i) {
                CAPTURE(info.name, parameter.name, before[i].parameter, before[i].value);
                const double change = measured_distance(after[i]) - measured_distance(before[i]);
                const double expected = before[i].parameter == parameter.name ? step : 0.0;
                CHECK(std::abs(change - expected) < 1e-9);
            }
        }
    }
}

TEST_CASE("part_dimensions: ends lie on the surface, or on the axes that they name", "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        Values middle;
        for (const PartParameter& parameter : info.parameters) {
            middle[parameter.name] = parameter.value;
        }
        for (const Values& values : {middle, random_values(info)}) {
            const Shape shape = make_shape(info.name, values);
            // The tori are what the test says.
            for (const auto& [face, torus] : shape.tori) {
                for (const int v : vertices_of_face(shape.part, face)) {
                    REQUIRE(torus.distance(shape.part.soup.points[v]) < 1e-9);
                }
            }
            Vector3 low = Vector3::Constant(1e9);
            Vector3 high = -low;
            for (const Vector3& x : shape.part.soup.points) {
                low = low.cwiseMin(x);
                high = high.cwiseMax(x);
            }
            const double size = (high - low).norm();
            for (const PartDimension& dimension : part_dimensions(info.name, values)) {
                for (const auto& [point, end] : {std::pair(dimension.from, dimension.from_end),
                                                 std::pair(dimension.to, dimension.to_end)}) {
                    CAPTURE(info.name, dimension.parameter, dimension.value, point.transpose());
                    if (end == DimensionEnd::surface) {
                        CHECK(distance_from_surface(shape, point) < on_surface * size);
                    } else if (end == DimensionEnd::axis) {
                        CHECK(is_on_axis(shape, point));
                    } else {
                        CHECK(info.name == "pant");
                    }
                }
            }
        }
    }
}

TEST_CASE("part_dimensions: the readme has each part's picture and each parameter's range",
          "[parts]") {
    std::ifstream file(std::string(COUTURE_SOURCE_DIR) + "/meshing/parts/README.md");
    std::stringstream text;
    text << file.rdbuf();
    for (const PartInfo& info : part_surfaces()) {
        CHECK_THAT(text.str(), Contains("(pictures/" + info.name + ".png)"));
        // The part's paragraph.
        const std::size_t start = text.str().find("### " + info.name + "\n");
        REQUIRE(start != std::string::npos);
        const std::string section =
            text.str().substr(start, text.str().find("\n### ", start + 1) - start);
        for (const PartParameter& parameter : info.parameters) {
            std::ostringstream row;
            row << "| " << parameter.name << " | " << parameter.value << " | [" << parameter.min
                << ", " << parameter.max << "] |";
            CHECK_THAT(section, Contains(row.str()));
        }
        for (const PartFace& face : make_part_surface(info.name).faces) {
            if (face.is_cap) {
                CHECK_THAT(section, Contains(face.name));
            }
        }
    }
}

TEST_CASE("part_dimensions: errors", "[parts]") {
    CHECK_THROWS_WITH(part_dimensions("wheels"),
                      Contains("part_dimensions: unknown part 'wheels'; did you mean 'wheel'?"));
    CHECK_THROWS_WITH(part_dimensions("plate", {{"P3", 1.0}}),
                      Contains("plate: unknown parameter 'P3'"));
    CHECK_THROWS_WITH(part_dimensions("plate", {{"P1", 51.0}}),
                      Contains("plate: P1 = 51 is out of range"));
}

}  // namespace couture::meshing
