#include "meshing/layout/cuboid_decomposition.h"

#include <catch2/catch.hpp>

#include "meshing/layout/layout_validity.h"
#include "tests/meshing/layout/cut_parts.h"
#include "tests/meshing/layout/embedding_checks.h"

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

TEST_CASE("cuboid decomposition: a patch without a template is named", "[layout]") {
    const Job job = cut_part("half_seal");
    TemplateLibrary library;
    library.add(make_bar_template("tee", {{0, 0}}, {{{0, 0}}}));
    CHECK_THROWS_WITH(
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, library),
        Catch::Contains("no template fits patch 0") && Catch::Contains("caps: tee."));
}
