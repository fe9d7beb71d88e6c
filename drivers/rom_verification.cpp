#include "drivers/rom_verification.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "drivers/rom_model.h"
#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "io/atomic_file.h"
#include "rom/field_sampler.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;
using verification::Recorder;

/// Relative errors that a model may have at the points of validation.
struct Bounds {
    double mean = 0.0;
    double worst = 0.0;
    double von_mises_max = 0.0;
};

/// A deck, and what is known of its model.
struct ModelCase {
    const char* name;
    const char* deck;
    /// All snapshots: geometries x loads x materials; 0: not given.
    int n_snapshots = 0;
    /// Of the last basis; 0: not given.
    int n_modes = 0;
    /// Of the displacement, or of the geometry if that is all there is.
    std::optional<Bounds> bounds = std::nullopt;
    /// Also of Galerkin's solution.
    std::optional<Bounds> galerkin_bounds = std::nullopt;
    /// Seconds of one evaluation of all fields.
    double evaluation_time = 0.0;
};

constexpr int n_validation_points = 20;
/// [Maquart19] Sec. 5.2.3.2: mean and worst error of 20 points, with three parameters.
constexpr double text_mean = 0.0125;
constexpr double text_worst = 0.0215;

void record_errors(const nlohmann::json& errors, const Bounds& bounds, const std::string& method,
                   bool is_geometry_only, Recorder& recorder) {
    const std::string field = is_geometry_only ? "geometry" : "displacement";
    recorder.vanishing(method + field + ", mean error", errors[field]["mean"], bounds.mean);
    recorder.vanishing(method + field + ", worst error", errors[field]["worst"], bounds.worst);
    if (is_geometry_only) return;
    recorder.vanishing(method + "largest von Mises, mean error", errors["von_mises_max"]["mean"],
                       bounds.von_mises_max);
}

/// Of geometry, displacement and stress together, the best of several.
double evaluation_seconds(const TrainedModel& trained) {
    const rom::ReducedModel& model = trained.model();
    const VectorX point = model.parts().reference_point;
    const io::Deck deck = trained.deck_at(point);
    const rom::FieldSampler sampler(
        model.space(), rom::make_sample_grids(*model.space(), rom::SampleRegion::volume));
    double best = std::numeric_limits<double>::infinity();
    constexpr int n_runs = 20;
    for (int i = 0; i < n_runs; ++i) {
        const Timer timer;
        const rom::Evaluation evaluation = model.evaluate(point);
        if (!trained.is_geometry_only()) {
            static_cast<void>(
                sampler.sample(evaluation.control_points, evaluation.displacement, deck.problem));
        }
        best = std::min(best, timer.seconds());
    }
    return best;
}

void run(const ModelCase& one, Recorder& recorder) {
    const fs::path deck = fs::path("drivers/decks") / one.deck;
    if (!fs::exists(deck)) {
        recorder.skip(deck.string() + " is not here; start the program where it is");
        return;
    }
    recorder.set_source("full solutions at " + std::to_string(n_validation_points) + " points");
    RomValidateOptions validate;
    validate.campaign.deck = deck;
    validate.campaign.out = fs::path("out/verify") / deck.stem();
    validate.n_points = n_validation_points;
    validate.galerkin = one.galerkin_bounds.has_value();
    CommonOptions common;
    common.quiet = true;
    static_cast<void>(run_rom_train(validate.campaign, common));
    const TrainedModel trained(validate.campaign.out / (deck.stem().string() + ".rom"));
    const RomSamples samples(deck, {});
    const RomPlan& plan = samples.plan();
    if (one.n_snapshots > 0) {
        recorder.absolute("snapshots", one.n_snapshots, plan.n_snapshots(), 0.0);
    }
    if (one.n_modes > 0) {
        const bool is_geometry_only = trained.is_geometry_only();
        const auto& models = trained.model().parts().models;
        recorder.absolute("modes", one.n_modes,
                          (is_geometry_only ? models.front() : models.back()).n_modes(), 0.0);
    }
    static_cast<void>(run_rom_validate(validate, common));
    const auto result = nlohmann::json::parse(
        io::read_text(validate.campaign.out / (deck.stem().string() + "_validation.json")));
    recorder.absolute("points of validation", n_validation_points, result["points"], 0.0);
    if (one.bounds) {
        record_errors(result["errors"], *one.bounds, "", trained.is_geometry_only(), recorder);
    }
    if (one.galerkin_bounds) {
        record_errors(result["galerkin_errors"], *one.galerkin_bounds, "Galerkin, ", false,
                      recorder);
    }
    if (one.evaluation_time > 0.0) {
        recorder.vanishing("seconds of an evaluation", evaluation_seconds(trained),
                           one.evaluation_time);
    }
}

}  // namespace

std::vector<verification::Case> reduced_model_cases() {
    const Bounds better{0.005, 0.02, 0.03};
    const Bounds text{text_mean, text_worst, 0.03};
    const std::vector<ModelCase> all = {
        {"reduced model, plate", "plate_family.toml", 0, 0, better, better, 2e-3},
        {"reduced model, pant", "rom_pant.toml", 0, 0, better, better, 2e-3},
        {"reduced model, seal", "rom_seal.toml", 0, 0, text, text, 2e-3},
        {"reduced model, wheel", "rom_wheel.toml", 0, 0, text, text, 2e-3},
        {"reduced model, pant stacked", "rom_pant_stacked.toml", 222, 60},
        {"reduced model, seal stacked", "rom_seal_stacked.toml", 400, 50},
        {"reduced model, wheel stacked", "rom_wheel_stacked.toml", 592, 50},
        {"reduced model, shapes of pants",
         "rom_pant_geometry.toml",
         37,
         12,
         Bounds{0.02, 0.05, 0.0},
         {},
         5e-3},
        {"reduced model, shapes of castings",
         "rom_casting_geometry.toml",
         65,
         15,
         Bounds{0.001, 0.002, 0.0},
         {},
         5e-3},
    };
    std::vector<verification::Case> cases;
    for (const ModelCase& one : all) {
        cases.push_back({one.name, true, [one](Recorder& recorder) { run(one, recorder); }});
    }
    return cases;
}

}  // namespace couture::drivers
