#include "meshing/surface/caps.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Closed {
    SurfaceMesh mesh;
    Features features;
};

Closed make_closed(const std::string& part) {
    Closed closed{make_surface_mesh(make_part_surface(part).soup), {}};
    closed.features = detect_features(closed.mesh);
    return closed;
}

}  // namespace

TEST_CASE("open_caps: the rims become boundary loops, the rest stays", "[surface][parts]") {
    Closed pant = make_closed("pant");
    const std::vector<Vector3> centres{{-110, 0, 0}, {110, 0, 0}, {0, 130, 0}};
    std::vector<Cap> caps;
    for (const Vector3& x : centres) {
        caps.push_back({"cap " + std::to_string(caps.size()), region_near(pant.mesh, x)});
    }
    const OpenedSurface opened = open_caps(pant.mesh, pant.features, caps);
    double area = 0.0;
    for (const Cap& cap : caps) area += pant.features.regions[cap.region].area;
    REQUIRE(area == Approx(3 * 40.0 * 40.0));
    const SurfaceMesh mesh = make_surface_mesh(opened.soup);
    REQUIRE(surface_area(mesh) == Approx(surface_area(pant.mesh) - area));
    std::vector<int> n_rim(3, 0);
    for (const auto vertex : mesh.vertices()) {
        REQUIRE(mesh.point(vertex) == pant.mesh.point(VertexHandle(opened.vertices[vertex.idx()])));
        const int cap = opened.cap_of_vertex[vertex.idx()];
        REQUIRE(mesh.is_boundary(vertex) == (cap >= 0));
        if (cap < 0) continue;
        ++n_rim[cap];
        REQUIRE((mesh.point(vertex) - centres[cap]).norm() < 20.0 * std::numbers::sqrt2 + 1e-9);
    }
    for (const int n : n_rim) REQUIRE(n >= 4);
}

TEST_CASE("regions_facing: by the direction of the normal", "[surface][parts]") {
    const Closed cube = make_closed("cube");
    REQUIRE(regions_facing(cube.features, {0, 0, 2}, degree).size() == 1);
    REQUIRE(regions_facing(cube.features, {1, 1, 0}, degree).empty());
    REQUIRE(regions_facing(cube.features, {1, 1, 0}, 46.0 * degree).size() == 2);
    REQUIRE_THROWS_AS(regions_facing(cube.features, {0, 0, 0}, degree), InputError);
}

TEST_CASE("open_caps: what can't be opened is named", "[surface][parts]") {
    Closed cube = make_closed("cube");
    const auto top = regions_facing(cube.features, {0, 0, 1}, degree).front();
    const auto side = regions_facing(cube.features, {1, 0, 0}, degree).front();
    using Caps = std::vector<Cap>;
    REQUIRE_THROWS_WITH(open_caps(cube.mesh, cube.features, Caps{{"a", 17}}),
                        "cap 'a': there is no face 17; there are 6 smooth faces");
    REQUIRE_THROWS_WITH(open_caps(cube.mesh, cube.features, Caps{{"a", top}, {"b", top}}),
                        "caps 'a' and 'b' are the same face; name it once");
    REQUIRE_THROWS_WITH(open_caps(cube.mesh, cube.features, Caps{{"a", top}, {"b", side}}),
                        Catch::Contains("caps 'a' and 'b' touch at ("));
    Closed wheel = make_closed("wheel");
    const auto ring = region_near(wheel.mesh, {90.0, 0.0, 0.0});
    REQUIRE_THROWS_WITH(open_caps(wheel.mesh, wheel.features, Caps{{"rim", ring}}),
                        Catch::Contains("cap 'rim': the "));
}
