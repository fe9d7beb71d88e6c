#include "meshing/surface/inflated_sphere.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/surface/cavity_center.h"
#include "meshing/surface/cube_sphere.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

constexpr double rounding = 1e-12;

/// A sphere of triangles about a centre, without those whose middle `is_left_out`.
template <typename Rule>
TriangleSoup ball_wall(const Vector3& center, double radius, int n, Rule is_left_out) {
    const QuadMesh quads = make_cube_sphere(n);
    TriangleSoup soup;
    for (const Vector3& point : quads.points) soup.points.push_back(center + radius * point);
    const auto add = [&](int a, int b, int c) {
        const Vector3 middle = (quads.points[a] + quads.points[b] + quads.points[c]) / 3.0;
        if (!is_left_out(Vector3(middle.normalized()))) soup.triangles.push_back({a, b, c});
    };
    for (const auto& [a, b, c, d] : quads.quads) {
        add(a, b, c);
        add(a, c, d);
    }
    return soup;
}

TriangleSoup closed_ball(const Vector3& center, double radius, int n = 12) {
    return ball_wall(center, radius, n, [](const Vector3&) { return false; });
}

/// Open at the top, 30 degrees around the axis.
TriangleSoup open_ball(double radius = 2.0) {
    return ball_wall(Vector3::Zero(), radius, 20,
                     [](const Vector3& middle) { return middle.z() > std::cos(0.5236); });
}

/// No vertex is behind the wall, those in contact are on it; strains keep to `limit`, and whoever
/// was stopped by them has an edge that reached it.
void check_laws(const InflatedSphere& sphere, const TriangleSoup& wall, double limit) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [a, b, c] : wall.triangles) {
        triangles.push_back({wall.points[a], wall.points[b], wall.points[c]});
    }
    const TriangleTree tree(triangles);
    for (std::size_t v = 0; v < sphere.mesh.points.size(); ++v) {
        const Vector3& point = sphere.mesh.points[v];
        REQUIRE(point.allFinite());
        const double distance = (point - sphere.center).norm();
        REQUIRE(distance >= sphere.radius * (1.0 - rounding));
        const auto hit = tree.first_contact(sphere.center, (point - sphere.center) / distance, 0.0);
        if (hit) REQUIRE(distance <= *hit + 1e-9);
    }
    std::vector<double> largest(sphere.mesh.points.size(), 0.0);
    for (std::size_t e = 0; e < sphere.edges.size(); ++e) {
        REQUIRE(sphere.strains[e] <= limit + 1e-9);
        for (const int v : sphere.edges[e]) largest[v] = std::max(largest[v], sphere.strains[e]);
    }
    for (std::size_t v = 0; v < sphere.mesh.points.size(); ++v) {
        if (sphere.stops[v] == InflationStop::strain) REQUIRE(largest[v] >= limit - 1e-9);
    }
}

}  // namespace

TEST_CASE("inflate_sphere: fills a ball from its centre", "[meshing]") {
    const Vector3 center(1.0, 2.0, 3.0);
    const TriangleSoup wall = closed_ball(center, 2.0, 24);
    const InflatedSphere sphere = inflate_sphere(wall, {.center = center, .radius = 0.5});
    CHECK(sphere.mesh.points.size() == 6 * 16 * 16 + 2);
    CHECK(sphere.n_contacts() == static_cast<int>(sphere.mesh.points.size()));
    CHECK(sphere.n_free == 0);
    for (const Vector3& point : sphere.mesh.points) {
        CHECK((point - center).norm() <= 2.0 + rounding);
        // Chords of 24 triangles in a quarter of a circle.
        CHECK((point - center).norm() > 1.99);
    }
    // All edges grew from 0.5 to 2, about.
    CHECK(sphere.max_strain() == Approx(3.0).margin(0.2));
}

TEST_CASE("inflate_sphere: stops at its strain limit, all at once", "[meshing]") {
    // Nearest place of the wall at 1.5, strained by 2; the limit lets the radius grow to 1.25.
    const TriangleSoup wall = closed_ball({0.5, 0.0, 0.0}, 2.0);
    InflationOptions options{.center = Vector3::Zero(), .radius = 0.5, .strain_limit = 1.5};
    CHECK_THROWS_WITH(inflate_sphere(wall, options), Contains("strained by 1.9"));
    options.strain_limit = 2.4;
    const InflatedSphere sphere = inflate_sphere(wall, options);
    CHECK(sphere.n_contacts() > 0);
    CHECK(sphere.n_contacts() < 6 * 16 * 16 + 2);
    check_laws(sphere, wall, 2.4);
}

