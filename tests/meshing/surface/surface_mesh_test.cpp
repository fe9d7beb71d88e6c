#include "meshing/surface/surface_mesh.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

int euler_characteristic(const SurfaceMesh& mesh) {
    return static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
           static_cast<int>(mesh.n_faces());
}

}  // namespace

TEST_CASE("SurfaceMesh: a soup goes in and comes out", "[meshing][surface]") {
    const TriangleSoup soup = make_plate_with_holes(2, 2);
    const SurfaceMesh mesh = make_surface_mesh(soup);
    REQUIRE(euler_characteristic(mesh) == -2);
    const TriangleSoup back = to_soup(mesh);
    REQUIRE(back.points == soup.points);
    REQUIRE(back.triangles.size() == soup.triangles.size());
}

TEST_CASE("SurfaceMesh: area, volume and angles of the unit cube", "[meshing][surface]") {
    const SurfaceMesh mesh = make_surface_mesh(make_cube(3));
    REQUIRE(surface_area(mesh) == Approx(6.0).epsilon(1e-14));
    REQUIRE(signed_volume(mesh) == Approx(1.0).epsilon(1e-14));
    REQUIRE(bounding_box_diagonal(mesh) == Approx(std::sqrt(3.0)).epsilon(1e-15));
    for (const auto face : mesh.faces()) {
        double sum = 0.0;
        for (const auto halfedge : mesh.fh_range(face)) sum += corner_angle(mesh, halfedge);
        REQUIRE(sum == Approx(std::numbers::pi).epsilon(1e-14));
    }
}

TEST_CASE("SurfaceMesh: splits keep the shape, the tags and where points come from",
          "[meshing][surface]") {
    const TriangleSoup soup = make_torus(9, 7, 2.0, 0.7);
    SurfaceMesh mesh = make_surface_mesh(soup);
    for (const auto face : mesh.faces()) mesh.data(face).region = face.idx();
    for (const auto edge : mesh.edges()) mesh.data(edge).feature = edge.idx();
    const double area = surface_area(mesh);
    const auto n_edges = static_cast<int>(mesh.n_edges());
    // Every third edge of the first mesh, then some of the new ones.
    for (int e = 0; e < n_edges + 200; e += 3) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(EdgeHandle(e), e % 2);
        const int feature = mesh.data(EdgeHandle(e)).feature;
        const VertexHandle from = mesh.from_vertex_handle(halfedge);
        const VertexHandle to = mesh.to_vertex_handle(halfedge);
        const Vector3 expected = 0.7 * mesh.point(from) + 0.3 * mesh.point(to);
        const VertexHandle vertex = split_edge(mesh, halfedge, 0.3);
        REQUIRE((mesh.point(vertex) - expected).norm() < 1e-15);
        for (const VertexHandle end : {from, to}) {
            REQUIRE(mesh.data(mesh.edge_handle(mesh.find_halfedge(vertex, end))).feature ==
                    feature);
        }
    }
    REQUIRE(euler_characteristic(mesh) == 0);
    REQUIRE(surface_area(mesh) == Approx(area).epsilon(1e-13));
    std::vector<double> area_of_source(soup.triangles.size(), 0.0);
    for (const auto face : mesh.faces()) {
        REQUIRE(mesh.data(face).region == mesh.data(face).source);
        area_of_source[mesh.data(face).source] += face_area(mesh, face);
    }
    const SurfaceMesh first = make_surface_mesh(soup);
    for (const auto face : first.faces()) {
        REQUIRE(area_of_source[face.idx()] == Approx(face_area(first, face)).epsilon(1e-12));
    }
    for (const auto vertex : mesh.vertices()) {
        const SurfacePoint& source = mesh.data(vertex).source;
        Vector3 point = Vector3::Zero();
        for (int i = 0; i < 3 && source.vertices[i] >= 0; ++i) {
            point += source.weights[i] * soup.points[source.vertices[i]];
        }
        REQUIRE((point - mesh.point(vertex)).norm() < 1e-14);
    }
}

TEST_CASE("SurfaceMesh: a boundary edge can be split", "[meshing][surface]") {
    SurfaceMesh mesh = make_surface_mesh(make_square(1));
    const HalfedgeHandle halfedge = mesh.find_halfedge(VertexHandle(0), VertexHandle(1));
    split_edge(mesh, halfedge, 0.25);
    REQUIRE(mesh.n_faces() == 3);
    REQUIRE(euler_characteristic(mesh) == 1);
    REQUIRE(surface_area(mesh) == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("SurfaceMesh: what is no oriented manifold is refused", "[meshing][surface]") {
    TriangleSoup soup = make_tetrahedron();
    std::swap(soup.triangles[3][0], soup.triangles[3][1]);
    REQUIRE_THROWS_AS(make_surface_mesh(soup), TopologyError);
    REQUIRE_THROWS_WITH(make_surface_mesh(soup), Catch::Contains("triangle 3"));
    soup.triangles[3] = {1, 1, 2};
    REQUIRE_THROWS_AS(make_surface_mesh(soup), InputError);
    soup.triangles[3] = {1, 3, 9};
    REQUIRE_THROWS_WITH(make_surface_mesh(soup), Catch::Contains("below 4"));
}
