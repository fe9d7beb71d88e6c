#include "iga/mechanics/kinematics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-14;

/// Derivatives and values in the order the operator takes them: a (d + 1) + s.
template <int d>
Vector<d*(d + 1)> packed(const Matrix<d>& gradient, const Vector<d>& value) {
    Vector<d*(d + 1)> result;
    for (int a = 0; a < d; ++a) {
        for (int s = 0; s < d; ++s) {
            result[a * (d + 1) + s] = gradient(a, s);
        }
        result[a * (d + 1) + d] = value[a];
    }
    return result;
}

template <int d>
Vector<6> strain(Kinematics kinematics, const Vector3& x, const Matrix<d>& gradient,
                 const Vector<d>& value) {
    return strain_operator<d>(kinematics, x) * packed<d>(gradient, value);
}

Material material(const std::string& name, PatchList patches) {
    Material result;
    result.name = name;
    result.patches = std::move(patches);
    return result;
}

}  // namespace

TEST_CASE("strain_operator: volumes have the symmetric gradient, shear doubled", "[mechanics]") {
    Matrix<3> gradient;
    gradient << 1, 2, 3, 4, 5, 6, 7, 8, 9;
    Vector<6> expected;
    expected << 1, 5, 9, 6 + 8, 3 + 7, 2 + 4;
    CHECK(strain<3>(Kinematics::solid, Vector3(0.1, 0.2, 0.3), gradient, Vector3(7, 8, 9)) ==
          expected);
}

TEST_CASE("strain_operator: turning and shifting a body strains nothing", "[mechanics]") {
    Matrix<3> turn;
    turn << 0, -3, 2, 3, 0, -1, -2, 1, 0;
    CHECK(strain<3>(Kinematics::solid, Vector3::Ones(), turn, Vector3(1, 2, 3)).isZero(0.0));
    Matrix<2> turn_in_plane;
    turn_in_plane << 0, -3, 3, 0;
    const Kinematics kinematics = GENERATE(Kinematics::plane_strain, Kinematics::plane_stress);
    CHECK(strain<2>(kinematics, Vector3::Ones(), turn_in_plane, Vector2(1, 2)).isZero(0.0));
}

TEST_CASE("strain_operator: plane problems strain nothing across the plane", "[mechanics]") {
    Matrix<2> gradient;
    gradient << 1, 2, 3, 4;
    Vector<6> expected;
    expected << 1, 4, 0, 0, 0, 5;
    const Kinematics kinematics = GENERATE(Kinematics::plane_strain, Kinematics::plane_stress);
    CHECK(strain<2>(kinematics, Vector3(2, 3, 0), gradient, Vector2(5, 6)) == expected);
}

TEST_CASE("strain_operator: axisymmetric hoop strain is u_r / r", "[mechanics]") {
    Matrix<2> gradient;
    gradient << 1, 2, 3, 4;
    Vector<6> expected;
    expected << 1, 4, 5.0 / 2.0, 0, 0, 5;
    const Vector<6> obtained =
        strain<2>(Kinematics::axisymmetric, Vector3(2, 3, 0), gradient, Vector2(5, 6));
    CHECK((obtained - expected).norm() < rounding);
    // Only shifts along the axis are free.
    CHECK(strain<2>(Kinematics::axisymmetric, Vector3(2, 3, 0), Matrix<2>::Zero(), Vector2(0, 6))
              .isZero(0.0));
}

TEST_CASE("measure: the thickness, the ring's circumference, or one", "[mechanics]") {
    const Vector3 x(2.0, 3.0, 0.0);
    CHECK(measure(Kinematics::solid, 0.1, x) == 1.0);
    CHECK(measure(Kinematics::plane_strain, 0.1, x) == 0.1);
    CHECK(measure(Kinematics::plane_stress, 0.1, x) == 0.1);
    CHECK(measure(Kinematics::axisymmetric, 0.1, x) == Approx(4.0 * std::numbers::pi));
}

