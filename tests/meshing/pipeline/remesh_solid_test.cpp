#include "meshing/pipeline/remesh_solid.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "iga/topology/element_quality.h"
#include "iga/topology/jacobian_certificate.h"
#include "iga/topology/multipatch_interpolate.h"
#include "meshing/parts/parts.h"
#include "meshing/pipeline/boundary_triangles.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

/// The half seal of 144 elements, without weights.
iga::MultiPatch<3> seal(int degree) {
    return iga::interpolate<3>(std::get<iga::MultiPatch<3>>(make_part("half_seal")), degree, {});
}

/// All control points moved.
template <typename Move>
iga::MultiPatch<3> moved(iga::MultiPatch<3> body, const Move& move) {
    for (iga::Volume& patch : body.patches) {
        MatrixX points = patch.control_points();
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
            points.row(i) = move(Vector3(points.row(i).transpose())).transpose();
        }
        patch = {patch.space(), std::move(points)};
    }
    return body;
}

/// About the z axis by an angle that grows with z.
Vector3 twisted(const Vector3& x) {
    const double angle = 0.01 * x.z();
    return {std::cos(angle) * x.x() - std::sin(angle) * x.y(),
            std::sin(angle) * x.x() + std::cos(angle) * x.y(), 1.2 * x.z()};
}

/// The ring's ends bent towards each other, through each other if `size` is large.
Vector3 closed_up(const Vector3& x, double size) {
    const double y = std::abs(x.y()) / 40.0;
    return {x.x(), x.y() - std::copysign(size * y * y, x.y()), x.z()};
}

}  // namespace

TEST_CASE("triangulate_boundary: the surface is closed and as large as the body's", "[pipeline]") {
    const iga::MultiPatch<3> body = moved(seal(2), twisted);
    const BoundaryFeatures features(seal(2));
    const CuboidDecomposition cuboids = triangulate_boundary(body, features, 8);
    CHECK(cuboids.surface.layout.euler_characteristic() == 2);
    CHECK(std::ranges::none_of(cuboids.mesh.halfedges(), [&](const HalfedgeHandle h) {
        return cuboids.mesh.is_boundary(h);
    }));
    CHECK(signed_volume(cuboids.mesh) == Approx(iga::volume(body)).epsilon(1e-3));
    for (int a = 0; a < cuboids.surface.layout.n_arcs(); ++a) {
        const auto [from, to] = cuboids.surface.layout.arcs()[a];
        CHECK(cuboids.surface.arcs[a].front() == cuboids.surface.nodes[from]);
        CHECK(cuboids.surface.arcs[a].back() == cuboids.surface.nodes[to]);
    }
    CHECK(cuboids.record.sets == cuboids.volume.sets);
    CHECK(cuboids.record.sets.count("cap") == 1);
    // A side of a cuboid on each set of the body that has sides.
    CHECK(cuboids.record.sets.at("cuts").size() == 6);
}

TEST_CASE("triangulate_boundary: wrong bodies are refused", "[pipeline]") {
    const iga::MultiPatch<3> body = seal(1);
    const BoundaryFeatures features(body);
    CHECK_THROWS_WITH(triangulate_boundary(body, features, 0), Contains("0 cells per element"));
    CHECK_THROWS_WITH(triangulate_boundary(seal(2), features, 1), Contains("they must be equal"));
    iga::MultiPatch<3> named = body;
    named.boundary_sets["inside"] = {
        iga::make_side<3>(named.interfaces[0].first_patch, named.interfaces[0].first_side)};
    CHECK_THROWS_WITH(
        triangulate_boundary(named, BoundaryFeatures(named), 1),
        Contains("boundary set 'inside' names patch") && Contains("which lies inside the volume"));
}

TEST_CASE("remesh_solid: a deformed body in new splines of the same signature", "[pipeline]") {
    const int degree = GENERATE(1, 2);
    CAPTURE(degree);
    const iga::MultiPatch<3> first = seal(degree);
    const iga::MultiPatch<3> body = moved(first, twisted);
    const RemeshedSolid again = remesh_solid(body, BoundaryFeatures(first));
    CHECK(iga::signature(again.volume) == iga::signature(body));
    CHECK(again.volume.boundary_sets == body.boundary_sets);
    iga::check(again.volume, 1e-12);
    for (const iga::Volume& patch : again.volume.patches) {
        CHECK(iga::certify(patch).validity == iga::Validity::valid);
    }
    CHECK(iga::element_quality(again.volume).min_scaled_jacobian > 0.85);
    CHECK(again.optimization.after.max_shape_ratio <= again.optimization.before.max_shape_ratio);
    CHECK(std::abs(again.volume_change) < 0.01);
    CHECK(again.distance.surface < 0.01);
    CHECK(again.distance.features < 0.01);
}

TEST_CASE("remesh_solid: bodies that meet themselves, and weights, are refused", "[pipeline]") {
    const iga::MultiPatch<3> first = seal(1);
    const BoundaryFeatures features(first);
    const iga::MultiPatch<3> crossed =
        moved(first, [](const Vector3& x) { return closed_up(x, 45.0); });
    CHECK_THROWS_WITH(remesh_solid(crossed, features),
                      Contains("the body's boundary meets itself") && Contains("the first near"));
    const iga::MultiPatch<3> exact = std::get<iga::MultiPatch<3>>(make_part("half_seal"));
    CHECK_THROWS_WITH(check_remeshable(exact, BoundaryFeatures(exact)),
                      Contains("has weights") && Contains("geometry = \"interpolated\""));
    CHECK_NOTHROW(check_remeshable(first, features));
}
