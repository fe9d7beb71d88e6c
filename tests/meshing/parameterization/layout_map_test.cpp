#include "meshing/parameterization/layout_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/field/layout_field.h"
#include "meshing/parameterization/map_samples.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/parameterization/sheet_sizes.h"
#include "meshing/parameterization/symmetric_dirichlet.h"
#include "tests/meshing/parameterization/layout_surfaces.h"

using namespace couture;
using namespace couture::meshing;

namespace {

std::vector<int> cells_of(const LaidOutSurface& surface, double size) {
    return cells_of_arcs(surface.embedding.layout,
                         sheet_sizes(surface.mesh, surface.embedding, {.target_size = size}));
}

LayoutMap map_of(const LaidOutSurface& surface, double size, const LayoutMapOptions& options = {}) {
    return make_layout_map(surface.mesh, surface.embedding, cells_of(surface, size), options);
}

const auto same = [](const Vector3& p) { return p; };
const auto all = [](const auto&) { return true; };

}  // namespace

TEST_CASE("symmetric Dirichlet: gradient and curvature by differences", "[parameterization]") {
    Matrix<2> F;
    F << 0.7, -0.4, 0.9, 1.3;
    const SymmetricDirichlet term(F);
    constexpr double step = 1e-5;
    for (int k = 0; k < 4; ++k) {
        Matrix<2> direction = Matrix<2>::Zero();
        direction(k / 2, k % 2) = 1.0;
        const double after = symmetric_dirichlet(F + step * direction);
        const double before = symmetric_dirichlet(F - step * direction);
        CHECK(term.gradient(k / 2, k % 2) == Approx((after - before) / (2.0 * step)).epsilon(1e-7));
    }
    constexpr double wide = 1e-4;
    for (int m = 0; m < 4; ++m) {
        const double curvature =
            (symmetric_dirichlet(F + wide * term.modes[m]) - 2.0 * term.energy +
             symmetric_dirichlet(F - wide * term.modes[m])) /
            (wide * wide);
        CHECK(term.eigenvalues[m] == Approx(std::max(0.0, curvature)).margin(1e-6));
        for (int n = 0; n < m; ++n) {
            CHECK(term.modes[m].cwiseProduct(term.modes[n]).sum() == Approx(0.0).margin(1e-14));
        }
    }
    Matrix<2> turn;
    turn << 0.6, -0.8, 0.8, 0.6;
    CHECK(symmetric_dirichlet(turn) == Approx(1.0));
    Matrix<2> mirror = Matrix<2>::Identity();
    mirror(1, 1) = -1.0;
    CHECK(std::isinf(symmetric_dirichlet(mirror)));
}

TEST_CASE("layout charts: transitions carry corners to corners", "[parameterization]") {
    const LaidOutSurface cube = make_cube_layout(2, same, all);
    const QuadLayout& layout = cube.embedding.layout;
    const std::vector<int> sizes{2, 3, 4};
    const LayoutCharts charts(layout, cells_of_arcs(layout, sizes));
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto& [left, right] = layout.arc_quads(a);
        const ChartTransition& across = charts.across(a);
        CHECK(across(charts.corner(left.quad, left.side)) ==
              charts.corner(right.quad, right.side + 1));
        CHECK(across(charts.corner(left.quad, left.side + 1)) ==
              charts.corner(right.quad, right.side));
        CHECK(across.inverse().after(across) == ChartTransition{});
    }
    CHECK_THROWS_AS(LayoutCharts(layout, std::vector<int>(3, 1)), InputError);
    std::vector<int> uneven(layout.n_arcs(), 1);
    uneven[0] = 2;
    // Arc 0 joins nodes 0 and 1, and faces those of nodes 2 and 3 and of nodes 4 and 5.
    CHECK_THROWS_WITH(LayoutCharts(layout, uneven),
                      Catch::Contains("2 on the arc of nodes 0 and 1") &&
                          Catch::Contains("1 on the arc of nodes 2 and 3") &&
                          Catch::Contains("arcs that face each other must have the same"));
}

