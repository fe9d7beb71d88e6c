#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "drivers/rom_model.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "rom/designs.h"

namespace couture::drivers {

namespace {

// Of the displacement, at points of the geometry's unit cube, all else in the middle.
VectorX expected_errors(const rom::ReducedModel& model, const RomPlan& plan,
                        const MatrixX& points) {
    VectorX errors(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        VectorX unit = VectorX::Constant(plan.space.size(), 0.5);
        for (std::size_t k = 0; k < plan.geometry.size(); ++k) {
            unit[plan.geometry[k]] = points(i, static_cast<Eigen::Index>(k));
        }
        errors[i] = model.errors(plan.space.from_unit(unit)).displacement.relative;
    }
    return errors;
}

// Up to n points where the model expects errors above the tolerance, the largest first, each away
// from those before.
MatrixX worst_points(const MatrixX& candidates, VectorX errors, double tolerance, int n) {
    MatrixX chosen(0, candidates.cols());
    // Such a neighbourhood holds about 1/n of the cube.
    const double apart = 0.5 * std::pow(1.0 / n, 1.0 / static_cast<double>(candidates.cols()));
    while (chosen.rows() < n) {
        Eigen::Index worst = 0;
        if (errors.maxCoeff(&worst) <= tolerance) break;
        chosen.conservativeResize(chosen.rows() + 1, Eigen::NoChange);
        chosen.bottomRows(1) = candidates.row(worst);
        for (Eigen::Index i = 0; i < candidates.rows(); ++i) {
            const double distance =
                (candidates.row(i) - candidates.row(worst)).cwiseAbs().maxCoeff();
            if (distance < apart) errors[i] = 0.0;
        }
    }
    return chosen;
}

// Of the model that there is, if it was compared with full solutions.
rom::Calibration validated(const RomTrainOptions& campaign) {
    const auto file = rom_folder(campaign) / (campaign.deck.stem().string() + ".rom");
    return std::filesystem::exists(file) ? TrainedModel(file).model().parts().calibration
                                         : rom::Calibration{};
}

}  // namespace

int run_rom_enrich(const RomEnrichOptions& options, const CommonOptions& common) {
    const Timer timer;
    const RomTrainOptions& campaign = options.campaign;
    RomSamples samples(campaign.deck, campaign.overrides);
    if (samples.plan().geometry.empty()) {
        throw InputError(
            "{}: no parameter changes the geometry; more samples are 'levels' of the others",
            campaign.deck.string());
    }
    if (samples.section().design == io::GeometryDesign::list) {
        throw InputError(
            "{}: members that are listed can't be made at other points; add lines to {}",
            campaign.deck.string(), samples.section().members.filename().string());
    }
    io::SnapshotStore store(rom_folder(campaign) / "snapshots", samples.job());
    if (campaign.retry) store.clear_failures();
    const auto n_parameters = static_cast<int>(samples.plan().geometry.size());
    constexpr int n_candidates = 2000;
    constexpr int n_at_once = 4;
    const MatrixX candidates = rom::sobol_design(n_parameters, n_candidates);
    const rom::Calibration calibration = validated(campaign);
    if (calibration.n_points == 0) {
        log::warn(
            "rom enrich: the model was not validated, its own estimates may be too small or large: "
            "run couture rom validate first");
    }
    for (int n_added = 0;;) {
        auto trained = train_model(campaign, common, samples, store);
        trained->model.set_calibration(calibration);
        const VectorX errors = expected_errors(trained->model, samples.plan(), candidates);
        const double worst = errors.maxCoeff();
        log::info(
            fmt::format("rom enrich: {} geometries, expected error up to {:.3g} %, wanted "
                        "{:.3g} %",
                        samples.plan().n_geometries(), 100.0 * worst, 100.0 * options.tolerance));
        if (worst <= options.tolerance || n_added >= options.max_points) {
            if (common.json) {
                const nlohmann::ordered_json object = {
                    {"program", "couture " COUTURE_VERSION},
                    {"status", worst <= options.tolerance ? "done" : "failed"},
                    {"added", n_added},
                    {"geometries", samples.plan().n_geometries()},
                    {"expected_error", worst},
                    {"tolerance", options.tolerance},
                    {"seconds", timer.seconds()},
                    {"warnings", log::warnings()},
                    {"files", {trained->file.string()}}};
                fmt::print("{}\n", object.dump(2));
            } else if (!common.quiet) {
                fmt::print(
                    "{} geometries were added, there are {}; expected error up to {:.3g} %; "
                    "wrote {}\n",
                    n_added, samples.plan().n_geometries(), 100.0 * worst, trained->file.string());
            }
            return worst <= options.tolerance ? ExitCode::done : ExitCode::run_failed;
        }
        const MatrixX more = worst_points(candidates, errors, options.tolerance,
                                          std::min(n_at_once, options.max_points - n_added));
        n_added += static_cast<int>(more.rows());
        const MatrixX before = store.added_points(n_parameters);
        MatrixX all(before.rows() + more.rows(), n_parameters);
        all << before, more;
        store.write_added_points(all);
    }
}

}  // namespace couture::drivers
