#pragma once

#include <array>
#include <utility>
#include <vector>

#include "iga/core/types.h"

namespace couture::iga {

/// Tensor-product Bernstein polynomial on [0, 1]^d. Coefficients: prod(degree + 1), first
/// direction fastest.
template <int d>
struct Bernstein {
    std::array<int, d> degrees{};
    std::vector<double> coefficients;

    /// The zero polynomial of these degrees.
    [[nodiscard]] static Bernstein zero(const std::array<int, d>& degrees);

    /// dP / dxi_k, of degree one less in direction k (degree >= 1 there).
    [[nodiscard]] Bernstein derivative(int direction) const;
    /// P on the lower and the upper half in one direction, each over [0, 1]^d again (de Casteljau).
    [[nodiscard]] std::pair<Bernstein, Bernstein> halves(int direction) const;
    /// P(xi) by de Casteljau.
    [[nodiscard]] double operator()(const Vector<d>& xi) const;
    /// Indices of a coefficient over degrees: the point it belongs to. Degree 0: 1/2.
    [[nodiscard]] Vector<d> abscissa(int i_coefficient) const;
};

/// Bernstein coefficients times their binomials: products become plain convolutions, whose weights
/// are all positive, so that they are as exact as the factors.
///
/// Source: [FaroukiRajan88] Sec. 4.2 (scaled Bernstein form).
template <int d>
struct ScaledBernstein {
    std::array<int, d> degrees{};
    std::vector<double> coefficients;

    [[nodiscard]] static ScaledBernstein zero(const std::array<int, d>& degrees);
    /// Adds factor * a * b, whose degrees must add up to these.
    void add_product(double factor, const ScaledBernstein& a, const ScaledBernstein& b);
};

template <int d>
[[nodiscard]] ScaledBernstein<d> to_scaled(const Bernstein<d>& polynomial);
template <int d>
[[nodiscard]] Bernstein<d> to_bernstein(const ScaledBernstein<d>& polynomial);

}  // namespace couture::iga
