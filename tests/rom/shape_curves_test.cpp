#include "rom/shape_curves.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "rom/pod.h"
#include "tests/rom/shape_samples.h"

using namespace couture;
using namespace couture::rom;
using namespace couture::tests;
using Catch::Matchers::Contains;

TEST_CASE("compactness: rises from 0 to 1, less and less", "[rom]") {
    const VectorX curve = compactness(make_shape_model(random_shapes(8, 20, 0.2)));
    REQUIRE(curve.size() == 8);
    CHECK(curve[0] == 0.0);
    CHECK(curve[7] == 1.0);
    for (int k = 1; k < 7; ++k) {
        CHECK(curve[k] > curve[k - 1]);
        CHECK(curve[k] - curve[k - 1] >= curve[k + 1] - curve[k]);
    }
    // Of the ellipsoids the first mode has steps twice as large, for coordinates of their own.
    const VectorX two = compactness(make_shape_model(ellipsoids(0.05)));
    const double x = 4.0 * sphere_points().col(0).squaredNorm();
    const double y = sphere_points().col(1).squaredNorm();
    CHECK(two[1] == Approx(x / (x + y)).epsilon(1e-11));
}

TEST_CASE("generalisation: falls with modes, to 0 where the others span a member", "[rom]") {
    // Nine members in two directions: any eight span the ninth.
    const ShapeModel model = make_shape_model(ellipsoids(0.05));
    const ShapeCurve curve = generalisation(model);
    REQUIRE(curve.values.size() == 3);
    CHECK(curve.values[1] < curve.values[0]);
    CHECK(curve.values[2] < curve.values[1]);
    CHECK(curve.values[2] < 1e-12);
    // Members without order never span each other.
    const ShapeCurve random = generalisation(make_shape_model(random_shapes(6, 40, 0.2)));
    REQUIRE(random.values.size() == 5);
    for (int k = 1; k < 5; ++k) CHECK(random.values[k] < random.values[k - 1]);
    CHECK(random.values[4] > 0.05);
}

TEST_CASE("generalisation: is that of models made without each member", "[rom]") {
    const std::vector<MatrixX> shapes = random_shapes(5, 10, 0.3);
    const AlignmentOptions as_they_are{.alignment = Alignment::none};
    const ShapeCurve curve = generalisation(make_shape_model(shapes, as_they_are));
    for (int k = 1; k <= 3; ++k) {
        VectorX distances(5);
        for (int j = 0; j < 5; ++j) {
            std::vector<MatrixX> others = shapes;
            others.erase(others.begin() + j);
            distances[j] =
                project_shape(make_shape_model(others, as_they_are), shapes[j], k).distance;
        }
        CHECK(curve.values[k] == Approx(distances.mean()).epsilon(1e-11));
        const double spread = std::sqrt((distances.array() - distances.mean()).square().sum() / 4);
        CHECK(curve.errors[k] == Approx(spread / std::sqrt(5.0)).epsilon(1e-11));
    }
}

TEST_CASE("specificity: without modes the distance of the mean, with them that of any sample",
          "[rom]") {
    const ShapeModel model = make_shape_model(random_shapes(6, 40, 0.2));
    const ShapeCurve curve = specificity(model, 500);
    REQUIRE(curve.values.size() == 6);
    CHECK(curve.values[0] ==
          Approx(model.coefficients.colwise().norm().minCoeff() / std::sqrt(40.0)));
    CHECK(curve.errors[0] < 1e-14);
    // Another sample gives the same but for its error.
    const ShapeCurve other = specificity(model, 500, 2);
    for (int k = 1; k < 6; ++k) {
        CHECK(std::abs(other.values[k] - curve.values[k]) <
              5.0 * (other.errors[k] + curve.errors[k]));
    }
}

TEST_CASE("specificity: of one mode in closed form", "[rom]") {
    // Members at -1 and 1 (times the mode): E | |z| s - 1 | with s = sqrt(2).
    const MatrixX shape = sphere_points();
    const ShapeModel model = make_shape_model({0.9 * shape, 1.1 * shape});
    REQUIRE(model.n_modes() == 1);
    const double s = std::sqrt(2.0);
    const double t = 1.0 / s;
    const double below = std::erf(t / std::sqrt(2.0));
    const double density = std::exp(-0.5 * t * t) * std::sqrt(2.0 / 3.14159265358979324);
    // Integral of (s z - 1) over the half normal, its sign turned below t.
    const double expected =
        (2.0 * below - 1.0) + s * (2.0 * density - std::sqrt(2.0 / 3.14159265358979324));
    const ShapeCurve curve = specificity(model, 4000);
    const double unit = 0.1 * shape_size(shape);
    CHECK(std::abs(curve.values[1] / unit - expected) < 4.0 * curve.errors[1] / unit);
    CHECK(curve.errors[1] / unit < 0.02);
}

TEST_CASE("shape curves: refuse too few members", "[rom]") {
    const MatrixX shape = sphere_points();
    const ShapeModel model = make_shape_model({shape, ellipsoid(1.1, 1.0, 1.0)});
    CHECK_THROWS_WITH(generalisation(model), Contains("2 members; leaving one out takes 3"));
    CHECK_THROWS_WITH(specificity(model, 1), Contains("1 virtual members"));
}
