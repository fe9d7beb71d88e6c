#pragma once

#include <string>
#include <vector>

namespace couture::drivers {

/// Evaluation of a reduced model at one point after the other, on one thread, in seconds of
/// processor time for each: a cube of degree 3, kriging of 9 geometry parameters and 2 others over
/// a design of 37 x 6 points, as many samples as nodes.
struct EvaluationRow {
    /// Modes of the geometry, and as many of the displacement.
    int n_modes = 0;
    int n_unknowns = 0;
    int n_samples = 0;
    /// Coefficients, control points and displacement.
    double fields_seconds = 0.0;
    /// Position, displacement, stress and von Mises stress of all samples.
    double samples_seconds = 0.0;
    /// The fields again, 64 points at once.
    double batch_seconds = 0.0;
    /// Error estimate and derivatives by all parameters.
    double errors_seconds = 0.0;
    double gradient_seconds = 0.0;
};

[[nodiscard]] std::vector<EvaluationRow> measure_evaluations(bool quick);
[[nodiscard]] std::string evaluation_text(const std::vector<EvaluationRow>& rows);

}  // namespace couture::drivers
