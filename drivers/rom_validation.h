#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/rom_error_measures.h"
#include "drivers/rom_model.h"

namespace couture::drivers {

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

struct Validation {
    std::vector<ValidationPoint> points;
    rom::Calibration calibration;

    /// Of a measure over the points, e.g. &PredictionErrors::displacement.
    [[nodiscard]] std::vector<double> errors(double PredictionErrors::*measure) const;
    [[nodiscard]] std::vector<double> galerkin_errors(double PredictionErrors::*measure) const;
    /// Mean over the points of the error with 1, 2, ... modes.
    [[nodiscard]] VectorX mean_by_modes() const;
};

/// Compares a model with the full solutions of a store, whose plan is that of `samples`.
///
/// @param with_galerkin  also with Galerkin solutions in the space of the modes
/// @throws InputError  if no point was solved
[[nodiscard]] Validation validate_model(const TrainedModel& trained, const RomSamples& samples,
                                        const io::SnapshotStore& store, bool with_galerkin);

/// As rom_schema.md says.
[[nodiscard]] std::string validation_json(const TrainedModel& trained, const Validation& validation,
                                          int n_refused, double seconds,
                                          const std::vector<std::string>& files);
/// A line for each point: parameters, errors, estimate.
[[nodiscard]] std::string validation_csv(const TrainedModel& trained, const Validation& validation);
void print_validation(const TrainedModel& trained, const Validation& validation, int n_refused);

/// Draws the errors of the points, the error over the number of modes, and the singular values:
/// STEM_errors.png.
void draw_validation(const std::filesystem::path& path, const TrainedModel& trained,
                     const Validation& validation);

/// The worst point by its displacement: fields of the prediction, of the full solution, and their
/// difference on the full member, STEM_worst_{predicted,computed,difference}.vtu and .png.
///
/// @return the files
[[nodiscard]] std::vector<std::string> write_worst_point(const std::filesystem::path& stem,
                                                         const TrainedModel& trained,
                                                         const RomSamples& samples,
                                                         const io::SnapshotStore& store,
                                                         const Validation& validation, bool png);

}  // namespace couture::drivers
