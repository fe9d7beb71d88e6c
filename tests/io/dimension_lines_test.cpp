#include "io/dimension_lines.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

constexpr double pixels_per_unit = 4.0;
constexpr double rounding = 1e-12;

/// The rectangle [0, 100] x [0, 50], seen from above.
Scene make_plate() {
    SurfacePiece piece;
    piece.vertices.resize(4, 3);
    piece.vertices << 0, 0, 0, 100, 0, 0, 100, 50, 0, 0, 50, 0;
    piece.triangles.resize(2, 3);
    piece.triangles << 0, 1, 2, 0, 2, 3;
    Scene scene;
    scene.surfaces = {piece};
    scene.view_direction = -Vector3::UnitZ();
    scene.up = Vector3::UnitY();
    return scene;
}

DimensionLine below(double x_from, double x_to, const std::string& text) {
    return {.from = {x_from, 0, 0},
            .to = {x_to, 0, 0},
            .along = Vector3::UnitX(),
            .offset = -Vector3::UnitY(),
            .text = text};
}

/// Whether a point lies within the frame.
bool is_seen(const Scene& scene, const Vector3& x) {
    const Vector3 seen = view_axes(scene).transpose() * x;
    const Vector2 from_center = seen.head<2>() - scene.frame->center;
    const double half_height = 0.5 * scene.frame->height;
    const double half_width = half_height * scene.width / scene.height;
    return std::abs(from_center.x()) < half_width && std::abs(from_center.y()) < half_height;
}

}  // namespace

TEST_CASE("add_dimension_lines: a line beside the piece, extension lines, arrows and a text",
          "[io]") {
    Scene scene = make_plate();
    add_dimension_lines(scene, {below(0.0, 100.0, "100")}, pixels_per_unit);
    // Two extension lines and the dimension line.
    REQUIRE(scene.curves.size() == 3);
    const MatrixX& line = scene.curves[2].points;
    CHECK(line(0, 0) == 0.0);
    CHECK(line(1, 0) == 100.0);
    CHECK(line(0, 1) == line(1, 1));
    CHECK(line(0, 1) < -5.0);
    for (int i = 0; i < 2; ++i) {
        const MatrixX& extension = scene.curves[i].points;
        CHECK(extension(0, 0) == 100.0 * i);
        CHECK(extension(0, 1) < 0.0);
        CHECK(extension(1, 1) < line(0, 1));
    }
    REQUIRE(scene.labels.size() == 1);
    CHECK(scene.labels[0].text == "100");
    CHECK(scene.labels[0].has_background);
    CHECK(scene.labels[0].position.x() == Approx(50.0));
    REQUIRE(scene.surfaces.size() == 2);
    const SurfacePiece& arrows = scene.surfaces[1];
    REQUIRE(arrows.triangles.rows() == 2);
    // Their tips touch the ends from inside.
    CHECK(arrows.vertices(0, 0) == 100.0);
    CHECK(arrows.vertices(1, 0) < 100.0);
    CHECK(arrows.vertices(3, 0) == 0.0);
    CHECK(arrows.vertices(4, 0) > 0.0);
    CHECK(arrows.vertices.col(2).minCoeff() > 0.0);
}

TEST_CASE("add_dimension_lines: the frame has the scale and shows everything", "[io]") {
    Scene scene = make_plate();
    scene.labels = {{{-30.0, 25.0, 0.0}, "left"}};
    DimensionLine through{
        .from = {50, 25, 0}, .to = {60, 25, 0}, .is_one_sided = true, .text = "radius 10"};
    add_dimension_lines(scene, {below(0.0, 100.0, "100"), below(0.0, 10.0, "short"), through},
                        pixels_per_unit);
    REQUIRE(scene.frame);
    CHECK(scene.height == Approx(scene.frame->height * pixels_per_unit));
    for (const SurfacePiece& piece : scene.surfaces) {
        for (Eigen::Index i = 0; i < piece.vertices.rows(); ++i) {
            CHECK(is_seen(scene, piece.vertices.row(i).transpose()));
        }
    }
    for (const CurvePiece& piece : scene.curves) {
        for (Eigen::Index i = 0; i < piece.points.rows(); ++i) {
            CHECK(is_seen(scene, piece.points.row(i).transpose()));
        }
    }
    for (const Label& label : scene.labels) {
        const Vector2 half = 0.5 / pixels_per_unit * label_size(label.text);
        CHECK(is_seen(scene, label.position + Vector3(half.x(), half.y(), 0.0)));
        CHECK(is_seen(scene, label.position - Vector3(half.x(), half.y(), 0.0)));
    }
    // The text of the line through both ends lies behind the piece.
    for (const Label& label : scene.labels) {
        if (label.text == "radius 10") {
            CHECK(label.position.x() - 0.5 / pixels_per_unit * label_size(label.text).x() > 100.0);
            CHECK(label.position.y() == Approx(25.0));
        }
    }
}

