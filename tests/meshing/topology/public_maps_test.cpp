#include <catch2/catch.hpp>
#include <map>

#include "meshing/surface/harmonic_map.h"
#include "meshing/surface/open_pant.h"
#include "meshing/surface/repair.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/surface/surface_curves.h"
#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/pants.h"
#include "meshing/topology/solid_check.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/public_surfaces.h"

using namespace couture;
using namespace couture::meshing;

namespace {

void require_one_to_one(const CutSurface& surface, const HarmonicMap& map) {
    REQUIRE(flipped_triangles(surface, map.parameters).empty());
}

void require_maps_of_disc(const CutSurface& disc) {
    for (const int n : {3, 4, 6}) {
        CutSurface surface = disc;
        require_one_to_one(surface, map_disc_to_polygon(surface, spread_corners(surface, n),
                                                        regular_polygon_corners(n)));
    }
    CutSurface surface = disc;
    const int start = surface.origin(surface.boundary_loops().front().front());
    require_one_to_one(surface, map_disc_to_circle(surface, start));
}

void require_maps_of_annulus(const CutSurface& annulus) {
    CutSurface opened = annulus;
    opened.split_chords();
    const auto corners = open_annulus(opened, path_between_boundaries(opened, 0, 1));
    for (const bool is_periodic : {false, true}) {
        CutSurface surface = opened;
        require_one_to_one(surface,
                           map_opened_annulus(surface, corners, 1.0, 1.0, is_periodic).map);
    }
    require_maps_of_disc(opened);
}

void require_maps_of_pant(const CutSurface& pant) {
    for (int middle = 0; middle < 3; ++middle) {
        CutSurface opened = pant;
        const auto corners = open_pant(opened, (middle + 1) % 3, middle, (middle + 2) % 3);
        CutSurface octagon = opened;
        require_one_to_one(octagon,
                           map_disc_to_polygon(octagon, corners, regular_polygon_corners(8)));
        require_one_to_one(opened, map_opened_pant(opened, corners, 1.0, 1.0));
    }
}

// A sphere with a slit along the shortest path between its first vertex and the one farthest away.
CutSurface slit(CutSurface sphere) {
    const int start = 0;
    ShortestPaths paths(sphere);
    paths.run({.sources = {&start, 1}});
    sphere.slice(paths.path_to(paths.settled().back()));
    return sphere;
}

CutSurface cut_along_handle(const CutSurface& torus) {
    HandleTunnelLoops loops = find_handle_tunnel_loops(torus);
    const auto& vertices = loops.handles.front().vertices;
    std::vector<int> path;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        path.push_back(
            loops.surface.find_halfedge(vertices[k], vertices[(k + 1) % vertices.size()]));
    }
    loops.surface.slice(path);
    return loops.surface;
}

// The pieces of a surface that is cut into pants, or that has none, map one to one.
void require_maps_of_pieces(const std::string& file, const TriangleSoup& soup) {
    SurfaceMesh mesh = make_surface_mesh(soup);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    std::map<int, std::vector<FaceHandle>> faces;
    for (const auto face : mesh.faces()) faces[pants.patch_of_face[face.idx()]].push_back(face);
    REQUIRE(faces.size() == pants.patches.size());
    for (const auto& [patch, faces_of_patch] : faces) {
        INFO(file << ", patch " << patch);
        const CutSurface piece(mesh, faces_of_patch, curve_seams(mesh));
        switch (piece.euler_characteristic()) {
            case -1:
                require_maps_of_pant(piece);
                break;
            case 0:
                require_maps_of_annulus(piece.boundary_loops().empty() ? cut_along_handle(piece)
                                                                       : piece);
                break;
            case 1:
                require_maps_of_disc(piece);
                break;
            default:
                require_maps_of_disc(slit(piece));
        }
    }
}

}  // namespace

TEST_CASE("harmonic maps: no flipped triangle on any public surface", "[meshing][topology]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const std::string& file : public_surface_files()) {
        require_maps_of_pieces(file, read_surface(*folder / "surfaces" / file));
    }
    // Triangles of these run against each other until they are repaired.
    for (const char* moment : {"00", "05", "10", "15"}) {
        const std::string file = std::string("vampy_moving_atrium_") + moment + ".off";
        RepairedSurface repaired = repair_surface(read_surface(*folder / "surfaces" / file));
        orient_outwards(repaired.soup, repaired.turned);
        require_maps_of_pieces(file, repaired.soup);
    }
}
