#pragma once

#include <filesystem>

#include "drivers/rom_samples.h"
#include "io/reduced_model_file.h"
#include "rom/galerkin.h"

namespace couture::drivers {

/// The options of a model that a deck's section [rom] asks for.
[[nodiscard]] rom::ReducedModelOptions model_options(const io::RomSection& section);

/// A model from a file, with the problem that it answers.
class TrainedModel {
  public:
    /// @throws what read_reduced_model throws
    explicit TrainedModel(const std::filesystem::path& path);

    [[nodiscard]] const rom::ReducedModel& model() const { return file_.model; }
    [[nodiscard]] const io::ReducedModelFile& file() const { return file_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Of the deck that it was trained by.
    [[nodiscard]] const io::RomSection& section() const { return section_; }
    /// It was trained without loads: displacements are 0.
    [[nodiscard]] bool is_geometry_only() const { return is_geometry_only_; }
    /// The deck that it was trained by, if it is still where it was.
    [[nodiscard]] std::filesystem::path deck_path() const;
    [[nodiscard]] std::vector<std::string> overrides() const;

    /// Materials, supports, loads, units and outputs at a point; the geometry is the model's.
    [[nodiscard]] io::Deck deck_at(const VectorX& point) const;

    /// @throws InputError  if a store holds the snapshots of another job than the model's
    void require_job(const io::SnapshotStore& store) const;

    /// The reference point with some values changed.
    ///
    /// @param settings  "NAME=VALUE", in the parameter's unit or with a unit of its own
    /// @param option    that they were given by, for messages
    /// @throws InputError  for names that there are not, values that are no numbers or units of
    ///                     something else
    [[nodiscard]] VectorX point_of(const std::vector<std::string>& settings,
                                   const std::string& option = "--set") const;

    /// Warns of a point outside the training box.
    /// @throws InputError  for one that is by more than a fifth of a range outside, unless forced
    void check_inside(
        const VectorX& point, bool is_forced,
        const std::string& way_out = "nothing it says is of use: take a value nearer to it") const;

  private:
    std::filesystem::path path_;
    io::ReducedModelFile file_;
    io::RomSection section_;
    bool is_geometry_only_ = false;
};

/// The answer of a model projected onto its displacement modes: linear problems are solved there,
/// at finite strain Newton takes one step from the prediction.
///
/// @param deck  of the evaluation's point
/// @throws what rom::solve_galerkin and rom::galerkin_newton_step throw
[[nodiscard]] rom::GalerkinSolution solve_projected(const rom::ReducedModel& model,
                                                    const rom::Evaluation& evaluation,
                                                    const io::Deck& deck);

/// What a model's file keeps beside it, for TrainedModel.
[[nodiscard]] std::map<std::string, std::string> model_provenance(const RomSamples& samples);

}  // namespace couture::drivers
