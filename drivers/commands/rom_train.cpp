#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "drivers/rom_model.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

struct BasisSummary {
    std::string name;
    int n_modes = 0;
    /// (1.14) of the modes that are kept.
    double truncation = 0.0;
    /// Of the field's length: 0.95 quantile of leave-one-out errors.
    double leave_one_out = 0.0;
    /// Of kriging, as chosen.
    std::string trend;
};

std::vector<BasisSummary> summarize(const rom::ReducedModel& model, bool is_geometry_only) {
    std::vector<BasisSummary> result;
    const rom::ReducedModelParts& parts = model.parts();
    const auto add = [&](const std::string& name, const rom::FieldPart& part) {
        const rom::FieldModel& field = parts.models[part.i_model];
        result.push_back({name, field.n_modes(), field.basis().relative_error(field.n_modes()),
                          part.size > 0.0 ? part.leave_one_out / part.size : part.leave_one_out,
                          rom::to_string(field.coefficients().options().trend)});
    };
    add("geometry", parts.geometry);
    if (!is_geometry_only) add("displacement", parts.displacement);
    return result;
}

void print_json(const RomSamples& samples, const io::SnapshotStore& store,
                const std::vector<BasisSummary>& bases, const rom::ReducedModel& model,
                const fs::path& file, double seconds) {
    const StoreProgress made = progress_of(samples.plan(), store);
    nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                     {"status", made.n_refused > 0 ? "failed" : "done"},
                                     {"title", samples.deck().title},
                                     {"signature", iga::signature(model.parts().reference)},
                                     {"unknowns", 3 * model.n_nodes()},
                                     {"geometries", samples.plan().n_geometries()},
                                     {"projected", samples.plan().n_projected},
                                     {"loads", samples.plan().n_loads()},
                                     {"materials", samples.plan().n_materials()},
                                     {"solutions", made.n_solutions}};
    object["refused"] = nlohmann::ordered_json::array();
    for (const RefusedSample& one : refused_samples(samples.plan(), store)) {
        object["refused"].push_back({{"point", one.point}, {"reason", one.reason}});
    }
    object["bases"] = nlohmann::ordered_json::array();
    for (const BasisSummary& one : bases) {
        object["bases"].push_back({{"field", one.name},
                                   {"modes", one.n_modes},
                                   {"truncation", one.truncation},
                                   {"leave_one_out", one.leave_one_out},
                                   {"trend", one.trend}});
    }
    object["seconds"] = seconds;
    object["warnings"] = log::warnings();
    object["files"] = {file.string()};
    fmt::print("{}\n", object.dump(2));
}

void print_table(const RomSamples& samples, const io::SnapshotStore& store,
                 const std::vector<BasisSummary>& bases, const rom::ReducedModel& model,
                 const fs::path& file, double seconds) {
    const StoreProgress made = progress_of(samples.plan(), store);
    fmt::print("{}\n", samples.deck().title);
    const RomPlan& plan = samples.plan();
    fmt::print("  {}{}, {} unknowns; refused {}\n", plan.geometries_text(),
               samples.is_geometry_only()
                   ? std::string(" without loads")
                   : fmt::format(" x {} loads x {} materials", plan.n_loads(), plan.n_materials()),
               3 * model.n_nodes(), made.n_refused);
    fmt::print("  {:<13} {:>6} {:>12} {:>14} {:>10}\n", "basis", "modes", "truncation",
               "leave-one-out", "trend");
    for (const BasisSummary& one : bases) {
        fmt::print("  {:<13} {:>6} {:>12.2e} {:>14.2e} {:>10}\n", one.name, one.n_modes,
                   one.truncation, one.leave_one_out, one.trend);
    }
    fmt::print("  {:.1f} s; wrote {}\n", seconds, file.string());
}

}  // namespace

int run_rom_train(const RomTrainOptions& options, const CommonOptions& common) {
    const Timer timer;
    RomSamples samples(options.deck, options.overrides);
    io::SnapshotStore store(rom_folder(options) / "snapshots", samples.job());
    if (options.retry) store.clear_failures();
    const auto trained = train_model(options, common, samples, store);
    if (!trained) return ExitCode::done;
    const auto bases = summarize(trained->model, samples.is_geometry_only());
    if (common.json) {
        print_json(samples, store, bases, trained->model, trained->file, timer.seconds());
    } else if (!common.quiet) {
        print_table(samples, store, bases, trained->model, trained->file, timer.seconds());
    }
    return progress_of(samples.plan(), store).n_refused > 0 ? ExitCode::run_failed : ExitCode::done;
}

}  // namespace couture::drivers
