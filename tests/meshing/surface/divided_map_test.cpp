#include "meshing/surface/divided_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "meshing/surface/map_quality.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// The outline on a circle by count. The centre is not zero, where numbers could shrink for ever.
struct Outline {
    std::vector<int> boundary;
    std::vector<int> sides;
    std::vector<Vector2> parameters;
    explicit Outline(const CutSurface& disc)
        : boundary(disc.boundary_loops().front()), parameters(disc.n_vertices(), Vector2::Zero()) {
        for (std::size_t i = 0; i < boundary.size(); ++i) {
            const double angle =
                6.283185307179586 * static_cast<double>(i) / static_cast<double>(boundary.size());
            sides.push_back(static_cast<int>(i));
            parameters[disc.origin(boundary[i])] = {0.3 + std::cos(angle), 0.7 + std::sin(angle)};
        }
    }
};

}  // namespace

TEST_CASE("map_by_division: divides nothing where the harmonic map is one-to-one",
          "[meshing][surface]") {
    const CutSurface disc(make_bumpy_square(6, 0.3));
    Outline outline(disc);
    const auto before = outline.parameters;
    CHECK(map_by_division(disc, outline.boundary, outline.sides, outline.parameters) == 0);
    CHECK(flipped_triangles(disc, outline.parameters).empty());
    for (const int h : outline.boundary) {
        CHECK(outline.parameters[disc.origin(h)] == before[disc.origin(h)]);
    }
}

TEST_CASE("map_by_division: maps long fingers one-to-one", "[meshing][surface]") {
    // A harmonic map shrinks by about e per unit of length: 1e-13 after 30, 1e-87 after 200.
    const std::vector<std::pair<int, int>> shapes{{3, 30}, {4, 60}, {8, 100}, {17, 200}};
    for (const auto& [n_around, length] : shapes) {
        CAPTURE(n_around, length);
        const CutSurface disc(make_finger(n_around, length, 1.0, length));
        Outline outline(disc);
        CHECK(map_by_division(disc, outline.boundary, outline.sides, outline.parameters) > 0);
        CHECK(flipped_triangles(disc, outline.parameters).empty());
    }
}
