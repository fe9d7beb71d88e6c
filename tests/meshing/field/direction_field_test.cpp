#include "meshing/field/direction_field.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numbers>

#include "meshing/field/aligned_field.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double pi = std::numbers::pi;

// The square [-1, 1]^2, with a vertex at the origin.
SurfaceMesh make_plane(int n) {
    TriangleSoup soup = make_square(n);
    for (Vector3& p : soup.points) p = 2.0 * p - Vector3(1.0, 1.0, 0.0);
    return make_surface_mesh(soup);
}

DirectionField sample(const SurfaceMesh& mesh, int symmetry,
                      const std::function<double(double)>& angle_at) {
    const FaceFrames frames(mesh);
    std::vector<double> angles;
    for (const FaceHandle face : mesh.faces()) {
        Vector3 x = Vector3::Zero();
        for (const VertexHandle v : mesh.fv_range(face)) x += mesh.point(v) / 3.0;
        const double angle = angle_at(std::atan2(x.y(), x.x()));
        angles.push_back(frames.angle_of(face, Vector3(std::cos(angle), std::sin(angle), 0.0)));
    }
    return field_of_angles(mesh, std::move(angles), symmetry);
}

int vertex_at_origin(const SurfaceMesh& mesh) {
    for (const VertexHandle v : mesh.vertices()) {
        if (mesh.point(v).norm() < 1e-12) return v.idx();
    }
    return -1;
}

}  // namespace

TEST_CASE("direction field: index and turning number of fields in the plane", "[field]") {
    // Uniform, source, vortex, saddle, and the dipole.
    struct Case {
        std::function<double(double)> angle;
        int index;
        double turning_number;
    };
    const std::vector<Case> cases{{[](double) { return 0.3; }, 0, -1.0},
                                  {[](double t) { return t; }, 1, 0.0},
                                  {[](double t) { return t + 0.5 * pi; }, 1, 0.0},
                                  {[](double t) { return -t; }, -1, -2.0},
                                  {[](double t) { return 2.0 * t; }, 2, 1.0}};
    const SurfaceMesh mesh = make_plane(12);
    const DualCycles cycles = make_dual_cycles(mesh);
    for (const auto& [angle, index, turning] : cases) {
        const FieldTopology topology = topology_of(mesh, cycles, sample(mesh, 1, angle));
        if (index == 0) {
            CHECK(topology.singularities.empty());
        } else {
            CHECK(topology.singularities ==
                  std::vector<Singularity>{{vertex_at_origin(mesh), index}});
        }
        CHECK(turning_number(topology.boundary_turns[0], 1) == Approx(turning));
    }
}

TEST_CASE("direction field: symmetric fields have parts of a turn", "[field]") {
    const SurfaceMesh mesh = make_plane(12);
    const DualCycles cycles = make_dual_cycles(mesh);
    for (const int symmetry : {1, 2, 4, 6}) {
        for (const int index : {-1, 1}) {
            CAPTURE(symmetry, index);
            const auto field =
                sample(mesh, symmetry, [&](double t) { return 0.1 + t * index / symmetry; });
            const FieldTopology topology = topology_of(mesh, cycles, field);
            CHECK(topology.singularities ==
                  std::vector<Singularity>{{vertex_at_origin(mesh), index}});
            CHECK(topology.boundary_turns == std::vector<int>{symmetry - index});
            check_topology(mesh, cycles, topology);
        }
    }
}

