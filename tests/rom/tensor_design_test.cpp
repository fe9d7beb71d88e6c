#include "rom/tensor_design.h"

#include <catch2/catch.hpp>

#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

TEST_CASE("TensorDesign: counts of the reference text", "[rom]") {
    CHECK(TensorDesign{{star_design(9, 2), full_design(1, 6)}}.n_points() == 222);
    CHECK(TensorDesign{{star_design(6, 2), full_design(1, 4), full_design(1, 4)}}.n_points() ==
          400);
}

TEST_CASE("TensorDesign: the last factor is fastest", "[rom]") {
    const TensorDesign design{{random_design(2, 3, 1), random_design(1, 2, 2)}};
    const MatrixX points = design.points();
    REQUIRE(points.rows() == 6);
    REQUIRE(points.cols() == 3);
    for (int i = 0; i < 6; ++i) {
        CHECK(points.row(i).head(2) == design.factors[0].row(i / 2));
        CHECK(points(i, 2) == design.factors[1](i % 2, 0));
    }
}