TEST_CASE("effective_stiffness: is condensed in plane stress only", "[mechanics]") {
    const ElasticStiffness D = isotropic_stiffness(10.0, 0.3);
    for (const Kinematics kinematics :
         {Kinematics::solid, Kinematics::plane_strain, Kinematics::axisymmetric}) {
        CHECK(effective_stiffness(kinematics, D) == D);
    }
    CHECK(effective_stiffness(Kinematics::plane_stress, D) == condense_plane_stress(D));
    CHECK(effective_stiffness(Kinematics::plane_stress, D) != D);
}

TEST_CASE("materials_of_patches: a list, or all patches", "[mechanics]") {
    Problem problem;
    problem.materials = {material("steel", {})};
    CHECK(materials_of_patches(problem, 3) == std::vector<int>{0, 0, 0});
    problem.materials = {material("steel", {2, 0}), material("rubber", {1})};
    CHECK(materials_of_patches(problem, 3) == std::vector<int>{0, 1, 0});
}

TEST_CASE("materials_of_patches: none, two and unknown patches are named", "[mechanics]") {
    Problem problem;
    problem.materials = {material("steel", {0, 2})};
    CHECK_THROWS_AS(materials_of_patches(problem, 3), InputError);
    CHECK_THROWS_WITH(materials_of_patches(problem, 3),
                      "patch 1 has no material; give one without 'patches', or list it");
    CHECK_THROWS_WITH(materials_of_patches(problem, 2),
                      "material 'steel': patch 2; the part has patches 0 to 1");
    problem.materials = {material("steel", {0, -1})};
    CHECK_THROWS_WITH(materials_of_patches(problem, 2),
                      "material 'steel': patch -1; the part has patches 0 to 1");
    problem.materials = {material("steel", {}), material("rubber", {1})};
    CHECK_THROWS_WITH(materials_of_patches(problem, 2),
                      "patch 1 has two materials, 'steel' and 'rubber'; list the patches of each");
}

TEST_CASE("check_kinematics: takes what fits the dimension", "[mechanics]") {
    Problem problem;
    CHECK_NOTHROW(check_kinematics(problem, 3));
    for (const Kinematics kinematics :
         {Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric}) {
        problem.kinematics = kinematics;
        CHECK_NOTHROW(check_kinematics(problem, 2));
    }
    problem.kinematics = Kinematics::solid;
    problem.physics = Physics::poisson;
    CHECK_NOTHROW(check_kinematics(problem, 2));
}

TEST_CASE("check_kinematics: what does not fit is said with the way out", "[mechanics]") {
    Problem problem;
    CHECK_THROWS_AS(check_kinematics(problem, 2), InputError);
    CHECK_THROWS_WITH(check_kinematics(problem, 2),
                      "a part in the plane needs kinematics = \"plane_strain\", \"plane_stress\" "
                      "or \"axisymmetric\"");
    problem.kinematics =
        GENERATE(Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric);
    CHECK_THROWS_WITH(check_kinematics(problem, 3),
                      "a volume is solved as kinematics = \"solid\"; plane and axisymmetric "
                      "kinematics need a part in the plane");
    problem.thickness = 0.0;
    CHECK_THROWS_WITH(check_kinematics(problem, 2), "thickness = 0; must be positive");
    problem.thickness = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(check_kinematics(problem, 2), "thickness = nan; must be positive");
}

TEST_CASE("Problem: load cases are listed as they appear, one unnamed if there is none",
          "[mechanics]") {
    Problem problem;
    CHECK(problem.load_cases() == std::vector<std::string>{""});
    Support support;
    support.load_case = "press fit";
    Pressure pressure;
    pressure.load_case = "pull";
    Temperature heat;
    heat.load_case = "press fit";
    problem.supports = {Support{}, support};
    problem.pressures = {pressure};
    problem.temperatures = {heat};
    CHECK(problem.load_cases() == std::vector<std::string>{"press fit", "pull"});
}
