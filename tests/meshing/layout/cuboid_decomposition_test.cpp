#include "meshing/layout/cuboid_decomposition.h"

#include <catch2/catch.hpp>

#include "meshing/layout/layout_validity.h"
#include "tests/meshing/layout/cut_parts.h"
#include "tests/meshing/layout/embedding_checks.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("cuboid decomposition: parts with one pant", "[layout]") {
    const auto [name, shape, n_cuboids] = GENERATE(table<std::string, std::string, int>(
        {{"pant", "tee", 4}, {"half_seal", "tee_in_column", 10}}));
    CAPTURE(name);
    const Job job = cut_part(name);
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    CHECK(cuboids.templates == std::vector<std::string>{shape});
    CHECK(cuboids.volume.n_cuboids() == n_cuboids);
    CHECK(cuboids.volume.sets.size() == 3);
    check_embedding(cuboids.mesh, cuboids.surface);
}

TEST_CASE("cuboid decomposition: parts with several", "[layout]") {
    const auto [name, loops, n_cuboids, genus] =
        GENERATE(table<std::string, std::vector<GuideLoop>, int, int>(
            {{"double_t", {}, 8, 0},
             {"seal", {}, 20, 1},
             {"wheel", wheel_loops(), 76, 3},
             {"casting", casting_loops(), 56, 5}}));
    CAPTURE(name);
    const Job job = cut_part(name, loops);
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    CHECK(cuboids.volume.n_cuboids() == n_cuboids);
    CHECK(volume_topology(cuboids.volume).genera == std::vector<int>{genus});
    check_embedding(cuboids.mesh, cuboids.surface);
}

TEST_CASE("cuboid decomposition: a cut through corners follows the sharp edge between them",
          "[layout]") {
    // Other cuts cross sharp edges. At the first corner the cut's points close the way between it
    // and the other cuts, but for edges that are split.
    const Vector3 low(-30.0, 20.0, -20.0);
    const Vector3 high(-30.0, 20.0, 20.0);
    const Job job =
        cut_part("double_t", {}, -0.75,
                 {{low, high, Vector3(-30.0, -20.0, -20.0), Vector3(-30.0, -20.0, 20.0)}});
    const auto cut = std::ranges::find(job.pants.curves, PantsCurveKind::cycle, &PantsCurve::kind);
    REQUIRE(cut != job.pants.curves.end());
    // Around a square of 40, on edges of triangles.
    CHECK(cut->length < 1.1 * 160.0);
    int n_between = 0;
    for (const VertexHandle v : cut->curve.vertices) {
        const Vector3& x = job.opened.point(v);
        const bool is_on_edge = (x - low).head<2>().norm() < 1e-9 && std::abs(x.z()) < 20.0;
        n_between += is_on_edge ? 1 : 0;
    }
    CHECK(n_between >= 5);
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    CHECK(cuboids.volume.n_cuboids() == 8);
    check_embedding(cuboids.mesh, cuboids.surface);
}

TEST_CASE("cuboid decomposition: a patch without a template is named", "[layout]") {
    const Job job = cut_part("half_seal");
    TemplateLibrary library;
    library.add(make_bar_template("tee", {{0, 0}}, {{{0, 0}}}));
    CHECK_THROWS_WITH(
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, library),
        Catch::Contains("no template fits patch 0") && Catch::Contains("caps: tee."));
    CHECK_THROWS_WITH(
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, TemplateLibrary()),
        Catch::Contains("patch 0 with 3 boundary loops") && Catch::Contains("caps: none."));
}

TEST_CASE("cuboid decomposition: a solid with cavities is refused", "[layout]") {
    // A cube in a cube.
    TriangleSoup soup = make_cube(2);
    const auto n = static_cast<int>(soup.points.size());
    const std::size_t n_triangles = soup.triangles.size();
    for (int v = 0; v < n; ++v)
        soup.points.emplace_back(0.25 * (Vector3::Ones() + 2.0 * soup.points[v]));
    for (std::size_t t = 0; t < n_triangles; ++t) {
        const auto [a, b, c] = soup.triangles[t];
        soup.triangles.push_back({a + n, c + n, b + n});
    }
    SurfaceMesh mesh = make_surface_mesh(soup);
    const Features features = detect_features(mesh);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    CHECK_THROWS_WITH(
        decompose_into_cuboids(mesh, features, pants, fill_boundaries(mesh), some_templates()),
        "layout: the surface has 2 shells, so that the solid has a cavity; templates of cuboids "
        "surround none: give a layout of cuboids around them ([meshing] layout, --layout)");
}
