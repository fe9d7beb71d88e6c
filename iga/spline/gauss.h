#pragma once

#include <vector>

namespace couture::iga {

/// Points and weights on [0, 1]; points increase, weights sum to 1.
struct GaussRule {
    std::vector<double> points;
    std::vector<double> weights;
};

constexpr int max_gauss_points = 64;

/// Gauss-Legendre rule of n points, exact for polynomials of degree 2 n - 1. Roots of the Legendre
/// polynomial by Newton, computed once; safe to call from many threads.
///
/// @param n  from 1 to `max_gauss_points`
/// @throws InputError  for other n
///
/// Source: [AbramowitzStegun72] Eq. 25.4.29.
[[nodiscard]] const GaussRule& gauss_rule(int n);

}  // namespace couture::iga
