#include "io/picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/scene.h"
#include "tests/iga/topology/test_patches.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::iga;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

/// False, with a message, where pictures can't be made; on CI that is a failure.
bool can_draw() {
    const auto missing = missing_for_pictures();
    if (!missing) {
        return true;
    }
    if (std::getenv("CI") != nullptr) {
        FAIL(*missing);
    }
    WARN("skipped: " << *missing);
    return false;
}

Space<3> make_box_space() {
    MultiPatch<3> geometry;
    geometry.patches = {make_unit_box<3>(2, 2), make_unit_box<3>(2, 2, Vector3::UnitX())};
    geometry.interfaces = {{0, 1, 1, 0, SideMap<3>::identity()}};
    return Space<3>(geometry);
}

}  // namespace

TEST_CASE("render_png: the picture has its size, shows something, and comes out alike twice",
          "[io]") {
    if (!can_draw()) {
        return;
    }
    const Space<3> space = make_box_space();
    SceneOptions options;
    options.values = VectorX::LinSpaced(space.n_dofs(), 0.0, 100.0);
    options.legend = "stress [MPa]";
    Scene scene = make_scene<3>(space, options);
    scene.width = 320;
    scene.height = 240;
    const TemporaryFolder folder;
    render_png(folder / "a.png", scene);
    render_png(folder / "b.png", scene);
    CHECK(read_text(folder / "a.png") == read_text(folder / "b.png"));

    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((folder / "a.png").c_str());
    reader->Update();
    vtkImageData& image = *reader->GetOutput();
    REQUIRE(image.GetDimensions()[0] == 320);
    REQUIRE(image.GetDimensions()[1] == 240);
    int n_colored = 0;
    for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 320; ++x) {
            n_colored += image.GetScalarComponentAsDouble(x, y, 0, 0) < 250.0 ? 1 : 0;
        }
    }
    // The boxes fill roughly a third of the picture, its corner is background.
    CHECK(n_colored > 320 * 240 / 8);
    CHECK(n_colored < 320 * 240 * 3 / 4);
    CHECK(image.GetScalarComponentAsDouble(319, 239, 0, 0) == 255.0);
}

TEST_CASE("render_png: several scenes in rows, each in its frame and centred", "[io]") {
    if (!can_draw()) {
        return;
    }
    // A black square [0, 1]^2 that fills the middle half of a frame of 2 x 2.
    Scene scene;
    SurfacePiece piece;
    piece.vertices.resize(4, 3);
    piece.vertices << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
    piece.triangles.resize(2, 3);
    piece.triangles << 0, 1, 2, 0, 2, 3;
    piece.color = {0.0, 0.0, 0.0};
    scene.surfaces = {piece};
    scene.view_direction = -Vector3::UnitZ();
    scene.up = Vector3::UnitY();
    scene.show_axes = false;
    scene.frame = {{0.5, 0.5}, 2.0};
    scene.width = 40;
    scene.height = 40;
    Scene small = scene;
    small.width = 20;
    small.height = 20;
    const TemporaryFolder folder;
    render_png(folder / "a.png", {{scene, small}, {small}});
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((folder / "a.png").c_str());
    reader->Update();
    vtkImageData& image = *reader->GetOutput();
    REQUIRE(image.GetDimensions()[0] == 60);
    REQUIRE(image.GetDimensions()[1] == 60);
    const auto is_dark = [&](int x, int y_from_top) {
        return image.GetScalarComponentAsDouble(x, 59 - y_from_top, 0, 0) < 128.0;
    };
    // First row: [10, 30) x [10, 30); [45, 55) x [15, 25). Second: [25, 35) x [45, 55).
    CHECK(is_dark(12, 12));
    CHECK(is_dark(27, 27));
    CHECK_FALSE(is_dark(7, 20));
    CHECK_FALSE(is_dark(20, 33));
    CHECK(is_dark(46, 16));
    CHECK_FALSE(is_dark(50, 12));
    CHECK(is_dark(26, 46));
    CHECK(is_dark(33, 53));
    CHECK_FALSE(is_dark(20, 50));
}

