#include "meshing/topology/n_pants.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/topology/invariants.h"
#include "tests/meshing/topology/part_members.h"

using namespace couture;
using namespace couture::meshing;
using couture::testing::make_member;
using couture::testing::Member;

TEST_CASE("merge_pants: patches keep their Euler characteristics and stay within the limit",
          "[topology][parts]") {
    Member member = make_member("sierpinski", {}, 2.0 * default_edge_length("sierpinski"), false);
    const int chi = compute_invariants(member.mesh).euler_characteristic;
    PantsOptions options;
    options.most_boundaries = GENERATE(3, 4, 5, 6);
    options.merge_ratio = GENERATE(1e-3, 1.0, 1e3);
    CAPTURE(options.most_boundaries, options.merge_ratio);
    const PantsDecomposition pants = decompose_into_pants(member.mesh, options);
    int sum = 0;
    for (const PantsPatch& patch : pants.patches) {
        REQUIRE(patch.genus == 0);
        REQUIRE(static_cast<int>(patch.boundary.size()) <= options.most_boundaries);
        sum += patch.euler_characteristic();
    }
    REQUIRE(sum == chi);
    if (options.merge_ratio < 0.01 || options.most_boundaries == 3) {
        REQUIRE(static_cast<int>(pants.patches.size()) == -chi);
    } else if (options.merge_ratio > 100.0) {
        REQUIRE(static_cast<int>(pants.patches.size()) < -chi);
    }
    // The curves on the mesh are those that are left, by their numbers.
    std::vector<int> n_edges(pants.curves.size(), 0);
    for (const auto edge : member.mesh.edges()) {
        const int number = member.mesh.data(edge).curve;
        if (number >= 0) ++n_edges.at(number);
    }
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        REQUIRE(n_edges[c] == static_cast<int>(pants.curves[c].curve.vertices.size()));
    }
    const auto region = regions_between_curves(member.mesh);
    for (const auto face : member.mesh.faces()) {
        const auto other = member.mesh.face_handle(
            member.mesh.opposite_halfedge_handle(*member.mesh.cfh_begin(face)));
        const bool same = region[face.idx()] == region[other.idx()];
        REQUIRE(same == (pants.patch_of_face[face.idx()] == pants.patch_of_face[other.idx()]));
    }
}

TEST_CASE("measure_tube: a long tube between two junctions is long, whatever its mesh",
          "[topology][parts]") {
    // Double T: a bar with two cross-bars; opened at the four ends of these.
    Member member = make_member("double_t", {}, 0.0, true);
    const PantsDecomposition pants = decompose_into_pants(member.mesh);
    int n_cuts = 0;
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        if (pants.curves[c].kind == PantsCurveKind::boundary) {
            REQUIRE_THROWS_AS(measure_tube(member.mesh, pants, static_cast<int>(c)), InputError);
            continue;
        }
        const Tube tube = measure_tube(member.mesh, pants, static_cast<int>(c));
        REQUIRE(tube.length > 0.0);
        REQUIRE(tube.diameter > 0.0);
        ++n_cuts;
    }
    REQUIRE(n_cuts > 0);
    REQUIRE_THROWS_AS(measure_tube(member.mesh, pants, 1000), InputError);
}
