#include "meshing/layout/blunt_path.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

using namespace couture;
using namespace couture::meshing;

namespace {

// A prism over a regular polygon: vertices 0 to n - 1 below, n to 2 n - 1 above, then the centres.
SurfaceMesh make_prism(int n, bool is_inside_out) {
    TriangleSoup soup;
    for (const double z : {0.0, 1.0}) {
        for (int i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / n;
            soup.points.emplace_back(std::cos(angle), std::sin(angle), z);
        }
    }
    soup.points.emplace_back(0.0, 0.0, 0.0);
    soup.points.emplace_back(0.0, 0.0, 1.0);
    for (int i = 0; i < n; ++i) {
        const int j = (i + 1) % n;
        soup.triangles.push_back({i, j, n + j});
        soup.triangles.push_back({i, n + j, n + i});
        soup.triangles.push_back({j, i, 2 * n});
        soup.triangles.push_back({n + i, n + j, 2 * n + 1});
    }
    if (is_inside_out) {
        for (auto& triangle : soup.triangles) std::swap(triangle[0], triangle[1]);
    }
    return make_surface_mesh(soup);
}

bool is_upright_blunt(int n, bool is_inside_out = false) {
    const std::array<VertexHandle, 2> path{VertexHandle(0), VertexHandle(n)};
    return is_blunt(make_prism(n, is_inside_out), path);
}

}  // namespace

TEST_CASE("is_blunt: edges of prisms are blunt above 120 degrees", "[layout]") {
    CHECK_FALSE(is_upright_blunt(3));
    CHECK_FALSE(is_upright_blunt(4));
    CHECK_FALSE(is_upright_blunt(5));
    CHECK(is_upright_blunt(7));
    CHECK(is_upright_blunt(12));
    // Seen from inside all fill more than half a turn.
    CHECK(is_upright_blunt(3, true));
    CHECK(is_upright_blunt(4, true));
}

TEST_CASE("is_blunt: the least corner along a path decides, from a tenth of it on", "[layout]") {
    const auto path = [](std::initializer_list<int> vertices) {
        std::vector<VertexHandle> handles;
        for (const int v : vertices) handles.emplace_back(v);
        return handles;
    };
    // Around an edge of the lid, at 90 degrees: the corners of two cuboids have sin 45 degrees, and
    // that of one sin 129 degrees is better, sin 150 degrees is worse.
    const SurfaceMesh of_seven = make_prism(7, false);
    CHECK_FALSE(is_blunt(of_seven, path({0, 1, 2, 3})));
    CHECK_FALSE(is_blunt(of_seven, path({0, 1, 2, 3, 10})));
    const SurfaceMesh of_twelve = make_prism(12, false);
    CHECK_FALSE(is_blunt(of_twelve, path({0, 1, 2, 3})));
    CHECK(is_blunt(of_twelve, path({0, 1, 2, 3, 15})));
    // Less than a tenth: 22 edges of the lids, 11.4 long together, and one of length 1.
    CHECK_FALSE(is_blunt(of_twelve, path({1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 0,
                                          12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23})));
}
