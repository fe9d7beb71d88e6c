#include "meshing/surface/curvature_clusters.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

#include "meshing/parts/part_surface.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double pi = std::numbers::pi;

CurvatureClusters clusters_of(const std::string& part) {
    return find_curvature_clusters(make_surface_mesh(make_part_surface(part).soup));
}

double total(const CurvatureClusters& clusters) {
    return std::accumulate(clusters.clusters.begin(), clusters.clusters.end(), clusters.rest,
                           [](double sum, const auto& c) { return sum + c.curvature; });
}

}  // namespace

TEST_CASE("curvature clusters: a quarter turn at each corner of a cube", "[surface][parts]") {
    const CurvatureClusters clusters = clusters_of("cube");
    REQUIRE(clusters.clusters.size() == 8);
    for (const CurvatureCluster& cluster : clusters.clusters) {
        REQUIRE(cluster.curvature == Approx(0.5 * pi));
        REQUIRE(cluster.quarter_turns == 1);
        for (const int v : cluster.vertices) REQUIRE(clusters.cluster_of_vertex[v] >= 0);
    }
    REQUIRE(clusters.missing_quarter_turns == 0);
    REQUIRE(std::abs(clusters.rest) < 1e-9);
}

TEST_CASE("curvature clusters: a torus is a bump outside and a saddle inside", "[surface][parts]") {
    const CurvatureClusters clusters = clusters_of("torus");
    REQUIRE(clusters.clusters.size() == 2);
    int turns = 0;
    for (const CurvatureCluster& cluster : clusters.clusters) {
        REQUIRE(std::abs(cluster.curvature) == Approx(4.0 * pi).epsilon(0.1));
        REQUIRE(std::abs(cluster.quarter_turns) == 8);
        turns += cluster.quarter_turns;
    }
    REQUIRE(turns == 0);
    REQUIRE(clusters.missing_quarter_turns == 0);
    REQUIRE(std::abs(total(clusters)) < 1e-9);
}

TEST_CASE("curvature clusters: sums obey Gauss and Bonnet on every part", "[surface][parts]") {
    for (const PartInfo& part : part_surfaces()) {
        CAPTURE(part.name);
        const SurfaceMesh mesh = make_surface_mesh(make_part_surface(part.name).soup);
        const CurvatureClusters clusters = find_curvature_clusters(mesh);
        const int chi = static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
                        static_cast<int>(mesh.n_faces());
        REQUIRE(total(clusters) == Approx(2.0 * pi * chi).margin(1e-7));
        int turns = clusters.missing_quarter_turns;
        for (const CurvatureCluster& cluster : clusters.clusters) turns += cluster.quarter_turns;
        REQUIRE(turns == 4 * chi);
    }
}
