#include "iga/topology/cell_shape.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace couture::iga {

namespace {

using std::numbers::pi;

constexpr double rounding = 1e-13;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <int d>
CellCorners<d> make_box_corners(const Vector<d>& size) {
    CellCorners<d> corners;
    for (int corner = 0; corner < 1 << d; ++corner) {
        for (int k = 0; k < d; ++k) {
            corners(k, corner) = (corner >> k & 1) * size[k];
        }
    }
    return corners;
}

/// A frustum: the upper face half as large and in the middle above the lower one.
CellCorners<3> make_frustum(double height) {
    CellCorners<3> corners =
        make_box_corners<3>(Vector3(2, 2, height)).colwise() - Vector3(1, 1, 0);
    corners.block<2, 4>(0, 4) /= 2.0;
    return corners;
}

/// Turned, moved and scaled.
CellCorners<3> moved(const CellCorners<3>& corners) {
    const Eigen::AngleAxisd turn(0.8, Vector3(1, 2, -1).normalized());
    return (3.0 * (turn.toRotationMatrix() * corners)).colwise() + Vector3(4, -5, 6);
}

/// The other hand, directions in another order.
CellCorners<3> mirrored(const CellCorners<3>& corners) {
    CellCorners<3> result;
    for (int i = 0; i < 8; ++i) {
        result.col((i >> 2 & 1) + 2 * (i >> 1 & 1) + 4 * (i & 1)) = corners.col(i);
    }
    return result;
}

}  // namespace

TEST_CASE("shape_ratio: sqrt 3 for a cube, sqrt 2 for a square", "[topology]") {
    CHECK(shape_ratio(make_box_corners<3>(Vector3::Ones())) ==
          Approx(std::sqrt(3.0)).epsilon(rounding));
    CHECK(shape_ratio(make_box_corners<2>(Vector2::Ones())) ==
          Approx(std::sqrt(2.0)).epsilon(rounding));
}

TEST_CASE("shape_ratio: diagonal over the smallest size of a box", "[topology]") {
    CHECK(shape_ratio(make_box_corners<3>(Vector3(2, 3, 6))) == Approx(7.0 / 2.0));
    CHECK(shape_ratio(make_box_corners<2>(Vector2(4, 3))) == Approx(5.0 / 3.0));
}

TEST_CASE("shape_ratio: infinite where a face has no area or meets the middle", "[topology]") {
    CHECK(shape_ratio(make_box_corners<3>(Vector3(2, 3, 0))) == infinity);
    CHECK(shape_ratio(make_box_corners<3>(Vector3::Zero())) == infinity);
    CHECK(shape_ratio(make_box_corners<2>(Vector2(2, 0))) == infinity);
    // A wedge: the face at x = 0 collapsed to an edge.
    CellCorners<3> wedge = make_box_corners<3>(Vector3::Ones());
    wedge.col(2) = wedge.col(0);
    wedge.col(6) = wedge.col(4);
    CHECK(shape_ratio(wedge) == infinity);
}

TEST_CASE("shape_ratio: faces that are not plane lie across their diagonals", "[topology]") {
    // Two opposite corners of the top up, the others down: the plane through their mean stays.
    CellCorners<3> corners = make_box_corners<3>(Vector3::Ones());
    constexpr double lift = 0.1;
    corners.row(2).tail<4>() += lift * Eigen::RowVector4d(1, -1, -1, 1);
    const double farthest = std::sqrt(0.5 + std::pow(0.5 + lift, 2));
    // Sides lean: mean of the side at x = 0 stays, its diagonals are (0, 1, 1 -+ lift).
    const Vector3 side = Vector3(0, 1, 1 - lift).cross(Vector3(0, 1, -1 - lift));
    REQUIRE(std::abs(side[1]) + std::abs(side[2]) < rounding);
    CHECK(shape_ratio(corners) == Approx(farthest / 0.5));
}

TEST_CASE("angle_deviation: 0 for boxes, however flat", "[topology]") {
    for (const double height : {1.0, 1e-3, 0.0}) {
        CHECK(angle_deviation(make_box_corners<3>(Vector3(1, 2, height))) < rounding);
        CHECK(angle_deviation(make_box_corners<2>(Vector2(1, height))) < rounding);
    }
}

TEST_CASE("angle_deviation: 4 pi pressed flat, as a limit too", "[topology]") {
    CHECK(angle_deviation(make_frustum(0.0)) == Approx(4 * pi).epsilon(rounding));
    CHECK(angle_deviation(make_frustum(1e-4)) == Approx(4 * pi).epsilon(1e-4));
}

TEST_CASE("angle_deviation: 6 pi on a line, 2 pi for a quadrilateral", "[topology]") {
    const CellCorners<3> box = make_box_corners<3>(Vector3(1, 2, 4));
    const Vector3 line(1, 1, 1);
    CHECK(angle_deviation(CellCorners<3>(line * (line.transpose() * box))) ==
          Approx(6 * pi).epsilon(rounding));
    const CellCorners<2> square = make_box_corners<2>(Vector2(1, 2));
    const Vector2 diagonal(1, 1);
    CHECK(angle_deviation(CellCorners<2>(diagonal * (diagonal.transpose() * square))) ==
          Approx(2 * pi).epsilon(rounding));
}

TEST_CASE("angle_deviation: of a parallelogram and its prism", "[topology]") {
    constexpr double angle = 0.9;
    CellCorners<2> plane = make_box_corners<2>(Vector2(2, 0));
    plane.rightCols<2>().colwise() += Vector2(std::cos(angle), std::sin(angle));
    CHECK(angle_deviation(plane) == Approx(4 * (pi / 2 - angle)));
    CellCorners<3> prism = make_box_corners<3>(Vector3(1, 1, 5));
    prism.block<2, 4>(0, 0) = plane;
    prism.block<2, 4>(0, 4) = plane;
    CHECK(angle_deviation(prism) == Approx(8 * (pi / 2 - angle)));
}

TEST_CASE("cell shapes: place, size, hand and order of directions do not matter", "[topology]") {
    CellCorners<3> cell = make_frustum(1.3);
    cell.col(5) += Vector3(0.2, -0.1, 0.3);
    CHECK(shape_ratio(moved(cell)) == Approx(shape_ratio(cell)));
    CHECK(angle_deviation(moved(cell)) == Approx(angle_deviation(cell)));
    CHECK(shape_ratio(mirrored(cell)) == Approx(shape_ratio(cell)));
    CHECK(angle_deviation(mirrored(cell)) == Approx(angle_deviation(cell)));
}

}  // namespace couture::iga
