#include "meshing/volume/volumes_from_surfaces.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "iga/spline/refine.h"
#include "iga/topology/side_patch.h"
#include "meshing/parts/parts.h"
#include "meshing/volume/layout_volume.h"
#include "meshing/volume/six_faces.h"
#include "tests/meshing/volume/sampled_layouts.h"

namespace couture::meshing {

namespace {

using Catch::Matchers::Contains;
using iga::MultiPatch;
using iga::Surface;

/// Of the size: neighbours share control points; and of the volume: rounding of sums.
constexpr double exactly = 1e-12;
constexpr double rounding = 1e-10;

std::vector<Surface> sides_of(const MultiPatch<3>& volume) {
    std::vector<Surface> surfaces;
    for (int p = 0; p < volume.n_patches(); ++p) {
        for (int side = 0; side < 6; ++side) {
            surfaces.push_back(
                iga::entity_patch<3, 2>(volume.patches[p], iga::make_side<3>(p, side).position));
        }
    }
    return surfaces;
}

/// Directions in another order and sense, knots over another interval.
Surface turned(const Surface& surface, bool is_swapped, bool is_reversed, double first,
               double last) {
    std::array<iga::KnotVector, 2> knots{surface.knots(0), surface.knots(1)};
    if (is_reversed) knots[0] = knots[0].reversed();
    const auto [n, m] = surface.space().sizes();
    std::vector<int> places;
    for (int j = 0; j < m; ++j) {
        for (int i = 0; i < n; ++i) places.push_back((is_reversed ? n - 1 - i : i) + n * j);
    }
    MatrixX rows = surface.homogeneous()(places, Eigen::all);
    if (is_swapped) {
        std::swap(knots[0], knots[1]);
        places.clear();
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < m; ++j) places.push_back(i + n * j);
        }
        rows = rows(places, Eigen::all).eval();
    }
    return Surface::from_homogeneous({{knots[0].rescaled(first, last), knots[1]}}, rows,
                                     surface.is_rational());
}

std::vector<Surface> disordered(std::vector<Surface> surfaces, unsigned seed) {
    std::mt19937 random(seed);
    surfaces.push_back(surfaces[random() % surfaces.size()]);
    std::shuffle(surfaces.begin(), surfaces.end(), random);
    for (Surface& surface : surfaces) {
        surface = turned(surface, random() % 2 == 0, random() % 2 == 0, -1.0, random() % 7);
    }
    return surfaces;
}

MultiPatch<3> volume_of(const MappedLayout& body, int degree, int n) {
    LayoutVolumeOptions options;
    options.degree = degree;
    options.n_elements = {n};
    return make_layout_volume(body.layout, sample(body, 2 * n), options).volume;
}

/// A ball: a cube with a cuboid on each side.
MappedLayout ball() {
    MappedLayout body;
    body.layout.n_nodes = 16;
    body.layout.cuboids.push_back({0, 1, 2, 3, 4, 5, 6, 7});
    for (int side = 0; side < 6; ++side) {
        std::array<int, 8> nodes{};
        const auto inner = side_nodes(body.layout, {0, side});
        for (int i = 0; i < 4; ++i) {
            // Directions as on the side, then outwards: mirrored on three sides.
            const int place = (side / 2 == 1) != (side % 2 == 1) ? i : (i >> 1 | (i & 1) << 1);
            nodes[i] = inner[place];
            nodes[i + 4] = inner[place] + 8;
        }
        body.layout.cuboids.push_back(nodes);
    }
    const VolumetricLayout layout = body.layout;
    body.map = [layout](int cuboid, const Vector3& xi) {
        Vector3 sum = Vector3::Zero();
        for (int i = 0; i < 8; ++i) {
            const int node = layout.cuboids[cuboid][i];
            const Vector3 corner(node & 1, node >> 1 & 1, node >> 2 & 1);
            double weight = node < 8 ? 0.4 : 1.0;
            for (int k = 0; k < 3; ++k) weight *= (i >> k & 1) != 0 ? xi[k] : 1.0 - xi[k];
            sum += weight * (2.0 * corner - Vector3::Ones());
        }
        return Vector3(cuboid > 0 ? sum.normalized() : sum);
    };
    return body;
}

}  // namespace