TEST_CASE("direction field: integrated connections have the topology they were made for",
          "[field]") {
    const SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(2, 2));
    const DualCycles cycles = make_dual_cycles(mesh);
    for (const int symmetry : {1, 2, 4, 6}) {
        const FieldTopology topology{symmetry, {{2, -2 * symmetry - 1}, {9, 1}}, {}, {1, 0, -2, 3}};
        const Connection x = trivial_connection(mesh, cycles, topology);
        const DirectionField field =
            integrate_connection(mesh, x, symmetry, 0.2, make_dual_tree(mesh));
        CHECK(topology_of(mesh, cycles, field) == topology);
        const Connection back = field_curvature(mesh, field);
        for (std::size_t e = 0; e < x.angles().size(); ++e) {
            CHECK(back.angles()[e] == Approx(x.angles()[e]).margin(1e-9));
        }
        // Smooth change keeps it; one generator more is another field.
        std::vector<AngleTarget> targets{{FaceHandle(4), 0.7, 1.0}, {FaceHandle(90), -0.4, 3.0}};
        CHECK(topology_of(mesh, cycles, align_field(mesh, field, targets)) == topology);
        FieldTopology other = topology;
        ++other.generator_turns[0];
        const Connection y = trivial_connection(mesh, cycles, other);
        CHECK_FALSE(topology_of(mesh, cycles,
                                integrate_connection(mesh, y, symmetry, 0.2,
                                                     make_dual_tree(mesh))) == topology);
    }
}

TEST_CASE("direction field: a disc of the sphere turns as the singularity outside it", "[field]") {
    TriangleSoup soup = make_cube(6);
    for (Vector3& p : soup.points) p = (p - Vector3::Constant(0.5)).normalized();
    const SurfaceMesh sphere = make_surface_mesh(soup);
    const DualCycles cycles = make_dual_cycles(sphere);
    constexpr int v = 0;
    constexpr int far = 100;
    for (const int index : {0, 1, 2, 3}) {
        CAPTURE(index);
        FieldTopology topology{1, {}, {}, {}};
        if (index != 0) topology.singularities.push_back({v, index});
        if (index != 2) topology.singularities.push_back({far, 2 - index});
        const DirectionField field = integrate_connection(
            sphere, trivial_connection(sphere, cycles, topology), 1, 0.0, make_dual_tree(sphere));
        // Without the ring around v: its faces keep their frames.
        TriangleSoup open{soup.points, {}};
        std::vector<FaceHandle> faces;
        for (const FaceHandle face : sphere.faces()) {
            const auto [a, b, c] = face_vertices(sphere, face);
            if (a.idx() == v || b.idx() == v || c.idx() == v) continue;
            open.triangles.push_back({a.idx(), b.idx(), c.idx()});
            faces.push_back(face);
        }
        const SurfaceMesh disc = make_surface_mesh(open);
        const FaceFrames frames(disc);
        const FaceFrames of_sphere(sphere);
        std::vector<double> angles;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            angles.push_back(
                frames.angle_of(FaceHandle(static_cast<int>(f)),
                                of_sphere.direction(faces[f], field.angles[faces[f].idx()])));
        }
        const FieldTopology of_disc =
            topology_of(disc, make_dual_cycles(disc), field_of_angles(disc, angles, 1));
        const double turning = turning_number(of_disc.boundary_turns[0], 1);
        CHECK(turning == Approx(-(index - 1.0)));
        CHECK(turning == Approx((2.0 - index) - 1.0));
    }
}

TEST_CASE("align field: held angles are exact and the rest is smooth", "[field]") {
    const SurfaceMesh mesh = make_plane(8);
    const DualCycles cycles = make_dual_cycles(mesh);
    const DirectionField start = sample(mesh, 4, [](double) { return 0.2; });
    std::vector<bool> is_feature(mesh.n_edges(), false);
    const DirectionField field = align_field(mesh, start, feature_targets(mesh, start, is_feature));
    // A square: the cross of its sides is the smoothest.
    for (const double x : field_curvature(mesh, field).angles()) {
        CHECK(x == Approx(0.0).margin(1e-12));
    }
    for (const AngleTarget& target : feature_targets(mesh, field, is_feature)) {
        CHECK(target.offset == Approx(0.0).margin(1e-12));
    }
    const std::vector<AngleTarget> soft{{FaceHandle(3), 0.5, 2.0}};
    const DirectionField turned = align_field(mesh, start, soft);
    CHECK(turned.angles[40] - start.angles[40] == Approx(0.5));
    const std::vector<AngleTarget> wrong{{FaceHandle(3), 0.5, -2.0}};
    CHECK_THROWS_WITH(align_field(mesh, start, wrong), Catch::Contains("weight -2"));
}
