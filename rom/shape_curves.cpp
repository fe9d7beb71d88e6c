#include "rom/shape_curves.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "rom/designs.h"
#include "rom/pod.h"

namespace couture::rom {

namespace {

/// Means of the rows, and their standard errors.
ShapeCurve curve_of(const MatrixX& samples) {
    const auto n = static_cast<double>(samples.cols());
    ShapeCurve curve;
    curve.values = samples.rowwise().mean();
    const MatrixX deviations = samples.colwise() - curve.values;
    curve.errors = deviations.rowwise().norm() / std::sqrt(n * (n - 1.0));
    return curve;
}

/// All members but one, as they lie in the modes of all: distances are those of the shapes.
MatrixX without(const MatrixX& coefficients, Eigen::Index member) {
    MatrixX others(coefficients.rows(), coefficients.cols() - 1);
    others << coefficients.leftCols(member),
        coefficients.rightCols(coefficients.cols() - member - 1);
    return others;
}

/// Distances of one member from its projections onto 0, 1, ... n_modes modes of the others.
VectorX left_out_distances(const MatrixX& coefficients, Eigen::Index member, Eigen::Index n_modes) {
    MatrixX others = without(coefficients, member);
    const VectorX mean = others.rowwise().mean();
    others.colwise() -= mean;
    VectorX rest = coefficients.col(member) - mean;
    VectorX distances = VectorX::Constant(n_modes + 1, rest.norm());
    if (others.isZero(0.0)) return distances;
    const PodBasis basis = make_pod_basis(others, InnerProduct(1));
    for (Eigen::Index k = 0; k < n_modes; ++k) {
        // Where the others have fewer modes more of them change nothing.
        if (k < basis.modes.cols()) rest -= basis.modes.col(k) * basis.modes.col(k).dot(rest);
        distances[k + 1] = rest.norm();
    }
    return distances;
}

}  // namespace

VectorX compactness(const ShapeModel& model) {
    const VectorX variances = model.standard_deviations.cwiseAbs2();
    VectorX parts = VectorX::Zero(variances.size() + 1);
    for (Eigen::Index k = 0; k < variances.size(); ++k) {
        parts[k + 1] = parts[k] + variances[k];
    }
    return parts / parts[variances.size()];
}

ShapeCurve generalisation(const ShapeModel& model) {
    if (model.n_members() < 3) {
        throw InputError("generalisation: {} members; leaving one out takes 3 or more",
                         model.n_members());
    }
    const Eigen::Index n_modes = std::min(model.n_modes(), model.n_members() - 2);
    MatrixX distances(n_modes + 1, model.n_members());
    for (Eigen::Index j = 0; j < distances.cols(); ++j) {
        distances.col(j) = left_out_distances(model.coefficients, j, n_modes);
    }
    return curve_of(distances / std::sqrt(model.n_points()));
}

ShapeCurve specificity(const ShapeModel& model, int n_virtual, std::uint64_t seed) {
    if (n_virtual < 2) {
        throw InputError("specificity: {} virtual members; a mean takes 2 or more", n_virtual);
    }
    const MatrixX coefficients = model.standard_deviations.asDiagonal() *
                                 normal_design(model.n_modes(), n_virtual, seed).transpose();
    MatrixX distances(model.n_modes() + 1, n_virtual);
    for (Eigen::Index i = 0; i < n_virtual; ++i) {
        // Squares of the distances from each member, the coefficients of more modes being 0.
        Eigen::RowVectorXd squares = model.coefficients.colwise().squaredNorm();
        distances(0, i) = std::sqrt(squares.minCoeff());
        for (Eigen::Index k = 0; k < model.n_modes(); ++k) {
            const auto own = model.coefficients.row(k).array();
            squares.array() += (own - coefficients(k, i)).square() - own.square();
            distances(k + 1, i) = std::sqrt(std::max(squares.minCoeff(), 0.0));
        }
    }
    return curve_of(distances / std::sqrt(model.n_points()));
}

}  // namespace couture::rom
