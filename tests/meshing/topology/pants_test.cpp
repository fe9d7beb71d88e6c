#include "meshing/topology/pants.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "iga/core/error.h"
#include "meshing/topology/homotopic_cycle.h"
#include "meshing/topology/pants_record.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// A square plate with `holes` square holes in a row, flat: a sphere with holes + 1 boundaries.
TriangleSoup make_flat_plate(int holes, int n) {
    TriangleSoup soup;
    std::map<std::pair<int, int>, int> number;
    const auto at = [&](int i, int j) {
        const auto [entry, is_new] =
            number.try_emplace({i, j}, static_cast<int>(soup.points.size()));
        if (is_new) {
            soup.points.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0);
        }
        return entry->second;
    };
    for (int i = 0; i < (2 * holes + 1) * n; ++i) {
        for (int j = 0; j < 3 * n; ++j) {
            if ((i / n) % 2 == 1 && j / n == 1) continue;
            soup.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            soup.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return soup;
}

void require_valid(const SurfaceMesh& mesh, const PantsDecomposition& pants) {
    std::set<int> seen;
    for (const PantsCurve& curve : pants.curves) {
        for (const VertexHandle vertex : curve.curve.vertices) {
            REQUIRE(seen.insert(vertex.idx()).second);
        }
    }
    REQUIRE(pants.patch_of_face.size() == mesh.n_faces());
    std::map<CurveSide, int> n_uses;
    for (const PantsPatch& patch : pants.patches) {
        for (const CurveSide& side : patch.boundary) ++n_uses[side];
    }
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        const bool is_boundary = pants.curves[c].kind == PantsCurveKind::boundary;
        const int number = static_cast<int>(c);
        REQUIRE(n_uses[{number, true}] + n_uses[{number, false}] == (is_boundary ? 1 : 2));
    }
}

}  // namespace

TEST_CASE("pants: -chi pants, each of Euler characteristic -1", "[meshing][topology]") {
    const int genus = GENERATE(2, 3, 5);
    const int n = GENERATE(1, 2, 3);
    SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(genus, n));
    const double volume = signed_volume(mesh);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    REQUIRE(pants.genus == genus);
    REQUIRE(static_cast<int>(pants.patches.size()) == 2 * genus - 2);
    REQUIRE(static_cast<int>(pants.curves.size()) == 3 * genus - 3);
    REQUIRE(static_cast<int>(pants.tunnels.size()) == genus);
    for (const PantsPatch& patch : pants.patches) REQUIRE(patch.euler_characteristic() == -1);
    require_valid(mesh, pants);
    REQUIRE(signed_volume(mesh) == Approx(volume).epsilon(1e-12));
}

TEST_CASE("pants: the same input gives the same curves", "[meshing][topology]") {
    const TriangleSoup soup = make_plate_with_holes(3, 2);
    SurfaceMesh first = make_surface_mesh(soup);
    SurfaceMesh second = make_surface_mesh(soup);
    const auto a = decompose_into_pants(first);
    const auto b = decompose_into_pants(second);
    REQUIRE(a.patch_of_face == b.patch_of_face);
    REQUIRE(a.curves.size() == b.curves.size());
    for (std::size_t c = 0; c < a.curves.size(); ++c) {
        REQUIRE(a.curves[c].curve.vertices == b.curves[c].curve.vertices);
        REQUIRE(a.curves[c].length == b.curves[c].length);
    }
}

TEST_CASE("pants: surfaces with boundary and without pants", "[meshing][topology]") {
    SurfaceMesh plate = make_surface_mesh(make_flat_plate(4, 3));
    const auto pants = decompose_into_pants(plate);
    REQUIRE(pants.patches.size() == 3);
    require_valid(plate, pants);
    SurfaceMesh pant = make_surface_mesh(make_flat_plate(2, 3));
    REQUIRE(decompose_into_pants(pant).patches.front().boundary.size() == 3);

    for (const TriangleSoup& soup :
         {make_cube(2), make_square(3), make_tube(8, 4, 1.0, 2.0), make_torus(12, 8, 2.0, 0.5)}) {
        SurfaceMesh mesh = make_surface_mesh(soup);
        const auto whole = decompose_into_pants(mesh);
        REQUIRE(whole.patches.size() == 1);
        REQUIRE(whole.patches.front().euler_characteristic() >= 0);
    }
}

