#pragma once

#include <vector>

#include "iga/core/types.h"

namespace couture::rom {

/// All combinations of the points of designs, one for each group of parameters: for each geometry
/// all loads, for each of these all materials. A design without such structure is one factor.
///
/// Source: [Maquart19] Eq. (7.4), Fig. 7.8.
struct TensorDesign {
    /// Of each factor n_g x d_g points; the parameters of the first factor are the first columns.
    std::vector<MatrixX> factors;

    [[nodiscard]] int n_points() const;
    [[nodiscard]] int n_parameters() const;
    /// Numbers of points of the factors.
    [[nodiscard]] std::vector<int> sizes() const;
    /// n_points x n_parameters, the last factor fastest.
    [[nodiscard]] MatrixX points() const;
};

}  // namespace couture::rom
