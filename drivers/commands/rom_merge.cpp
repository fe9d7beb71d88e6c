#include <fmt/core.h>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "iga/core/error.h"

namespace couture::drivers {

int run_rom_merge(const RomMergeOptions& options, const CommonOptions& common) {
    RomSamples samples(options.campaign.deck, options.campaign.overrides);
    io::SnapshotStore store(rom_folder(options.campaign) / "snapshots", samples.job());
    for (const std::filesystem::path& folder : options.folders) {
        const std::filesystem::path snapshots = folder / "snapshots";
        if (!std::filesystem::is_directory(snapshots)) {
            throw InputError(
                "rom merge: there is no folder {}; name the folders that couture rom train --out "
                "wrote",
                snapshots.string());
        }
        const int n_files = store.merge(io::SnapshotStore(snapshots, samples.job()));
        if (!common.quiet) fmt::print("{}: {} files taken over\n", folder.string(), n_files);
    }
    samples.take_added(store);
    const StoreProgress progress = progress_of(samples.plan(), store);
    if (!common.quiet) {
        fmt::print(
            "{}: {} of {} solutions, {} refused; couture rom train {} --out {} makes the "
            "model\n",
            store.folder().string(), progress.n_solutions,
            samples.plan().n_geometries() * samples.plan().n_materials(), progress.n_refused,
            options.campaign.deck.string(), rom_folder(options.campaign).string());
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