TEST_CASE("pants: criteria with weights cut validly; the symmetric plane is found",
          "[meshing][topology]") {
    for (const CriterionWeights& weights : {CriterionWeights{.length = 1.0, .symmetry = 5.0},
                                            CriterionWeights{.length = 1.0, .curvature = 3.0}}) {
        SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(2, 4));
        const auto pants = decompose_into_pants(mesh, {.cycle = weights, .merge = weights});
        REQUIRE(pants.patches.size() == 2);
        require_valid(mesh, pants);
    }
    const auto planes = find_symmetry_planes(make_surface_mesh(make_plate_with_holes(2, 4)));
    REQUIRE(planes.size() == 3);
    for (const auto& plane : planes) {
        const Vector3 centre(2.5, 1.5, 0.5);
        REQUIRE(plane.offset == Approx(plane.normal.dot(centre)).margin(1e-12));
    }
}

TEST_CASE("pants: errors name the cause", "[meshing][topology]") {
    SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(2, 2));
    REQUIRE_THROWS_WITH(decompose_into_pants(mesh, {.cycle = {.length = 0.0}}),
                        Catch::Contains("criterion of the cycle") && Catch::Contains("all 0"));
    REQUIRE_THROWS_WITH(decompose_into_pants(mesh, {.merge = {.symmetry = -1.0}}),
                        Catch::Contains("weight -1"));
    static_cast<void>(decompose_into_pants(mesh));
    REQUIRE_THROWS_WITH(decompose_into_pants(mesh), Catch::Contains("already"));
}

TEST_CASE("pants: the shells of a solid with cavities are cut one by one", "[meshing][topology]") {
    const auto placed = [](TriangleSoup soup, double factor, const Vector3& shift, bool is_cavity) {
        for (Vector3& point : soup.points) point = factor * point + shift;
        for (auto& triangle : soup.triangles) {
            if (is_cavity) std::swap(triangle[1], triangle[2]);
        }
        return soup;
    };
    const TriangleSoup plate = make_plate_with_holes(2, 3);
    const TriangleSoup torus = make_torus(12, 8, 2.0, 0.5);
    const TriangleSoup solid =
        join(join(placed(plate, 100.0, {0, 0, 0}, false), placed(plate, 4.0, {20, 20, 40}, true)),
             join(placed(torus, 5.0, {50, 50, 50}, true),
                  placed(make_cube(2), 5.0, {10, 200, 50}, true)));
    SurfaceMesh mesh = make_surface_mesh(solid);
    const PantsDecomposition pants = decompose_into_pants(mesh);
    require_valid(mesh, pants);
    CHECK(pants.genus == 5);
    CHECK(pants.curves.size() == 6);
    CHECK(pants.tunnels.size() == 5);
    std::map<int, std::vector<int>> chi_of_shell;
    for (const PantsPatch& patch : pants.patches) {
        chi_of_shell[patch.shell].push_back(patch.euler_characteristic());
    }
    CHECK(chi_of_shell ==
          std::map<int, std::vector<int>>{{0, {-1, -1}}, {1, {-1, -1}}, {2, {0}}, {3, {2}}});

    // In the material around a cavity a disc spans what is a tunnel of the same shape as a body.
    SurfaceMesh body = make_surface_mesh(torus);
    SurfaceMesh cavity = make_surface_mesh(placed(torus, 1.0, {0, 0, 0}, true));
    const auto length_of_tunnel = [](SurfaceMesh& surface) {
        const auto loop = decompose_into_pants(surface).tunnels.front();
        double length = 0.0;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            length += (loop[(k + 1) % loop.size()] - loop[k]).norm();
        }
        return length;
    };
    // Polygons of 12 and 8 corners: the long way inside, the short way around the tube.
    CHECK(length_of_tunnel(body) == Approx(24.0 * 1.5 * std::sin(std::acos(-1.0) / 12.0)));
    CHECK(length_of_tunnel(cavity) == Approx(16.0 * 0.5 * std::sin(std::acos(-1.0) / 8.0)));

    // The same again from the record, on shells in another order.
    const PantsRecord record = record_pants(mesh, pants, {});
    SurfaceMesh again = make_surface_mesh(
        join(join(placed(make_cube(2), 5.0, {10, 200, 50}, true),
                  placed(plate, 4.0, {20, 20, 40}, true)),
             join(placed(torus, 5.0, {50, 50, 50}, true), placed(plate, 100.0, {0, 0, 0}, false))));
    const PantsDecomposition replayed = replay_pants(again, record, {}, {});
    REQUIRE(replayed.patches.size() == pants.patches.size());
    for (std::size_t p = 0; p < pants.patches.size(); ++p) {
        CHECK(replayed.patches[p].boundary == pants.patches[p].boundary);
        CHECK(replayed.patches[p].shell == pants.patches[p].shell);
        CHECK(replayed.patches[p].genus == pants.patches[p].genus);
    }
}