TEST_CASE("view_axes: to the right, upwards, towards the viewer", "[io]") {
    Scene scene;
    scene.view_direction = 2.0 * Vector3::UnitY();
    Matrix<3> expected;
    expected << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    CHECK(view_axes(scene) == expected);
}

TEST_CASE("render_png: wrong scenes are named and leave no file", "[io]") {
    const TemporaryFolder folder;
    Scene scene;
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene), Contains("nothing to show"));
    SurfacePiece piece;
    piece.vertices = MatrixX::Identity(3, 3);
    piece.triangles = Eigen::RowVector3i(0, 1, 3);
    scene.surfaces = {piece};
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene),
                      "render_png: the triangles of surface 0 are m x 3 with vertices 0 to 3; "
                      "expected m x 3 and 0 to 2");
    scene.surfaces[0].triangles = Eigen::RowVector3i(0, 1, 2);
    scene.surfaces[0].values = VectorX::Zero(2);
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene),
                      "render_png: surface 0 has 2 values for 3 vertices");
    scene.surfaces[0].values.resize(0);
    scene.up = scene.view_direction;
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene), Contains("must be independent"));
    scene.up = Vector3::UnitZ();
    scene.width = 9000;
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene),
                      "render_png: size 9000 x 900; each must be from 16 to 8192 pixels");
    scene.width = 100;
    scene.curves.resize(1);
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene), Contains("the points of curve 0"));
    scene.curves.clear();
    scene.frame = {{0.0, 1.0}, -2.0};
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene),
                      "render_png: the frame has its centre at (0, 1) and is -2 high; the centre "
                      "must be finite and the height positive");
    scene.frame.reset();
    scene.text_scale = 0.0;
    CHECK_THROWS_WITH(render_png(folder / "a.png", scene),
                      "render_png: text_scale = 0; must be positive and below 100");
    CHECK_THROWS_WITH(render_png(folder / "a.png", {{scene}}), Contains("text_scale = 0"));
    CHECK_THROWS_WITH(render_png(folder / "a.png", std::vector<std::vector<Scene>>(2)),
                      "render_png: 2 rows without a scene; nothing to show");
    CHECK(folder.is_empty());
}

TEST_CASE("round_ticks: round numbers within the range", "[io]") {
    CHECK(round_ticks(-90.8, 224.1) == std::vector<double>{0.0, 100.0, 200.0});
    CHECK(round_ticks(0.0, 1.0).front() == 0.0);
    CHECK(round_ticks(0.0, 1.0).back() == Approx(1.0));
    CHECK(round_ticks(3.0, 3.0) == std::vector<double>{3.0});
}

TEST_CASE("make_scene: outer sides and their edges, displaced", "[io]") {
    const Space<3> space = make_box_space();
    SceneOptions options;
    options.samples = 1;
    options.displacement = MatrixX::Ones(space.n_dofs(), 3);
    options.displacement_scale = 2.0;
    const Scene scene = make_scene<3>(space, options);
    constexpr int n_sides_seen = 10;
    REQUIRE(scene.surfaces.size() == n_sides_seen);
    CHECK(scene.curves.size() == 4 * n_sides_seen);
    for (const SurfacePiece& piece : scene.surfaces) {
        CHECK(piece.triangles.rows() == 2 * 2 * 2);
        CHECK(piece.vertices.minCoeff() >= 2.0 - 1e-12);
        CHECK(piece.vertices.maxCoeff() <= 4.0 + 1e-12);
    }
    options.displacement = MatrixX::Ones(2, 3);
    CHECK_THROWS_WITH(make_scene<3>(space, options), Contains("the displacement is 2 x 3"));
    options.displacement.resize(0, 0);
    options.values = VectorX::Ones(3);
    CHECK_THROWS_WITH(make_scene<3>(space, options), Contains("3 values; the space has"));
    options.values.resize(0);
    options.samples = -1;
    CHECK_THROWS_WITH(make_scene<3>(space, options), Contains("samples = -1"));
}
