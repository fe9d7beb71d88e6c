#include "iga/spline/gauss.h"

#include <array>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

// One more format than double, so that the rounded results carry no error of the iteration.
using Real = long double;

struct Legendre {
    Real value;
    Real derivative;
};

Legendre legendre(int n, Real x) {
    Real before = 1.0L;
    Real value = x;
    for (int k = 2; k <= n; ++k) {
        const Real next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
    }
    return {value, n * (before - x * value) / (1.0L - x * x)};
}

GaussRule make_rule(int n) {
    GaussRule rule{std::vector<double>(n), std::vector<double>(n)};
    // The rule is symmetric: the upper half mirrors the lower one.
    for (int i = 0; 2 * i < n; ++i) {
        Real x = 0.0L;
        if (2 * i + 1 != n) {
            x = -std::cos(std::numbers::pi_v<Real> * (i + 0.75L) / (n + 0.5L));
            constexpr int max_iterations = 10;
            for (int iteration = 0; iteration < max_iterations; ++iteration) {
                const Legendre P = legendre(n, x);
                x -= P.value / P.derivative;
            }
        }
        const Real dP = legendre(n, x).derivative;
        const Real weight = 1.0L / ((1.0L - x * x) * dP * dP);
        rule.points[i] = static_cast<double>((1.0L + x) / 2.0L);
        rule.points[n - 1 - i] = static_cast<double>((1.0L - x) / 2.0L);
        rule.weights[i] = rule.weights[n - 1 - i] = static_cast<double>(weight);
    }
    return rule;
}

}  // namespace

const GaussRule& gauss_rule(int n) {
    static const std::array<GaussRule, max_gauss_points> rules = [] {
        std::array<GaussRule, max_gauss_points> result;
        for (int i = 0; i < max_gauss_points; ++i) {
            result[i] = make_rule(i + 1);
        }
        return result;
    }();
    if (n < 1 || n > max_gauss_points) {
        throw InputError("gauss_rule: {} points; must be from 1 to {}", n, max_gauss_points);
    }
    return rules[n - 1];
}

}  // namespace couture::iga
