#include "iga/topology/field.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-12;

/// The control points as coefficients: the field is the position.
template <int d>
Field<d> position_field(const SpacePtr<d>& space) {
    Field<d> field{space, MatrixX::Zero(space->n_dofs(), space->geometry().dimension())};
    for (int p = 0; p < space->n_patches(); ++p) {
        for (int i = 0; i < space->tensor(p).n_basis(); ++i) {
            field.coefficients.row(space->dofs(p)[i]) =
                space->geometry().patches[p].control_points().row(i);
        }
    }
    return field;
}

/// Half of a pipe: two rational patches, the second left-handed.
MultiPatch<3> half_pipe() {
    const Volume quarter = make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0, 0, 3));
    MatrixX mirrored = quarter.control_points();
    mirrored.col(0) *= -1.0;
    MultiPatch<3> part;
    part.patches = {quarter, Volume(quarter.space(), mirrored, quarter.weights())};
    static_cast<void>(find_interfaces(part));
    return part;
}

template <int d>
Field<d> wavy_field(const SpacePtr<d>& space, int n_components) {
    Field<d> field{space, MatrixX(space->n_dofs(), n_components)};
    for (int i = 0; i < space->n_dofs(); ++i) {
        for (int a = 0; a < n_components; ++a) {
            field.coefficients(i, a) = std::sin(1.7 * i + 0.9 * a);
        }
    }
    return field;
}

}  // namespace

TEST_CASE("Field: with control points as coefficients is the position, its gradient the identity",
          "[topology]") {
    const auto space = std::make_shared<const Space<3>>(half_pipe());
    REQUIRE(space->geometry().interfaces.size() == 1);
    const Field<3> field = position_field<3>(space);
    for (int p = 0; p < 2; ++p) {
        for (const Vector3& xi : {Vector3(0, 0, 0), Vector3(0.3, 0.6, 0.2), Vector3(1, 1, 1)}) {
            CHECK((field.value(p, xi) - space->geometry().patches[p].point(xi)).norm() < rounding);
            CHECK((field.gradient(p, xi) - Matrix<3>::Identity()).norm() < rounding);
        }
    }
}

TEST_CASE("Field: the gradient is the difference quotient along the map", "[topology]") {
    const auto space =
        std::make_shared<const Space<3>>(refine<3>(half_pipe(), 3, std::array<int, 3>{2, 3, 1}));
    const Field<3> field = wavy_field<3>(space, 2);
    constexpr double step = 1e-5;
    constexpr double difference_error = 1e-6;
    for (int p = 0; p < 2; ++p) {
        const Patch<3>& map = space->geometry().patches[p];
        const Vector3 xi(0.3, 0.55, 0.7);
        const MatrixX gradient = field.gradient(p, xi);
        REQUIRE(gradient.rows() == 2);
        REQUIRE(gradient.cols() == 3);
        // du/dxi = grad u * dx/dxi.
        const MatrixX along = gradient * map.jacobian(xi);
        for (int k = 0; k < 3; ++k) {
            const Vector3 e = step * Vector3::Unit(k);
            const VectorX quotient = (field.value(p, xi + e) - field.value(p, xi - e)) / (2 * step);
            CHECK((quotient - along.col(k)).norm() < difference_error * (1.0 + along.norm()));
        }
    }
}

TEST_CASE("Field: is continuous across an interface", "[topology]") {
    const auto space =
        std::make_shared<const Space<3>>(refine<3>(half_pipe(), 3, std::array<int, 3>{2, 3, 1}));
    const Field<3> field = wavy_field<3>(space, 3);
    // The patches are mirror images and meet where the arc ends.
    for (const double t : {0.0, 0.27, 0.8}) {
        const Vector3 xi(t, 1.0, 1.0 - t);
        CHECK((space->geometry().patches[0].point(xi) - space->geometry().patches[1].point(xi))
                  .norm() < rounding);
        CHECK((field.value(0, xi) - field.value(1, xi)).norm() < rounding);
    }
    CHECK((field.value(0, Vector3(0.5, 0.2, 0.5)) - field.value(1, Vector3(0.5, 0.2, 0.5))).norm() >
          1e-3);
}

TEST_CASE("Field: a singular map has values but no gradient", "[topology]") {
    MultiPatch<3> part;
    part.patches = {make_sphere_shell_patch(1.0, 2.0)};
    const auto space = std::make_shared<const Space<3>>(part);
    const Field<3> field = position_field<3>(space);
    // The polar angle is zero on the z axis.
    const Vector3 on_axis(0.5, 0.0, 0.25);
    CHECK((field.value(0, on_axis) - Vector3(0, 0, 1.5)).norm() < rounding);
    CHECK_THROWS_AS(field.gradient(0, on_axis), GeometryError);
    CHECK_THROWS_WITH(field.gradient(0, on_axis),
                      "patch 0: the map is singular (det J = 0) at parameter (0.5, 0, 0.25); take "
                      "a point beside it");
    CHECK((field.gradient(0, Vector3(0.5, 1e-4, 0.25)) - Matrix<3>::Identity()).norm() < 1e-8);
}

TEST_CASE("Field: a surface in space has values but no gradient", "[topology]") {
    MatrixX corners(4, 3);
    corners << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1;
    MultiPatch<2> part;
    part.patches = {make_multilinear<2>(corners)};
    const Field<2> field = position_field<2>(std::make_shared<const Space<2>>(part));
    CHECK((field.value(0, Vector2(0.5, 0.5)) - Vector3(0.5, 0.5, 0.25)).norm() < rounding);
    CHECK_THROWS_WITH(field.gradient(0, Vector2(0.5, 0.5)),
                      "patch 0 has 2 parameters but 3 coordinates; gradients need equal numbers");
}

TEST_CASE("Field: a parameter outside the patch is refused", "[topology]") {
    const Field<3> field = wavy_field<3>(std::make_shared<const Space<3>>(half_pipe()), 1);
    CHECK_THROWS_AS(field.value(0, Vector3(0.5, 0.5, 1.5)), InputError);
}
