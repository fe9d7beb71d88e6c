#include "iga/spline/patch.h"

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"

namespace couture::iga {

template <int d>
Patch<d>::Patch(TensorSpace<d> space, MatrixX control_points, VectorX weights)
    : space_(std::move(space)),
      control_points_(std::move(control_points)),
      weights_(std::move(weights)) {
    if (control_points_.rows() != space_.n_basis()) {
        throw InputError("Patch: {} control points; the knot vectors ask for {}",
                         control_points_.rows(), space_.n_basis());
    }
    if (dimension() < d || dimension() > 3) {
        throw InputError(
            "Patch: control points have {} coordinates; a patch with {} parameters "
            "takes {} to 3",
            dimension(), d, d);
    }
    for (Eigen::Index i = 0; i < control_points_.rows(); ++i) {
        if (!control_points_.row(i).allFinite()) {
            throw InputError("Patch: control point {} has a coordinate that is not finite", i);
        }
    }
    if (weights_.size() == 0) {
        return;
    }
    if (weights_.size() != space_.n_basis()) {
        throw InputError("Patch: {} weights; the knot vectors ask for {}", weights_.size(),
                         space_.n_basis());
    }
    for (Eigen::Index i = 0; i < weights_.size(); ++i) {
        if (!(weights_[i] > 0.0) || !std::isfinite(weights_[i])) {
            throw InputError("Patch: weight {} = {}; weights must be positive", i, weights_[i]);
        }
    }
    if ((weights_.array() == weights_[0]).all()) {
        weights_.resize(0);
    }
}

template <int d>
MatrixX Patch<d>::homogeneous() const {
    MatrixX rows(control_points_.rows(), dimension() + 1);
    if (is_rational()) {
        rows.leftCols(dimension()) = weights_.asDiagonal() * control_points_;
        rows.col(dimension()) = weights_;
    } else {
        rows.leftCols(dimension()) = control_points_;
        rows.col(dimension()).setOnes();
    }
    return rows;
}

template <int d>
Patch<d> Patch<d>::from_homogeneous(TensorSpace<d> space, const MatrixX& rows, bool is_rational) {
    const Eigen::Index dimension = rows.cols() - 1;
    if (!is_rational) {
        return {std::move(space), rows.leftCols(dimension)};
    }
    const VectorX weights = rows.col(dimension);
    return {std::move(space), weights.cwiseInverse().asDiagonal() * rows.leftCols(dimension),
            weights};
}

template <int d>
VectorX Patch<d>::point(const Vector<d>& xi) const {
    const PointBasis<d> basis = evaluate_basis(space_, weights_, xi);
    VectorX x = VectorX::Zero(dimension());
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        x += basis.values[i] * control_points_.row(basis.functions[i]).transpose();
    }
    return x;
}

template <int d>
MatrixX Patch<d>::jacobian(const Vector<d>& xi) const {
    const PointBasis<d> basis = evaluate_basis(space_, weights_, xi);
    MatrixX J = MatrixX::Zero(dimension(), d);
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        J += control_points_.row(basis.functions[i]).transpose() * basis.gradients.row(i);
    }
    return J;
}

template <int d>
PointBasis<d> evaluate_basis(const TensorSpace<d>& space, const VectorX& weights,
                             const Vector<d>& xi) {
    std::array<MatrixX, d> rows;
    std::array<int, d> first;
    int n_functions = 1;
    for (int k = 0; k < d; ++k) {
        const KnotVector& knots = space.knots[k];
        const int span = knots.find_span(xi[k]);
        rows[k] = basis_derivatives(knots, span, xi[k], 1);
        first[k] = span - knots.degree();
        n_functions *= knots.degree() + 1;
    }
    PointBasis<d> result;
    result.functions.resize(n_functions);
    result.values.resize(n_functions);
    result.gradients.resize(n_functions, d);
    for (int i = 0; i < n_functions; ++i) {
        std::array<int, d> local;
        std::array<int, d> global;
        int rest = i;
        double value = 1.0;
        for (int k = 0; k < d; ++k) {
            const int n = space.knots[k].degree() + 1;
            local[k] = rest % n;
            rest /= n;
            global[k] = first[k] + local[k];
            value *= rows[k](0, local[k]);
        }
        result.functions[i] = space.index(global);
        result.values[i] = value;
        for (int k = 0; k < d; ++k) {
            double gradient = 1.0;
            for (int l = 0; l < d; ++l) {
                gradient *= rows[l](l == k ? 1 : 0, local[l]);
            }
            result.gradients(i, k) = gradient;
        }
    }
    if (weights.size() > 0) {
        VectorX w(n_functions);
        for (int i = 0; i < n_functions; ++i) {
            w[i] = weights[result.functions[i]];
        }
        const double W = w.dot(result.values);
        const Eigen::Matrix<double, 1, d> dW = w.transpose() * result.gradients;
        result.gradients = (w / W).asDiagonal() * (result.gradients - result.values * (dW / W));
        result.values = w.cwiseProduct(result.values) / W;
    }
    return result;
}

template class Patch<1>;
template class Patch<2>;
template class Patch<3>;
template PointBasis<1> evaluate_basis(const TensorSpace<1>&, const VectorX&, const Vector<1>&);
template PointBasis<2> evaluate_basis(const TensorSpace<2>&, const VectorX&, const Vector<2>&);
template PointBasis<3> evaluate_basis(const TensorSpace<3>&, const VectorX&, const Vector<3>&);

}  // namespace couture::iga