TEST_CASE("sheet sizes: lengths over the target, rounded", "[parameterization]") {
    const LaidOutSurface box = make_cube_layout(
        2, [](const Vector3& p) { return Vector3(p.x(), 2.0 * p.y(), 0.1 * p.z()); }, all);
    std::vector<int> sizes = sheet_sizes(box.mesh, box.embedding, {.target_size = 0.5});
    std::sort(sizes.begin(), sizes.end());
    CHECK(sizes == std::vector<int>{1, 4, 8});
    CHECK(sheet_sizes(box.mesh, box.embedding, {.min_cells = 3}) == std::vector<int>(3, 3));
    CHECK_THROWS_AS(sheet_sizes(box.mesh, box.embedding, {.min_cells = 0}), InputError);
    CHECK_THROWS_AS(cells_of_arcs(box.embedding.layout, std::vector<int>{1, 0, 2}), InputError);
    CHECK_THROWS_AS(cells_of_arcs(box.embedding.layout, std::vector<int>{1}), InputError);
}

TEST_CASE("layout map: the cube is flat, each face a square", "[parameterization]") {
    const LaidOutSurface cube = make_cube_layout(4, same, all);
    const LayoutMap map = map_of(cube, 0.5);
    CHECK(map.report.n_flipped == 0);
    CHECK(map.report.energies.back() == Approx(1.0).margin(1e-9));
    CHECK(map.report.cell_size == Approx(0.5));
    CHECK(map.report.distortion.largest_angle_change < 1e-6);
    const LayoutSamples samples = sample_layout_map(cube.mesh, cube.embedding, map, 3);
    for (const MatrixX& quad : samples.quads) {
        CHECK(quad.cols() == 13 * 13);
        // Every step along s has the same length.
        CHECK((quad.col(1) - quad.col(0)).norm() == Approx(2.0 / 12.0));
        CHECK((quad.col(100) - quad.col(99)).norm() == Approx(2.0 / 12.0));
    }
}

TEST_CASE("layout map: arcs of a developable surface straighten", "[parameterization]") {
    const LaidOutSurface tube = make_tube_layout(12, true);
    const std::vector<int> cells = cells_of(tube, 0.2);
    LayoutMapOptions options;
    // Of an isometry: the prism's sides and its height.
    const std::vector<double> lengths = arc_lengths(tube.mesh, tube.embedding);
    const QuadLayout& layout = tube.embedding.layout;
    const std::vector<int> sheets = layout.sheets();
    options.cell_lengths.assign(*std::max_element(sheets.begin(), sheets.end()) + 1, 0.0);
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const bool is_upright = !layout.is_boundary_arc(a);
        options.cell_lengths[sheets[a]] = (is_upright ? 2.0 : lengths[a]) / cells[a];
    }
    options.tolerance = 1e-12;
    const LayoutMap map = make_layout_map(tube.mesh, tube.embedding, cells, options);
    const auto& report = map.report;
    CHECK(report.n_flipped == 0);
    CHECK(report.energies.front() > 2.0);
    CHECK(report.energies.back() == Approx(1.0).margin(1e-8));
    CHECK(report.cell_size == Approx(1.0).margin(1e-6));
    CHECK(report.distortion.largest_angle_change < 1e-4);
    CHECK(report.distortion.largest_area_ratio == Approx(1.0).margin(1e-4));
    // The upright arcs are straight lines now.
    const LayoutSamples samples = sample_layout_map(tube.mesh, tube.embedding, map);
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (layout.is_boundary_arc(a)) continue;
        for (int i = 0; i < samples.arcs[a].cols(); ++i) {
            const Vector2 off = (samples.arcs[a].col(i) - samples.arcs[a].col(0)).head<2>();
            CHECK(off.norm() < 1e-4);
        }
    }
    // Without optimisation it stays as it starts.
    options.route = LayoutMapRoute::harmonic;
    const LayoutMap harmonic = make_layout_map(tube.mesh, tube.embedding, cells, options);
    CHECK(harmonic.report.energies == std::vector<double>{report.energies.front()});
}

