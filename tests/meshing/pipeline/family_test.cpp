#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/polycube_templates.h"
#include "meshing/pipeline/homology.h"
#include "meshing/pipeline/midpoint.h"
#include "meshing/pipeline/solid_mesh.h"
#include "meshing/topology/member_warp.h"
#include "tests/meshing/topology/part_members.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

TemplateLibrary two_templates() {
    TemplateLibrary library;
    const std::vector<SectionCell> quad{{0, 0}};
    library.add(make_polycube_template("cube", {{0, 0, 0}}, {}));
    library.add(make_bar_template("tee", quad, {quad}));
    return library;
}

struct Meshed {
    SolidMesh solid;
    MemberRecord record;
    NamedFeatures features;
    [[nodiscard]] const iga::MultiPatch<3>& volume() const { return solid.volume->volume; }
};

// @param like  nothing: the reference
Meshed mesh_member(const std::string& name, const std::map<std::string, double>& parameters,
                   double edge_length, const std::optional<MemberRecord>& like) {
    const PartSurface part = make_part_surface(name, parameters, edge_length);
    const bool is_open = name == "pant";
    testing::Member member = testing::make_member(name, parameters, edge_length, is_open);
    const Features features = detect_features(member.mesh);
    const ClosingCaps caps = fill_boundaries(member.mesh);
    PantsOptions named;
    named.boundary_names = member.boundary_names;
    const PantsDecomposition pants =
        like ? replay_pants(member.mesh, like->pants, member.boundary_names, member.landmarks)
             : decompose_into_pants(member.mesh, named);
    SolidMeshOptions options;
    NamedFaces faces{part.soup, part.face_of_triangle, {}};
    for (const PartFace& face : part.faces) faces.names.push_back(face.name);
    options.faces = faces;
    const auto cuboids = [&] {
        if (!like)
            return decompose_into_cuboids(member.mesh, features, pants, caps, two_templates());
        const MemberWarp warp(like->pants, member.mesh, member.landmarks);
        return repeat_cuboids(member.mesh, features, pants, caps, two_templates(),
                              carry_over(*like->layout, warp));
    };
    Meshed result;
    result.solid = mesh_solid(cuboids(), options);
    result.record.pants = record_pants(member.mesh, pants, member.landmarks);
    result.record.layout = result.solid.cuboids.record;
    result.features = named_features(part);
    return result;
}

std::vector<int> corner_of_each(const SolidMesh& solid) {
    return solid.cuboids.record.patches[0].match.nodes;
}

}  // namespace

TEST_CASE("family: members that are triangulated anew have one signature and are homologous",
          "[pipeline]") {
    const auto [name, parameters] = GENERATE(table<std::string, std::map<std::string, double>>(
        {{"cube", {}}, {"pant", {{"X1", 20.0}, {"Z2", -25.0}}}}));
    CAPTURE(name);
    const double edge_length = default_edge_length(name);
    const Meshed reference = mesh_member(name, {}, 2.0 * edge_length, {});
    const Meshed member = mesh_member(name, parameters, 1.5 * edge_length, reference.record);
    CHECK(member.solid.cuboids.mesh.n_vertices() != reference.solid.cuboids.mesh.n_vertices());
    CHECK(iga::signature(member.volume()) == iga::signature(reference.volume()));
    CHECK(certified(midpoint(reference.volume(), member.volume())) == iga::Validity::valid);
    const FeatureImages images = find_feature_images(reference.volume(), reference.features);
    const HomologyReport report = measure_homology(member.volume(), member.features, images);
    CHECK(report.points_per_curve == 200);
    CHECK(report.n_corners == (name == "cube" ? 8 : 16));
    // Corners are interpolated, edges fitted.
    CHECK(report.max_corner_distance < 1e-12);
    CHECK(report.max_curve_distance < 5e-4);
    CHECK(report.is_homologous());
    // Every face of the part is a set, and every outer side is in one.
    std::size_t n_sides = 0;
    for (const auto& [set, sides] : member.volume().boundary_sets) n_sides += sides.size();
    CHECK(n_sides == member.volume().outer_sides().size());
}

TEST_CASE("family: a layout that is turned is not homologous", "[pipeline]") {
    const Meshed reference = mesh_member("cube", {}, 0.0, {});
    MemberRecord turned = reference.record;
    // Half a turn about z: x and y change their ends.
    TemplateMatch& match = turned.layout->patches[0].match;
    for (int& node : match.nodes) node ^= 3;
    for (auto& curve : match.curves) {
        for (int& node : curve) node ^= 3;
    }
    const Meshed member = mesh_member("cube", {}, 0.0, turned);
    REQUIRE(corner_of_each(member.solid) != corner_of_each(reference.solid));
    // The connectivity says nothing of it.
    CHECK(iga::signature(member.volume()) == iga::signature(reference.volume()));
    CHECK(member.solid.volume->report.parameterization.validity == iga::Validity::valid);
    const FeatureImages images = find_feature_images(reference.volume(), reference.features);
    const HomologyReport report = measure_homology(member.volume(), member.features, images);
    CHECK_FALSE(report.is_homologous());
    // The diagonal of a face over that of the cube.
    CHECK(report.max_corner_distance == Approx(std::sqrt(2.0 / 3.0)));
    CHECK(certified(midpoint(reference.volume(), member.volume())) != iga::Validity::valid);
}

TEST_CASE("family: what does not match is refused", "[pipeline]") {
    const Meshed reference = mesh_member("cube", {}, 0.0, {});
    MemberRecord other = reference.record;
    other.layout->patches[0].features.curves[3].kind = ArcKind::reflex;
    CHECK_THROWS_WITH(mesh_member("cube", {}, 0.0, other),
                      Contains("layout: patch 0: features don't match the reference"));
    other = reference.record;
    other.layout->sets["low"] = {{7, 0}};
    CHECK_THROWS_WITH(mesh_member("cube", {}, 0.0, other),
                      Contains("side 0 of cuboid 7 is in the recorded set 'low'"));
    other = reference.record;
    other.layout->elements.pop_back();
    CHECK_THROWS_WITH(mesh_member("cube", {}, 0.0, other),
                      Contains("were recorded, but there are"));
    other = reference.record;
    other.layout->patches[0].shape = "cub";
    CHECK_THROWS_AS(mesh_member("cube", {}, 0.0, other), InputError);
    other = reference.record;
    other.layout->patches[0].match.curves[0][1] = 7 - other.layout->patches[0].match.curves[0][0];
    CHECK_THROWS_WITH(mesh_member("cube", {}, 0.0, other), Contains("template 'cube' lacks"));
    other = reference.record;
    other.layout->elements[0] += 1;
    const Meshed finer = mesh_member("cube", {}, 0.0, other);
    CHECK_THROWS_WITH(midpoint(reference.volume(), finer.volume()), Contains("differ"));
}
