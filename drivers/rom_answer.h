#pragma once

// What a trained model answers at a point, and the full solution there.
#include "drivers/rom_error_measures.h"
#include "drivers/rom_model.h"
#include "iga/topology/jacobian_certificate.h"
#include "rom/field_sampler.h"

namespace couture::drivers {

/// Largest values at the sample points.
struct RomExtremes {
    double displacement = 0.0;
    double von_mises = 0.0;
    /// On the undeformed member.
    Vector3 von_mises_at = Vector3::Zero();
};

[[nodiscard]] RomExtremes extremes_of(const rom::FieldSamples& samples);

struct RomAnswer {
    rom::Evaluation evaluation;
    rom::ErrorEstimates errors;
    RomExtremes extremes;
    double volume = 0.0;
    /// Of evaluation and sampling.
    double seconds = 0.0;
    iga::Validity validity = iga::Validity::valid;
};

/// At the ends of all elements.
[[nodiscard]] rom::FieldSampler answer_sampler(const rom::ReducedModel& model);

/// Warns of a geometry that is not valid.
[[nodiscard]] RomAnswer answer_at(const TrainedModel& trained, const VectorX& point,
                                  const rom::FieldSampler& sampler);

/// Control points and displacement, 3 n_nodes numbers each.
struct FullSolution {
    VectorX control_points;
    VectorX displacement;
};

/// @param option  that asks for a full solution, for messages
/// @throws InputError  if the deck that the model was trained by is not there any more
void require_deck(const TrainedModel& trained, const std::string& option);

/// @throws what require_deck, meshing and solving throw
[[nodiscard]] FullSolution solve_in_full(const TrainedModel& trained, const VectorX& point,
                                         const std::string& option);

[[nodiscard]] PredictionErrors errors_against(const TrainedModel& trained, const FullSolution& full,
                                              const rom::Evaluation& predicted,
                                              const iga::Problem& problem,
                                              const rom::FieldSampler& sampler);

/// Writes the fields (VTU), and a picture.
///
/// @param folder  empty: out/<model name>
/// @return paths of the files
[[nodiscard]] std::vector<std::string> write_answer(const TrainedModel& trained,
                                                    const RomAnswer& answer,
                                                    std::filesystem::path folder, bool has_picture);

}  // namespace couture::drivers
