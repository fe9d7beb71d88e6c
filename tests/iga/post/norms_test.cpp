#include "iga/post/norms.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/spline/shapes.h"
#include "tests/iga/post/quadratic_fields.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-12;

template <int d>
SpacePtr<d> two_boxes(int degree, int n_elements) {
    return std::make_shared<const Space<d>>(make_two_boxes<d>(degree, n_elements));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("error_norms: are zero for the function that the field is", "[post]",
                       ((int d), d), 2, 3) {
    const QuadraticFunction<d> function(2);
    const Field<d> field = function.field_on(two_boxes<d>(GENERATE(2, 3), 2));
    const ErrorNorms norms =
        error_norms<d>(field, {[&](const Vector3& x) -> VectorX { return function.value(x); },
                               [&](const Vector3& x) -> MatrixX { return function.gradient(x); }});
    CHECK(norms.l2_exact > 0.1);
    CHECK(norms.h1_exact > 0.1);
    CHECK(norms.l2 < rounding * norms.l2_exact);
    CHECK(norms.h1 < rounding * norms.h1_exact);
}

TEST_CASE("error_norms: of a field that is zero are those of the function", "[post]") {
    // u = x^2 y on [0, 2] x [0, 1]: |u|^2 = 32/5 * 1/3, |grad u|^2 = 4 * 8/3 * 1/3 + 32/5.
    const SpacePtr<2> space = two_boxes<2>(2, 1);
    const Field<2> zero{space, MatrixX::Zero(space->n_dofs(), 1)};
    const ErrorNorms norms = error_norms<2>(
        zero, {[](const Vector3& x) -> VectorX { return Vector<1>(x[0] * x[0] * x[1]); },
               [](const Vector3& x) -> MatrixX {
                   return Eigen::RowVector2d(2.0 * x[0] * x[1], x[0] * x[0]);
               }});
    CHECK(norms.l2 == Approx(std::sqrt(32.0 / 15.0)).epsilon(rounding));
    CHECK(norms.h1 == Approx(std::sqrt(32.0 / 9.0 + 32.0 / 5.0)).epsilon(rounding));
    CHECK(norms.l2 == norms.l2_exact);
    CHECK(norms.h1 == norms.h1_exact);
}

TEST_CASE("error_norms: measure a known difference on a left-handed curved patch", "[post]") {
    // The field is the position itself, the function the position and 0.1 more: 0.1 sqrt(area).
    MultiPatch<2> part;
    part.patches = {reoriented<2>(make_quarter_annulus(1.0, 2.0), {1, 0}, {false, false})};
    const auto space = std::make_shared<const Space<2>>(part);
    Field<2> field{space, MatrixX(space->n_dofs(), 2)};
    for (int i = 0; i < space->tensor(0).n_basis(); ++i) {
        field.coefficients.row(space->dofs(0)[i]) = part.patches[0].control_points().row(i);
    }
    const ErrorNorms norms =
        error_norms<2>(field,
                       {[](const Vector3& x) -> VectorX { return Vector2(x[0] + 0.1, x[1]); },
                        [](const Vector3&) -> MatrixX { return Matrix<2>::Identity(); }},
                       12);
    const double area = 0.75 * std::numbers::pi;
    CHECK(norms.l2 == Approx(0.1 * std::sqrt(area)).epsilon(1e-10));
    CHECK(norms.h1_exact == Approx(std::sqrt(2.0 * area)).epsilon(1e-10));
    CHECK(norms.h1 < rounding);
}

TEST_CASE("error_norms: the number of Gauss points is as asked", "[post]") {
    // |x^4|^2 = x^8 has degree 8: exact with 5 points and not with 4.
    const SpacePtr<2> space = two_boxes<2>(1, 1);
    const Field<2> zero{space, MatrixX::Zero(space->n_dofs(), 1)};
    const ExactSolution<2> function = {
        [](const Vector3& x) -> VectorX { return Vector<1>(std::pow(x[0], 4)); },
        [](const Vector3& x) -> MatrixX {
            return Eigen::RowVector2d(4.0 * std::pow(x[0], 3), 0.0);
        }};
    const double expected = std::sqrt(512.0 / 9.0);
    CHECK(std::abs(error_norms<2>(zero, function, 5).l2 / expected - 1.0) < rounding);
    CHECK(std::abs(error_norms<2>(zero, function, 4).l2 / expected - 1.0) > 1e-7);
}
