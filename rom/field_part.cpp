#include "rom/field_part.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

constexpr double leave_one_out_quantile = 0.95;

/// The smallest of the values that at least this part of them does not exceed.
double quantile(VectorX values, double part) {
    std::sort(values.begin(), values.end());
    const auto n = static_cast<double>(values.size());
    const auto i = static_cast<Eigen::Index>(std::ceil(part * n)) - 1;
    return values[std::clamp<Eigen::Index>(i, 0, values.size() - 1)];
}

/// 1^T W 1.
double total_weight(const InnerProduct& product, Eigen::Index n_rows) {
    return product.apply(VectorX::Ones(n_rows)).sum() / 3.0;
}

void measure_leave_one_out(FieldPart& part, const CoefficientModel& coefficients) {
    if (coefficients.n_inputs() == 0) {
        return;
    }
    const MatrixX residuals = coefficients.leave_one_out();
    const MatrixX expected_squares = coefficients.leave_one_out_variances() * part.gram.diagonal();
    const VectorX errors =
        (residuals * part.gram).cwiseProduct(residuals).rowwise().sum().cwiseMax(0.0).cwiseSqrt();
    part.leave_one_out = quantile(errors, leave_one_out_quantile);
    // Errors of constants are rounding over rounding.
    constexpr double least = 1e-150;
    part.leave_one_out_ratio = quantile(
        errors.cwiseQuotient(expected_squares.cwiseSqrt().cwiseMax(least)), leave_one_out_quantile);
}

}  // namespace

MatrixX FieldPart::values(MatrixX fields, int n_components) const {
    if (n_components == 3) {
        return fields;
    }
    const Eigen::Index n_nodes = fields.rows() / n_components;
    MatrixX rows(3 * n_nodes, fields.cols());
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
        for (Eigen::Index i = 0; i < n_nodes; ++i) {
            rows.col(j).segment<3>(3 * i) =
                scale * fields.col(j).segment<3>(n_components * i + first_component);
        }
    }
    return rows;
}

double FieldPart::length(const VectorX& coefficients) const {
    return std::sqrt(size * size + std::max(0.0, coefficients.dot(gram * coefficients)));
}

VectorX lengths(const MatrixX& fields, const InnerProduct& product) {
    return (product.squared_norms(fields) / total_weight(product, fields.rows()))
        .cwiseMax(0.0)
        .cwiseSqrt();
}

double length_about_centroid(const VectorX& positions, const InnerProduct& product) {
    const MatrixX weighted = product.apply(positions).reshaped(3, positions.size() / 3);
    const Vector3 centroid = weighted.rowwise().sum() / total_weight(product, positions.size());
    VectorX centred = positions;
    for (Eigen::Index i = 0; i < positions.size(); i += 3) {
        centred.segment<3>(i) -= centroid;
    }
    return lengths(centred, product)[0];
}

FieldPart measured(FieldPart part, const FieldModel& model, const MatrixX& fields, int n_components,
                   const InnerProduct& product) {
    const MatrixX modes = part.values(model.basis().modes, n_components);
    const double weight = total_weight(product, modes.rows());
    part.gram = product.apply(modes).transpose() * modes / weight;
    const MatrixX left = fields - model.fields(model.coefficients().training().transpose());
    part.truncation =
        std::sqrt(lengths(part.values(left, n_components), product).cwiseAbs2().mean());
    part.size = lengths(part.values(model.mean(), n_components), product)[0];
    measure_leave_one_out(part, model.coefficients());
    return part;
}

FieldPart with_amplitude(FieldPart part, const CoefficientModel& amplitude) {
    const VectorX errors = amplitude.leave_one_out().col(0).cwiseAbs();
    const VectorX expected = amplitude.leave_one_out_variances().col(0).cwiseSqrt();
    part.leave_one_out = std::hypot(part.leave_one_out, quantile(errors, leave_one_out_quantile));
    part.leave_one_out_ratio = std::max(
        part.leave_one_out_ratio, quantile(errors.cwiseQuotient(expected), leave_one_out_quantile));
    return part;
}

ErrorEstimate estimate_error(const FieldPart& part, const VectorX& variances, double factor,
                             double length, double calibration, double amplitude_error) {
    const double size = std::abs(factor);
    ErrorEstimate error;
    error.truncation = size * part.truncation;
    error.kriging =
        std::hypot(size * std::sqrt(variances.dot(part.gram.diagonal())), amplitude_error);
    error.leave_one_out = size * part.leave_one_out;
    error.total =
        calibration * std::hypot(error.truncation, part.leave_one_out_ratio * error.kriging);
    error.relative = length > 0.0 ? error.total / length : 0.0;
    return error;
}

double calibration_factor(const VectorX& errors, const VectorX& estimates, double coverage) {
    if (errors.size() == 0 || errors.size() != estimates.size()) {
        throw InputError(
            "calibration_factor: {} errors and {} estimates; there must be one of both for each of "
            "at least one point",
            errors.size(), estimates.size());
    }
    if (!errors.allFinite() || !estimates.allFinite() || !(estimates.minCoeff() > 0.0)) {
        throw InputError(
            "calibration_factor: an error or estimate is not finite, or the smallest estimate ({}) "
            "is not positive; leave its point out",
            estimates.minCoeff());
    }
    return quantile(errors.cwiseQuotient(estimates), coverage);
}

}  // namespace couture::rom
