#include "meshing/parameterization/node_relocation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/parameterization/map_samples.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/parameterization/sample_quality.h"
#include "tests/meshing/parameterization/layout_surfaces.h"

using namespace couture;
using namespace couture::meshing;

namespace {

LayoutSamples samples_of(const LaidOutSurface& surface, int n_cells) {
    const std::vector<int> cells(surface.embedding.layout.n_arcs(), n_cells);
    return sample_layout_map(surface.mesh, surface.embedding,
                             make_layout_map(surface.mesh, surface.embedding, cells));
}

}  // namespace

TEST_CASE("relocate nodes: a cube off the centre of a sphere becomes even", "[parameterization]") {
    const LaidOutSurface sphere = make_sphere_layout(14, {0.4, 0.3, 0.5});
    const LayoutSamples start = samples_of(sphere, 6);
    // Nothing holds a sphere's nodes from turning together: it takes long until they stand still.
    NodeRelocationOptions options;
    options.tolerance = 1e-5;
    const RelocatedSamples moved = relocate_nodes(sphere.mesh, sphere.embedding, start, options);
    CHECK(moved.report.is_converged);
    CHECK(moved.report.n_inverted == 0);
    CHECK(moved.report.largest_move > 0.5);
    const QuadQuality before = quad_quality(to_quad_mesh(start), sphere.mesh);
    const QuadQuality after = quad_quality(to_quad_mesh(moved.samples), sphere.mesh);
    // The cube's own angles at a corner are 120 degrees, whose sine is 0.866.
    CHECK(before.smallest_scaled_jacobian < 0.2);
    CHECK(after.smallest_scaled_jacobian > 0.78);
    CHECK(after.mean_scaled_jacobian > 0.9);
    // Nodes at the corners of a cube in the sphere.
    for (const MatrixX& arc : moved.samples.arcs) {
        CHECK((arc.col(0) - arc.rightCols(1)).norm() == Approx(2.0 / std::sqrt(3.0)).epsilon(0.03));
    }
}

TEST_CASE("relocate nodes: cells are as long as wanted", "[parameterization]") {
    const LaidOutSurface sphere = make_sphere_layout(14, {0.0, 0.0, 0.0});
    const LayoutSamples start = samples_of(sphere, 6);
    const QuadLayout& layout = sphere.embedding.layout;
    // The arcs of a first quad are wanted longer than all others.
    NodeRelocationOptions options;
    options.cell_lengths.assign(layout.n_arcs(), 1.0);
    const auto length = [&](const LayoutSamples& samples) {
        double sum = 0.0;
        for (const QuadLayout::Side& side : layout.sides(0)) {
            const MatrixX& arc = samples.arcs[side.arc];
            sum += (arc.col(0) - arc.rightCols(1)).norm();
        }
        return sum;
    };
    const RelocatedSamples even = relocate_nodes(sphere.mesh, sphere.embedding, start, options);
    for (const QuadLayout::Side& side : layout.sides(0)) options.cell_lengths[side.arc] = 1.4;
    const RelocatedSamples longer = relocate_nodes(sphere.mesh, sphere.embedding, start, options);
    CHECK(length(even.samples) == Approx(8.0 / std::sqrt(3.0)).epsilon(0.03));
    CHECK(length(longer.samples) > 1.1 * length(even.samples));
    options.cell_lengths.pop_back();
    CHECK_THROWS_WITH(relocate_nodes(sphere.mesh, sphere.embedding, start, options),
                      Catch::Contains("11 lengths of cells for 12 arcs"));
}

TEST_CASE("relocate nodes: corners stay, features keep their points", "[parameterization]") {
    const LaidOutSurface can = make_can_layout(12, 0.7);
    const LayoutSamples start = samples_of(can, 5);
    const RelocatedSamples moved = relocate_nodes(can.mesh, can.embedding, start);
    CHECK(moved.report.energies.back() < moved.report.energies.front());
    double twist = 0.0;
    double twist_at_start = 0.0;
    for (int a = 0; a < can.embedding.layout.n_arcs(); ++a) {
        const MatrixX& arc = moved.samples.arcs[a];
        if (can.embedding.is_feature_arc[a]) {
            for (int i = 0; i < arc.cols(); ++i) {
                CHECK(std::abs(arc(2, i)) == Approx(1.0).margin(1e-12));
                CHECK(arc.col(i).head<2>().norm() > 0.98);
            }
        } else {
            const auto turn = [](const MatrixX& upright) {
                const Vector2 a_end = upright.col(0).head<2>();
                const Vector2 b_end = upright.rightCols(1).topRows(2);
                return (a_end - b_end).norm();
            };
            twist = std::max(twist, turn(arc));
            twist_at_start = std::max(twist_at_start, turn(start.arcs[a]));
        }
    }
    CHECK(twist_at_start > 0.6);
    CHECK(twist < 0.1);

    const LaidOutSurface cube = make_cube_layout(
        4, [](const Vector3& p) { return p; }, [](const auto&) { return true; });
    const LayoutSamples flat = samples_of(cube, 4);
    const RelocatedSamples same = relocate_nodes(cube.mesh, cube.embedding, flat);
    CHECK(same.report.energies.back() == Approx(1.0).margin(1e-9));
    CHECK(same.report.largest_move == 0.0);
    const QuadQuality quality = quad_quality(to_quad_mesh(same.samples), cube.mesh);
    CHECK(quality.smallest_scaled_jacobian == Approx(1.0).margin(1e-5));
    CHECK(quality.largest_edge_ratio == Approx(1.0).margin(1e-5));
    CHECK(quality.hausdorff_distance < 1e-9);
}

