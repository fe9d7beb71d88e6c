#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/commands/commands.h"
#include "drivers/rom_training.h"
#include "rom/reduced_model.h"

namespace couture::drivers {

/// out/NAME of the deck unless told otherwise. @throws FileError  if it can't be written to
[[nodiscard]] std::filesystem::path rom_folder(const RomTrainOptions& options);

/// Each process computes with so many threads, whatever the number of processes, so that results do
/// not depend on how the work is split: those asked for, else one.
int use_rom_threads(const CommonOptions& common);

/// Makes what a store lacks of the samples' plan: of all of it, by several processes of this
/// program, or of the shard that the options name. Says what was refused.
///
/// @param command  words that make a process fill the same store: "rom", "train", ...
/// @return false if that was a shard: the rest is for others
/// @throws InputError   for a shard that is none
/// @throws SolverError  if a process ended early: what was made is kept
bool run_campaign(const RomTrainOptions& options, const CommonOptions& common, RomSamples& samples,
                  const iga::Space<3>& reference, io::SnapshotStore& store,
                  const std::vector<std::string>& command);

struct TrainedFile {
    rom::ReducedModel model;
    std::filesystem::path file;
};

/// Makes all that a store lacks of the deck's design and of what was added to it, learns the model
/// and writes it beside the store.
///
/// @return nothing if that was a shard
[[nodiscard]] std::optional<TrainedFile> train_model(const RomTrainOptions& options,
                                                     const CommonOptions& common,
                                                     RomSamples& samples, io::SnapshotStore& store);

}  // namespace couture::drivers
