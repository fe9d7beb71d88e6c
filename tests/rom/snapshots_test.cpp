#include "rom/snapshots.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

TEST_CASE("SnapshotSet: the design is that of the sampled parameters, mechanics fastest", "[rom]") {
    const SnapshotSet set = BoxFamily::snapshots(2);
    CHECK_NOTHROW(check(set));
    CHECK(set.n_nodes() == 7 * 4 * 4);
    CHECK(set.n_geometries() == 4);
    CHECK(set.n_mechanics() == 4);
    CHECK(set.design().sizes() == std::vector<int>{4, 2, 2});
    CHECK(sampled_parameters(set.parameters, set.factor_power, ParameterGroup::load) ==
          std::vector<int>{BoxFamily::lift});
    CHECK(sampled_parameters(set.parameters, set.factor_power, ParameterGroup::material) ==
          std::vector<int>{BoxFamily::poissons_ratio});
}

TEST_CASE("SnapshotSet: refused columns are NaN throughout", "[rom]") {
    SnapshotSet set = BoxFamily::snapshots(2);
    BoxFamily::refuse(set.displacements, 5);
    CHECK_NOTHROW(check(set));
    CHECK(accepted_columns(set.displacements).size() == 15);
    BoxFamily::refuse(set.control_points, 2);
    CHECK_THROWS_WITH(check(set),
                      Contains("displacement 8 was solved on geometry 2, which was refused"));
    for (int m = 0; m < 4; ++m) {
        BoxFamily::refuse(set.displacements, 8 + m);
    }
    CHECK_NOTHROW(check(set));
    set.displacements(17, 0) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(check(set), Contains("column 0 of the displacements"));
}

TEST_CASE("SnapshotSet: what breaks a rule is named", "[rom]") {
    SnapshotSet set = BoxFamily::snapshots(2);
    SECTION("powers") {
        set.factor_power = {0, 0, 1};
        CHECK_THROWS_WITH(check(set), Contains("3 powers and 6 reference values for 6 parameters"));
    }
    SECTION("a power of a geometry parameter") {
        set.factor_power[BoxFamily::taper] = 1;
        CHECK_THROWS_WITH(check(set), Contains("geometry parameter 'taper' has the power 1"));
    }
    SECTION("a square") {
        set.factor_power[BoxFamily::force] = 2;
        CHECK_THROWS_WITH(check(set), Contains("power 2 of parameter 'force'"));
    }
    SECTION("a factored load that is 0 at the reference") {
        set.reference_point[BoxFamily::force] = 0.0;
        CHECK_THROWS_WITH(check(set), Contains("factored parameter 'force' is 0 at the reference"));
    }
    SECTION("points outside the cube") {
        set.geometry_points(3, 1) = 1.5;
        CHECK_THROWS_WITH(check(set), Contains("coordinate 1 of point 3 for geometries is 1.5"));
    }
    SECTION("a design too few") {
        set.mechanics_factors.pop_back();
        CHECK_THROWS_WITH(check(set), Contains("no design for materials"));
    }
    SECTION("a design too many") {
        set.mechanics_factors.push_back(full_design(1, 1));
        CHECK_THROWS_WITH(check(set), Contains("3 designs of loads and materials; expected 2"));
    }
    SECTION("another number of fields") {
        set.displacements = MatrixX(set.displacements.leftCols(15));
        CHECK_THROWS_WITH(check(set), Contains("displacements are 336 x 15; expected 336 x 16"));
    }
    SECTION("nothing left") {
        set.displacements.setConstant(std::numeric_limits<double>::quiet_NaN());
        CHECK_THROWS_WITH(check(set), Contains("all 16 columns of the displacements were refused"));
    }
}
