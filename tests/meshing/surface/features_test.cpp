#include "meshing/surface/features.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// What must hold of any features: tags, chains and regions agree.
void require_consistent(const SurfaceMesh& mesh, const Features& features) {
    std::size_t n_tagged = 0;
    for (const auto edge : mesh.edges()) n_tagged += mesh.data(edge).feature >= 0;
    std::size_t n_edges = 0;
    for (std::size_t i = 0; i < features.curves.size(); ++i) {
        const FeatureCurve& curve = features.curves[i];
        const std::size_t n = curve.vertices.size();
        double length = 0.0;
        for (std::size_t k = 0; k + (curve.is_closed ? 0 : 1) < n; ++k, ++n_edges) {
            const auto halfedge =
                mesh.find_halfedge(curve.vertices[k], curve.vertices[(k + 1) % n]);
            REQUIRE(halfedge.is_valid());
            REQUIRE(mesh.data(mesh.edge_handle(halfedge)).feature == static_cast<int>(i));
            REQUIRE(mesh.is_boundary(mesh.edge_handle(halfedge)) == curve.is_boundary);
            length += edge_length(mesh, mesh.edge_handle(halfedge));
        }
        REQUIRE(curve.length == Approx(length));
    }
    REQUIRE(n_edges == n_tagged);
    double area = 0.0;
    std::size_t n_faces = 0;
    for (std::size_t i = 0; i < features.regions.size(); ++i) {
        area += features.regions[i].area;
        n_faces += features.regions[i].faces.size();
        for (const auto face : features.regions[i].faces) {
            REQUIRE(mesh.data(face).region == static_cast<int>(i));
        }
    }
    REQUIRE(n_faces == mesh.n_faces());
    REQUIRE(area == Approx(surface_area(mesh)));
}

std::vector<VertexHandle> handles(const std::vector<int>& numbers) {
    return {numbers.begin(), numbers.end()};
}

}  // namespace

TEST_CASE("Features: a cube has 12 curves, 8 corners and 6 planar discs", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_cube(4));
    const Features features = detect_features(mesh);
    require_consistent(mesh, features);
    REQUIRE(features.curves.size() == 12);
    REQUIRE(features.corners.size() == 8);
    REQUIRE(features.regions.size() == 6);
    for (const auto& curve : features.curves) {
        REQUIRE_FALSE(curve.is_closed);
        REQUIRE_FALSE(curve.is_boundary);
        REQUIRE(curve.length == Approx(1.0));
    }
    for (const auto& region : features.regions) {
        REQUIRE(region.area == Approx(1.0));
        REQUIRE(region.is_planar);
        REQUIRE(region.is_disc());
        REQUIRE(region.curves.size() == 4);
        REQUIRE(region.normal.dot(region.centroid - Vector3(0.5, 0.5, 0.5)) == Approx(0.5));
    }
}

TEST_CASE("Features: a plate with holes", "[meshing][surface]") {
    for (const int genus : {1, 2}) {
        SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(genus, 2));
        const Features features = detect_features(mesh);
        require_consistent(mesh, features);
        REQUIRE(features.curves.size() == static_cast<std::size_t>(12 + 12 * genus));
        REQUIRE(features.corners.size() == static_cast<std::size_t>(8 + 8 * genus));
        REQUIRE(features.regions.size() == static_cast<std::size_t>(6 + 4 * genus));
        int n_pierced = 0;
        for (const auto& region : features.regions) {
            REQUIRE(region.is_planar);
            if (region.is_disc()) continue;
            ++n_pierced;
            REQUIRE(region.n_loops == 1 + genus);
            REQUIRE(region.euler_characteristic == 1 - genus);
        }
        REQUIRE(n_pierced == 2);
    }
}

