#include "iga/topology/space.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Two unit squares side by side.
MultiPatch<2> two_squares(int degree, int n_elements) {
    return {
        {make_unit_box<2>(degree, n_elements), make_unit_box<2>(degree, n_elements, {1.0, 0.0})},
        {{0, 1, 1, 0, SideMap<2>::identity()}},
        {}};
}

/// Quarter annulus from radius 1 to 2: direction 0 radial, direction 1 circumferential.
Patch<2> annulus() {
    MatrixX points(6, 2);
    points << 1, 0, 2, 0, 1, 1, 2, 2, 0, 1, 0, 2;
    VectorX weights(6);
    weights << 1, 1, std::sqrt(0.5), std::sqrt(0.5), 1, 1;
    return {{{KnotVector::uniform(1, 1), KnotVector::uniform(2, 1)}}, points, weights};
}

}  // namespace

TEST_CASE("Space: the geometry's own functions are isoparametric", "[topology]") {
    const Space<2> space(two_squares(2, 2));
    CHECK(space.is_isoparametric());
    CHECK(space.n_dofs() == 2 * 16 - 4);
    CHECK(space.dofs_on(make_side<2>(0, 1)) == space.dofs_on(make_side<2>(1, 0)));
    CHECK(space.dofs_on({1, {End::high, End::high}}) == std::vector<int>{27});
    CHECK_THROWS_WITH(space.dofs_on(make_side<2>(2, 0)),
                      "Space: patch 2 does not exist; there are 2");
}

TEST_CASE("Space: functions are rational where they contain the geometry's", "[topology]") {
    const MultiPatch<2> geometry{{annulus()}, {}, {}};
    const KnotVector fine = KnotVector::uniform(3, 4);

    const Space<2> finer(geometry, {{{fine, fine}}});
    CHECK_FALSE(finer.is_isoparametric());
    REQUIRE(finer.weights(0).size() == fine.n_basis() * fine.n_basis());
    // The weight function is the geometry's.
    const Vector<2> xi(0.3, 0.7);
    const auto weight_at = [&](const TensorSpace<2>& tensor, const VectorX& weights) {
        const PointBasis<2> basis = evaluate_basis(tensor, {}, xi);
        double sum = 0.0;
        for (std::size_t i = 0; i < basis.functions.size(); ++i) {
            sum += basis.values[i] * weights[basis.functions[i]];
        }
        return sum;
    };
    CHECK(weight_at(finer.tensor(0), finer.weights(0)) ==
          Approx(weight_at(annulus().space(), annulus().weights())).epsilon(1e-14));

    const KnotVector linear = KnotVector::uniform(1, 4);
    const Space<2> lower(geometry, {{{linear, linear}}});
    CHECK(lower.weights(0).size() == 0);
    CHECK(lower.n_dofs() == 25);
}

TEST_CASE("Space: a neighbour without rational functions makes both polynomial", "[topology]") {
    // Two annuli around each other share an arc; the outer one is cubic across it.
    MatrixX points(12, 2);
    points << 2, 0, 2.5, 0, 3, 0, 4, 0, 2, 2, 2.5, 2.5, 3, 3, 4, 4, 0, 2, 0, 2.5, 0, 3, 0, 4;
    VectorX weights(12);
    weights << 1, 1, 1, 1, VectorX::Constant(4, std::sqrt(0.5)), 1, 1, 1, 1;
    const Patch<2> outer({{KnotVector::uniform(3, 1), KnotVector::uniform(2, 1)}}, points, weights);
    const MultiPatch<2> geometry{{annulus(), outer}, {{0, 1, 1, 0, SideMap<2>::identity()}}, {}};
    check(geometry);
    const KnotVector quadratic = KnotVector::uniform(2, 2);
    const Space<2> space(geometry, {{{quadratic, quadratic}}, {{quadratic, quadratic}}});
    CHECK(space.weights(0).size() == 0);
    CHECK(space.weights(1).size() == 0);
    const Space<2> own(geometry);
    CHECK(own.weights(0).size() == 6);
    CHECK(own.weights(1).size() == 12);
}

TEST_CASE("Space: breakpoints of the geometry must be kept", "[topology]") {
    const MultiPatch<2> geometry = two_squares(1, 2);
    const KnotVector good = KnotVector::uniform(2, 2);
    const KnotVector bad = KnotVector::uniform(2, 3);
    CHECK_THROWS_WITH(Space<2>(geometry, {{{good, good}}, {{bad, good}}}),
                      "Space: patch 1 direction 0: the geometry's breakpoint 0.5 is not among the "
                      "functions'; add it as a knot");
    const KnotVector longer = KnotVector::uniform(2, 4, 0.0, 2.0);
    CHECK_THROWS_WITH(Space<2>(geometry, {{{good, longer}}, {{good, good}}}),
                      "Space: patch 0 direction 1: functions live on [0, 2], the geometry on [0, "
                      "1]; the intervals must be equal");
    CHECK_THROWS_WITH(Space<2>(geometry, {{{good, good}}}),
                      "Space: 1 tensor spaces for 2 patches; each patch takes one");
    CHECK_THROWS_AS(Space<2>(geometry, {{{good, good}}, {{good, KnotVector::uniform(3, 2)}}}),
                    TopologyError);
}