TEST_CASE("relocate nodes: a finger of the surface stays covered", "[parameterization]") {
    // On the cube's upper face, steep enough for the grid to have less energy without it.
    const auto move = [](const Vector3& p) {
        const double r = p.head<2>().norm();
        return p.z() < 1.0 ? p
                           : Vector3(p + 1.5 * std::exp(-std::pow(r / 0.35, 4)) * Vector3::UnitZ());
    };
    const LaidOutSurface cube = make_cube_layout(24, move, [](const auto&) { return true; });
    const LayoutSamples start = samples_of(cube, 10);
    const RelocatedSamples moved = relocate_nodes(cube.mesh, cube.embedding, start);
    CHECK(moved.report.n_inverted == 0);
    CHECK(moved.report.energies.back() < moved.report.energies.front());
    const double before = quad_quality(to_quad_mesh(start), cube.mesh).hausdorff_distance;
    const double after = quad_quality(to_quad_mesh(moved.samples), cube.mesh).hausdorff_distance;
    CAPTURE(before, after);
    CHECK(before < 0.03);
    CHECK(after < 0.05);
}

TEST_CASE("relocate nodes: a point pushed over its neighbours comes back", "[parameterization]") {
    const LaidOutSurface cube = make_cube_layout(
        4, [](const Vector3& p) { return p; }, [](const auto&) { return true; });
    constexpr int n_cells = 6;
    LayoutSamples pushed = samples_of(cube, n_cells);
    const LayoutSamples even = pushed;
    constexpr int middle = 3 * (n_cells + 1) + 3;
    MatrixX& points = pushed.quads[0];
    points.col(middle) += 1.7 * (points.col(middle + 1) - points.col(middle)) +
                          0.4 * (points.col(middle + n_cells + 1) - points.col(middle));
    const RelocatedSamples moved = relocate_nodes(cube.mesh, cube.embedding, pushed);
    CHECK(moved.report.n_inverted_at_start > 0);
    CHECK(moved.report.n_inverted == 0);
    for (std::size_t q = 0; q < even.quads.size(); ++q) {
        CHECK((moved.samples.quads[q] - even.quads[q]).cwiseAbs().maxCoeff() < 1e-3);
    }
}

TEST_CASE("refine samples: points stay on the surface, coarse ones where they were",
          "[parameterization]") {
    const LaidOutSurface sphere = make_sphere_layout(10, Vector3::Zero());
    const LayoutSamples coarse = samples_of(sphere, 3);
    const LayoutSamples fine = refine_samples(sphere.mesh, sphere.embedding, coarse, 3);
    CHECK(fine.n_cells.front() == 9);
    for (std::size_t q = 0; q < fine.quads.size(); ++q) {
        CHECK((fine.quads[q].col(3 * 10 + 3) - coarse.quads[q].col(4 + 1)).norm() < 1e-12);
    }
    // Chords of the sphere sag by less than its facets and no more.
    const QuadQuality quality = quad_quality(to_quad_mesh(fine), sphere.mesh);
    CHECK(quality.hausdorff_distance < 0.01);
    CHECK(quality.smallest_scaled_jacobian > 0.7);
    CHECK_THROWS_AS(refine_samples(sphere.mesh, sphere.embedding, coarse, 0), InputError);
}

TEST_CASE("refine samples: points stay on their side of edges that bend into a cell",
          "[parameterization]") {
    // A cube with one side pushed in: its edges bend into the quads above and below, which have
    // two cells per direction.
    const LaidOutSurface cube = make_cube_layout(
        16,
        [](const Vector3& x) {
            const double part = 0.225 * (1.0 + x.x()) * (1.0 - x.y() * x.y());
            return Vector3(x.x() - part, x.y(), x.z());
        },
        [](const std::vector<Vector3>&) { return true; });
    const LayoutSamples coarse = samples_of(cube, 2);
    REQUIRE(!worst_turned_corner(coarse, cube.mesh));
    const LayoutSamples fine = refine_samples(cube.mesh, cube.embedding, coarse, 4);
    CHECK(!worst_turned_corner(fine, cube.mesh));
    CHECK(quad_quality(to_quad_mesh(fine), cube.mesh).smallest_scaled_jacobian > 0.2);
}
