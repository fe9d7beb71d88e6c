#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_answer.h"
#include "drivers/rom_json.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

struct Answer {
    RomAnswer at_point;
    std::optional<rom::GalerkinSolution> galerkin;
    std::optional<PredictionErrors> true_errors;
    std::optional<PredictionErrors> galerkin_errors;
    std::vector<std::string> files;
};

nlohmann::ordered_json to_json(const rom::ErrorEstimate& one) {
    return {{"relative", one.relative},
            {"total", one.total},
            {"truncation", one.truncation},
            {"kriging", one.kriging},
            {"leave_one_out", one.leave_one_out}};
}

void print_json(const TrainedModel& trained, const Answer& answer) {
    const rom::ParameterSpace& space = trained.model().parameters();
    nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION}, {"status", "done"}};
    object["parameters"] = parameters_json(space, answer.at_point.evaluation.point);
    object["displacement_max"] = answer.at_point.extremes.displacement;
    object["von_mises_max"] = answer.at_point.extremes.von_mises;
    object["von_mises_at"] = {answer.at_point.extremes.von_mises_at[0],
                              answer.at_point.extremes.von_mises_at[1],
                              answer.at_point.extremes.von_mises_at[2]};
    object["volume"] = answer.at_point.volume;
    object["certificate"] = iga::to_string(answer.at_point.validity);
    object["estimates"] = {{"geometry", to_json(answer.at_point.errors.geometry)},
                           {"displacement", to_json(answer.at_point.errors.displacement)},
                           {"von_mises", answer.at_point.errors.von_mises}};
    const VectorX& a = answer.at_point.evaluation.displacement_coefficients;
    const VectorX s =
        trained.model().displacement_standard_errors(answer.at_point.evaluation.point);
    object["coefficients"] = std::vector<double>(a.begin(), a.end());
    object["standard_errors"] = std::vector<double>(s.begin(), s.end());
    if (answer.galerkin) {
        object["galerkin"] = {
            {"relative_residual", answer.galerkin->relative_residual},
            {"relative_residual_of_kriging", answer.galerkin->relative_residual_of_kriging},
            {"relative_change", answer.galerkin->relative_change},
            {"energy", answer.galerkin->energy}};
    }
    if (answer.true_errors) object["errors"] = to_json(*answer.true_errors);
    if (answer.galerkin_errors) object["galerkin_errors"] = to_json(*answer.galerkin_errors);
    object["seconds"] = answer.at_point.seconds;
    object["warnings"] = log::warnings();
    object["files"] = answer.files;
    fmt::print("{}\n", object.dump(2));
}

void print_errors(const char* name, const PredictionErrors& one) {
    fmt::print(
        "  {:<22} displacement {:.3f} %, geometry {:.4f} %, von Mises {:.3f} %, its largest "
        "{:.3f} %\n",
        name, 100.0 * one.displacement, 100.0 * one.geometry, 100.0 * one.von_mises,
        100.0 * one.von_mises_max);
}

void print_extremes(const RomAnswer& answer) {
    const Vector3& at = answer.extremes.von_mises_at;
    fmt::print("  largest displacement   {:.6g}, expected error {:.2g} %\n",
               answer.extremes.displacement, 100.0 * answer.errors.displacement.relative);
    fmt::print(
        "  largest von Mises      {:.6g} at ({:.4g}, {:.4g}, {:.4g}), expected error {:.2g} "
        "%\n",
        answer.extremes.von_mises, at[0], at[1], at[2], 100.0 * answer.errors.von_mises);
}

void print_table(const TrainedModel& trained, const Answer& answer) {
    fmt::print("{}\n",
               describe_point(trained.model().parameters(), answer.at_point.evaluation.point));
    if (trained.is_geometry_only()) {
        fmt::print("  geometry               expected error {:.2g} %\n",
                   100.0 * answer.at_point.errors.geometry.relative);
    } else {
        print_extremes(answer.at_point);
    }
    fmt::print("  volume                 {:.6g}; det J {}\n", answer.at_point.volume,
               iga::to_string(answer.at_point.validity));
    if (answer.galerkin) {
        fmt::print(
            "  Galerkin               residual {:.2e} (kriging {:.2e}), change {:.2e} in "
            "energy\n",
            answer.galerkin->relative_residual, answer.galerkin->relative_residual_of_kriging,
            answer.galerkin->relative_change);
    }
    if (answer.true_errors) print_errors("error", *answer.true_errors);
    if (answer.galerkin_errors) print_errors("error of Galerkin", *answer.galerkin_errors);
    fmt::print("  {:.2f} ms", 1e3 * answer.at_point.seconds);
    if (!answer.files.empty()) fmt::print("; wrote");
    for (const std::string& file : answer.files) fmt::print(" {}", file);
    fmt::print("\n");
}

}  // namespace

int run_rom_eval(const RomEvalOptions& options, const CommonOptions& common) {
    const TrainedModel trained(options.model);
    const rom::ReducedModel& model = trained.model();
    const VectorX point = trained.point_of(options.settings);
    trained.check_inside(point, options.is_forced, "it answers with --force only");
    if (options.galerkin && trained.is_geometry_only()) {
        throw InputError("rom eval: --galerkin solves for displacements; {} has geometry only",
                         trained.path().string());
    }
    const io::Deck deck = trained.deck_at(point);
    const rom::FieldSampler sampler = answer_sampler(model);
    Answer answer;
    answer.at_point = answer_at(trained, point, sampler);
    if (options.galerkin) {
        answer.galerkin = solve_projected(model, answer.at_point.evaluation, deck);
    }
    if (options.solve) {
        const FullSolution full = solve_in_full(trained, point, "--solve");
        const auto errors_of = [&](const VectorX& displacement) {
            rom::Evaluation predicted = answer.at_point.evaluation;
            predicted.displacement = displacement;
            return errors_against(trained, full, predicted, deck.problem, sampler);
        };
        answer.true_errors = errors_of(answer.at_point.evaluation.displacement);
        if (answer.galerkin) answer.galerkin_errors = errors_of(answer.galerkin->displacement);
    }
    if (!options.out.empty() || options.png) {
        answer.files = write_answer(trained, answer.at_point, options.out, options.png);
    }
    if (common.json) {
        print_json(trained, answer);
    } else if (!common.quiet) {
        print_table(trained, answer);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
