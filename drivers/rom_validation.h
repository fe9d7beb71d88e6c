#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/rom_error_measures.h"
#include "drivers/rom_model.h"

namespace couture::drivers {

/// A full solution of a store.
struct SolvedPoint {
    VectorX point;
    VectorX control_points;
    VectorX displacement;
};
/// All that were not refused, in the plan's order.
[[nodiscard]] std::vector<SolvedPoint> solved_points(const RomSamples& samples,
                                                     const io::SnapshotStore& store,
                                                     const iga::MultiPatch<3>& reference);

/// A point at which a model was compared with the full solution.
struct ValidationPoint {
    VectorX point;
    PredictionErrors kriging;
    std::optional<PredictionErrors> galerkin;
    /// Relative, by the model itself before it was calibrated.
    double estimate = 0.0;
    /// Relative errors of the displacement with 1, 2, ... modes, their coefficients as predicted.
    VectorX by_modes;
};

/// Mean, median and largest of numbers.
struct Statistics {
    double mean = 0.0;
    double median = 0.0;
    double worst = 0.0;
    int i_worst = 0;
};
/// @throws InputError  without numbers
[[nodiscard]] Statistics statistics_of(const std::vector<double>& values);

/// The mean error of a model that learned from part of the geometries.
struct LearningPoint {
    int n_geometries = 0;
    double error = 0.0;
};

struct Validation {
    std::vector<ValidationPoint> points;
    rom::Calibration calibration;
    /// Of the displacement; of the geometry if the model has no other field.
    std::vector<LearningPoint> learning;

    /// Of a measure over the points, e.g. &PredictionErrors::displacement.
    [[nodiscard]] std::vector<double> errors(double PredictionErrors::*measure) const;
    [[nodiscard]] std::vector<double> galerkin_errors(double PredictionErrors::*measure) const;
    /// Mean over the points of the error with 1, 2, ... modes.
    [[nodiscard]] VectorX mean_by_modes() const;
};

/// Compares a model with full solutions.
///
/// @param with_galerkin  also with Galerkin solutions in the space of the modes
/// @throws InputError  if there is none
[[nodiscard]] Validation validate_model(const TrainedModel& trained,
                                        const std::vector<SolvedPoint>& solved, bool with_galerkin);

/// As rom_schema.md says.
[[nodiscard]] std::string validation_json(const TrainedModel& trained, const Validation& validation,
                                          int n_refused, double seconds,
                                          const std::vector<std::string>& files);
/// A line for each point: parameters, errors, estimate.
[[nodiscard]] std::string validation_csv(const TrainedModel& trained, const Validation& validation);
void print_validation(const TrainedModel& trained, const Validation& validation, int n_refused);

/// Draws the errors of the points, the errors over the number of modes and of geometries, singular
/// values, and the design beside the points.
void draw_validation(const std::filesystem::path& path, const TrainedModel& trained,
                     const RomPlan& design, const Validation& validation);

/// The worst point by its displacement: fields of the prediction, of the full solution, and their
/// difference on the full member, STEM_worst_{predicted,computed,difference}.vtu and .png.
///
/// @param solved  that the model was compared with
/// @return the files
[[nodiscard]] std::vector<std::string> write_worst_point(const std::filesystem::path& stem,
                                                         const TrainedModel& trained,
                                                         const std::vector<SolvedPoint>& solved,
                                                         const Validation& validation, bool png);

}  // namespace couture::drivers
