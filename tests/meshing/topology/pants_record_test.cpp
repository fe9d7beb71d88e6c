#include "meshing/topology/pants_record.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/caps.h"
#include "meshing/surface/features.h"
#include "meshing/topology/invariants.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"
#include "tests/meshing/topology/part_members.h"

using namespace couture;
using namespace couture::meshing;
using couture::testing::make_member;
using couture::testing::Member;

namespace {

std::vector<PantsCurveKind> kinds_of(const PantsDecomposition& pants) {
    std::vector<PantsCurveKind> kinds;
    for (const PantsCurve& curve : pants.curves) kinds.push_back(curve.kind);
    return kinds;
}

std::vector<std::vector<CurveSide>> sides_of(const PantsDecomposition& pants) {
    std::vector<std::vector<CurveSide>> sides;
    for (const PantsPatch& patch : pants.patches) sides.push_back(patch.boundary);
    return sides;
}

// All ends of the parameters' ranges one at a time, and both at once.
std::vector<std::map<std::string, double>> star(const std::string& part) {
    std::vector<std::map<std::string, double>> points;
    const auto& parts = part_surfaces();
    const auto info =
        std::find_if(parts.begin(), parts.end(), [&](const PartInfo& p) { return p.name == part; });
    std::map<std::string, double> low;
    std::map<std::string, double> high;
    for (const auto& parameter : info->parameters) {
        points.push_back({{parameter.name, parameter.min}});
        points.push_back({{parameter.name, parameter.max}});
        low[parameter.name] = parameter.min;
        high[parameter.name] = parameter.max;
    }
    points.push_back(low);
    points.push_back(high);
    return points;
}

}  // namespace

TEST_CASE("replay_pants: a family is cut in the same way, each member on its own mesh",
          "[topology][parts]") {
    const std::string part = GENERATE("seal", "wheel", "casting");
    CAPTURE(part);
    const double edge_length = 1.6 * default_edge_length(part);
    Member reference = make_member(part, {}, edge_length, part == "seal");
    const PantsDecomposition pants =
        decompose_into_pants(reference.mesh, {.boundary_names = reference.boundary_names});
    const PantsRecord record = record_pants(reference.mesh, pants, reference.landmarks);
    REQUIRE(static_cast<int>(record.patches.size()) ==
            -compute_invariants(reference.mesh).euler_characteristic);
    for (const auto& parameters : star(part)) {
        CAPTURE(parameters);
        // Another triangulation: nothing may rest on vertex numbers.
        Member member = make_member(part, parameters, 1.1 * edge_length, part == "seal");
        const PantsDecomposition replayed =
            replay_pants(member.mesh, record, member.boundary_names, member.landmarks);
        REQUIRE(kinds_of(replayed) == kinds_of(pants));
        REQUIRE(sides_of(replayed) == sides_of(pants));
        for (std::size_t c = 0; c < pants.curves.size(); ++c) {
            CAPTURE(c);
            // Within the change of dimensions.
            REQUIRE(replayed.curves[c].length < 1.6 * pants.curves[c].length);
            REQUIRE(replayed.curves[c].length > 0.6 * pants.curves[c].length);
        }
    }
}

TEST_CASE("replay_pants: on the member itself the cuts stay where they are", "[topology][parts]") {
    Member reference = make_member("wheel", {}, 2.0 * default_edge_length("wheel"), false);
    const PantsDecomposition pants = decompose_into_pants(reference.mesh);
    const PantsRecord record = record_pants(reference.mesh, pants, reference.landmarks);
    Member again = make_member("wheel", {}, 2.0 * default_edge_length("wheel"), false);
    const PantsDecomposition replayed = replay_pants(again.mesh, record, {}, again.landmarks);
    const double far = 2.0 * default_edge_length("wheel");
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        for (const VertexHandle vertex : replayed.curves[c].curve.vertices) {
            REQUIRE(distance_to_loop(again.mesh.point(vertex), record.curves[c].shape.points) <
                    2.0 * far);
        }
    }
}

TEST_CASE("replay_pants: on the same surface no curve gets longer or shorter",
          "[meshing][topology]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    const std::string file =
        GENERATE("mambo_S3.off", "hexgen_mount1.off", "vampy_atrium.off", "hexgen_joint.off");
    CAPTURE(file);
    const TriangleSoup soup = read_off(*folder / "surfaces" / file);
    SurfaceMesh mesh = make_surface_mesh(soup);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    const PantsRecord record = record_pants(mesh, pants, {});
    SurfaceMesh again = make_surface_mesh(soup);
    const PantsDecomposition replayed = replay_pants(again, record, {}, {});
    REQUIRE(kinds_of(replayed) == kinds_of(pants));
    REQUIRE(sides_of(replayed) == sides_of(pants));
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        CAPTURE(c);
        REQUIRE(replayed.curves[c].length == Approx(pants.curves[c].length).epsilon(1e-9));
    }
}

TEST_CASE("replay_pants: another topology is refused", "[topology][parts]") {
    Member torus = make_member("double_torus", {}, 0.0, false);
    const PantsDecomposition pants = decompose_into_pants(torus.mesh);
    const PantsRecord record = record_pants(torus.mesh, pants, torus.landmarks);
    Member wheel = make_member("wheel", {}, 2.0 * default_edge_length("wheel"), false);
    REQUIRE_THROWS_WITH(replay_pants(wheel.mesh, record, {}, wheel.landmarks),
                        "replay: the surface has genus 3, the recorded one has 2");
    Member open = make_member("seal", {}, 0.0, true);
    const PantsRecord of_seal = record_pants(
        open.mesh, decompose_into_pants(open.mesh, {.boundary_names = open.boundary_names}),
        open.landmarks);
    Member closed = make_member("seal", {}, 0.0, false);
    REQUIRE_THROWS_WITH(replay_pants(closed.mesh, of_seal, {}, closed.landmarks),
                        "replay: the surface has 0 boundary loops, the recorded one has 2: "
                        "cap_x_low, cap_x_high; open the same caps (--open, --open-at, "
                        "--open-facing)");
    Member renamed = make_member("seal", {}, 0.0, true);
    renamed.boundary_names[0] = "elsewhere";
    REQUIRE_THROWS_WITH(
        replay_pants(renamed.mesh, of_seal, renamed.boundary_names, renamed.landmarks),
        Catch::Contains("no boundary loop of the surface is the cap"));
}