TEST_CASE("homotopic cycle: around two holes of a flat plate it is the shortest box",
          "[meshing][topology]") {
    // Three holes: the cycle around two neighbours keeps one edge off them.
    const int n = 4;
    const CutSurface plate(make_flat_plate(3, n));
    const HomotopicCycles cycles(plate);
    REQUIRE(cycles.loops().size() == 4);
    std::vector<int> holes;
    for (int i = 0; i < 4; ++i) {
        if (cycles.loops()[i].size() == 4 * n) holes.push_back(i);
    }
    REQUIRE(holes.size() == 3);
    const auto centre = [&](int i) { return plate.point(plate.origin(cycles.loops()[i][0]))[0]; };
    std::sort(holes.begin(), holes.end(), [&](int a, int b) { return centre(a) < centre(b); });
    const auto cycle = cycles.find(holes[0], holes[1]);
    // Box of 3 x 1 units, one edge of 1/n wider on each side; two corners are cut by diagonals.
    const double h = 1.0 / n;
    const double box = 2.0 * (3.0 + 2.0 * h) + 2.0 * (1.0 + 2.0 * h);
    REQUIRE(cycle.weight == Approx(box - 2.0 * (2.0 - std::sqrt(2.0)) * h).epsilon(1e-12));
    double winding = 0.0;
    for (std::size_t k = 0; k < cycle.vertices.size(); ++k) {
        const Vector3& p = cycle.surface.point(cycle.vertices[k]);
        const Vector3& q = cycle.surface.point(cycle.vertices[(k + 1) % cycle.vertices.size()]);
        winding += p[0] * q[1] - p[1] * q[0];
    }
    REQUIRE(0.5 * winding > 3.0);
    REQUIRE_THROWS_AS(cycles.find(0, 0), InputError);
    REQUIRE_THROWS_AS(cycles.find(0, 4), InputError);
    REQUIRE_THROWS_AS(HomotopicCycles(CutSurface(make_square(2))), TopologyError);
}

TEST_CASE("pants: public surfaces of any genus", "[meshing][topology]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const PublicSurface& surface : public_surfaces()) {
        INFO(surface.file);
        SurfaceMesh mesh = make_surface_mesh(read_off(*folder / "surfaces" / surface.file));
        const auto pants = decompose_into_pants(mesh);
        REQUIRE(pants.genus == surface.genus);
        const int n_patches = std::max(1, -surface.euler_characteristic);
        REQUIRE(static_cast<int>(pants.patches.size()) == n_patches);
        require_valid(mesh, pants);
    }
}
