#include "verification/geometry/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>

#include "meshing/surface/cube_sphere.h"
#include "meshing/surface/inflated_sphere.h"
#include "meshing/surface/triangle_tree.h"
#include "rom/designs.h"
#include "rom/shape_analysis.h"
#include "rom/shape_curves.h"
#include "verification/geometry/synthetic_aneurysm.h"

namespace couture::verification {

namespace {

MatrixX rows_of(const std::vector<Vector3>& points) {
    MatrixX rows(static_cast<Eigen::Index>(points.size()), 3);
    for (Eigen::Index v = 0; v < rows.rows(); ++v) rows.row(v) = points[v].transpose();
    return rows;
}

/// A rotation and translation that follow from the number.
rom::Similarity rigid_motion(int number) {
    const MatrixX values = rom::normal_design(7, 1, 100 + static_cast<std::uint64_t>(number));
    const Eigen::Quaterniond turn(values(0, 0), values(0, 1), values(0, 2), values(0, 3));
    return {turn.normalized().toRotationMatrix(), 1.0, 10.0 * values.rightCols(3).transpose()};
}

/// Axes 1 - 0.1, 1, 1 + 0.1 in x, half as much in y; each ellipsoid somewhere else.
void ellipsoids(Recorder& recorder) {
    const MatrixX sphere = rows_of(meshing::make_cube_sphere(6).points);
    std::vector<MatrixX> shapes;
    for (const int i : {-1, 0, 1}) {
        for (const int j : {-1, 0, 1}) {
            const MatrixX shape = sphere * Vector3(1.0 + 0.1 * i, 1.0 + 0.05 * j, 1.0).asDiagonal();
            shapes.push_back(rigid_motion(static_cast<int>(shapes.size())).apply(shape));
        }
    }
    const rom::ShapeModel model = rom::make_shape_model(shapes);
    recorder.set_source("closed form");
    recorder.absolute("modes", 2.0, model.n_modes(), 0.0);
    // Of nine steps -1, 0, 1 the variance is 6 / 8; x and y have the same sum of squares.
    const double unit = std::sqrt(6.0 / 8.0) * sphere.col(0).norm();
    recorder.relative("standard deviation of mode 1", 0.1 * unit, model.standard_deviations[0],
                      1e-11);
    recorder.relative("standard deviation of mode 2", 0.05 * unit, model.standard_deviations[1],
                      1e-11);
    recorder.relative("compactness of one mode", 0.8, rom::compactness(model)[1], 1e-11);
    recorder.vanishing("generalisation of two modes", rom::generalisation(model).values[2], 1e-12);
    const rom::ShapeProjection projection = rom::project_shape(
        model, rigid_motion(20).apply(sphere * Vector3(1.06, 0.98, 1.0).asDiagonal()), 2);
    recorder.relative("score of 1.06 along x", 0.6 / std::sqrt(0.75),
                      std::abs(projection.scores[0]), 1e-10);
    recorder.relative("score of 0.98 along y", 0.4 / std::sqrt(0.75),
                      std::abs(projection.scores[1]), 1e-10);
}

/// Vertices that are farther from the centre than the wall in their direction.
int n_behind(const meshing::InflatedSphere& sphere, const meshing::TriangleSoup& wall) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [a, b, c] : wall.triangles) {
        triangles.push_back({wall.points[a], wall.points[b], wall.points[c]});
    }
    const meshing::TriangleTree tree(std::move(triangles));
    constexpr double tolerance = 1e-9;
    return static_cast<int>(std::ranges::count_if(sphere.mesh.points, [&](const Vector3& point) {
        const Vector3 way = point - sphere.center;
        const auto wall_distance = tree.first_contact(sphere.center, way.normalized(), 0.0);
        return wall_distance && way.norm() > *wall_distance + tolerance;
    }));
}

void aneurysms(Recorder& recorder) {
    constexpr int n_members = 20;
    const meshing::InflationOptions options;
    const meshing::QuadMesh sphere = meshing::make_cube_sphere(options.n_divisions);
    std::vector<MatrixX> shapes;
    int n_equal = 0;
    int n_wrong = 0;
    double slowest = 0.0;
    double strain = 0.0;
    for (int k = 0; k <= n_members; ++k) {
        const SyntheticAneurysm aneurysm = make_synthetic_aneurysm(k);
        const std::clock_t start = std::clock();
        const meshing::InflatedSphere inflated = meshing::inflate_sphere(aneurysm.surface, options);
        const auto ticks = static_cast<double>(std::clock() - start);
        slowest = std::max(slowest, ticks / CLOCKS_PER_SEC);
        n_equal += inflated.mesh.quads == sphere.quads ? 1 : 0;
        n_wrong += n_behind(inflated, aneurysm.surface);
        strain = std::max(strain, inflated.max_strain());
        shapes.push_back(rows_of(inflated.mesh.points));
    }
    recorder.set_source("count");
    recorder.absolute("meshes with the connectivity of the sphere", n_members + 1, n_equal, 0.0);
    recorder.vanishing("vertices behind the wall", n_wrong, 0.0);
    recorder.set_source("[Maquart19] Eq. (5.1), corrected");
    recorder.vanishing("strain over its limit", std::max(strain - options.strain_limit, 0.0), 1e-9);
    recorder.set_source("[Maquart19] Sec. 5.2.3.3: a few seconds");
    recorder.vanishing("seconds of processor time, the slowest", slowest, 2.0);
    const MatrixX other = shapes.back();
    shapes.pop_back();
    const rom::ShapeModel model = rom::make_shape_model(shapes);
    recorder.set_source("orthogonal projection");
    double furthest = 0.0;
    for (const MatrixX& shape : shapes) {
        furthest = std::max(furthest, rom::project_shape(model, shape, model.n_modes()).distance);
    }
    recorder.vanishing("members from their projections", furthest, 1e-9);
    const rom::ShapeProjection projection = rom::project_shape(model, other, model.n_modes());
    recorder.vanishing("a new one from its projection, over that from the mean",
                       projection.distance / projection.distance_to_mean, 1.0);
}

}  // namespace

std::vector<Case> shape_cases() {
    return {{"shapes: ellipsoids", false, ellipsoids}, {"shapes: aneurysms", false, aneurysms}};
}

}  // namespace couture::verification
