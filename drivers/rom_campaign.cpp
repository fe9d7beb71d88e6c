#include "drivers/rom_campaign.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <charconv>

#include "drivers/rom_model.h"
#include "drivers/worker_processes.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

// "2/4" as position and number of parts.
std::pair<int, int> read_shard(const std::string& text) {
    int part = 0;
    int n_parts = 0;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, part);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
        const auto second = std::from_chars(first.ptr + 1, end, n_parts);
        if (second.ec == std::errc() && second.ptr == end && part >= 1 && part <= n_parts) {
            return {part, n_parts};
        }
    }
    throw InputError("rom: --shard {}: must read I/N with 1 <= I <= N, for example 2/4", text);
}

// Fills the store by processes of this program, each with a part of the geometries.
void run_shards(const RomTrainOptions& options, int n_jobs, int n_threads,
                const std::vector<std::string>& command, const std::function<void()>& watch) {
    std::vector<std::vector<std::string>> arguments;
    for (int j = 1; j <= n_jobs; ++j) {
        std::vector<std::string> one = command;
        one.insert(one.end(), {options.deck.string(), "--out", rom_folder(options).string(),
                               "--shard", fmt::format("{}/{}", j, n_jobs), "--threads",
                               std::to_string(n_threads), "--quiet"});
        for (const std::string& setting : options.overrides) {
            one.insert(one.end(), {"--set", setting});
        }
        arguments.push_back(std::move(one));
    }
    const std::vector<int> codes = run_processes(arguments, watch);
    constexpr int signal_base = 128;
    for (std::size_t j = 0; j < codes.size(); ++j) {
        if (codes[j] == ExitCode::done) continue;
        throw SolverError(
            "rom: process {} of {} ended with exit code {}{}; what was made is kept: the same "
            "command goes on from there",
            j + 1, codes.size(), codes[j],
            codes[j] > signal_base ? fmt::format(" (signal {})", codes[j] - signal_base) : "");
    }
}

}  // namespace

fs::path rom_folder(const RomTrainOptions& options) {
    fs::path folder = options.out.empty() ? fs::path("out") / options.deck.stem() : options.out;
    io::require_writable(folder);
    return folder;
}

int use_rom_threads(const CommonOptions& common) {
    const int n_threads = std::max(common.n_threads, 1);
    set_n_threads(n_threads);
    return n_threads;
}

bool run_campaign(const RomTrainOptions& options, const CommonOptions& common, RomSamples& samples,
                  const iga::Space<3>& reference, io::SnapshotStore& store,
                  const std::vector<std::string>& command) {
    if (!options.shard.empty()) {
        const auto [part, n_parts] = read_shard(options.shard);
        fill_store(samples, reference, store, part - 1, n_parts);
        const StoreProgress made = progress_of(samples.plan(), store);
        if (samples.plan().n_projected > 0 && made.n_missing > 0) {
            const std::string others =
                made.n_unsolved > 0
                    ? fmt::format(", after the {} solutions of other shards", made.n_unsolved)
                    : "";
            log::info("rom: start the shards again for displacements that are projected" + others);
        }
        return false;
    }
    const RomPlan& plan = samples.plan();
    const int n_threads = use_rom_threads(common);
    const int n_cores = std::max(1, omp_get_num_procs() / n_threads);
    const int n_jobs = std::min({options.n_jobs > 0 ? options.n_jobs : n_cores, plan.n_geometries(),
                                 std::max(progress_of(plan, store).n_missing, 1)});
    log::info(
        fmt::format("rom: {} x {} loads x {} materials = {} snapshots of {} "
                    "unknowns, {} at once",
                    plan.geometries_text(), plan.n_loads(), plan.n_materials(), plan.n_snapshots(),
                    3 * reference.n_dofs(), n_jobs));
    const auto fill = [&] {
        if (n_jobs > 1) {
            const Progress progress(plan, store);
            run_shards(options, n_jobs, n_threads, command, [&] { progress.report(); });
        } else {
            fill_store(samples, reference, store, 0, 1);
        }
    };
    fill();
    // What is projected waits for all that is solved.
    if (plan.n_projected > 0 && progress_of(plan, store).n_missing > 0) fill();
    // All is made, nobody writes any more.
    io::remove_leftovers(store.folder(), "");
    for (const RefusedSample& one : refused_samples(plan, store)) {
        log::warn(fmt::format("rom: refused: {}: {}", one.point, one.reason));
    }
    return true;
}

std::optional<TrainedFile> train_model(const RomTrainOptions& options, const CommonOptions& common,
                                       RomSamples& samples, io::SnapshotStore& store) {
    use_rom_threads(common);
    samples.take_added(store);
    const auto reference = samples.make_reference(store);
    samples.check_factored(reference);
    samples.check_periodic(reference);
    if (!run_campaign(options, common, samples, *reference, store, {"rom", "train"})) return {};
    TrainedFile trained{rom::ReducedModel(read_snapshots(samples, *reference, store),
                                          model_options(samples.section())),
                        rom_folder(options) / (options.deck.stem().string() + ".rom")};
    const rom::ReducedModelParts& parts = trained.model.parts();
    const auto warn_of_modes = [&](const rom::FieldPart& part, const std::string& name) {
        const auto message = parts.models[part.i_model].missing_modes();
        if (message) log::warn(fmt::format("rom: {}: {}", name, *message));
    };
    const bool is_one_basis = parts.models.size() == 1;
    warn_of_modes(parts.geometry, is_one_basis ? "stacked basis" : "geometry");
    if (!is_one_basis && !samples.is_geometry_only()) {
        warn_of_modes(parts.displacement, "displacement");
    }
    io::remove_leftovers(trained.file.parent_path(), trained.file.stem().string());
    io::write_reduced_model(trained.file,
                            {trained.model, samples.text(), model_provenance(samples)});
    return trained;
}

}  // namespace couture::drivers
