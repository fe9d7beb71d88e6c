#include "iga/spline/refine.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Room for rounding of values of size one through a few hundred operations.
constexpr double rounding = 1e-13;
/// What the project asks of refinement, relative to the size of the geometry.
constexpr double unchanged = 1e-12;

/// Knots of every multiplicity from 1 to degree, spans from 1 to `1 / grading` in size.
KnotVector graded_knots(int degree, double grading) {
    std::vector<double> knots(degree + 1, -1.0);
    double xi = -1.0;
    for (int m = 1; m <= degree; ++m) {
        xi += m % 2 == 0 ? grading : 0.3 + 0.1 * m;
        knots.insert(knots.end(), m, xi);
    }
    knots.insert(knots.end(), degree + 1, xi + 0.5);
    return {degree, std::move(knots)};
}

VectorX all_functions(const KnotVector& knots, double xi) {
    VectorX values = VectorX::Zero(knots.n_basis());
    const int first = knots.find_span(xi) - knots.degree();
    values.segment(first, knots.degree() + 1) = basis_derivatives(knots, xi, 0).row(0).transpose();
    return values;
}

/// Largest deviation of coarse functions from their expression in fine ones.
double reproduction_error(const KnotVector& coarse, const Refinement& fine) {
    double error = 0.0;
    const int n_samples = 3;
    for (int e = 0; e < fine.knots.n_elements(); ++e) {
        const double first = fine.knots.breakpoints()[e];
        const double width = fine.knots.breakpoints()[e + 1] - first;
        for (int i = 0; i < n_samples; ++i) {
            const double xi = first + width * (i + 0.5) / n_samples;
            const VectorX expected = all_functions(coarse, xi);
            const VectorX obtained = fine.prolongation.transpose() * all_functions(fine.knots, xi);
            error = std::max(error, (expected - obtained).cwiseAbs().maxCoeff());
        }
    }
    return error;
}

void check_convex_rows(const Refinement& refinement) {
    const VectorX sums = refinement.prolongation * VectorX::Ones(refinement.prolongation.cols());
    CHECK((sums.array() - 1.0).abs().maxCoeff() < rounding);
    for (int k = 0; k < refinement.prolongation.outerSize(); ++k) {
        for (SparseMatrix::InnerIterator it(refinement.prolongation, k); it; ++it) {
            CHECK(it.value() >= 0.0);
        }
    }
}

template <int d>
MatrixX random_coefficients(int rows) {
    std::mt19937 generator(17 + d);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return MatrixX::NullaryExpr(rows, d, [&] { return uniform(generator); });
}

}  // namespace

TEST_CASE("refine: insertion reproduces every function, for every degree and multiplicity",
          "[spline]") {
    for (int degree = 1; degree <= max_degree; ++degree) {
        for (const double grading : {0.4, 1e-6}) {
            const KnotVector coarse = graded_knots(degree, grading);
            std::vector<double> added;
            for (int e = 0; e < coarse.n_elements(); ++e) {
                const double first = coarse.breakpoints()[e];
                const double width = coarse.breakpoints()[e + 1] - first;
                added.insert(added.end(), 1 + e % degree, first + 0.3 * width);
                added.push_back(first + 0.9 * width);
                const int room = e == 0 ? 0 : degree - coarse.multiplicities()[e];
                added.insert(added.end(), room, first);
            }
            const Refinement fine = insert_knots(coarse, added);
            CHECK(fine.knots.n_basis() == coarse.n_basis() + static_cast<int>(added.size()));
            CHECK(reproduction_error(coarse, fine) < rounding);
            check_convex_rows(fine);
        }
    }
}

TEST_CASE("refine: elevation reproduces every function and keeps the continuity", "[spline]") {
    for (int degree = 1; degree <= max_degree; ++degree) {
        for (int n_times = 0; degree + n_times <= max_degree; ++n_times) {
            const KnotVector coarse = graded_knots(degree, 1e-6);
            const Refinement fine = elevate_degree(coarse, n_times);
            CHECK(fine.knots.degree() == degree + n_times);
            for (int e = 0; e <= coarse.n_elements(); ++e) {
                CHECK(fine.knots.multiplicities()[e] == coarse.multiplicities()[e] + n_times);
            }
            CHECK(reproduction_error(coarse, fine) < rounding);
            check_convex_rows(fine);
        }
    }
}

TEST_CASE("refine: elevation of one element is the formula of Bezier curves", "[spline]") {
    for (int degree = 1; degree < max_degree; ++degree) {
        const SparseMatrix& matrix = elevate_degree(KnotVector::uniform(degree, 1), 1).prolongation;
        for (int i = 0; i <= degree + 1; ++i) {
            const double alpha = static_cast<double>(i) / (degree + 1);
            if (i <= degree) {
                CHECK(matrix.coeff(i, i) == Approx(1.0 - alpha).epsilon(rounding));
            }
            if (i > 0) {
                CHECK(matrix.coeff(i, i - 1) == Approx(alpha).epsilon(rounding));
            }
        }
        CHECK(matrix.nonZeros() == 2 * degree + 2);
    }
}