TEST_CASE("layout map: no step flips a triangle or raises the energy", "[parameterization]") {
    const auto check = [](const LaidOutSurface& surface) {
        const LayoutMap map = map_of(surface, 0.2);
        CHECK(map.report.n_flipped == 0);
        CHECK(map.report.is_converged);
        CHECK(map.report.energies.size() > 2);
        for (std::size_t i = 1; i < map.report.energies.size(); ++i) {
            CHECK(map.report.energies[i] <= map.report.energies[i - 1]);
        }
        // Points of nodes, and borders on both sides, are the same to the last bit.
        const QuadLayout& layout = surface.embedding.layout;
        const LayoutSamples samples = sample_layout_map(surface.mesh, surface.embedding, map, 2);
        const QuadMesh quads = to_quad_mesh(samples);
        CHECK(quads.quads.size() == [&] {
            std::size_t n = 0;
            for (int q = 0; q < layout.n_quads(); ++q) {
                const auto [n_s, n_t] = map.charts.size(q);
                n += static_cast<std::size_t>(4 * n_s * n_t);
            }
            return n;
        }());
        for (int a = 0; a < layout.n_arcs(); ++a) {
            const VertexHandle node = surface.embedding.nodes[layout.arcs()[a].from];
            CHECK(samples.arcs[a].col(0) == surface.mesh.point(node));
        }
    };
    SECTION("sphere") { check(make_sphere_layout(10, {0.4, 0.3, 0.5})); }
    SECTION("can with turned lid") { check(make_can_layout(10, 0.6)); }
    SECTION("torus, three uneven sections") { check(make_torus_layout(8, {0, 12, 32}, {0, 2, 4})); }
    SECTION("torus, turned within a vertex") { check(make_torus_layout(8, {0, 2, 32}, {0, 3, 6})); }
}

