#include "rom/procrustes.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/rom/shape_samples.h"

using namespace couture;
using namespace couture::rom;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace {

// Coordinates are of size 10.
constexpr double rounding = 1e-13;

MatrixX mirrored(MatrixX points) {
    points.col(1) *= -1.0;
    return points;
}

}  // namespace

TEST_CASE("fit_rigid: finds the motion that points were given", "[rom]") {
    const MatrixX points = random_shapes(1, 20, 0.3)[0];
    for (int number = 0; number < 20; ++number) {
        const Similarity motion = rigid_motion(number);
        const Similarity found = fit_rigid(points, motion.apply(points));
        CHECK((found.rotation - motion.rotation).norm() < rounding);
        CHECK((found.translation - motion.translation).norm() < 10.0 * rounding);
    }
}

TEST_CASE("fit_rigid: no other rotation fits better", "[rom]") {
    const std::vector<MatrixX> shapes = random_shapes(2, 15, 1.0);
    const Similarity best = fit_rigid(shapes[0], shapes[1]);
    const double distance = rms_distance(best.apply(shapes[0]), shapes[1]);
    for (int number = 0; number < 200; ++number) {
        Similarity other = best;
        const Matrix<3> far = rigid_motion(number).rotation;
        // Near ones too: a part of the way towards a far one.
        const double part = number % 2 == 0 ? 1.0 : 1e-3;
        other.rotation = best.rotation * ((1.0 - part) * Matrix<3>::Identity() + part * far);
        other.rotation =
            fit_rigid(MatrixX(Matrix<3>::Identity()), MatrixX(other.rotation.transpose())).rotation;
        CHECK(rms_distance(other.apply(shapes[0]), shapes[1]) > distance);
    }
}

TEST_CASE("fit_rigid: never mirrors, and says when that would fit", "[rom]") {
    const MatrixX points = random_shapes(1, 20, 0.3)[0];
    const MatrixX image = mirrored(points);
    const Similarity motion = fit_rigid(image, points);
    CHECK(motion.rotation.determinant() == Approx(1.0));
    CHECK(rms_distance(motion.apply(image), points) > 0.1);
    CHECK(fits_mirrored(image, points));
    CHECK_FALSE(fits_mirrored(points, points));
    // A plane shape is its own mirror image.
    MatrixX plane = points;
    plane.col(2).setZero();
    const Similarity turn = fit_rigid(mirrored(plane), plane);
    CHECK(turn.rotation.determinant() == Approx(1.0));
    CHECK(rms_distance(turn.apply(mirrored(plane)), plane) < rounding);
}

TEST_CASE("Similarity: inverse and composition", "[rom]") {
    Similarity first = rigid_motion(1);
    first.scale = 2.5;
    const Similarity second = rigid_motion(2);
    const MatrixX points = sphere_points();
    CHECK((second.after(first).apply(points) - second.apply(first.apply(points))).norm() < 1e-12);
    CHECK((first.inverse().apply(first.apply(points)) - points).norm() < 1e-12);
}

TEST_CASE("align_population: rigid motions are removed", "[rom]") {
    const std::vector<MatrixX> same(6, random_shapes(1, 30, 0.3)[0]);
    const AlignedPopulation population = align_population(moved(same));
    CHECK(population.has_converged);
    for (const MatrixX& shape : population.shapes) {
        CHECK(rms_distance(shape, population.shapes[0]) < 1e-12);
    }
    CHECK(rms_distance(population.mean, population.shapes[0]) < 1e-12);
}

TEST_CASE("align_population: does not see the places of the members", "[rom]") {
    const std::vector<MatrixX> shapes = random_shapes(8, 30, 0.2);
    const AlignedPopulation a = align_population(shapes);
    const AlignedPopulation b = align_population(moved(shapes));
    CHECK(a.has_converged);
    CHECK(b.has_converged);
    CHECK(a.reference == b.reference);
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        // Only as they stand to each other: each population stands at its own reference.
        CHECK(rms_distance(a.shapes[j], a.mean) ==
              Approx(rms_distance(b.shapes[j], b.mean)).epsilon(1e-11));
    }
}

TEST_CASE("align_population: stands where the reference does", "[rom]") {
    const std::vector<MatrixX> shapes = moved(random_shapes(5, 12, 0.2));
    const int reference = GENERATE(0, 3);
    const AlignedPopulation population = align_population(shapes, {.reference = reference});
    CHECK(population.reference == reference);
    CHECK(population.shapes[reference] == shapes[reference]);
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        CHECK((population.motions[j].apply(shapes[j]) - population.shapes[j]).norm() < 1e-12);
        CHECK(population.motions[j].rotation.determinant() == Approx(1.0));
    }
}

TEST_CASE("align_population: the member nearest to the mean is the reference", "[rom]") {
    std::vector<MatrixX> shapes = ellipsoids(0.1);
    std::swap(shapes[4], shapes[7]);
    CHECK(align_population(shapes).reference == 7);
    CHECK(align_population(shapes, {.alignment = Alignment::none}).reference == 7);
}

TEST_CASE("align_population: sizes are kept or made equal", "[rom]") {
    const MatrixX shape = random_shapes(1, 30, 0.3)[0];
    const std::vector<MatrixX> shapes = moved({shape, 2.0 * shape, 3.0 * shape});
    const AlignedPopulation rigid = align_population(shapes);
    CHECK(shape_size(rigid.shapes[2]) == Approx(3.0 * shape_size(rigid.shapes[0])));
    const AlignedPopulation similar =
        align_population(shapes, {.alignment = Alignment::similarity});
    for (const MatrixX& aligned : similar.shapes) {
        CHECK(rms_distance(aligned, similar.shapes[0]) < 1e-12);
    }
    CHECK(similar.motions[similar.reference].scale == 1.0);
}

TEST_CASE("align_population: without alignment members stay", "[rom]") {
    const std::vector<MatrixX> shapes = moved(random_shapes(4, 5, 0.2));
    const AlignedPopulation population = align_population(shapes, {.alignment = Alignment::none});
    CHECK(population.shapes == shapes);
    CHECK((population.mean - (shapes[0] + shapes[1] + shapes[2] + shapes[3]) / 4.0).norm() < 1e-13);
}

TEST_CASE("align_population: refuses what is no population", "[rom]") {
    const MatrixX shape = sphere_points();
    CHECK_THROWS_WITH(align_population({}), Contains("0 members of 0 points"));
    CHECK_THROWS_WITH(align_population({shape, shape.topRows(5)}),
                      Contains("member 1 has 5 x 3 coordinates, member 0 24 x 3"));
    MatrixX broken = shape;
    broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(align_population({shape, broken}), Contains("member 1 has coordinates"));
    CHECK_THROWS_WITH(align_population({shape, shape}, {.reference = 2}),
                      Contains("reference 2; members are 0 to 1"));
    CHECK_THROWS_WITH(
        align_population({shape, MatrixX::Ones(24, 3)}, {.alignment = Alignment::similarity}),
        Contains("all points of member 1 are one"));
}
