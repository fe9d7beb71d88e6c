#include "meshing/layout/patch_sketch.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

// The edges of a box. Around each corner they come in the order x, y, z at those that an even
// number of steps lead to from the origin, seen from outside against it at the others.
PatchSketch box_edges(const Vector3& size) {
    PatchSketch box;
    for (int n = 0; n < 8; ++n) {
        const Vector3 corner(n & 1, n >> 1 & 1, n >> 2 & 1);
        box.nodes.push_back({"", -1, {}, corner.cwiseProduct(size)});
    }
    for (int d = 0; d < 3; ++d) {
        for (int n = 0; n < 8; ++n) {
            const int other = n | 1 << d;
            if (other == n) continue;
            const Vector3 middle = 0.5 * (box.nodes[n].place + box.nodes[other].place);
            box.curves.push_back({"", n, other, ArcKind::convex, middle});
        }
    }
    const auto end_at = [&](int n, int d) {
        for (int k = 0; k < 4; ++k) {
            const auto& curve = box.curves[4 * d + k];
            if (curve.from == n) return 2 * (4 * d + k);
            if (curve.to == n) return 2 * (4 * d + k) + 1;
        }
        return -1;
    };
    for (int n = 0; n < 8; ++n) {
        const bool is_even = ((n & 1) + (n >> 1 & 1) + (n >> 2 & 1)) % 2 == 0;
        for (const int d : is_even ? std::array{0, 1, 2} : std::array{0, 2, 1}) {
            box.nodes[n].curve_ends.push_back(end_at(n, d));
        }
    }
    return box;
}

// The same with nodes and curves counted backwards, and every other curve reversed.
PatchSketch renumbered(const PatchSketch& sketch) {
    const int n_nodes = static_cast<int>(sketch.nodes.size());
    const int n_curves = static_cast<int>(sketch.curves.size());
    PatchSketch result = sketch;
    for (int n = 0; n < n_nodes; ++n) {
        PatchSketch::Node& node = result.nodes[n_nodes - 1 - n];
        node = sketch.nodes[n];
        for (int& end : node.curve_ends) {
            const int c = end / 2;
            end = 2 * (n_curves - 1 - c) + (end + c) % 2;
        }
        std::rotate(node.curve_ends.begin(), node.curve_ends.begin() + n % 3,
                    node.curve_ends.end());
    }
    for (int c = 0; c < n_curves; ++c) {
        PatchSketch::Curve& curve = result.curves[n_curves - 1 - c];
        curve = sketch.curves[c];
        curve.from = n_nodes - 1 - sketch.curves[c].from;
        curve.to = n_nodes - 1 - sketch.curves[c].to;
        if (c % 2 == 1) std::swap(curve.from, curve.to);
    }
    return result;
}

}  // namespace

TEST_CASE("patch sketch: other numbers and directions are seen through", "[layout]") {
    const PatchSketch first = box_edges({1.0, 1.0, 1.0});
    // A cube has 24 motions: places decide.
    const PatchSketch second = renumbered(box_edges({1.1, 0.9, 1.05}));
    const SketchMatch match = match_sketches(first, second);
    for (int n = 0; n < 8; ++n) CHECK(match.nodes[n] == 7 - n);
    for (int c = 0; c < 12; ++c) {
        CHECK(match.curves[c] == 11 - c);
        CHECK(match.is_reversed[c] == (c % 2 == 1));
    }
}

TEST_CASE("patch sketch: names come before places", "[layout]") {
    PatchSketch first = box_edges({1.0, 1.0, 1.0});
    PatchSketch second = first;
    // A quarter turn about z takes the corner at the origin to that at x, and x to (x, y).
    first.nodes[0].name = "low";
    first.nodes[1].name = "next";
    second.nodes[1].name = "low";
    second.nodes[3].name = "next";
    const SketchMatch match = match_sketches(first, second);
    CHECK(match.nodes == std::vector<int>{1, 3, 0, 2, 5, 7, 4, 6});
    // No neighbour of the corner at x.
    std::swap(second.nodes[3].name, second.nodes[6].name);
    CHECK_THROWS_WITH(match_sketches(first, second), Contains("'low' at the place near (0, 0, 0)"));
}

TEST_CASE("patch sketch: what differs is refused", "[layout]") {
    const PatchSketch first = box_edges({1.0, 1.0, 1.0});
    PatchSketch reflex = first;
    reflex.curves[5].kind = ArcKind::reflex;
    CHECK_THROWS_AS(match_sketches(first, reflex), TopologyError);
    PatchSketch mirrored = first;
    for (auto& node : mirrored.nodes) std::swap(node.curve_ends[1], node.curve_ends[2]);
    // A mirrored cube is a cube, but places of corners can't be kept.
    CHECK(match_sketches(first, mirrored).nodes != match_sketches(first, first).nodes);
    PatchSketch less = first;
    less.curves.pop_back();
    CHECK_THROWS_WITH(match_sketches(first, less),
                      Contains("11 sharp edges, 8 corners inside") && Contains("reference has 12"));
}
