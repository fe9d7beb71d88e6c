#pragma once

#include "iga/topology/space.h"

namespace couture::iga {

/// Coefficients on a space.
template <int d>
struct Field {
    SpacePtr<d> space;
    /// n_dofs x components.
    MatrixX coefficients;

    /// Value at a parameter of a patch, one number per component.
    [[nodiscard]] VectorX value(int patch, const Vector<d>& xi) const;
    /// du_i / dx_k: components x d, in physical space (the patch's dimension must be d).
    /// @throws GeometryError  where the map is singular
    [[nodiscard]] MatrixX gradient(int patch, const Vector<d>& xi) const;
};

}  // namespace couture::iga
