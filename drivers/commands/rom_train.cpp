#include <fmt/core.h>
#include <omp.h>

#include <charconv>

#include "drivers/commands/commands.h"
#include "drivers/rom_training.h"
#include "drivers/worker_processes.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
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
void fill_by_processes(const RomTrainOptions& options, const fs::path& folder, int n_jobs,
                       int n_threads, const std::function<void()>& watch) {
    std::vector<std::vector<std::string>> arguments;
    for (int j = 1; j <= n_jobs; ++j) {
        std::vector<std::string> one = {"rom",
                                        "train",
                                        options.deck.string(),
                                        "--out",
                                        folder.string(),
                                        "--shard",
                                        fmt::format("{}/{}", j, n_jobs),
                                        "--threads",
                                        std::to_string(n_threads),
                                        "--quiet"};
        for (const std::string& override : options.overrides) {
            one.insert(one.end(), {"--set", override});
        }
        arguments.push_back(std::move(one));
    }
    const std::vector<int> codes = run_processes(arguments, watch);
    for (std::size_t j = 0; j < codes.size(); ++j) {
        if (codes[j] != ExitCode::done) {
            throw SolverError(
                "rom: process {} of {} ended with exit code {}; what it made is kept: the same "
                "command goes on from there",
                j + 1, codes.size(), codes[j]);
        }
    }
}

}  // namespace

int run_rom_train(const RomTrainOptions& options, const CommonOptions& common) {
    const Timer timer;
    RomSamples samples(options.deck, options.overrides);
    const std::string name = options.deck.stem().string();
    const fs::path folder = options.out.empty() ? fs::path("out") / name : options.out;
    io::require_writable(folder);
    io::SnapshotStore store(folder / "snapshots", samples.job());
    if (options.retry) store.clear_failures();
    // Results must not depend on how the work is split.
    const int n_threads = common.n_threads > 0 ? common.n_threads : 1;
    set_n_threads(n_threads);
    const auto reference = samples.make_reference(store);
    samples.check_factored(reference);
    const RomPlan& plan = samples.plan();
    if (!options.shard.empty()) {
        const auto [part, n_parts] = read_shard(options.shard);
        fill_store(samples, *reference, store, part - 1, n_parts);
        return ExitCode::done;
    }
    log::info(
        fmt::format("rom: {} geometries x {} loads x {} materials = {} snapshots of {} "
                    "unknowns",
                    plan.n_geometries(), plan.n_loads(), plan.n_materials(), plan.n_snapshots(),
                    3 * reference->n_dofs()));
    const int n_cores = std::max(1, omp_get_num_procs() / n_threads);
    const int n_missing = progress_of(plan, store).n_missing;
    const int n_jobs = std::min({options.n_jobs > 0 ? options.n_jobs : n_cores, plan.n_geometries(),
                                 std::max(n_missing, 1)});
    if (n_jobs > 1) {
        const Progress progress(plan, store);
        fill_by_processes(options, folder, n_jobs, n_threads, [&] { progress.report(); });
    } else {
        fill_store(samples, *reference, store, 0, 1);
    }
    const StoreProgress done = progress_of(plan, store);
    for (const RefusedSample& one : refused_samples(plan, store)) {
        fmt::print(stderr, "refused: {}: {}\n", one.point, one.reason);
    }
    fmt::print("{} solutions, {} refused, {:.1f} s\n", done.n_solutions, done.n_refused,
               timer.seconds());
    return done.n_refused > 0 ? ExitCode::run_failed : ExitCode::done;
}

}  // namespace couture::drivers
