#pragma once

#include <array>

#include "iga/spline/knot_vector.h"

namespace couture::iga {

/// Tensor product of d knot vectors. Functions are numbered with the first direction fastest:
/// index = i_0 + n_0 (i_1 + n_1 i_2).
template <int d>
struct TensorSpace {
    std::array<KnotVector, d> knots;

    [[nodiscard]] std::array<int, d> sizes() const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = knots[k].n_basis();
        }
        return result;
    }
    [[nodiscard]] std::array<int, d> degrees() const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = knots[k].degree();
        }
        return result;
    }
    [[nodiscard]] std::array<int, d> n_elements() const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = knots[k].n_elements();
        }
        return result;
    }
    [[nodiscard]] int n_basis() const {
        int product = 1;
        for (const KnotVector& direction : knots) {
            product *= direction.n_basis();
        }
        return product;
    }
    [[nodiscard]] int index(const std::array<int, d>& i) const {
        int result = 0;
        for (int k = d - 1; k >= 0; --k) {
            result = result * knots[k].n_basis() + i[k];
        }
        return result;
    }
    [[nodiscard]] std::array<int, d> indices(int index) const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = index % knots[k].n_basis();
            index /= knots[k].n_basis();
        }
        return result;
    }

    bool operator==(const TensorSpace&) const = default;
};

}  // namespace couture::iga