TEST_CASE("find_six_faces: a cube, two cubes, and an open box", "[volume]") {
    using Quads = std::vector<std::array<int, 4>>;
    Quads cube;
    for (int side = 0; side < 6; ++side) cube.push_back(side_corners(side));
    REQUIRE(find_six_faces(cube).size() == 1);
    const SixFaces found = find_six_faces(cube)[0];
    for (int side = 0; side < 6; ++side) {
        auto expected = cube[found.faces[side]];
        std::array<int, 4> nodes{};
        for (int k = 0; k < 4; ++k) nodes[k] = found.nodes[side_corners(side)[k]];
        std::ranges::sort(expected);
        std::ranges::sort(nodes);
        CHECK(nodes == expected);
    }
    Quads open(cube.begin(), cube.end() - 1);
    CHECK(find_six_faces(open).empty());
    Quads two = cube;
    for (int side = 0; side < 5; ++side) {
        auto quad = cube[side];
        for (int& node : quad) node = node < 4 ? node + 8 : node - 4;
        two.push_back(quad);
    }
    // Corners 0 to 3 are those where the first cube begins, 8 to 11 the far ones.
    CHECK(find_six_faces(two).size() == 2);
}

TEST_CASE("volumes_from_surfaces: all parts come back from their disordered sides", "[volume]") {
    unsigned seed = 1;
    for (const PartInfo& info : parts()) {
        if (info.dimension != 3) continue;
        const auto part = std::get<MultiPatch<3>>(make_part(info.name));
        const std::vector<Surface> surfaces = disordered(sides_of(part), ++seed);
        const Timer timer;
        const VolumesFromSurfaces result = volumes_from_surfaces(surfaces);
        CAPTURE(info.name, part.n_patches(), timer.seconds());
        CHECK(timer.seconds() < 2.0);
        CHECK(result.volume.n_patches() == part.n_patches());
        CHECK(result.volume.interfaces.size() == part.interfaces.size());
        CHECK_NOTHROW(iga::check(result.volume, exactly));
        CHECK(iga::volume(result.volume) == Approx(iga::volume(part)).epsilon(rounding));
        CHECK(result.report.duplicates.size() == part.interfaces.size() + 1);
        for (const auto& duplicate : result.report.duplicates) {
            CHECK(duplicate.gap < exactly * part.size());
        }
        CHECK(result.report.unused.empty());
        CHECK(result.report.collapsed.empty());
        CHECK(result.report.n_fitted_edges == 0);
        CHECK(result.report.parameterization.validity == iga::Validity::valid);
        for (int p = 0; p < result.volume.n_patches(); ++p) {
            for (int side = 0; side < 6; ++side) {
                const auto middle = iga::entity_patch<3, 2>(result.volume.patches[p],
                                                            iga::make_side<3>(p, side).position)
                                        .point(Vector2(0.5, 0.5));
                const Surface& own = surfaces[result.surfaces[p][side]];
                const Vector2 xi(0.5 * (own.knots(0).front() + own.knots(0).back()),
                                 0.5 * (own.knots(1).front() + own.knots(1).back()));
                CHECK((middle - own.point(xi)).norm() < 1e-9 * part.size());
            }
        }
    }
}

TEST_CASE("volumes_from_surfaces: fitted volumes come back, none that enclose others", "[volume]") {
    const std::vector<std::pair<MappedLayout, std::size_t>> bodies{
        {mapped_box({3, 3, 3},
                    [](const Vector3& x) { return Vector3(x[0], x[1] + x[0] * x[0], x[2]); }),
         0},
        {torus_of_20(), 0},
        // Its six outer sides have eight corners.
        {ball(), 1}};
    for (const auto& [body, n_enclosing] : bodies) {
        const MultiPatch<3> volume = volume_of(body, 3, 3);
        const std::vector<Surface> surfaces = disordered(sides_of(volume), 5);
        const Timer timer;
        const VolumesFromSurfaces result = volumes_from_surfaces(surfaces);
        CAPTURE(volume.n_patches(), timer.seconds());
        CHECK(timer.seconds() < 2.0);
        CHECK(result.volume.n_patches() == volume.n_patches());
        CHECK(result.report.enclosing.size() == n_enclosing);
        CHECK(iga::volume(result.volume) == Approx(iga::volume(volume)).epsilon(rounding));
        CHECK_NOTHROW(iga::check(result.volume, exactly));
        CHECK(result.report.parameterization.validity == iga::Validity::valid);
    }
}

