#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/deck_check.h"
#include "drivers/result_files.h"
#include "drivers/rom_error_measures.h"
#include "drivers/rom_json.h"
#include "drivers/rom_model.h"
#include "iga/assembly/assembler.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/solve/static_system.h"
#include "iga/topology/jacobian_certificate.h"
#include "rom/field_sampler.h"
#include "rom/galerkin.h"
#include "rom/member_geometry.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

struct Extremes {
    double displacement = 0.0;
    double von_mises = 0.0;
    Vector3 von_mises_at = Vector3::Zero();
};

Extremes extremes_of(const rom::FieldSamples& samples) {
    Extremes extremes;
    extremes.displacement = samples.displacements.colwise().norm().maxCoeff();
    Eigen::Index worst = 0;
    extremes.von_mises = samples.von_mises.maxCoeff(&worst);
    extremes.von_mises_at = samples.points.col(worst);
    return extremes;
}

struct Answer {
    rom::Evaluation evaluation;
    rom::ErrorEstimates errors;
    Extremes extremes;
    double volume = 0.0;
    /// Of evaluation and sampling.
    double seconds = 0.0;
    iga::Validity validity = iga::Validity::valid;
    std::optional<rom::GalerkinSolution> galerkin;
    std::optional<PredictionErrors> true_errors;
    std::optional<PredictionErrors> galerkin_errors;
    std::vector<std::string> files;
};

// The member and its solution by the full model.
std::pair<VectorX, VectorX> solve_in_full(const TrainedModel& trained, const VectorX& point) {
    const fs::path deck = trained.deck_path();
    if (deck.empty() || !fs::exists(deck)) {
        throw InputError(
            "{}: --solve needs the deck that the model was trained by, {}, which is not "
            "there any more",
            trained.path().string(), deck.string());
    }
    RomSamples samples(deck, trained.overrides());
    io::SnapshotStore store(trained.path().parent_path() / "snapshots", samples.job());
    const auto reference = samples.make_reference(store);
    const auto member = samples.make_member(point, store);
    return {rom::to_field(*reference, member->geometry()), samples.solve(member, {point}).col(0)};
}

iga::Validity validity_of(const iga::MultiPatch<3>& geometry) {
    iga::Validity worst = iga::Validity::valid;
    for (const auto& patch : geometry.patches) {
        worst = std::max(worst, iga::certify(patch).validity);
    }
    return worst;
}

void write_files(const RomEvalOptions& options, const TrainedModel& trained, Answer& answer) {
    if (options.out.empty() && !options.png) return;
    io::Deck deck = trained.deck_at(answer.evaluation.point);
    deck.path = trained.path();
    deck.output.vtu = true;
    deck.output.png = options.png;
    const auto space =
        std::make_shared<const iga::Space<3>>(trained.model().member(answer.evaluation));
    iga::LinearStaticResult<3> result;
    result.cases.emplace_back();
    result.cases.back().displacement = {space, iga::unflatten(answer.evaluation.displacement, 3)};
    const GeometryCertificate certificate{answer.validity, 0.0, 0};
    const fs::path folder =
        options.out.empty() ? fs::path("out") / trained.path().stem() : options.out;
    for (const fs::path& file : write_result_files<3>(deck, space, result, certificate, folder)) {
        answer.files.push_back(file.string());
    }
}

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
    object["parameters"] = parameters_json(space, answer.evaluation.point);
    object["displacement_max"] = answer.extremes.displacement;
    object["von_mises_max"] = answer.extremes.von_mises;
    object["von_mises_at"] = {answer.extremes.von_mises_at[0], answer.extremes.von_mises_at[1],
                              answer.extremes.von_mises_at[2]};
    object["volume"] = answer.volume;
    object["certificate"] = iga::to_string(answer.validity);
    object["estimates"] = {{"geometry", to_json(answer.errors.geometry)},
                           {"displacement", to_json(answer.errors.displacement)},
                           {"von_mises", answer.errors.von_mises}};
    const VectorX& a = answer.evaluation.displacement_coefficients;
    const VectorX s = trained.model().displacement_standard_errors(answer.evaluation.point);
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
    object["seconds"] = answer.seconds;
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

