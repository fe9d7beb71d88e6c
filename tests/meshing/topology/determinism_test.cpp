#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "iga/core/parallel.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/curvature.h"
#include "meshing/surface/harmonic_map.h"
#include "meshing/surface/open_pant.h"
#include "meshing/surface/surface_curves.h"
#include "meshing/topology/cut_graph.h"
#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/pants.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// All that came out, bit by bit.
class Record {
  public:
    void add(double x) { bits_.push_back(std::bit_cast<std::uint64_t>(x)); }
    void add(int x) { bits_.push_back(static_cast<std::uint64_t>(x)); }
    void add(const Vector3& p) {
        for (int i = 0; i < 3; ++i) add(p[i]);
    }
    void add(const std::vector<int>& numbers) {
        for (const int x : numbers) add(x);
    }
    void add(const TriangleSoup& soup) {
        for (const Vector3& p : soup.points) add(p);
        for (const auto& triangle : soup.triangles) {
            for (const int v : triangle) add(v);
        }
    }
    void add(const HarmonicMap& map) {
        for (const Vector2& x : map.parameters) {
            add(x.x());
            add(x.y());
        }
        add(map.report.residual);
        add(map.report.distortion.mean_angle_change);
    }
    [[nodiscard]] const std::vector<std::uint64_t>& bits() const { return bits_; }

  private:
    std::vector<std::uint64_t> bits_;
};

void add_loops(Record& record, const CutSurface& surface) {
    const HandleTunnelLoops loops = find_handle_tunnel_loops(surface);
    for (const auto* kind : {&loops.handles, &loops.tunnels}) {
        for (const HomologyLoop& loop : *kind) {
            record.add(loop.vertices);
            record.add(loop.homology_class);
            record.add(loop.length);
        }
    }
}

void add_pants(Record& record, SurfaceMesh& mesh) {
    const PantsDecomposition pants = decompose_into_pants(mesh);
    record.add(to_soup(mesh));
    record.add(pants.patch_of_face);
    for (const PantsCurve& curve : pants.curves) {
        for (const VertexHandle v : curve.curve.vertices) record.add(v.idx());
        record.add(curve.length);
    }
    std::vector<std::vector<FaceHandle>> faces(pants.patches.size());
    for (const auto face : mesh.faces()) faces[pants.patch_of_face[face.idx()]].push_back(face);
    for (const auto& faces_of_patch : faces) {
        CutSurface piece(mesh, faces_of_patch, curve_seams(mesh));
        if (piece.euler_characteristic() == -1) {
            const auto corners = open_pant(piece);
            record.add(map_opened_pant(piece, corners, 1.0, 1.0));
        } else {
            CutSurface disc = open_to_disc(piece);
            record.add(map_disc_to_polygon(disc, spread_corners(disc, 4), square_corners()));
        }
    }
}

std::vector<std::uint64_t> run(const TriangleSoup& soup) {
    Record record;
    add_loops(record, CutSurface(soup));
    SurfaceMesh mesh = make_surface_mesh(soup);
    for (const PrincipalCurvatures& curvature : principal_curvatures(mesh)) {
        record.add(curvature.minimum);
        record.add(curvature.maximum);
        record.add(curvature.normal);
    }
    for (const double curvature : gaussian_curvature(mesh)) record.add(curvature);
    add_pants(record, mesh);
    return record.bits();
}

void require_same_bits(const TriangleSoup& soup) {
    const int n_before = n_threads();
    set_n_threads(1);
    const auto first = run(soup);
    const bool is_same_again = run(soup) == first;
    set_n_threads(2);
    const bool is_same_on_two_threads = run(soup) == first;
    set_n_threads(n_before);
    REQUIRE(!first.empty());
    CHECK(is_same_again);
    CHECK(is_same_on_two_threads);
}

}  // namespace

TEST_CASE(
    "determinism: loops, pants, maps and curvature have the same bits again and on two "
    "threads",
    "[meshing][topology]") {
    require_same_bits(make_plate_with_holes(3, 4));
    require_same_bits(make_torus(24, 16, 2.0, 0.5));
    for (const char* part : {"sierpinski", "casting"}) {
        INFO(part);
        require_same_bits(make_part_surface(part, {}, 12.0).soup);
    }
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const char* file : {"hexgen_rod.off", "hexgen_mount1.off", "igl_3holes.off",
                             "vampy_atrium.off", "vampy_ventricle.stl", "wingnut.obj"}) {
        INFO(file);
        require_same_bits(read_surface(*folder / "surfaces" / file));
    }
}
