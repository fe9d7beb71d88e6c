#include "iga/assembly/field_grid.h"

namespace couture::iga {

namespace {

/// Coefficients of a patch's functions, times the weights where rational.
template <int d>
MatrixX patch_rows(const Field<d>& field, int patch) {
    const std::vector<int>& dofs = field.space->dofs(patch);
    const VectorX& weights = field.space->weights(patch);
    MatrixX rows(dofs.size(), field.coefficients.cols());
    for (std::size_t i = 0; i < dofs.size(); ++i) {
        rows.row(static_cast<Eigen::Index>(i)) =
            field.coefficients.row(dofs[i]) * (weights.size() > 0 ? weights[i] : 1.0);
    }
    return rows;
}

}  // namespace

template <int d>
FieldGrid<d>::FieldGrid(const Field<d>& field, int patch, const GeometryGrid<d>& grid)
    : is_rational_(field.space->weights(patch).size() > 0),
      n_components_(static_cast<int>(field.coefficients.cols())),
      spline_(field.space->tensor(patch), field.space->tensor(patch), patch_rows(field, patch),
              grid.lines()) {}

template <int d>
void FieldGrid<d>::evaluate(int i_plane, const GeometryPlane<d>& plane) {
    spline_.evaluate(i_plane, work_);
    const int nc = n_components_;
    const int stride = spline_.stride();
    values_.resize(nc, plane.n_points);
    gradients_.resize(nc, static_cast<Eigen::Index>(d) * plane.n_points);
    for (int q = 0; q < plane.n_points; ++q) {
        const double* U = &work_[static_cast<std::size_t>(q) * (d + 1) * stride];
        const double W = is_rational_ ? plane.denominator[q] : 1.0;
        for (int a = 0; a < nc; ++a) {
            values_(a, q) = U[a] / W;
            for (int s = 0; s < d; ++s) {
                double sum = 0.0;
                for (int k = 0; k < d; ++k) {
                    double slope = U[(1 + k) * stride + a];
                    if (is_rational_) {
                        slope = (slope - values_(a, q) * plane.denominator_gradient[d * q + k]) / W;
                    }
                    sum += slope * plane.inverse_jacobian[d * d * q + d * k + s];
                }
                gradients_(a, static_cast<Eigen::Index>(d) * q + s) = sum;
            }
        }
    }
}

template class FieldGrid<2>;
template class FieldGrid<3>;

}  // namespace couture::iga