TEST_CASE("inflate_sphere: a membrane closes an opening", "[meshing]") {
    const TriangleSoup wall = open_ball();
    double last_height = 0.0;
    for (const double limit : {1.1, 1.5, 3.0}) {
        const InflatedSphere sphere =
            inflate_sphere(wall, {.center = Vector3::Zero(), .radius = 1.0, .strain_limit = limit});
        check_laws(sphere, wall, limit);
        CHECK(sphere.n_free > 50);
        CHECK(sphere.n_contacts() + sphere.n_free <= 6 * 16 * 16 + 2);
        double height = 0.0;
        for (std::size_t v = 0; v < sphere.stops.size(); ++v) {
            const Vector3 direction = sphere.mesh.points[v].normalized();
            if (direction.z() < std::cos(0.6)) {
                CHECK(sphere.stops[v] == InflationStop::contact);
            } else if (direction.z() > std::cos(0.45)) {
                CHECK(sphere.stops[v] == InflationStop::strain);
                height = std::max(height, sphere.mesh.points[v].z());
            }
        }
        // All of it is out of the opening, and the farther the more strain there may be.
        CHECK(height > 2.0);
        CHECK(height > last_height);
        last_height = height;
    }
}

TEST_CASE("inflate_sphere: does not see copies, turned triangles and fins outside", "[meshing]") {
    TriangleSoup wall = open_ball();
    InflationOptions options{.center = Vector3(0.1, 0.2, 0.0), .radius = 1.0};
    // The fins change the box that the default is a part of.
    options.hole_size = 0.05;
    const InflatedSphere clean = inflate_sphere(wall, options);
    const std::size_t n = wall.triangles.size();
    for (std::size_t t = 0; t < n; t += 3) wall.triangles.push_back(wall.triangles[t]);
    for (std::size_t t = 0; t < n; t += 5) std::swap(wall.triangles[t][0], wall.triangles[t][1]);
    // Away from the opening, where the membrane would meet them.
    for (std::size_t t = 0; t < n; t += 7) {
        const auto [a, b, c] = wall.triangles[t];
        if (wall.points[a].z() > 0.0) continue;
        wall.points.emplace_back(1.2 * wall.points[a]);
        wall.triangles.push_back({a, b, static_cast<int>(wall.points.size()) - 1});
    }
    const InflatedSphere defective = inflate_sphere(wall, options);
    CHECK(defective.mesh.quads == clean.mesh.quads);
    double difference = 0.0;
    for (std::size_t v = 0; v < clean.stops.size(); ++v) {
        difference = std::max(difference, (clean.mesh.points[v] - defective.mesh.points[v]).norm());
    }
    CHECK(difference < 1e-9);
}

TEST_CASE("inflate_sphere: small holes hold vertices, larger ones don't", "[meshing]") {
    // A triangle is missing in the direction of a vertex of the sphere.
    const Vector3 direction = make_cube_sphere(16).points[40];
    TriangleSoup wall = closed_ball(Vector3::Zero(), 2.0, 14);
    std::size_t missing = 0;
    double best = -1.0;
    for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
        const auto [a, b, c] = wall.triangles[t];
        const Vector3 middle = wall.points[a] + wall.points[b] + wall.points[c];
        if (middle.normalized().dot(direction) > best) {
            best = middle.normalized().dot(direction);
            missing = t;
        }
    }
    wall.triangles.erase(wall.triangles.begin() + static_cast<std::ptrdiff_t>(missing));
    InflationOptions options{.center = Vector3::Zero(), .radius = 1.0};
    options.hole_size = 1e-3;
    const InflatedSphere leaking = inflate_sphere(wall, options);
    CHECK(leaking.n_free > 0);
    CHECK(leaking.n_contacts() < static_cast<int>(leaking.stops.size()));
    // Sides of the triangle are 0.2 to 0.3 long, its inscribed circle 0.13 wide.
    options.hole_size = 0.15;
    const InflatedSphere tight = inflate_sphere(wall, options);
    CHECK(tight.n_free == 0);
    CHECK(tight.n_contacts() == static_cast<int>(tight.stops.size()));
    for (const Vector3& point : tight.mesh.points) CHECK(point.norm() > 1.9);
    for (const Vector3& point : tight.mesh.points) CHECK(point.norm() <= 2.0 + rounding);
}