TEST_CASE("layout map: points of feature arcs lie on their edges", "[parameterization]") {
    const LaidOutSurface can = make_can_layout(10, 0.6);
    const LayoutSamples samples = sample_layout_map(can.mesh, can.embedding, map_of(can, 0.25), 3);
    int n_features = 0;
    for (int a = 0; a < can.embedding.layout.n_arcs(); ++a) {
        if (!can.embedding.is_feature_arc[a]) continue;
        ++n_features;
        const auto& path = can.embedding.arcs[a];
        for (int i = 0; i < samples.arcs[a].cols(); ++i) {
            const Vector3 point = samples.arcs[a].col(i);
            double nearest = 1.0;
            for (std::size_t k = 1; k < path.size(); ++k) {
                const Vector3& from = can.mesh.point(path[k - 1]);
                const Vector3& to = can.mesh.point(path[k]);
                const double t =
                    std::clamp((point - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
                nearest = std::min(nearest, ((1.0 - t) * from + t * to - point).norm());
            }
            CHECK(nearest < 1e-15);
        }
    }
    CHECK(n_features == 8);
}

TEST_CASE("layout map: directions turn it", "[parameterization]") {
    const LaidOutSurface torus = make_torus_layout(8, {0, 12, 32}, {0, 2, 4});
    std::vector<double> angles;
    for (const FaceHandle face : torus.mesh.faces()) {
        // Around the axis.
        const HalfedgeHandle h = torus.mesh.halfedge_handle(face);
        const Vector3& a = torus.mesh.point(torus.mesh.from_vertex_handle(h));
        const Vector3 edge = torus.mesh.point(torus.mesh.to_vertex_handle(h)) - a;
        const Vector3 around = Vector3(-a.y(), a.x(), 0.0);
        angles.push_back(
            std::atan2(edge.cross(around).dot(face_normal(torus.mesh, face)), edge.dot(around)));
    }
    const DirectionField field = field_of_angles(torus.mesh, std::move(angles), 4);
    LayoutMapOptions options;
    options.directions = FaceDirections{chart_directions(torus.mesh, torus.embedding, field)};
    const LayoutMap free = map_of(torus, 0.2, options);
    options.alignment_weight = 3.0;
    const LayoutMap aligned = map_of(torus, 0.2, options);
    CHECK(aligned.report.n_flipped == 0);
    CHECK(free.report.mean_angle_to_directions > 0.02);
    CHECK(aligned.report.mean_angle_to_directions < 0.9 * free.report.mean_angle_to_directions);
    options.route = LayoutMapRoute::quadratic;
    const LayoutMap squares = map_of(torus, 0.2, options);
    CHECK(squares.report.mean_angle_to_directions < aligned.report.mean_angle_to_directions);
}

TEST_CASE("layout map: least squares to the field", "[parameterization]") {
    const auto quadratic = [](const LaidOutSurface& surface, double size) {
        const LayoutField field =
            make_layout_field(surface.mesh, surface.embedding, {.principal_strength = 0.0});
        LayoutMapOptions options;
        options.route = LayoutMapRoute::quadratic;
        options.directions =
            FaceDirections{chart_directions(surface.mesh, surface.embedding, field.field)};
        return map_of(surface, size, options);
    };
    // A cube's field is the gradient of its map: nothing is left of the squares.
    const LayoutMap cube = quadratic(make_cube_layout(4, same, all), 0.5);
    CHECK(cube.report.n_flipped == 0);
    CHECK(cube.report.energies.back() < 1e-12);
    CHECK(cube.report.cell_size == Approx(0.5));
    // Squares only fall, until they settle.
    const LayoutMap sphere = quadratic(make_sphere_layout(6, Vector3(0.3, 0.2, 0.0)), 0.3);
    CHECK(sphere.report.is_converged);
    for (std::size_t k = 1; k < sphere.report.energies.size(); ++k) {
        CHECK(sphere.report.energies[k] <= sphere.report.energies[k - 1]);
    }
    // Quads of very different sizes have as many cells: nothing keeps triangles open.
    const LaidOutSurface uneven = make_sphere_layout(6, Vector3(0.9, 0.1, 0.0));
    CHECK(quadratic(uneven, 0.3).report.n_flipped > 0);
    CHECK(map_of(uneven, 0.3).report.n_flipped == 0);
}

TEST_CASE("layout map: what does not fit is refused", "[parameterization]") {
    LaidOutSurface cube = make_cube_layout(3, same, all);
    const std::vector<int> cells(cube.embedding.layout.n_arcs(), 2);
    LayoutMapOptions options;
    options.cell_lengths = {1.0};
    CHECK_THROWS_AS(make_layout_map(cube.mesh, cube.embedding, cells, options), InputError);
    options.cell_lengths = {1.0, -1.0, 1.0};
    CHECK_THROWS_WITH(make_layout_map(cube.mesh, cube.embedding, cells, options),
                      Catch::Contains("sheet 1"));
    options.cell_lengths.clear();
    options.directions.emplace();
    CHECK_THROWS_AS(make_layout_map(cube.mesh, cube.embedding, cells, options), InputError);
    options.directions.reset();
    options.route = LayoutMapRoute::quadratic;
    CHECK_THROWS_WITH(make_layout_map(cube.mesh, cube.embedding, cells, options),
                      Catch::Contains("needs directions"));
    const LayoutMap map = make_layout_map(cube.mesh, cube.embedding, cells);
    CHECK_THROWS_AS(sample_layout_map(cube.mesh, cube.embedding, map, 0), InputError);
    EmbeddedLayout broken = cube.embedding;
    broken.quad_of_face[0] = (broken.quad_of_face[0] + 1) % 6;
    CHECK_THROWS_AS(make_layout_map(cube.mesh, broken, cells), Error);
    broken = cube.embedding;
    broken.arcs[4].erase(broken.arcs[4].begin() + 1);
    CHECK_THROWS_WITH(make_layout_map(cube.mesh, broken, cells), Catch::Contains("arc 4"));
}
