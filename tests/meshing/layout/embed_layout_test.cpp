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

TEST_CASE("embed layout: where a map is too thin arcs are drawn as shortest paths", "[layout]") {
    // A finger amid a side of the cube, twenty times as long as it is round: the harmonic map of
    // the side shrinks it by exp(-2 pi) for each of these, far below what doubles tell apart.
    Cube cube = tied_cube(2);
    TriangleSoup soup = to_soup(cube.mesh);
    const Vector3 top(50.0, 50.0, 100.0);
    const auto centroid = [&](const std::array<int, 3>& t) -> Vector3 {
        return (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]) / 3.0;
    };
    const auto base = std::ranges::min_element(
        soup.triangles, {}, [&](const auto& t) { return (centroid(t) - top).norm(); });
    std::array<int, 3> ring = *base;
    const double side = (soup.points[ring[0]] - soup.points[ring[1]]).norm();
    soup.triangles.erase(base);
    constexpr int n_levels = 60;
    for (int level = 0; level < n_levels; ++level) {
        std::array<int, 3> next{};
        for (int k = 0; k < 3; ++k) {
            next[k] = static_cast<int>(soup.points.size());
            soup.points.emplace_back(soup.points[ring[k]] + side * Vector3::UnitZ());
        }
        for (int k = 0; k < 3; ++k) {
            const int other = (k + 1) % 3;
            soup.triangles.push_back({ring[k], ring[other], next[other]});
            soup.triangles.push_back({ring[k], next[other], next[k]});
        }
        ring = next;
    }
    soup.triangles.push_back(ring);
    cube.mesh = make_surface_mesh(soup);
    const LayoutBoundary boundary = layout_boundary(block(2));
    check_embedding(cube.mesh, embed_layout(cube.mesh, boundary.layout, cube.ties));
}
