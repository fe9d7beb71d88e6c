#include "meshing/layout/embed_layout.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/volumetric_layout.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/features.h"
#include "tests/meshing/layout/embedding_checks.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// Blocks of n^3 cuboids in a cube.
VolumetricLayout block(int n) {
    VolumetricLayout layout;
    const int m = n + 1;
    layout.n_nodes = m * m * m;
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                std::array<int, 8> nodes{};
                for (int c = 0; c < 8; ++c) {
                    nodes[c] = (i + (c & 1)) + m * ((j + (c >> 1 & 1)) + m * (k + (c >> 2 & 1)));
                }
                layout.cuboids.push_back(nodes);
            }
        }
    }
    return layout;
}

struct Cube {
    SurfaceMesh mesh;
    std::vector<LayoutTie> ties;
};

// The cube with its twelve edges tied to those of a block.
Cube tied_cube(int n) {
    const PartSurface part = make_part_surface("cube");
    Cube cube;
    cube.mesh = make_surface_mesh(part.soup);
    const Features features = detect_features(cube.mesh);
    Vector3 low = Vector3::Constant(1e300);
    Vector3 high = -low;
    for (const Vector3& x : part.soup.points) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const auto grid = [&](const Vector3& x) {
        std::array<int, 3> index{};
        for (int d = 0; d < 3; ++d) {
            index[d] = static_cast<int>(std::lround(n * (x[d] - low[d]) / (high[d] - low[d])));
        }
        return index;
    };
    for (const FeatureCurve& curve : features.curves) {
        LayoutTie tie{curve.vertices, {}, true, false, "edge"};
        const std::array<int, 3> from = grid(cube.mesh.point(curve.vertices.front()));
        const std::array<int, 3> to = grid(cube.mesh.point(curve.vertices.back()));
        for (int k = 0; k <= n; ++k) {
            std::array<int, 3> at{};
            for (int d = 0; d < 3; ++d) at[d] = from[d] + (to[d] - from[d]) * k / n;
            tie.nodes.push_back(at[0] + (n + 1) * (at[1] + (n + 1) * at[2]));
        }
        cube.ties.push_back(std::move(tie));
    }
    return cube;
}

}  // namespace

TEST_CASE("embed layout: blocks in a cube", "[layout]") {
    const int n = GENERATE(1, 2, 3, 5);
    Cube cube = tied_cube(n);
    const LayoutBoundary boundary = layout_boundary(block(n));
    const EmbeddedLayout embedded = embed_layout(cube.mesh, boundary.layout, cube.ties);
    check_embedding(cube.mesh, embedded);
    for (const auto& [a, b] : {std::pair{0, n}, std::pair{n * (n + 1), (n + 1) * (n + 1) - 1}}) {
        CHECK((cube.mesh.point(embedded.nodes[a]) - cube.mesh.point(embedded.nodes[b])).norm() > 0);
    }
}

TEST_CASE("embed layout: ties that don't fit are refused", "[layout]") {
    const LayoutBoundary boundary = layout_boundary(block(2));
    {
        Cube cube = tied_cube(2);
        std::swap(cube.ties[0].nodes.front(), cube.ties[0].nodes.back());
        CHECK_THROWS_WITH(embed_layout(cube.mesh, boundary.layout, cube.ties),
                          Catch::Contains("would lie at vertices"));
    }
    {
        Cube cube = tied_cube(2);
        cube.ties[3].nodes = {cube.ties[3].nodes.front(), cube.ties[3].nodes.back()};
        CHECK_THROWS_WITH(embed_layout(cube.mesh, boundary.layout, cube.ties),
                          Catch::Contains("no arc joins"));
    }
    {
        Cube cube = tied_cube(2);
        cube.ties.clear();
        CHECK_THROWS_WITH(embed_layout(cube.mesh, boundary.layout, cube.ties),
                          Catch::Contains("needs one"));
    }
}

TEST_CASE("embed layout: regions with holes are cut open", "[layout]") {
    // Without the four edges along z the sides are one region with two boundary loops.
    Cube cube = tied_cube(3);
    std::erase_if(cube.ties, [&](const LayoutTie& tie) {
        const Vector3 way =
            cube.mesh.point(tie.vertices.front()) - cube.mesh.point(tie.vertices.back());
        return std::abs(way.z()) > 1e-9;
    });
    REQUIRE(cube.ties.size() == 8);
    const LayoutBoundary boundary = layout_boundary(block(3));
    check_embedding(cube.mesh, embed_layout(cube.mesh, boundary.layout, cube.ties));
}
