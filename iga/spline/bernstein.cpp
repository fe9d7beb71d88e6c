#include "iga/spline/bernstein.h"

#include <cassert>
#include <cstddef>

namespace couture::iga {

namespace {

template <int d>
std::size_t n_coefficients(const std::array<int, d>& degrees) {
    std::size_t product = 1;
    for (const int degree : degrees) {
        product *= static_cast<std::size_t>(degree) + 1;
    }
    return product;
}

/// The coefficients as [outer][i][inner] with i the index in one direction.
struct Lines {
    std::size_t n_outer = 1;
    std::size_t n = 1;
    std::size_t n_inner = 1;
};

template <int d>
Lines lines(const std::array<int, d>& degrees, int direction) {
    Lines result;
    for (int k = 0; k < d; ++k) {
        const auto n = static_cast<std::size_t>(degrees[k]) + 1;
        (k < direction ? result.n_inner : k == direction ? result.n : result.n_outer) *= n;
    }
    return result;
}

std::vector<double> binomials(int n) {
    std::vector<double> result(n + 1, 1.0);
    for (int i = 1; i <= n; ++i) {
        result[i] = result[i - 1] * (n - i + 1) / i;
    }
    return result;
}

/// Multiplies (or divides) every coefficient by the binomials of its indices.
template <int d>
void scale(const std::array<int, d>& degrees, bool divide, std::vector<double>& coefficients) {
    for (int k = 0; k < d; ++k) {
        const Lines shape = lines<d>(degrees, k);
        const std::vector<double> weights = binomials(degrees[k]);
        double* c = coefficients.data();
        for (std::size_t outer = 0; outer < shape.n_outer; ++outer) {
            for (std::size_t i = 0; i < shape.n; ++i) {
                for (std::size_t inner = 0; inner < shape.n_inner; ++inner, ++c) {
                    *c = divide ? *c / weights[i] : *c * weights[i];
                }
            }
        }
    }
}

/// out += factor * a * b along the last of `n_directions` directions, the others by recursion.
void convolve(int n_directions, double factor, const double* a, const int* a_degrees,
              const double* b, const int* b_degrees, double* out) {
    const int k = n_directions - 1;
    if (k == 0) {
        for (int i = 0; i <= a_degrees[0]; ++i) {
            const double weight = factor * a[i];
            for (int j = 0; j <= b_degrees[0]; ++j) {
                out[i + j] += weight * b[j];
            }
        }
        return;
    }
    std::size_t a_stride = 1;
    std::size_t b_stride = 1;
    std::size_t out_stride = 1;
    for (int m = 0; m < k; ++m) {
        a_stride *= a_degrees[m] + 1;
        b_stride *= b_degrees[m] + 1;
        out_stride *= a_degrees[m] + b_degrees[m] + 1;
    }
    for (int i = 0; i <= a_degrees[k]; ++i) {
        for (int j = 0; j <= b_degrees[k]; ++j) {
            convolve(k, factor, a + i * a_stride, a_degrees, b + j * b_stride, b_degrees,
                     out + (i + j) * out_stride);
        }
    }
}

}  // namespace

template <int d>
Bernstein<d> Bernstein<d>::zero(const std::array<int, d>& degrees) {
    return {degrees, std::vector<double>(n_coefficients<d>(degrees), 0.0)};
}

template <int d>
Bernstein<d> Bernstein<d>::derivative(int direction) const {
    assert(degrees[direction] >= 1);
    std::array<int, d> lower = degrees;
    --lower[direction];
    Bernstein result = zero(lower);
    const Lines shape = lines<d>(degrees, direction);
    double* out = result.coefficients.data();
    for (std::size_t outer = 0; outer < shape.n_outer; ++outer) {
        const double* c = coefficients.data() + outer * shape.n * shape.n_inner;
        for (std::size_t i = 0; i < (shape.n - 1) * shape.n_inner; ++i, ++out) {
            *out = degrees[direction] * (c[i + shape.n_inner] - c[i]);
        }
    }
    return result;
}

template <int d>
std::pair<Bernstein<d>, Bernstein<d>> Bernstein<d>::halves(int direction) const {
    std::pair<Bernstein, Bernstein> result{*this, *this};
    const Lines shape = lines<d>(degrees, direction);
    for (std::size_t outer = 0; outer < shape.n_outer; ++outer) {
        const std::size_t begin = outer * shape.n * shape.n_inner;
        double* low = result.first.coefficients.data() + begin;
        double* high = result.second.coefficients.data() + begin;
        for (std::size_t r = 1; r < shape.n; ++r) {
            for (std::size_t i = 0; i < (shape.n - r) * shape.n_inner; ++i) {
                high[i] = 0.5 * (high[i] + high[i + shape.n_inner]);
            }
            for (std::size_t inner = 0; inner < shape.n_inner; ++inner) {
                low[r * shape.n_inner + inner] = high[inner];
            }
        }
    }
    return result;
}

template <int d>
double Bernstein<d>::operator()(const Vector<d>& xi) const {
    std::vector<double> c = coefficients;
    std::size_t n_lines = c.size();
    for (int k = d - 1; k >= 0; --k) {
        n_lines /= static_cast<std::size_t>(degrees[k]) + 1;
        for (int r = degrees[k]; r >= 1; --r) {
            for (std::size_t i = 0; i < r * n_lines; ++i) {
                c[i] = (1.0 - xi[k]) * c[i] + xi[k] * c[i + n_lines];
            }
        }
    }
    return c[0];
}

template <int d>
Vector<d> Bernstein<d>::abscissa(int i_coefficient) const {
    Vector<d> xi;
    for (int k = 0; k < d; ++k) {
        const int i = i_coefficient % (degrees[k] + 1);
        i_coefficient /= degrees[k] + 1;
        xi[k] = degrees[k] == 0 ? 0.5 : static_cast<double>(i) / degrees[k];
    }
    return xi;
}

template <int d>
ScaledBernstein<d> ScaledBernstein<d>::zero(const std::array<int, d>& degrees) {
    return {degrees, std::vector<double>(n_coefficients<d>(degrees), 0.0)};
}

template <int d>
void ScaledBernstein<d>::add_product(double factor, const ScaledBernstein& a,
                                     const ScaledBernstein& b) {
    for (int k = 0; k < d; ++k) {
        assert(a.degrees[k] + b.degrees[k] == degrees[k]);
    }
    convolve(d, factor, a.coefficients.data(), a.degrees.data(), b.coefficients.data(),
             b.degrees.data(), coefficients.data());
}

template <int d>
ScaledBernstein<d> to_scaled(const Bernstein<d>& polynomial) {
    ScaledBernstein<d> result{polynomial.degrees, polynomial.coefficients};
    scale<d>(result.degrees, false, result.coefficients);
    return result;
}

template <int d>
Bernstein<d> to_bernstein(const ScaledBernstein<d>& polynomial) {
    Bernstein<d> result{polynomial.degrees, polynomial.coefficients};
    scale<d>(result.degrees, true, result.coefficients);
    return result;
}

template struct Bernstein<1>;
template struct Bernstein<2>;
template struct Bernstein<3>;
template struct ScaledBernstein<1>;
template struct ScaledBernstein<2>;
template struct ScaledBernstein<3>;
template ScaledBernstein<1> to_scaled<1>(const Bernstein<1>&);
template ScaledBernstein<2> to_scaled<2>(const Bernstein<2>&);
template ScaledBernstein<3> to_scaled<3>(const Bernstein<3>&);
template Bernstein<1> to_bernstein<1>(const ScaledBernstein<1>&);
template Bernstein<2> to_bernstein<2>(const ScaledBernstein<2>&);
template Bernstein<3> to_bernstein<3>(const ScaledBernstein<3>&);

}  // namespace couture::iga
