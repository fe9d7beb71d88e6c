#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "iga/core/error.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

// All are looked at before anything is taken over.
std::vector<io::SnapshotStore> stores_of(const std::vector<std::filesystem::path>& folders,
                                         const std::string& job) {
    std::vector<io::SnapshotStore> stores;
    for (const std::filesystem::path& folder : folders) {
        const std::filesystem::path snapshots = folder / "snapshots";
        if (!std::filesystem::is_directory(snapshots)) {
            throw InputError(
                "rom merge: there is no folder {}; name the folders that couture rom train --out "
                "wrote",
                snapshots.string());
        }
        stores.emplace_back(snapshots, job);
    }
    return stores;
}

}  // namespace

int run_rom_merge(const RomMergeOptions& options, const CommonOptions& common) {
    RomSamples samples(options.campaign.deck, options.campaign.overrides);
    const std::vector<io::SnapshotStore> parts = stores_of(options.folders, samples.job());
    io::SnapshotStore store(rom_folder(options.campaign) / "snapshots", samples.job());
    nlohmann::ordered_json folders = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = options.folders[i].string();
        const int n_files = store.merge(parts[i]);
        folders.push_back({{"folder", name}, {"files", n_files}});
        if (!common.quiet && !common.json) fmt::print("{}: {} files taken over\n", name, n_files);
    }
    samples.take_added(store);
    const StoreProgress progress = progress_of(samples.plan(), store);
    if (common.json) {
        const nlohmann::ordered_json object = {
            {"program", "couture " COUTURE_VERSION}, {"status", "done"},
            {"store", store.folder().string()},      {"folders", folders},
            {"solutions", progress.n_solutions},     {"missing", progress.n_missing},
            {"refused", progress.n_refused},         {"warnings", log::warnings()}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
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
