#pragma once

#include "rom/field_model.h"

namespace couture::rom {

/// Where one of the two fields lies in a field model, and how far the model can be trusted there.
/// Lengths are root mean squares over the reference member in the sense of the modes' product:
/// |v| = sqrt(v^T W v / (1^T W 1)).
struct FieldPart {
    /// Index of the field model, first component among those of each node, factor on its values.
    int i_model = 0;
    int first_component = 0;
    double scale = 1.0;
    /// Mean products of the modes' parts, scaled: n_modes x n_modes.
    MatrixX gram;
    /// Of what the modes leave of the snapshots, (1.14) as a length.
    double truncation = 0.0;
    /// 0.95 quantile of the lengths of leave-one-out errors at the points learned from.
    double leave_one_out = 0.0;
    /// 0.95 quantile of these lengths over those that kriging expects.
    double leave_one_out_ratio = 1.0;
    /// Length of the mean field; of a geometry that of the positions about their centroid.
    double size = 0.0;

    /// The part's rows of fields of its model, scaled: 3 n_nodes x n_fields.
    /// @param n_components  of the model at each node: 3, or 6 if stacked
    [[nodiscard]] MatrixX values(MatrixX fields, int n_components) const;
    /// Length of the field with these coefficients, of one without a mean.
    [[nodiscard]] double length(const VectorX& coefficients) const;
};

/// |v| of each field as defined above. @param fields  3 n_nodes x n_fields
[[nodiscard]] VectorX lengths(const MatrixX& fields, const InnerProduct& product);

/// |x - centroid| of positions. @param positions  3 n_nodes numbers
[[nodiscard]] double length_about_centroid(const VectorX& positions, const InnerProduct& product);

/// The part of a field model, measured at the fields that it was learned from.
///
/// @param part     model, component and scale are set
/// @param fields   of the model's values at the points of its design
/// @param product  of the part's three components
[[nodiscard]] FieldPart measured(FieldPart part, const FieldModel& model, const MatrixX& fields,
                                 int n_components, const InnerProduct& product);

/// The part of fields of unit length, with what leave-one-out says of the logarithm of their
/// amplitude.
[[nodiscard]] FieldPart with_amplitude(FieldPart part, const CoefficientModel& amplitude);

/// Expected error of a field at a point; lengths as in FieldPart.
struct ErrorEstimate {
    /// Of what the modes can't show.
    double truncation = 0.0;
    /// Standard error of kriging, from the variances of the coefficients.
    double kriging = 0.0;
    /// Of the points learned from, each predicted from the others.
    double leave_one_out = 0.0;
    /// calibration * sqrt(truncation^2 + (leave_one_out_ratio * kriging)^2)
    double total = 0.0;
    /// total over the field's length.
    double relative = 0.0;
};

/// @param variances    of the field's coefficients
/// @param factor       on the field
/// @param length       of the field, that `relative` refers to
/// @param amplitude_error  standard error of that length
[[nodiscard]] ErrorEstimate estimate_error(const FieldPart& part, const VectorX& variances,
                                           double factor, double length, double calibration,
                                           double amplitude_error = 0.0);

struct ErrorEstimates {
    ErrorEstimate geometry;
    ErrorEstimate displacement;
    /// Relative, from that of the displacement.
    double von_mises = 0.0;
};

/// Factors on error estimates, from a comparison with full solutions.
struct Calibration {
    double geometry = 1.0;
    double displacement = 1.0;
    /// Relative error of the von Mises stress over the relative estimate of the displacement.
    double von_mises = 1.0;
    /// Full solutions compared with; 0: not calibrated.
    int n_points = 0;
};

/// The smallest factor with which estimates are at least the errors at this part of the points.
///
/// @throws InputError  for no points, other numbers of both, or values that are not finite
[[nodiscard]] double calibration_factor(const VectorX& errors, const VectorX& estimates,
                                        double coverage = 0.9);

}  // namespace couture::rom
