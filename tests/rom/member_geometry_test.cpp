#include "rom/member_geometry.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

namespace {

iga::MultiPatch<3> box(double width) {
    VectorX point = BoxFamily::parameters().centre();
    point[BoxFamily::width] = width;
    return BoxFamily::geometry(point);
}

}  // namespace

TEST_CASE("to_member: gives back what to_field took", "[rom]") {
    const iga::Space<3> reference(box(10.0));
    const iga::MultiPatch<3> member = box(12.0);
    const VectorX field = to_field(reference, member);
    REQUIRE(field.size() == 3 * reference.n_dofs());
    const iga::MultiPatch<3> again = to_member(reference, field);
    CHECK(iga::signature(again) == iga::signature(member));
    for (int p = 0; p < 2; ++p) {
        CHECK((again.patches[p].control_points() - member.patches[p].control_points()).norm() <
              1e-13);
    }
}

TEST_CASE("to_field: refuses strangers", "[rom]") {
    const iga::Space<3> reference(box(10.0));
    iga::MultiPatch<3> renamed = box(10.0);
    renamed.boundary_sets.erase("tip");
    CHECK_THROWS_WITH(to_field(reference, renamed), Contains("its signature is"));
    iga::MultiPatch<3> rational = box(10.0);
    const iga::Patch<3>& patch = rational.patches[1];
    VectorX weights = VectorX::Ones(patch.space().n_basis());
    weights[3] = 0.5;
    rational.patches[1] = iga::Patch<3>(patch.space(), patch.control_points(), weights);
    CHECK_THROWS_WITH(to_field(reference, rational), Contains("patch 1 is rational"));
    CHECK_THROWS_WITH(to_field(iga::Space<3>(rational), box(10.0)),
                      Contains("patch 1 is not rational"));
    CHECK_THROWS_WITH(to_member(reference, VectorX::Zero(5)), Contains("5 numbers"));
    const iga::KnotVector knots = iga::KnotVector::uniform(1, 2);
    const iga::Space<3> other(box(10.0),
                              std::vector<iga::TensorSpace<3>>(2, {{knots, knots, knots}}));
    CHECK_THROWS_WITH(to_field(other, box(10.0)), Contains("not those of its geometry"));
}
