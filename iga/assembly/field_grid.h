#pragma once

#include "iga/assembly/geometry_grid.h"
#include "iga/topology/field.h"

namespace couture::iga {

/// Values and physical gradients of a field at the quadrature points of one patch.
template <int d>
class FieldGrid {
  public:
    /// @param grid  must outlive this
    FieldGrid(const Field<d>& field, int patch, const GeometryGrid<d>& grid);

    /// Moves to a plane of points, at which `plane` was evaluated.
    void evaluate(int i_plane, const GeometryPlane<d>& plane);
    /// Components.
    [[nodiscard]] VectorX value(int i_point) const { return values_.col(i_point); }
    /// Components x d.
    [[nodiscard]] MatrixX gradient(int i_point) const {
        return gradients_.middleCols(static_cast<Eigen::Index>(d) * i_point, d);
    }

  private:
    bool is_rational_;
    int n_components_;
    SplineGrid<d> spline_;
    Buffer<double> work_;
    MatrixX values_;
    MatrixX gradients_;
};

}  // namespace couture::iga