TEST_CASE("volumes_from_surfaces: other knots, degrees and borders are brought together",
          "[volume]") {
    const auto box = std::get<MultiPatch<3>>(make_part("twisted_box"));
    std::vector<Surface> surfaces = sides_of(box);
    surfaces[0] = iga::refine_to<2>(
        surfaces[0], {{iga::refine(surfaces[0].knots(0), 4, 3).knots,
                       iga::insert_knots(surfaces[0].knots(1), std::vector<double>{0.3}).knots}});
    const VolumesFromSurfaces finer = volumes_from_surfaces(surfaces);
    CHECK(finer.report.n_fitted_edges == 0);
    CHECK(iga::volume(finer.volume) == Approx(iga::volume(box)).epsilon(rounding));

    // A border that bulges away from its neighbour's.
    const double bulge = 0.02;
    MatrixX points = surfaces[3].control_points();
    points(1, 0) += bulge;
    surfaces[3] = Surface(surfaces[3].space(), points);
    const VolumesFromSurfaces fitted = volumes_from_surfaces(surfaces);
    CHECK(fitted.report.n_fitted_edges == 1);
    CHECK(fitted.report.max_edge_gap > 0.05 * bulge);
    CHECK(fitted.report.max_edge_gap < bulge);
    CHECK(fitted.report.parameterization.validity == iga::Validity::valid);
    CHECK(iga::volume(fitted.volume) == Approx(iga::volume(box)).epsilon(0.01));
    CHECK(iga::volume(fitted.volume) != Approx(iga::volume(box)).epsilon(1e-6));
}

TEST_CASE("volumes_from_surfaces: what bounds no volume is reported", "[volume]") {
    const auto box = std::get<MultiPatch<3>>(make_part("twisted_box"));
    std::vector<Surface> surfaces = sides_of(box);
    // A fin, a triangle, and another surface between the corners of side 0.
    const auto moved = [](const Surface& surface, int row, const Vector3& x) {
        MatrixX points = surface.control_points();
        points.row(row) += x.transpose();
        return Surface(surface.space(), points);
    };
    surfaces.insert(surfaces.begin(), moved(surfaces[0], 0, Vector3(0.0, 0.0, 5.0)));
    const auto [n, m] = surfaces[1].space().sizes();
    surfaces.push_back(
        moved(surfaces[1], 0,
              (surfaces[1].control_points().row(n - 1) - surfaces[1].control_points().row(0))
                  .transpose()));
    surfaces.push_back(moved(surfaces[1], 1 + n, Vector3(3.0, 0.0, 0.0)));
    const VolumesFromSurfaces result = volumes_from_surfaces(surfaces);
    CHECK(result.volume.n_patches() == 1);
    CHECK(result.report.unused == std::vector<int>{0});
    CHECK(result.report.collapsed == std::vector<int>{7});
    REQUIRE(result.report.duplicates.size() == 1);
    CHECK(result.report.duplicates[0].surface == 8);
    CHECK(result.report.duplicates[0].original == 1);
    CHECK(result.report.duplicates[0].gap > 0.1);

    surfaces.erase(surfaces.begin() + 6, surfaces.end());
    CHECK_THROWS_WITH(volumes_from_surfaces(surfaces), Contains("no six of the 6 surfaces"));
    CHECK_THROWS_AS(volumes_from_surfaces({}), InputError);
    CHECK_THROWS_WITH(volumes_from_surfaces(surfaces, {.tolerance = 0.0}),
                      Contains("tolerance = 0"));
    const auto plane = std::get<MultiPatch<2>>(make_part("rectangle"));
    CHECK_THROWS_WITH(volumes_from_surfaces(plane.patches),
                      Contains("surface 0 lies in the plane"));
}

}  // namespace couture::meshing
