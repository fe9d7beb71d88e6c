#include "meshing/surface/ball_contact.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "meshing/surface/triangle_tree.h"

using namespace couture;
using namespace couture::meshing;

namespace {

using Triangle = std::array<Vector3, 3>;

const Triangle flat{Vector3(0.0, 0.0, 0.0), Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0)};

double distance_to(const Vector3& point, const Triangle& triangle) {
    const Vector3 w = nearest_weights(point, triangle);
    return (w[0] * triangle[0] + w[1] * triangle[1] + w[2] * triangle[2] - point).norm();
}

class RandomVectors {
  public:
    Vector3 operator()() { return {number_(engine_), number_(engine_), number_(engine_)}; }

  private:
    std::mt19937 engine_{7};
    std::uniform_real_distribution<double> number_{-1.0, 1.0};
};

}  // namespace

TEST_CASE("ball_contact: face, edge and corner in closed form", "[meshing]") {
    const Vector3 down(0.0, 0.0, -1.0);
    CHECK(ball_contact({0.2, 0.3, 5.0}, down, 0.5, flat).value() == Approx(4.5));
    CHECK(ball_contact({0.2, 0.3, -5.0}, -down, 0.5, flat).value() == Approx(4.5));
    // 0.3 beside the edge y = 0: the ball's centre stops at height 0.4.
    CHECK(ball_contact({0.5, -0.3, 5.0}, down, 0.5, flat).value() == Approx(4.6));
    // 0.3 and 0.1 beside the corner at the origin.
    const double height = std::sqrt(0.25 - 0.09 - 0.01);
    CHECK(ball_contact({-0.3, -0.1, 5.0}, down, 0.5, flat).value() == Approx(5.0 - height));
    CHECK_FALSE(ball_contact({-0.4, -0.4, 5.0}, down, 0.5, flat));
    CHECK_FALSE(ball_contact({0.2, 0.3, 5.0}, -down, 0.5, flat));
    CHECK(ball_contact({0.2, 0.3, 0.4}, down, 0.5, flat).value() == 0.0);
}

TEST_CASE("ball_contact: without radius a line, edges included", "[meshing]") {
    const Vector3 down(0.0, 0.0, -1.0);
    CHECK(ball_contact({0.2, 0.3, 5.0}, down, 0.0, flat).value() == Approx(5.0));
    CHECK(ball_contact({0.5, 0.0, 5.0}, down, 0.0, flat).value() == Approx(5.0));
    CHECK(ball_contact({0.0, 0.0, 5.0}, down, 0.0, flat).value() == Approx(5.0));
    CHECK_FALSE(ball_contact({0.5, -1e-6, 5.0}, down, 0.0, flat));
    const Triangle segment{flat[0], flat[1], flat[1]};
    CHECK_FALSE(ball_contact({0.5, 0.0, 5.0}, down, 0.0, segment));
    CHECK(ball_contact({0.5, 0.0, 5.0}, down, 0.5, segment).value() == Approx(4.5));
}

TEST_CASE("ball_contact: the ball touches where it stops and nowhere before", "[meshing]") {
    constexpr double tolerance = 1e-12;
    RandomVectors random;
    int n_touched = 0;
    for (int i = 0; i < 3000; ++i) {
        const Triangle triangle{random(), random(), random()};
        const Vector3 start = 3.0 * random();
        // Most of them near the triangle or through it.
        const Vector3 middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        const Vector3 direction = (middle + random() - start).normalized();
        const double radius = 0.3;
        if (distance_to(start, triangle) <= radius) continue;
        const auto contact = ball_contact(start, direction, radius, triangle);
        const double end = contact.value_or(10.0);
        for (int k = 0; k <= 200; ++k) {
            const double distance = distance_to(start + end * k / 200.0 * direction, triangle);
            REQUIRE(distance >= radius - tolerance);
        }
        if (!contact) continue;
        ++n_touched;
        CHECK(std::abs(distance_to(start + *contact * direction, triangle) - radius) < 1e-10);
    }
    CHECK(n_touched > 300);
}

TEST_CASE("TriangleTree: the first contact is that of all triangles", "[meshing]") {
    RandomVectors random;
    std::vector<Triangle> triangles;
    for (int t = 0; t < 200; ++t) {
        const Vector3 at = 5.0 * random();
        triangles.push_back({at, at + random(), at + random()});
    }
    const TriangleTree tree(triangles);
    const double radius = GENERATE(0.0, 0.2);
    int n_met = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vector3 start = 6.0 * random();
        Vector3 direction = random().normalized();
        if (i % 10 == 0) direction = Vector3::Unit(i / 10 % 3);
        std::optional<double> first;
        for (const Triangle& triangle : triangles) {
            const auto one = ball_contact(start, direction, radius, triangle);
            if (one && (!first || *one < *first)) first = one;
        }
        CHECK(tree.first_contact(start, direction, radius) == first);
        n_met += first ? 1 : 0;
    }
    CHECK(n_met > 100);
    CHECK(n_met < 1000);
}
