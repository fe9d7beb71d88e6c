#include "io/pants_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/template_file.h"
#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/parts/part_landmarks.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

TEST_CASE("pants record: what is written is read again, to the last bit", "[io]") {
    const PartSurface part = make_part_surface("plate_with_two_holes", {}, 8.0);
    SurfaceMesh mesh = make_surface_mesh(part.soup);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    const PantsRecord record = record_pants(mesh, pants, part_landmarks(part));
    REQUIRE_FALSE(record.landmarks.corners.empty());
    const io::TemporaryFolder folder;
    const auto path = folder / "pants.json";
    io::write_pants_record(path, record, "here");
    const PantsRecord again = io::read_member_record(path).pants;
    REQUIRE(again.shells.size() == 1);
    CHECK(again.shells[0].genus == 2);
    CHECK(again.shells[0].center == record.shells[0].center);
    CHECK(again.shell_of_patch == record.shell_of_patch);
    CHECK(again.box_min == record.box_min);
    CHECK(again.box_max == record.box_max);
    CHECK(again.landmarks.corners == record.landmarks.corners);
    CHECK(again.landmarks.curves == record.landmarks.curves);
    CHECK(again.landmarks.closed_curves == record.landmarks.closed_curves);
    CHECK(again.patches == record.patches);
    REQUIRE(again.curves.size() == record.curves.size());
    for (std::size_t c = 0; c < record.curves.size(); ++c) {
        CHECK(again.curves[c].kind == record.curves[c].kind);
        CHECK(again.curves[c].name == record.curves[c].name);
        CHECK(again.curves[c].shape.points == record.curves[c].shape.points);
        CHECK(again.curves[c].shape.normals == record.curves[c].shape.normals);
    }
}

TEST_CASE("pants record: files that hold something else are refused", "[io]") {
    const io::TemporaryFolder folder;
    const auto path = folder / "pants.json";
    const auto refused = [&](const std::string& text, const std::string& message) {
        io::write_text(path, text);
        CAPTURE(text);
        CHECK_THROWS_WITH(io::read_member_record(path),
                          Contains("pants.json: ") && Contains(message));
    };
    refused("", "no JSON from byte");
    refused("[1, 2]", "the file is array, expected an object");
    refused("{}", "format is missing; take the NAME_pants.json");
    refused(R"({"format": "couture pants 0"})", "format is 'couture pants 0', expected");
    const auto head = [](const std::string& box) {
        return R"({"format": "couture pants 2", "box": )" + box +
               R"(, "shells": [{"genus": 0, "center": [0, 0, 0]}], "corners": {}, )"
               R"("feature_curves": {}, )";
    };
    refused(head("[[0,0,0],[0,0,0]]") + R"("curves": []})", "box has size 0 x 0 x 0");
    refused(head("[[0,0,0],[1,-1,1]]") + R"("curves": []})", "box has size 1 x -1 x 1");
    const std::string good = head("[[0,0,0],[1,1,1]]");
    refused(good + R"("curves": 3})", "curves is number, expected a list");
    refused(good + R"("curves": [], "patches": [{"shell": 0, "boundary": [{"curve": 3, )"
                   R"("left": true}]}]})",
            "patches[0].boundary[0].curve = 3; it must be below 0");
    refused(good + R"("curves": [{"kind": "x", "name": "", "points": [], "normals": []}]})",
            "curves[0].kind: 'x' is no kind of curve");
    refused(good + R"("curves": [{"kind": "cycle", "name": "", "points": [[0, 1]], )"
                   R"("normals": []}]})",
            "curves[0].points[0] has 2 numbers");
    refused(good + R"("curves": [{"kind": "cycle", "name": "", "points": [], "normals": []}]})",
            "curves[0] has 0 points");
    CHECK_THROWS_AS(io::read_member_record(folder / "no.json"), FileError);
}

TEST_CASE("layout record: what is written is read again", "[io]") {
    const PartSurface part = make_part_surface("cube");
    SurfaceMesh mesh = make_surface_mesh(part.soup);
    const Features features = detect_features(mesh);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    const PantsRecord cuts = record_pants(mesh, pants, part_landmarks(part));
    LayoutRecord record = decompose_into_cuboids(mesh, features, pants, fill_boundaries(mesh),
                                                 io::built_in_templates())
                              .record;
    record.elements = {3, 4, 5};
    record.base_elements = {3, 2, 5};
    record.area_part = 0.25;
    record.rotations = {{2, 1}};
    record.starts = {{3, {0.1, -2.0, 1e-30}}};
    record.sets = {{"low", {{0, 2}, {0, 4}}}};
    const io::TemporaryFolder folder;
    const auto path = folder / "layout.json";
    io::write_layout_record(path, cuts, record, "here");
    const MemberRecord again = io::read_member_record(path);
    CHECK(again.pants.landmarks.corners == cuts.landmarks.corners);
    REQUIRE(again.layout);
    CHECK(again.layout->elements == record.elements);
    CHECK(again.layout->base_elements == record.base_elements);
    CHECK(again.layout->area_part == record.area_part);
    CHECK(again.layout->rotations == record.rotations);
    CHECK(again.layout->starts == record.starts);
    CHECK(again.layout->sets == record.sets);
    REQUIRE(again.layout->patches.size() == 1);
    const LayoutRecord::Patch& first = record.patches[0];
    const LayoutRecord::Patch& second = again.layout->patches[0];
    CHECK(second.shape == first.shape);
    CHECK(second.match.nodes == first.match.nodes);
    CHECK(second.match.curves == first.match.curves);
    REQUIRE(second.features.nodes.size() == 8);
    REQUIRE(second.features.curves.size() == 12);
    for (std::size_t n = 0; n < 8; ++n) {
        CHECK(second.features.nodes[n].place == first.features.nodes[n].place);
        CHECK(second.features.nodes[n].curve_ends == first.features.nodes[n].curve_ends);
        CHECK(second.features.nodes[n].loop == -1);
    }
    for (std::size_t c = 0; c < 12; ++c) {
        CHECK(second.features.curves[c].middle == first.features.curves[c].middle);
        CHECK(second.features.curves[c].kind == ArcKind::convex);
    }
    io::write_pants_record(path, cuts, "here");
    CHECK_FALSE(io::read_member_record(path).layout);
    record.area_part = 1.5;
    io::write_layout_record(path, cuts, record, "here");
    CHECK_THROWS_WITH(io::read_member_record(path),
                      Contains("layout.area_part = 1.5; it must lie in [0, 1]"));
    record.area_part = 0.5;
    record.patches[0].match.nodes.pop_back();
    io::write_layout_record(path, cuts, record, "here");
    CHECK_THROWS_WITH(io::read_member_record(path),
                      Contains("layout.patches[0]: nodes of 0 loops, 7 corners and 12 curves"));
    // It does not say how nodes were placed.
    std::string old = io::read_text(path);
    old.replace(old.find("couture layout 3"), 16, "couture layout 2");
    io::write_text(path, old);
    CHECK_THROWS_WITH(io::read_member_record(path),
                      Contains("format is 'couture layout 2', expected 'couture pants 2' or "
                               "'couture layout 3'; take the NAME_pants.json") &&
                          Contains("or write it again by meshing that member"));
}
