#include "meshing/surface/cut_surface.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

void require_consistent(const CutSurface& surface) {
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        const int twin = surface.twin(h);
        if (twin >= 0) {
            REQUIRE(surface.twin(twin) == h);
            REQUIRE(surface.origin(twin) == surface.target(h));
            REQUIRE(surface.target(twin) == surface.origin(h));
        }
    }
    for (int v = 0; v < surface.n_vertices(); ++v) {
        const int first = surface.outgoing(v);
        REQUIRE(surface.origin(first) == v);
        // On the boundary the fan starts there; going round reaches every corner of the vertex.
        int n_corners = 0;
        for (int h = first; h >= 0;) {
            REQUIRE(surface.origin(h) == v);
            ++n_corners;
            h = surface.rotated(h);
            if (h == first) break;
        }
        int expected = 0;
        for (int h = 0; h < surface.n_halfedges(); ++h) expected += surface.origin(h) == v;
        REQUIRE(n_corners == expected);
    }
}

std::vector<int> path_of(const CutSurface& surface, const std::vector<int>& vertices) {
    std::vector<int> path;
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
        path.push_back(surface.find_halfedge(vertices[i], vertices[i + 1]));
        REQUIRE(path.back() >= 0);
    }
    return path;
}

}  // namespace

TEST_CASE("CutSurface: splits keep it consistent and log what they did", "[meshing][surface]") {
    CutSurface surface(make_tube(7, 4, 1.0, 2.0));
    const int chi = surface.euler_characteristic();
    REQUIRE(chi == 0);
    for (int h = 0; h < surface.n_halfedges() && h < 400; h += 5) surface.split_edge(h, 0.25);
    require_consistent(surface);
    REQUIRE(surface.euler_characteristic() == chi);
    for (const auto& split : surface.splits()) {
        const Vector3 expected = 0.75 * surface.point(split.from) + 0.25 * surface.point(split.to);
        REQUIRE((surface.point(split.vertex) - expected).norm() < 1e-15);
        REQUIRE(surface.parent(split.vertex) == -1);
    }
    REQUIRE(surface.boundary_loops().size() == 2);
}

TEST_CASE("CutSurface: a torus opened along a meridian is a tube, then a disc",
          "[meshing][surface]") {
    CutSurface surface(make_torus(8, 6, 2.0, 0.7));
    REQUIRE(surface.boundary_loops().empty());
    surface.slice(path_of(surface, {0, 1, 2, 3, 4, 5, 0}));
    require_consistent(surface);
    REQUIRE(surface.euler_characteristic() == 0);
    REQUIRE(surface.boundary_loops().size() == 2);
    REQUIRE(surface.n_vertices() == 48 + 6);

    // Along the other direction, from one copy of vertex 0 to the other.
    std::vector<int> around{surface.find_halfedge(0, 6) >= 0 ? 0 : 48};
    for (int i = 1; i < 8; ++i) around.push_back(6 * i);
    around.push_back(around.front() == 0 ? 48 : 0);
    if (surface.find_halfedge(around[7], around[8]) < 0) {
        for (int v = 48; v < 54; ++v) {
            if (surface.find_halfedge(around[7], v) >= 0 && surface.parent(v) == 0) around[8] = v;
        }
    }
    surface.slice(path_of(surface, around));
    require_consistent(surface);
    REQUIRE(surface.euler_characteristic() == 1);
    REQUIRE(surface.boundary_loops().size() == 1);
    REQUIRE(surface.boundary_loops()[0].size() == 2 * (6 + 8));
}

TEST_CASE("CutSurface: a slit inside opens without dividing its ends", "[meshing][surface]") {
    CutSurface surface(make_square(4));
    const int n = surface.n_vertices();
    surface.slice(path_of(surface, {6, 7, 8}));
    require_consistent(surface);
    REQUIRE(surface.n_vertices() == n + 1);
    REQUIRE(surface.euler_characteristic() == 0);
    REQUIRE(surface.boundary_loops().size() == 2);
}

TEST_CASE("CutSurface: seams of a mesh become its boundary", "[meshing][surface]") {
    const SurfaceMesh mesh = make_surface_mesh(make_torus(8, 6, 2.0, 0.7));
    std::vector<bool> is_seam(mesh.n_edges(), false);
    for (const int i : {0, 3}) {
        for (int j = 0; j < 6; ++j) {
            const auto halfedge =
                mesh.find_halfedge(VertexHandle(6 * i + j), VertexHandle(6 * i + (j + 1) % 6));
            is_seam[mesh.edge_handle(halfedge).idx()] = true;
        }
    }
    const std::vector<FaceHandle> faces(mesh.faces_begin(), mesh.faces_end());
    const CutSurface surface(mesh, faces, is_seam);
    require_consistent(surface);
    REQUIRE(surface.boundary_loops().size() == 4);
    const auto component = surface.face_components();
    REQUIRE(*std::max_element(component.begin(), component.end()) == 1);
    REQUIRE(std::count(component.begin(), component.end(), 0) == 3 * 6 * 2);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        REQUIRE(surface.point(v) == mesh.point(VertexHandle(surface.parent(v))));
    }
}

TEST_CASE("CutSurface: chords are split until none is left", "[meshing][surface]") {
    // A strip one square wide: every inner edge joins boundary vertices.
    CutSurface surface(make_tube(5, 1, 1.0, 1.0));
    surface.split_chords();
    require_consistent(surface);
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.twin(h) < 0) continue;
        REQUIRE_FALSE((surface.is_boundary_vertex(surface.origin(h)) &&
                       surface.is_boundary_vertex(surface.target(h))));
    }
    REQUIRE(surface.splits().size() == 10);
}

TEST_CASE("CutSurface: triangles that do not fit together are refused", "[meshing][surface]") {
    TriangleSoup soup = make_tetrahedron();
    std::swap(soup.triangles[3][0], soup.triangles[3][1]);
    REQUIRE_THROWS_AS(CutSurface(soup), TopologyError);
}
