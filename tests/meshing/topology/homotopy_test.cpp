// Loops and cuts beside CGAL's tests of homotopy on surfaces, which know nothing of how ours were
// found.
#include <CGAL/Curves_on_surface_topology.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Path_on_surface.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "meshing/parts/part_surface.h"
#include "meshing/surface/surface_curves.h"
#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/pants.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

using CgalMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using CgalPath = CGAL::Surface_mesh_topology::Path_on_surface<CgalMesh>;
using Vertices = std::vector<int>;

CgalMesh to_cgal(const TriangleSoup& soup) {
    CgalMesh mesh;
    for (const Vector3& p : soup.points) mesh.add_vertex({p.x(), p.y(), p.z()});
    for (const auto& [a, b, c] : soup.triangles) {
        mesh.add_face(CgalMesh::Vertex_index(a), CgalMesh::Vertex_index(b),
                      CgalMesh::Vertex_index(c));
    }
    return mesh;
}

TriangleSoup to_soup(const CutSurface& surface) {
    TriangleSoup soup;
    for (int v = 0; v < surface.n_vertices(); ++v) soup.points.push_back(surface.point(v));
    for (int f = 0; f < surface.n_faces(); ++f) soup.triangles.push_back(surface.triangle(f));
    return soup;
}

// Asks about closed walks by their vertices, the first one not repeated.
class Oracle {
  public:
    explicit Oracle(const TriangleSoup& soup) : mesh_(to_cgal(soup)), topology_(mesh_) {}
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;

    bool is_contractible(const Vertices& walk) { return topology_.is_contractible(path(walk)); }
    bool is_simple(const Vertices& walk) {
        return topology_.is_homotopic_to_simple_cycle(path(walk));
    }
    bool are_homotopic(const Vertices& a, const Vertices& b) {
        return topology_.are_freely_homotopic(path(a), path(b));
    }

  private:
    CgalPath path(const Vertices& walk) {
        CgalPath result(mesh_);
        for (std::size_t k = 0; k < walk.size(); ++k) {
            const CgalMesh::Vertex_index from(walk[k]);
            const CgalMesh::Vertex_index to(walk[(k + 1) % walk.size()]);
            result.push_back(mesh_.halfedge(from, to));
        }
        REQUIRE(result.is_closed());
        return result;
    }

    CgalMesh mesh_;
    CGAL::Surface_mesh_topology::Curves_on_surface_topology<CgalMesh> topology_;
};

Vertices reversed(Vertices walk) {
    std::reverse(walk.begin(), walk.end());
    return walk;
}

Vertices vertices_of(const PantsCurve& curve) {
    Vertices vertices;
    for (const VertexHandle v : curve.curve.vertices) vertices.push_back(v.idx());
    return vertices;
}

// The curve with the given side on its left.
Vertices along(const PantsDecomposition& pants, const CurveSide& side) {
    const Vertices vertices = vertices_of(pants.curves[side.curve]);
    return side.is_left ? vertices : reversed(vertices);
}

// The boundary loop of a piece that runs along a side, as vertices of the piece.
Vertices loop_along(const CutSurface& piece, const Vertices& side) {
    for (const auto& loop : piece.boundary_loops()) {
        const auto first = std::find(side.begin(), side.end(), piece.parent(piece.origin(loop[0])));
        if (first == side.end()) continue;
        const int second = first + 1 == side.end() ? side.front() : *(first + 1);
        if (piece.parent(piece.target(loop[0])) != second) continue;
        Vertices vertices;
        for (const int h : loop) vertices.push_back(piece.origin(h));
        return vertices;
    }
    return {};
}

// A path over the edges of a piece that was cut open, as vertices of the mesh; both ends included.
Vertices path_in_piece(const CutSurface& piece, const Vertices& from, const Vertices& to) {
    std::vector<int> before(piece.n_vertices(), -2);
    Vertices queue = from;
    for (const int v : from) before[v] = -1;
    const std::set<int> ends(to.begin(), to.end());
    for (std::size_t i = 0; i < queue.size(); ++i) {
        if (ends.contains(queue[i])) {
            Vertices path;
            for (int v = queue[i]; v >= 0; v = before[v]) path.push_back(piece.parent(v));
            return reversed(path);
        }
        const int first = piece.outgoing(queue[i]);
        for (int h = first; h >= 0;) {
            const int next = piece.target(h);
            if (before[next] == -2) {
                before[next] = queue[i];
                queue.push_back(next);
            }
            h = piece.rotated(h);
            if (h == first) break;
        }
    }
    return {};
}

Vertices from_vertex(Vertices walk, int v) {
    std::rotate(walk.begin(), std::find(walk.begin(), walk.end(), v), walk.end());
    return walk;
}

