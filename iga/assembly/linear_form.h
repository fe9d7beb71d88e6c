#pragma once

#include <functional>
#include <optional>

#include "iga/assembly/geometry_grid.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// A linear form l(v) = integral of sum b[a][s] D_s v_a, D_s = d/dx_s for s < d, D_d the value.
template <int d>
struct LinearForm {
    int n_components = 1;
    /// Fills b, [point][a][s], of a plane of quadrature points of a patch (cleared before).
    std::function<void(int patch, const GeometryGrid<d>& grid, int i_plane,
                       const GeometryPlane<d>& plane, double* b)>
        coefficients;
};

/// @param patches  empty: all
/// @return n_dofs x n_components
template <int d>
[[nodiscard]] MatrixX integrate(const Space<d>& space, const LinearForm<d>& form,
                                const std::vector<int>& patches = {},
                                std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