void print_extremes(const Answer& answer) {
    const Vector3& at = answer.extremes.von_mises_at;
    fmt::print("  largest displacement   {:.6g}, expected error {:.2g} %\n",
               answer.extremes.displacement, 100.0 * answer.errors.displacement.relative);
    fmt::print(
        "  largest von Mises      {:.6g} at ({:.4g}, {:.4g}, {:.4g}), expected error {:.2g} "
        "%\n",
        answer.extremes.von_mises, at[0], at[1], at[2], 100.0 * answer.errors.von_mises);
}

void print_table(const TrainedModel& trained, const Answer& answer) {
    fmt::print("{}\n", describe_point(trained.model().parameters(), answer.evaluation.point));
    if (trained.is_geometry_only()) {
        fmt::print("  geometry               expected error {:.2g} %\n",
                   100.0 * answer.errors.geometry.relative);
    } else {
        print_extremes(answer);
    }
    fmt::print("  volume                 {:.6g}; det J {}\n", answer.volume,
               iga::to_string(answer.validity));
    if (answer.galerkin) {
        fmt::print(
            "  Galerkin               residual {:.2e} (kriging {:.2e}), change {:.2e} in "
            "energy\n",
            answer.galerkin->relative_residual, answer.galerkin->relative_residual_of_kriging,
            answer.galerkin->relative_change);
    }
    if (answer.true_errors) print_errors("error", *answer.true_errors);
    if (answer.galerkin_errors) print_errors("error of Galerkin", *answer.galerkin_errors);
    fmt::print("  {:.2f} ms", 1e3 * answer.seconds);
    if (!answer.files.empty()) fmt::print("; wrote");
    for (const std::string& file : answer.files) fmt::print(" {}", file);
    fmt::print("\n");
}

}  // namespace

int run_rom_eval(const RomEvalOptions& options, const CommonOptions& common) {
    const TrainedModel trained(options.model);
    const rom::ReducedModel& model = trained.model();
    const VectorX point = trained.point_of(options.settings);
    trained.check_inside(point, options.is_forced);
    if (options.galerkin && trained.is_geometry_only()) {
        throw InputError("rom eval: --galerkin solves for displacements; {} has geometry only",
                         trained.path().string());
    }
    const io::Deck deck = trained.deck_at(point);
    const rom::FieldSampler sampler(
        model.space(), rom::make_sample_grids(*model.space(), rom::SampleRegion::volume));
    Answer answer;
    const Timer timer;
    answer.evaluation = model.evaluate(point);
    if (!trained.is_geometry_only()) {
        answer.extremes = extremes_of(sampler.sample(answer.evaluation.control_points,
                                                     answer.evaluation.displacement, deck.problem));
    }
    answer.seconds = timer.seconds();
    answer.errors = model.errors(point);
    const iga::MultiPatch<3> member = model.member(answer.evaluation);
    answer.validity = validity_of(member);
    if (answer.validity != iga::Validity::valid) {
        log::warn(fmt::format("the predicted geometry is {}", iga::to_string(answer.validity)));
    }
    answer.volume = iga::volume(member);
    if (options.galerkin) {
        answer.galerkin = rom::solve_galerkin(model, answer.evaluation, deck.problem, "",
                                              deck.discretization.n_gauss_points);
    }
    if (options.solve) {
        const auto [control_points, displacement] = solve_in_full(trained, point);
        const rom::InnerProduct product =
            rom::mode_product(*model.space(), model.parts().options.product);
        const auto measure = [&](const VectorX& u) {
            return measure_prediction(product, sampler, deck.problem, control_points, displacement,
                                      answer.evaluation.control_points, u);
        };
        answer.true_errors = measure(answer.evaluation.displacement);
        if (answer.galerkin) answer.galerkin_errors = measure(answer.galerkin->displacement);
    }
    write_files(options, trained, answer);
    if (common.json) {
        print_json(trained, answer);
    } else if (!common.quiet) {
        print_table(trained, answer);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
