#include "iga/spline/approximate.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// The condition of Greville collocation grows like 2^degree.
constexpr double reproduced = 1e-12;

KnotVector uneven_knots(int degree) {
    std::vector<double> knots(degree + 1, -1.0);
    for (int m = 1; m <= degree; ++m) {
        knots.insert(knots.end(), m, -0.9 + 0.2 * m * m);
    }
    knots.insert(knots.end(), degree + 1, 0.2 * (degree + 1) * (degree + 1));
    return {degree, std::move(knots)};
}

VectorX spline_value(const TensorSpace<3>& space, const MatrixX& coefficients,
                     const Vector<3>& xi) {
    const PointBasis<3> basis = evaluate_basis(space, {}, xi);
    VectorX value = VectorX::Zero(coefficients.cols());
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        value += basis.values[i] * coefficients.row(basis.functions[i]).transpose();
    }
    return value;
}

}  // namespace

TEST_CASE("interpolate: splines of the space are reproduced, for every degree", "[spline]") {
    for (int degree = 1; degree <= max_degree; ++degree) {
        const TensorSpace<3> space{
            {uneven_knots(degree), KnotVector::uniform(2, 3), KnotVector::uniform(1, 1)}};
        MatrixX expected(space.n_basis(), 2);
        for (int i = 0; i < space.n_basis(); ++i) {
            expected.row(i) << std::sin(3.0 * i), std::cos(7.0 * i);
        }
        const MatrixX obtained = interpolate<3>(
            space, 2, [&](const Vector<3>& xi) { return spline_value(space, expected, xi); });
        CHECK((expected - obtained).cwiseAbs().maxCoeff() < reproduced);
    }
}

TEST_CASE("interpolate: a smooth function converges with order degree + 1", "[spline]") {
    for (int degree = 1; degree <= 5; ++degree) {
        double errors[2];
        for (int level = 0; level < 2; ++level) {
            const TensorSpace<1> space{{KnotVector::uniform(degree, 8 << level)}};
            const MatrixX c = interpolate<1>(space, 1, [](const Vector<1>& xi) {
                return VectorX::Constant(1, std::exp(std::sin(4.0 * xi[0])));
            });
            errors[level] = 0.0;
            for (int i = 0; i <= 500; ++i) {
                const double xi = i / 500.0;
                const int first = space.knots[0].find_span(xi) - degree;
                const double value = (basis_derivatives(space.knots[0], xi, 0) *
                                      c.middleRows(first, degree + 1))(0, 0);
                errors[level] =
                    std::max(errors[level], std::abs(value - std::exp(std::sin(4.0 * xi))));
            }
        }
        CHECK(std::log2(errors[0] / errors[1]) > degree + 0.5);
    }
}

TEST_CASE("interpolate: a function of the wrong kind is refused", "[spline]") {
    const TensorSpace<1> space{{KnotVector::uniform(2, 3)}};
    CHECK_THROWS_WITH(
        interpolate<1>(space, 2, [](const Vector<1>&) { return VectorX::Zero(1).eval(); }),
        "interpolate: the function returns 1 numbers; 2 were promised");
    CHECK_THROWS_WITH(
        interpolate<1>(space, 1,
                       [](const Vector<1>& xi) { return VectorX::Constant(1, std::sqrt(-xi[0])); }),
        Catch::Contains(
            "interpolate: the function is not finite at Greville point 1, xi[0] = 0.1"));
}