TEST_CASE("add_dimension_lines: shorter lines lie nearer, and those apart share a row", "[io]") {
    Scene scene = make_plate();
    add_dimension_lines(scene,
                        {below(0.0, 100.0, "100"), below(0.0, 45.0, "45"), below(60.0, 95.0, "35")},
                        pixels_per_unit);
    std::map<std::string, double> level;
    for (const Label& label : scene.labels) {
        level[label.text] = label.position.y();
    }
    CHECK(level["45"] == level["35"]);
    CHECK(level["100"] < level["45"]);
}

TEST_CASE("add_dimension_lines: where it is narrow, arrows point inwards and the text is beside",
          "[io]") {
    Scene scene = make_plate();
    add_dimension_lines(scene, {below(90.0, 92.0, "2")}, pixels_per_unit);
    const MatrixX& arrows = scene.surfaces[1].vertices;
    CHECK(arrows(0, 0) == 92.0);
    CHECK(arrows(1, 0) > 92.0);
    CHECK(arrows(3, 0) == 90.0);
    CHECK(arrows(4, 0) < 90.0);
    CHECK(scene.labels[0].position.x() > 92.0);

    // A negative size: towards lower coordinates.
    Scene backwards = make_plate();
    add_dimension_lines(backwards, {below(92.0, 90.0, "-2")}, pixels_per_unit);
    CHECK(backwards.labels[0].position.x() < 90.0);
}

TEST_CASE("add_dimension_lines: texts of upright lines are turned", "[io]") {
    Scene scene = make_plate();
    const DimensionLine line{.from = {100, 0, 0},
                             .to = {100, 50, 0},
                             .along = Vector3::UnitY(),
                             .offset = Vector3::UnitX(),
                             .text = "50"};
    add_dimension_lines(scene, {line}, pixels_per_unit);
    CHECK(scene.labels[0].angle == Approx(std::numbers::pi / 2));
    CHECK(scene.labels[0].position.x() > 100.0);
    CHECK(std::abs(scene.labels[0].position.y() - 25.0) < rounding);
}

TEST_CASE("add_dimension_lines: errors", "[io]") {
    Scene nothing;
    CHECK_THROWS_WITH(add_dimension_lines(nothing, {}, 1.0), Contains("no surface and no curve"));
    Scene scene = make_plate();
    CHECK_THROWS_WITH(add_dimension_lines(scene, {}, 0.0),
                      "add_dimension_lines: pixels_per_unit = 0; must be positive and finite");
    CHECK_THROWS_AS(add_dimension_lines(scene, {}, std::numeric_limits<double>::quiet_NaN()),
                    InputError);
    DimensionLine wrong = below(0.0, 1.0, "deep");
    wrong.offset = Vector3::UnitZ();
    CHECK_THROWS_WITH(add_dimension_lines(scene, {wrong}, 1.0),
                      "add_dimension_lines: 'deep' is measured along (1, 0, 0) and moved along (0, "
                      "0, 1); one must be to the right or left in the picture, the other up or "
                      "down");
    wrong.offset = Vector3::Zero();
    wrong.along = Vector3::UnitZ();
    CHECK_THROWS_WITH(add_dimension_lines(scene, {wrong}, 1.0),
                      "add_dimension_lines: 'deep' is measured along (0, 0, 1); it must be a unit "
                      "direction in the picture's plane");
}
