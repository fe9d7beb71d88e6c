#include "iga/topology/element_quality.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-13;

template <int d>
MultiPatch<d> single(const Patch<d>& patch) {
    MultiPatch<d> result;
    result.patches.push_back(patch);
    return result;
}

}  // namespace

TEST_CASE("scaled_jacobian: sine of the angle in the plane, 0 for a zero column", "[topology]") {
    const double angle = 0.7;
    Matrix<2> J;
    J << 3.0, 0.1 * std::cos(angle), 0.0, 0.1 * std::sin(angle);
    CHECK(scaled_jacobian<2>(J) == Approx(std::sin(angle)));
    J.col(1).setZero();
    CHECK(scaled_jacobian<2>(J) == 0.0);
    CHECK(scaled_jacobian<3>(Vector3(2.0, 5.0, -1e-3).asDiagonal()) == Approx(-1.0));
}

TEST_CASE("element_quality: 1 for boxes of either hand", "[topology]") {
    const Patch<3> box = make_box<3>(Vector3(2.0, 3.0, 0.01));
    MatrixX points = box.control_points();
    points.col(1) *= -1.0;
    MultiPatch<3> boxes = single<3>(box);
    boxes.patches.push_back(Patch<3>(box.space(), points));
    const QualitySummary<3> summary = element_quality(boxes);
    CHECK(summary.min_scaled_jacobian == Approx(1.0).epsilon(rounding));
    CHECK(summary.mean_scaled_jacobian == Approx(1.0).epsilon(rounding));
}

TEST_CASE("element_quality: 1 for polar coordinates, rational or not", "[topology]") {
    const QualitySummary<2> annulus = element_quality(single<2>(make_quarter_annulus(1.0, 2.0)));
    CHECK(annulus.min_scaled_jacobian == Approx(1.0).epsilon(rounding));
}

TEST_CASE("element_quality: the worst corner of a quadrilateral is found", "[topology]") {
    // Angle of 30 degrees at the corner (1, 1), which is folded over for a negative height.
    MatrixX corners(4, 2);
    corners << 0, 0, 1, 0, 0, 1, 0.4, 0.4;
    const QualitySummary<2> summary = element_quality(single<2>(make_multilinear<2>(corners)));
    const Vector2 along_u = Vector2(0.4, 0.4) - Vector2(0, 1);
    const Vector2 along_v = Vector2(0.4, 0.4) - Vector2(1, 0);
    const double sine =
        (along_u[0] * along_v[1] - along_u[1] * along_v[0]) / (along_u.norm() * along_v.norm());
    CHECK(sine < 0.0);
    CHECK(summary.min_scaled_jacobian == Approx(sine));
    CHECK(summary.min_at_corners == summary.min_scaled_jacobian);
    CHECK(summary.min_at_gauss_points > summary.min_at_corners);
    CHECK(summary.worst_xi == Vector2(1.0, 1.0));
}

TEST_CASE("element_quality: a collapsed side counts as 0 at its corners", "[topology]") {
    const QualitySummary<3> summary = element_quality(single<3>(make_sphere_shell_patch(1.0, 2.0)));
    CHECK(std::abs(summary.min_at_corners) < rounding);
    CHECK(summary.min_at_gauss_points > 0.5);
    CHECK(summary.worst_patch == 0);
}

TEST_CASE("element_quality: shapes are those of the elements, not of the patch", "[topology]") {
    // Elements of sizes 1, 1, 1 and 3, 1, 1.
    const Patch<3> long_box = make_box<3>(Vector3(4.0, 1.0, 1.0));
    const std::vector<double> cut = {0.25};
    const std::array<Refinement, 3> cuts = {insert_knots(long_box.knots(0), cut),
                                            refine(long_box.knots(1), 1, 1),
                                            refine(long_box.knots(2), 1, 1)};
    MultiPatch<3> boxes = single<3>(make_box<3>(Vector3(2.0, 2.0, 2.0)));
    boxes.patches.push_back(refine<3>(long_box, cuts));
    const QualitySummary<3> summary = element_quality(boxes);
    CHECK(summary.max_shape_ratio == Approx(std::sqrt(11.0)));
    CHECK(summary.mean_shape_ratio == Approx((2.0 * std::sqrt(3.0) + std::sqrt(11.0)) / 3.0));
    CHECK(summary.worst_shape_ratio_patch == 1);
    CHECK(summary.worst_shape_ratio_xi == Vector3(0.625, 0.5, 0.5));
    CHECK(summary.max_angle_deviation < rounding);
    CHECK(summary.mean_angle_deviation < rounding);
}

TEST_CASE("element_quality: shapes of rational elements have corners on the arc", "[topology]") {
    // One element with corners (1, 0), (2, 0), (0, 1), (0, 2): angles 45, 135 degrees.
    const QualitySummary<2> summary = element_quality(single<2>(make_quarter_annulus(1.0, 2.0)));
    CHECK(summary.max_angle_deviation == Approx(std::numbers::pi));
    CHECK(summary.mean_angle_deviation == Approx(std::numbers::pi));
    // Mean (3/4, 3/4) to (2, 0); to the middle (1/2, 1/2) of the inner chord.
    CHECK(summary.max_shape_ratio == Approx(std::hypot(1.25, 0.75) / (std::sqrt(2.0) / 4.0)));
}

TEST_CASE("element_quality: surfaces in space are refused", "[topology]") {
    const Patch<2> flat = make_box<2>(Vector2(1.0, 1.0));
    MatrixX points = MatrixX::Zero(4, 3);
    points.leftCols(2) = flat.control_points();
    CHECK_THROWS_WITH(element_quality(single<2>(Surface(flat.space(), points))),
                      "element_quality: patch 0 has 2 parameters in 3 dimensions; the scaled "
                      "Jacobian needs as many dimensions as parameters");
}