TEST_CASE("refine: k-refinement raises first and splits with simple knots", "[spline]") {
    const KnotVector coarse(2, {0, 0, 0, 0.25, 0.5, 0.5, 1, 1, 1});
    const Refinement fine = refine(coarse, 3, 5);
    CHECK(fine.knots ==
          KnotVector(3, {0, 0, 0, 0, 0.125, 0.25, 0.25, 0.375, 0.5, 0.5, 0.5, 0.75, 1, 1, 1, 1}));
    CHECK(reproduction_error(coarse, fine) < rounding);
    CHECK(refine(coarse, 2, 1).knots == coarse);
    CHECK(refine(coarse, 2, 3).knots == coarse);
    CHECK(refine(coarse, 2, 4).knots.n_elements() == 6);
    CHECK(refine(coarse, 8, 30).knots.n_elements() == 30);
}

TEST_CASE("refine: an element too small for parts stays whole", "[spline]") {
    const double tiny = 1e-12;
    const KnotVector coarse(1, {0, 0, 0.5, 0.5 + tiny, 1, 1});
    CHECK(refine(coarse, 1, 6).knots ==
          KnotVector(1, {0, 0, 0.25, 0.5, 0.5 + tiny, 0.5 + tiny + (0.5 - tiny) / 2, 1, 1}));
}

TEST_CASE("refine: knots within the tolerance are one knot", "[spline]") {
    const KnotVector coarse(2, {0, 0, 0, 0.5, 1, 1, 1});
    const double noise = 0.4 * knot_tolerance_of_span;
    const Refinement fine =
        insert_knots(coarse, std::vector<double>{0.5 + noise, 0.25, 0.25 + noise});
    CHECK(fine.knots == KnotVector(2, {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 1, 1, 1}));

    const KnotVector noisy(2, {noise, noise, noise, 0.5 - noise, 1, 1, 1});
    CHECK(common_refinement(coarse, noisy) == coarse);
    CHECK(prolongation_to(coarse, noisy).knots == noisy);
    CHECK(prolongation_to(coarse, noisy).prolongation.nonZeros() == coarse.n_basis());
}

TEST_CASE("refine: prolongation to any containing space is exact and banded", "[spline]") {
    for (int degree = 1; degree <= max_degree; ++degree) {
        for (int other = 1; other <= max_degree; ++other) {
            const KnotVector a = graded_knots(degree, 1e-6);
            const KnotVector b = KnotVector::uniform(other, 7, a.front(), a.back());
            const KnotVector common = common_refinement(a, b);
            for (const KnotVector& coarse : {a, b}) {
                const Refinement fine = prolongation_to(coarse, common);
                CHECK(fine.knots == common);
                CHECK(reproduction_error(coarse, fine) < rounding);
                check_convex_rows(fine);
            }
        }
    }
    // Halving every element of degree 4 combines 3 neighbours inside.
    const KnotVector coarse = KnotVector::uniform(4, 200);
    const Refinement fine = refine(coarse, 4, 400);
    CHECK(fine.prolongation.nonZeros() <= 3 * fine.prolongation.rows() + 20);
    CHECK(fine.prolongation.rows() == 404);
}

TEST_CASE("refine: the common refinement is the smallest", "[spline]") {
    const KnotVector a(2, {0, 0, 0, 0.25, 0.5, 0.5, 1, 1, 1});
    const KnotVector b(3, {0, 0, 0, 0, 0.5, 0.75, 1, 1, 1, 1});
    CHECK(common_refinement(a, b) ==
          KnotVector(3, {0, 0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.5, 0.75, 1, 1, 1, 1}));
    CHECK(common_refinement(a, a) == a);
}

TEST_CASE("refine: a rational patch keeps its map and derivatives", "[spline]") {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int degree = 1; degree <= max_degree; ++degree) {
        const TensorSpace<2> space{{graded_knots(degree, 0.01), graded_knots(1, 0.4)}};
        const VectorX weights = (random_coefficients<1>(space.n_basis()).array() + 1.5).matrix();
        const Patch<2> patch(space, random_coefficients<3>(space.n_basis()), weights);
        const Patch<2> fine = refine<2>(
            patch, {refine(space.knots[0], degree, 12), refine(space.knots[1], max_degree, 3)});
        const TensorSpace<2> finer{
            {common_refinement(fine.knots(0), elevate_degree(space.knots[0], degree < 8).knots),
             fine.knots(1)}};
        const Patch<2> finest = refine_to<2>(fine, finer);
        for (int i = 0; i < 50; ++i) {
            const double length_0 = space.knots[0].back() - space.knots[0].front();
            const double length_1 = space.knots[1].back() - space.knots[1].front();
            const Vector2 xi(space.knots[0].front() + uniform(generator) * length_0,
                             space.knots[1].front() + uniform(generator) * length_1);
            CHECK((patch.point(xi) - fine.point(xi)).norm() < unchanged);
            CHECK((patch.point(xi) - finest.point(xi)).norm() < unchanged);
            const MatrixX J = patch.jacobian(xi);
            CHECK((J - finest.jacobian(xi)).norm() < 100 * unchanged * (1.0 + J.norm()));
        }
    }
}