TEST_CASE("Features: boundaries are curves of their own kind", "[meshing][surface]") {
    SurfaceMesh tube = make_surface_mesh(make_tube(24, 3, 1.0, 2.0));
    const Features features = detect_features(tube);
    require_consistent(tube, features);
    REQUIRE(features.corners.empty());
    REQUIRE(features.curves.size() == 2);
    for (const auto& curve : features.curves) {
        REQUIRE(curve.is_closed);
        REQUIRE(curve.is_boundary);
    }
    REQUIRE(features.regions.size() == 1);
    REQUIRE(features.regions[0].n_loops == 2);
    REQUIRE(features.regions[0].euler_characteristic == 0);
    REQUIRE_FALSE(features.regions[0].is_planar);
    REQUIRE(features.regions[0].normal == Vector3::Zero());

    SurfaceMesh square = make_surface_mesh(make_square(3));
    const Features corners = detect_features(square);
    require_consistent(square, corners);
    REQUIRE(corners.curves.size() == 4);
    REQUIRE(corners.corners == handles({0, 3, 12, 15}));
    REQUIRE(corners.regions[0].is_disc());
}

TEST_CASE("Features: a smooth torus has one region without loops", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_torus(24, 16, 2.0, 0.8));
    const Features features = detect_features(mesh);
    REQUIRE(features.curves.empty());
    REQUIRE(features.regions.size() == 1);
    REQUIRE(features.regions[0].n_loops == 0);
    REQUIRE(features.regions[0].euler_characteristic == 0);
    REQUIRE_FALSE(features.regions[0].is_disc());
}

TEST_CASE("Features: the angle decides, short sets of edges can be left out",
          "[meshing][surface]") {
    SurfaceMesh prism = make_surface_mesh(make_tube(8, 1, 1.0, 2.0));
    // Neighbours meet at 45 degrees.
    REQUIRE(detect_features(prism, {.angle = 46.0 * std::numbers::pi / 180.0}).regions.size() == 1);
    REQUIRE(detect_features(prism, {.angle = 44.0 * std::numbers::pi / 180.0}).regions.size() == 8);
    const auto edge = prism.edge_handle(prism.find_halfedge(VertexHandle(0), VertexHandle(8)));
    REQUIRE(dihedral_angle(prism, edge) == Approx(std::numbers::pi / 4));

    // A dent in a plane: its sharp edges are a set of their own, beside the square's boundary.
    TriangleSoup soup = make_square(8);
    soup.points[4 * 9 + 4].z() = 0.3;
    SurfaceMesh dented = make_surface_mesh(soup);
    REQUIRE(detect_features(dented).curves.size() > 4);
    const Features smooth = detect_features(dented, {.min_length = 3.0});
    require_consistent(dented, smooth);
    REQUIRE(smooth.curves.size() == 4);
    REQUIRE(smooth.regions.size() == 1);
    REQUIRE_FALSE(smooth.regions[0].is_planar);
}

TEST_CASE("Features: a curve that ends inside a region is part of its loop", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_square(4));
    const std::vector<std::vector<VertexHandle>> curves{handles({10, 11, 12})};
    const Features features = tag_features(mesh, curves);
    require_consistent(mesh, features);
    REQUIRE(features.regions.size() == 1);
    // From the boundary (10) inwards.
    REQUIRE(features.regions[0].n_loops == 1);
    REQUIRE(features.regions[0].is_disc());
    const std::vector<std::vector<VertexHandle>> inside{handles({11, 12, 13})};
    REQUIRE(tag_features(mesh, inside).regions[0].n_loops == 2);
}

TEST_CASE("Features: declared curves keep their numbers", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_torus(8, 6, 2.0, 0.7));
    const std::vector<std::vector<VertexHandle>> curves{handles({24, 25, 26, 27, 28, 29, 24}),
                                                        handles({0, 1, 2, 3, 4, 5, 0})};
    const Features features = tag_features(mesh, curves);
    require_consistent(mesh, features);
    REQUIRE(features.corners.empty());
    REQUIRE(features.curves.size() == 2);
    REQUIRE(features.curves[0].vertices.front() == VertexHandle(24));
    REQUIRE(features.curves[0].is_closed);
    REQUIRE(features.regions.size() == 2);
    for (const auto& region : features.regions) {
        REQUIRE(region.n_loops == 2);
        REQUIRE(region.euler_characteristic == 0);
        REQUIRE(region.curves == std::vector<int>{0, 1});
    }
    // Declaring what was detected gives the same back.
    SurfaceMesh cube = make_surface_mesh(make_cube(3));
    const Features detected = detect_features(cube);
    std::vector<std::vector<VertexHandle>> declared;
    for (const auto& curve : detected.curves) declared.push_back(curve.vertices);
    const Features again = tag_features(cube, declared);
    REQUIRE(again.corners == detected.corners);
    REQUIRE(again.regions.size() == 6);
}

