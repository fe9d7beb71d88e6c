#include "io/expression.h"

#include <omp.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"

using namespace couture;
using io::Expression;

TEST_CASE("Expression: values are those of the formula", "[io]") {
    const Vector3 x(0.3, -2.0, 5.0);
    CHECK(Expression("x + 2*y - z^2 + t")(x, 0.5) == 0.3 - 4.0 - 25.0 + 0.5);
    CHECK(Expression("sin(pi*x)")(x, 0.0) == Approx(std::sin(M_PI * 0.3)).epsilon(1e-15));
    CHECK(Expression("sqrt(x^2 + y^2)")(x, 0.0) == Approx(std::hypot(0.3, 2.0)).epsilon(1e-15));
    CHECK(Expression("log(e)")(x, 0.0) == Approx(1.0).epsilon(1e-15));
    CHECK(Expression("x > 0 ? 2 : 3")(x, 0.0) == 2.0);
    CHECK(Expression("y >= 0 ? 2 : 3")(x, 0.0) == 3.0);
    CHECK(Expression("1 + 1").variables().empty());
    CHECK(Expression("y*t").variables() == std::vector<std::string>{"t", "y"});
}

TEST_CASE("Expression: threads do not disturb each other", "[io]") {
    const Function f = Expression("x^2 + sin(y) + t");
    std::atomic<int> n_wrong = 0;
#pragma omp parallel for num_threads(4)
    for (int i = 0; i < 2000; ++i) {
        const Vector3 x(i, 0.5 * i, 0.0);
        if (f(x, 1.0) != std::pow(x[0], 2.0) + std::sin(x[1]) + 1.0) {
            ++n_wrong;
        }
    }
    CHECK(n_wrong == 0);
}

TEST_CASE("Expression: mistakes are shown with a caret", "[io]") {
    CHECK_THROWS_WITH(Expression("2 * sqr(x)"),
                      "expression: 'sqr' is neither a function nor one of x, y, z, t, pi, e; did "
                      "you mean 'sqrt'?\n        2 * sqr(x)\n            ^");
    CHECK_THROWS_WITH(Expression("x +"), "expression: ends too early\n        x +\n           ^");
    CHECK_THROWS_WITH(Expression("x = 3"),
                      "expression: '=' assigns; compare with '=='\n        x = 3\n          ^");
    CHECK_THROWS_WITH(Expression("  "),
                      "expression: the text is empty; give a number or an expression");
    CHECK_THROWS_WITH(Expression("1,5 * x"),
                      "expression: a comma stands between the arguments of a function only; "
                      "decimals are written with a point, as 1.5\n        1,5 * x\n         ^");
    CHECK_THROWS_WITH(Expression("2 * (1, x)"), Catch::Contains("arguments of a function only"));
    CHECK(Expression("min(1, (x), max(y, 2))")(Vector3(0.5, 3.0, 0.0), 0.0) == 0.5);
    std::string sum = "x";
    while (sum.size() < 25'000) {
        sum += "+0*y";
    }
    CHECK_THROWS_WITH(Expression(sum),
                      "expression: it has 25001 characters; at most 10000 are read");
    CHECK_THROWS_WITH(Expression(std::string(2000, '(') + "x" + std::string(2000, ')')),
                      "expression: more than 100 parentheses inside each other");
    const Expression f("1/x");
    CHECK_THROWS_WITH(f(Vector3(0.0, 1.0, 0.0), 0.0),
                      "expression '1/x': is inf at x = 0, y = 1, z = 0, t = 0");
}