// w_i p w_j p^-1.
Vertices around_both(const Vertices& w_i, const Vertices& path, const Vertices& w_j) {
    Vertices walk = from_vertex(w_i, path.front());
    walk.insert(walk.end(), path.begin(), path.end() - 1);
    const Vertices second = from_vertex(w_j, path.back());
    walk.insert(walk.end(), second.begin(), second.end());
    walk.insert(walk.end(), path.rbegin(), path.rend() - 1);
    return walk;
}

void require_loops(const TriangleSoup& soup) {
    const HandleTunnelLoops loops = find_handle_tunnel_loops(CutSurface(soup));
    Oracle oracle(to_soup(loops.surface));
    for (const auto* kind : {&loops.handles, &loops.tunnels}) {
        for (const HomologyLoop& loop : *kind) {
            REQUIRE_FALSE(oracle.is_contractible(loop.vertices));
            REQUIRE(oracle.is_simple(loop.vertices));
        }
    }
}

void require_pants(const TriangleSoup& soup) {
    SurfaceMesh mesh = make_surface_mesh(soup);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    Oracle oracle(couture::meshing::to_soup(mesh));
    std::vector<Vertices> curves;
    for (const PantsCurve& curve : pants.curves) curves.push_back(vertices_of(curve));
    for (std::size_t i = 0; i < curves.size(); ++i) {
        INFO("curve " << i << " (" << to_string(pants.curves[i].kind) << ")");
        REQUIRE_FALSE(oracle.is_contractible(curves[i]));
        REQUIRE(oracle.is_simple(curves[i]));
        for (std::size_t j = 0; j < i; ++j) {
            INFO("and curve " << j);
            REQUIRE_FALSE(oracle.are_homotopic(curves[i], curves[j]));
            REQUIRE_FALSE(oracle.are_homotopic(curves[i], reversed(curves[j])));
        }
        if (!pants.curves[i].around) continue;
        // The pant that was cut off lies left of the cycle.
        const CurveSide left{static_cast<int>(i), true};
        const auto patch = std::find_if(
            pants.patches.begin(), pants.patches.end(), [&](const PantsPatch& candidate) {
                return std::count(candidate.boundary.begin(), candidate.boundary.end(), left) == 1;
            });
        REQUIRE(patch != pants.patches.end());
        const auto& [a, b] = *pants.curves[i].around;
        const Vertices w_a = along(pants, a);
        const Vertices w_b = along(pants, b);
        // Both may be sides of one handle: the path is looked for on the pant, cut open.
        std::vector<FaceHandle> faces;
        for (const auto face : mesh.faces()) {
            if (pants.patch_of_face[face.idx()] == patch - pants.patches.begin()) {
                faces.push_back(face);
            }
        }
        const CutSurface pant(mesh, faces, curve_seams(mesh));
        const Vertices path = path_in_piece(pant, loop_along(pant, w_a), loop_along(pant, w_b));
        REQUIRE(!path.empty());
        const Vertices both = around_both(w_a, path, w_b);
        CHECK(oracle.are_homotopic(reversed(curves[i]), both));
        // The test tells orientations apart, where the surface does.
        CHECK_FALSE(oracle.are_homotopic(curves[i], both));
    }
}

}  // namespace

TEST_CASE("homotopy: the oracle knows a torus' loops", "[meshing][topology]") {
    // Vertex 8 i + j: i around the axis, j in the tube.
    Oracle torus(make_torus(12, 8, 2.0, 0.7));
    Vertices meridian;
    Vertices longitude;
    for (int j = 0; j < 8; ++j) meridian.push_back(j);
    for (int i = 0; i < 12; ++i) longitude.push_back(8 * i);
    CHECK_FALSE(torus.is_contractible(meridian));
    CHECK(torus.is_simple(meridian));
    CHECK_FALSE(torus.are_homotopic(meridian, longitude));
    CHECK(torus.is_contractible({0, 8, 9}));
    Vertices twice = meridian;
    twice.insert(twice.end(), meridian.begin(), meridian.end());
    CHECK_FALSE(torus.is_simple(twice));
}

TEST_CASE("homotopy: loops and pants of parts", "[meshing][topology]") {
    struct Part {
        const char* name;
        double edge_length;
    };
    const auto part = GENERATE(Part{"double_torus", 5.0}, Part{"wheel", 9.0}, Part{"casting", 12.0},
                               Part{"sierpinski", 9.0}, Part{"seal", 5.0});
    INFO(part.name);
    const TriangleSoup soup = make_part_surface(part.name, {}, part.edge_length).soup;
    require_loops(soup);
    require_pants(soup);
}

TEST_CASE("homotopy: loops and pants of public surfaces", "[meshing][topology]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const char* file :
         {"eight.off", "hexgen_joint.off", "hexgen_mount1.off", "hexgen_rod.off", "igl_3holes.off",
          "mambo_S3.off", "openfoam_flange.stl", "oded_torus.obj", "vampy_atrium.off"}) {
        INFO(file);
        const TriangleSoup soup = read_surface(*folder / "surfaces" / file);
        require_loops(soup);
        if (CutSurface(soup).euler_characteristic() < 0) require_pants(soup);
    }
}