TEST_CASE("inflate_sphere: limits of regions and of outlets", "[meshing]") {
    const TriangleSoup wall = open_ball();
    InflationOptions options{.center = Vector3::Zero(), .radius = 1.0, .strain_limit = 3.0};
    const auto highest = [&] {
        double z = 0.0;
        for (const Vector3& p : inflate_sphere(wall, options).mesh.points) z = std::max(z, p.z());
        return z;
    };
    const double all_alike = highest();
    options.outlet_strain_limit = 1.2;
    const double tight_outlet = highest();
    CHECK(tight_outlet < 0.7 * all_alike);
    // The same by a place: a ball, or a box, around the opening.
    options.outlet_strain_limit.reset();
    options.regions = {{Ball{{0.0, 0.0, 2.5}, 1.2}, 1.2}};
    CHECK(highest() < 0.7 * all_alike);
    options.regions = {{AxisBox{{-2.0, -2.0, 1.5}, {2.0, 2.0, 9.0}}, 1.2}};
    CHECK(highest() < 0.7 * all_alike);
    // A region that allows more is farther than one that is not there.
    options.regions = {{AxisBox{{-2.0, -2.0, 1.5}, {2.0, 2.0, 9.0}}, 4.0}};
    CHECK(highest() > 1.1 * all_alike);
    // One elsewhere changes nothing.
    options.regions = {{Ball{{0.0, 0.0, 50.0}, 1.0}, 0.1}};
    CHECK(highest() == all_alike);
}

TEST_CASE("inflate_sphere: an edge that enters a region longer than allowed stops there",
          "[meshing]") {
    const TriangleSoup wall = open_ball();
    InflationOptions options{.center = Vector3::Zero(), .radius = 1.0, .strain_limit = 3.0};
    options.regions = {{AxisBox{{-9.0, -9.0, 2.2}, {9.0, 9.0, 9.0}}, 0.01}};
    const InflatedSphere sphere = inflate_sphere(wall, options);
    for (std::size_t e = 0; e < sphere.edges.size(); ++e) {
        const auto [a, b] = sphere.edges[e];
        CHECK(0.5 * (sphere.mesh.points[a] + sphere.mesh.points[b]).z() <= 2.2 + rounding);
    }
}

TEST_CASE("find_cavity_center: the centre of a ball, open or closed", "[meshing]") {
    const Vector3 center(3.0, -1.0, 0.5);
    const auto tree_of = [](const TriangleSoup& wall) {
        std::vector<std::array<Vector3, 3>> triangles;
        for (const auto& [a, b, c] : wall.triangles) {
            triangles.push_back({wall.points[a], wall.points[b], wall.points[c]});
        }
        return TriangleTree(triangles);
    };
    const auto place = find_cavity_center(tree_of(closed_ball(center, 2.0)));
    REQUIRE(place);
    CHECK((place->position - center).norm() < 0.05);
    CHECK(place->distance == Approx(2.0).epsilon(0.02));
    const TriangleTree open = tree_of(open_ball());
    REQUIRE(find_cavity_center(open));
    CHECK(find_cavity_center(open)->position.norm() < 0.3);
    // (1 - cos 30 degrees) / 2 of all directions are open.
    CHECK(enclosed_part(open, Vector3::Zero()) == Approx(1.0 - 0.067).margin(0.01));
    CHECK(enclosed_part(open, {0.0, 0.0, 30.0}) < 0.05);
    // A sheet encloses nothing.
    CHECK_FALSE(find_cavity_center(
        TriangleTree({{Vector3(0.0, 0.0, 0.0), Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.1)}})));
}

TEST_CASE("inflate_sphere: refuses what can't be inflated", "[meshing]") {
    const TriangleSoup wall = closed_ball(Vector3::Zero(), 2.0);
    CHECK_THROWS_WITH(inflate_sphere(TriangleSoup()), Contains("has no triangles"));
    CHECK_THROWS_WITH(inflate_sphere({{Vector3::Zero()}, {{0, 0, 1}}}),
                      Contains("triangle 0 has vertex 1; there are 1 points"));
    CHECK_THROWS_WITH(inflate_sphere(wall, {.strain_limit = 0.0}),
                      Contains("the strain limit is 0"));
    CHECK_THROWS_WITH(inflate_sphere(wall, {.radius = -1.0}), Contains("the radius is -1"));
    CHECK_THROWS_WITH(inflate_sphere(wall, {.hole_size = 0.0}), Contains("the size of holes is 0"));
    CHECK_THROWS_WITH(inflate_sphere(wall, {.center = Vector3::Zero(), .radius = 2.5}),
                      Contains("of radius 2.5 is not inside: the wall is 1.9"));
    CHECK_THROWS_WITH(inflate_sphere(wall, {.center = Vector3(30.0, 0.0, 0.0), .radius = 1.0}),
                      Contains("all vertices were held") || Contains("no vertex meets the wall"));
    const TriangleSoup sheet{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.1}}, {{0, 1, 2}}};
    CHECK_THROWS_WITH(inflate_sphere(sheet), Contains("it encloses no cavity"));
}
