#include "iga/topology/field.h"

#include <Eigen/LU>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/format.h"

namespace couture::iga {

namespace {

template <int d>
PointBasis<d> basis_at(const Space<d>& space, int patch, const Vector<d>& xi) {
    return evaluate_basis(space.tensor(patch), space.weights(patch), xi);
}

}  // namespace

template <int d>
VectorX Field<d>::value(int patch, const Vector<d>& xi) const {
    const PointBasis<d> basis = basis_at(*space, patch, xi);
    VectorX result = VectorX::Zero(coefficients.cols());
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        result +=
            basis.values[i] * coefficients.row(space->dofs(patch)[basis.functions[i]]).transpose();
    }
    return result;
}

template <int d>
MatrixX Field<d>::gradient(int patch, const Vector<d>& xi) const {
    const PointBasis<d> basis = basis_at(*space, patch, xi);
    Eigen::Matrix<double, Eigen::Dynamic, d> parametric =
        Eigen::Matrix<double, Eigen::Dynamic, d>::Zero(coefficients.cols(), d);
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        parametric += coefficients.row(space->dofs(patch)[basis.functions[i]]).transpose() *
                      basis.gradients.row(i);
    }
    const Patch<d>& map = space->geometry().patches[patch];
    if (map.dimension() != d) {
        throw GeometryError(
            "patch {} has {} parameters but {} coordinates; gradients need equal "
            "numbers",
            patch, d, map.dimension());
    }
    const Matrix<d> J = map.jacobian(xi);
    const double det = J.determinant();
    double scale = 1.0;
    for (int k = 0; k < d; ++k) {
        scale *= J.col(k).norm();
    }
    if (!(std::abs(det) > 1e-12 * scale)) {
        throw GeometryError(
            "patch {}: the map is singular (det J = {:.3g}) at parameter {}; take a "
            "point beside it",
            patch, det, format_point(xi));
    }
    return parametric * J.inverse();
}

template struct Field<2>;
template struct Field<3>;

}  // namespace couture::iga
