// The public surfaces have the numbers that the list beside them gives, found by other programs.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/surface_info.h"
#include "meshing/surface/features.h"
#include "meshing/surface/soup_sides.h"
#include "meshing/topology/invariants.h"
#include "tests/data_folder.h"

using namespace couture;
using namespace couture::meshing;

namespace {

/// Edges with more than two triangles, and those that two run along in the same direction.
std::pair<int, int> count_bad_edges(const TriangleSoup& soup) {
    int n_bad = 0;
    int n_inconsistent = 0;
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        n_bad += edge.size() > 2 ? 1 : 0;
        n_inconsistent += edge.size() == 2 && edge[0].is_forward == edge[1].is_forward ? 1 : 0;
    }
    return {n_bad, n_inconsistent};
}

/// Of the cone over the triangles from the origin, whichever way they run.
double cone_volume(const TriangleSoup& soup) {
    double volume = 0.0;
    for (const auto& [a, b, c] : soup.triangles) {
        volume += soup.points[a].dot(soup.points[b].cross(soup.points[c])) / 6.0;
    }
    return volume;
}

}  // namespace

TEST_CASE("public surfaces: as read and repaired they are what the list says", "[io]") {
    const auto data = test::data_folder();
    if (!data) return;
    std::ifstream stream(*data / "surfaces" / "oracle.json");
    const auto list = nlohmann::json::parse(stream);
    REQUIRE(list.size() >= 20);
    for (const auto& [name, expected] : list.items()) {
        CAPTURE(name);
        const io::SurfaceFile file = io::read_surface_file(*data / "surfaces" / name);
        CHECK(file.n_polygons_read == expected["F"].get<int>());
        RepairedSurface repaired = repair_surface(file.soup);
        orient_outwards(repaired.soup, repaired.turned);
        const SurfaceMesh mesh = make_surface_mesh(repaired.soup);
        const auto invariants = compute_invariants(mesh);
        CHECK(invariants.n_vertices == expected["V"].get<int>());
        CHECK(invariants.genus == expected["genus"].get<double>());
        CHECK(invariants.n_boundaries == expected["boundaries"].get<int>());
        CHECK(invariants.euler_characteristic == expected["chi"].get<int>());
        const auto [n_bad, n_inconsistent] = count_bad_edges(file.soup);
        CHECK(n_inconsistent == expected["inconsistent_halfedges"].get<int>());
        CHECK(n_bad == expected["nonmanifold_edges"].get<int>());
        // Quads that are not flat: the volume depends on the diagonals.
        const double volume = expected["signed_volume"].get<double>();
        const double tolerance = expected["faces"].contains("4") ? 5e-3 : 1e-9;
        // Of triangles that run against each other the list has the sum as they are in the file.
        const double found = n_inconsistent > 0 ? cone_volume(file.soup) : signed_volume(mesh);
        CHECK(found == Approx(volume).epsilon(tolerance));
        int n_sharp = 0;
        for (const auto edge : mesh.edges()) {
            n_sharp += dihedral_angle(mesh, edge) > 40.0 * std::numbers::pi / 180.0 ? 1 : 0;
        }
        // The list counts edges between triangles that run against each other as sharp: their
        // normals are opposite. Turned to run alike there are none.
        CHECK(n_sharp == expected["sharp_edges_40deg"].get<int>() - n_inconsistent);
        CHECK(check_solid(repaired.soup).count(FlawKind::non_manifold_vertex) == 0);
    }
}