TEST_CASE("refine: the Kronecker product runs with the first direction fastest", "[spline]") {
    std::array<SparseMatrix, 3> matrices{refine(KnotVector::uniform(1, 1), 2, 2).prolongation,
                                         refine(KnotVector::uniform(2, 2), 3, 2).prolongation,
                                         refine(KnotVector::uniform(1, 2), 1, 4).prolongation};
    const int n_0 = static_cast<int>(matrices[0].cols());
    const int n_1 = static_cast<int>(matrices[1].cols());
    const int n_2 = static_cast<int>(matrices[2].cols());
    const MatrixX coefficients = random_coefficients<2>(n_0 * n_1 * n_2);
    const MatrixX obtained = apply_kronecker<3>(matrices, coefficients);
    REQUIRE(obtained.rows() == matrices[0].rows() * matrices[1].rows() * matrices[2].rows());
    REQUIRE(obtained.cols() == 2);
    for (int c = 0; c < 2; ++c) {
        for (int row = 0; row < obtained.rows(); ++row) {
            const int i = row % static_cast<int>(matrices[0].rows());
            const int rest = row / static_cast<int>(matrices[0].rows());
            const int j = rest % static_cast<int>(matrices[1].rows());
            const int k = rest / static_cast<int>(matrices[1].rows());
            double sum = 0.0;
            for (int column = 0; column < coefficients.rows(); ++column) {
                sum += matrices[0].coeff(i, column % n_0) *
                       matrices[1].coeff(j, column / n_0 % n_1) *
                       matrices[2].coeff(k, column / (n_0 * n_1)) * coefficients(column, c);
            }
            CHECK(std::abs(sum - obtained(row, c)) < rounding);
        }
    }
}

TEST_CASE("refine: broken rules are named with their values", "[spline]") {
    const KnotVector knots(2, {0, 0, 0, 0.5, 1, 1, 1});
    CHECK_THROWS_WITH(insert_knots(knots, std::vector<double>{1.5}),
                      "insert_knots: new knot 1.5 does not lie inside (0, 1)");
    CHECK_THROWS_WITH(insert_knots(knots, std::vector<double>{std::nan("")}),
                      "insert_knots: new knot nan does not lie inside (0, 1)");
    CHECK_THROWS_WITH(insert_knots(knots, std::vector<double>{0.5, 0.5}),
                      "insert_knots: knot 0.5 would occur 3 times; an interior knot of degree 2 "
                      "occurs at most 2 times");
    CHECK_THROWS_WITH(elevate_degree(knots, 7),
                      "elevate_degree: degree 2 raised 7 times; the result must be from 2 to 8");
    CHECK_THROWS_WITH(refine(knots, 1, 4),
                      "refine: degree 1 asked of a spline of degree 2; it can only be raised, up "
                      "to 8");
    CHECK_THROWS_WITH(refine(knots, 2, 0), "refine: 0 elements asked; must be at least 1");
    CHECK_THROWS_WITH(prolongation_to(knots, KnotVector::uniform(1, 2)),
                      "prolongation_to: degree 1 of the finer space is below degree 2 of the "
                      "coarser one; it must not be");
    CHECK_THROWS_WITH(prolongation_to(knots, KnotVector::uniform(2, 3)),
                      "prolongation_to: knot 0.5 of the coarser space is missing in the finer "
                      "one; all must be there, see common_refinement");
    CHECK_THROWS_WITH(
        prolongation_to(knots, KnotVector::uniform(3, 2)),
        "prolongation_to: knot 0.5 occurs 1 times in the finer space; it must occur at "
        "least 2 times, the 1 of the coarser one and 1 for the raised degree");
    CHECK_THROWS_WITH(common_refinement(knots, KnotVector::uniform(2, 2, 0, 2)),
                      "common_refinement: the knot vectors span [0, 1] and [0, 2]; they must span "
                      "the same interval, see KnotVector::rescaled");
    CHECK_THROWS_WITH(apply_kronecker<1>({refine(knots, 2, 2).prolongation}, MatrixX::Zero(3, 1)),
                      "apply_kronecker: 3 rows of coefficients; the matrices ask for 4");
    const Patch<1> curve(TensorSpace<1>{{knots}}, MatrixX::Zero(4, 2));
    CHECK_THROWS_WITH(refine<1>(curve, {refine(KnotVector::uniform(1, 1), 1, 2)}),
                      "refine: the refinement of direction 0 starts from 2 functions; the patch "
                      "has 4");
}
