#include "meshing/surface/harmonic_function.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

std::vector<int> boundary_vertices(const CutSurface& surface) {
    std::vector<int> vertices;
    for (int v = 0; v < surface.n_vertices(); ++v) {
        if (surface.is_boundary_vertex(v)) vertices.push_back(v);
    }
    return vertices;
}

// Neighbours along edges, each once.
std::vector<int> neighbours(const CutSurface& surface, int v) {
    std::vector<int> result;
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.origin(h) == v) result.push_back(surface.target(h));
        if (surface.target(h) == v && surface.twin(h) < 0) result.push_back(surface.origin(h));
    }
    return result;
}

}  // namespace

TEST_CASE("harmonic_function: mean value weights reproduce linear functions on a plane",
          "[meshing][surface]") {
    TriangleSoup soup = make_jittered_square(15, 3);
    // In a tilted plane: weights come from lengths and angles alone.
    const Eigen::AngleAxisd rotation(0.7, Vector3(1.0, 2.0, -1.0).normalized());
    const TriangleSoup flat = soup;
    for (Vector3& point : soup.points) point = rotation * point + Vector3(3.0, -2.0, 1.0);
    const CutSurface surface(soup);
    const auto fixed = boundary_vertices(surface);
    const auto linear = [&](int v) { return 2.0 + 3.0 * flat.points[v].x() - flat.points[v].y(); };
    std::vector<double> values;
    for (const int v : fixed) values.push_back(linear(v));
    const VectorX f = harmonic_function(surface, fixed, values);
    double error = 0.0;
    for (int v = 0; v < surface.n_vertices(); ++v) {
        error = std::max(error, std::abs(f[v] - linear(v)));
    }
    // Rounding of a few hundred unknowns.
    CHECK(error < 1e-12);

    // Uniform weights do not, on irregular triangles; nor does either do quadratic functions.
    const VectorX g = harmonic_function(surface, fixed, values, HarmonicWeights::uniform);
    CHECK((f - g).cwiseAbs().maxCoeff() > 1e-3);
}

TEST_CASE("harmonic_function: uniform weights put vertices at the mean of their neighbours",
          "[meshing][surface]") {
    const CutSurface surface(make_bumpy_square(6, 0.4));
    const auto fixed = boundary_vertices(surface);
    std::vector<double> values;
    for (const int v : fixed) values.push_back(surface.point(v).z());
    const VectorX f = harmonic_function(surface, fixed, values, HarmonicWeights::uniform);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        if (surface.is_boundary_vertex(v)) continue;
        const auto around = neighbours(surface, v);
        double mean = 0.0;
        for (const int w : around) mean += f[w] / static_cast<double>(around.size());
        REQUIRE(f[v] == Approx(mean).margin(1e-13));
    }
}

TEST_CASE("harmonic_function: 0 and 1 on the ends of a tube give its height",
          "[meshing][surface]") {
    const CutSurface surface(make_tube(12, 9, 1.3, 4.0));
    const auto fixed = boundary_vertices(surface);
    std::vector<double> values;
    for (const int v : fixed) values.push_back(surface.point(v).z() > 2.0 ? 1.0 : 0.0);
    const VectorX f = harmonic_function(surface, fixed, values);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        REQUIRE(f[v] == Approx(surface.point(v).z() / 4.0).margin(1e-13));
    }
}

TEST_CASE(
    "harmonic_function: the largest and smallest values are given ones, also where the "
    "boundary is free",
    "[meshing][surface]") {
    // A pant: a square with two holes.
    CutSurface surface(make_bumpy_square(12, 0.6));
    const auto slit = [&](const std::vector<int>& vertices) {
        std::vector<int> path;
        for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
            path.push_back(surface.find_halfedge(vertices[i], vertices[i + 1]));
        }
        surface.slice(path);
    };
    slit({13 * 4 + 3, 13 * 4 + 4, 13 * 4 + 5, 13 * 4 + 6});
    slit({13 * 8 + 5, 13 * 8 + 6, 13 * 8 + 7});
    const auto loops = surface.boundary_loops();
    REQUIRE(loops.size() == 3);
    REQUIRE(surface.euler_characteristic() == -1);
    for (const bool is_one_free : {false, true}) {
        std::vector<int> fixed;
        std::vector<double> values;
        std::vector<char> is_fixed(surface.n_vertices(), 0);
        for (std::size_t i = 0; i < 3; ++i) {
            if (i == 2 && is_one_free) continue;
            for (const int h : loops[i]) {
                fixed.push_back(surface.origin(h));
                values.push_back(i == 0 ? 0.0 : 1.0);
                is_fixed[surface.origin(h)] = 1;
            }
        }
        for (const auto weights : {HarmonicWeights::mean_value, HarmonicWeights::uniform}) {
            const VectorX f = harmonic_function(surface, fixed, values, weights);
            for (int v = 0; v < surface.n_vertices(); ++v) {
                if (is_fixed[v] != 0) continue;
                REQUIRE(f[v] > 0.0);
                REQUIRE(f[v] < 1.0);
                double low = 1.0;
                double high = 0.0;
                for (const int w : neighbours(surface, v)) {
                    low = std::min(low, f[w]);
                    high = std::max(high, f[w]);
                }
                REQUIRE(f[v] >= low - 1e-14);
                REQUIRE(f[v] <= high + 1e-14);
            }
        }
    }
}

TEST_CASE("harmonic_function: triangles without area do no harm", "[meshing][surface]") {
    TriangleSoup soup = make_square(6);
    // Vertex 24 on top of its neighbour, and one row of triangles with aspect 1e6.
    soup.points[24] = soup.points[25];
    for (int i = 0; i <= 6; ++i) soup.points[7 * 2 + i].y() = soup.points[7 + i].y() + 1e-7;
    const CutSurface surface(soup);
    const auto fixed = boundary_vertices(surface);
    std::vector<double> values;
    for (const int v : fixed) values.push_back(surface.point(v).x());
    const VectorX f = harmonic_function(surface, fixed, values);
    for (int v = 0; v < surface.n_vertices(); ++v) {
        REQUIRE(f[v] >= 0.0);
        REQUIRE(f[v] <= 1.0);
    }
}

TEST_CASE("harmonic_function: errors say what is wrong", "[meshing][surface]") {
    const CutSurface surface(make_square(2));
    const std::vector<double> two{0.0, 1.0};
    const auto message = [&](const std::vector<int>& vertices, const std::vector<double>& values) {
        try {
            static_cast<void>(harmonic_function(surface, vertices, values));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(message({0}, two) == "harmonic_function: 1 vertices and 2 values; each vertex needs one");
    CHECK(message({0, 9}, two) ==
          "harmonic_function: vertex 9 (entry 1) does not exist; name different vertices of the 9 "
          "there are");
    CHECK(message({3, 3}, two) ==
          "harmonic_function: vertex 3 (entry 1) stands twice; name different vertices of the 9 "
          "there are");
    CHECK(message({}, {}) ==
          "solve_harmonic: no vertex of the component of vertex 0 is fixed; its values are not "
          "determined: fix at least one");
    HarmonicProblem problem;
    const std::vector<Vector3> points(3, Vector3::Zero());
    problem.points = points;
    REQUIRE_THROWS_WITH(solve_harmonic(problem),
                        Catch::Contains("3 points, 0 flags, 0 rows of values, 0 originals"));
}