TEST_CASE("Features: the same mesh gives the same numbers", "[meshing][surface]") {
    SurfaceMesh first = make_surface_mesh(make_plate_with_holes(2, 3));
    SurfaceMesh second = make_surface_mesh(make_plate_with_holes(2, 3));
    const Features a = detect_features(first);
    const Features b = detect_features(second);
    for (std::size_t i = 0; i < a.curves.size(); ++i) {
        REQUIRE(a.curves[i].vertices == b.curves[i].vertices);
    }
    // And a second time on tagged edges.
    const Features c = detect_features(first);
    for (std::size_t i = 0; i < a.curves.size(); ++i) {
        REQUIRE(a.curves[i].vertices == c.curves[i].vertices);
    }
}

TEST_CASE("Features: what is wrong is told", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_square(4));
    REQUIRE_THROWS_AS(detect_features(mesh, {.angle = 0.0}), InputError);
    REQUIRE_THROWS_WITH(detect_features(mesh, {.angle = 40.0}),
                        "FeatureOptions: angle is 40; it must be in (0, pi) radians");
    REQUIRE_THROWS_WITH(detect_features(mesh, {.corner_angle = -1.0}),
                        Catch::Contains("corner_angle is -1"));
    REQUIRE_THROWS_WITH(detect_features(mesh, {.min_length = -1.0}),
                        Catch::Contains("min_length is -1"));
    REQUIRE_THROWS_WITH(detect_features(mesh, {.planar_tolerance = -1.0}),
                        Catch::Contains("planar_tolerance is -1"));
    const auto tag = [&](const std::vector<std::vector<int>>& numbers) {
        std::vector<std::vector<VertexHandle>> curves;
        for (const auto& curve : numbers) curves.push_back(handles(curve));
        return tag_features(mesh, curves);
    };
    REQUIRE_THROWS_AS(tag({{7}}), InputError);
    REQUIRE_THROWS_WITH(tag({{7, 8}, {7}}), Catch::Contains("curve 1 has 1 vertices"));
    REQUIRE_THROWS_WITH(tag({{7, 8, 7}}), Catch::Contains("curve 0 has 3 vertices"));
    REQUIRE_THROWS_WITH(tag({{7, 99}}), Catch::Contains("curve 0 has vertex 99; the mesh has 25"));
    REQUIRE_THROWS_AS(tag({{6, 8}}), TopologyError);
    REQUIRE_THROWS_WITH(tag({{6, 8}}), Catch::Contains("from vertex 6 to 8"));
    REQUIRE_THROWS_WITH(tag({{6, 7}, {7, 6}}), Catch::Contains("stands in curves 0 and 1"));
    REQUIRE_THROWS_WITH(tag({{1, 2, 7}}), Catch::Contains("leaves the boundary at vertex 2"));
    REQUIRE_THROWS_WITH(tag({{7, 2, 1}}), Catch::Contains("enters the boundary at vertex 2"));
    REQUIRE_THROWS_WITH(tag({{11, 12, 13}, {12, 17}}),
                        Catch::Contains("curve 0 meets other curves, or itself, at vertex 12"));
}

TEST_CASE("Features: public surfaces have as many sharp edges as their list says",
          "[meshing][surface][data]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const auto& surface : public_surfaces()) {
        CAPTURE(surface.file);
        SurfaceMesh mesh = make_surface_mesh(read_off(*folder / "surfaces" / surface.file));
        const Features features = detect_features(mesh);
        require_consistent(mesh, features);
        int n_sharp = 0;
        for (const auto edge : mesh.edges()) {
            n_sharp += !mesh.is_boundary(edge) && mesh.data(edge).feature >= 0;
        }
        REQUIRE(n_sharp == surface.n_sharp_edges);
    }
}
