#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_json.h"
#include "drivers/rom_optimum.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "io/picture.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::ordered_json;

// The optimum by the full model.
struct FullCheck {
    RomExtremes extremes;
    double violation = 0.0;
    PredictionErrors errors;
};

struct Result {
    OptimumProblem problem;
    rom::MassMinimum minimum;
    RomAnswer answer;
    std::optional<FullCheck> full;
    std::array<std::string, 3> units;  ///< length, force, pressure
    double kilograms = 1.0;            ///< of the deck's unit of mass
    double seconds = 0.0;
    std::vector<std::string> files;

    [[nodiscard]] const rom::MassSearch& best() const { return minimum.searches[minimum.best]; }
};

constexpr const char* full_solution = "the full solution (without --no-solve)";

FullCheck check_in_full(const TrainedModel& trained, const Result& result,
                        const rom::FieldSampler& sampler) {
    const rom::Evaluation& evaluation = result.answer.evaluation;
    const FullSolution full = solve_in_full(trained, evaluation.point, full_solution);
    const iga::Problem problem = trained.deck_at(evaluation.point).problem;
    FullCheck check;
    check.extremes = extremes_of(sampler.sample(full.control_points, full.displacement, problem));
    check.violation = violation_of(result.problem.limits, check.extremes);
    check.errors = errors_against(trained, full, evaluation, problem, sampler);
    if (result.minimum.is_feasible && check.violation > rom::mass_tolerance) {
        log::warn(
            fmt::format("the full solution of the optimum is {:.2g} % above a limit: lower the "
                        "limits by as much, or add samples (couture rom enrich)",
                        100.0 * check.violation));
    }
    return check;
}

Json start_json(const rom::ParameterSpace& space, const Result& result,
                const rom::MassSearch& search) {
    Json object = {{"start", parameters_json(space, search.start)},
                   {"end", parameters_json(space, search.point)}};
    if (result.problem.has_mass) {
        object["mass"] = result.kilograms * search.mass;
    } else {
        object["volume"] = search.mass;
    }
    if (search.von_mises) object["von_mises_max"] = *search.von_mises;
    if (search.displacement) object["displacement_max"] = *search.displacement;
    object["violation"] = search.violation;
    object["evaluations"] = search.n_evaluations;
    return object;
}

void print_json(const TrainedModel& trained, const Result& result) {
    const rom::ParameterSpace& space = trained.model().parameters();
    Json object = {{"program", "couture " COUTURE_VERSION},
                   {"status", result.minimum.is_feasible ? "done" : "infeasible"},
                   {"minimized", result.problem.has_mass ? "mass" : "volume"}};
    object["limits"] = Json::object();
    if (result.problem.limits.von_mises) {
        object["limits"]["von_mises"] = *result.problem.limits.von_mises;
    }
    if (result.problem.limits.displacement) {
        object["limits"]["displacement"] = *result.problem.limits.displacement;
    }
    object["free"] = Json::array();
    for (const int i : result.problem.free) object["free"].push_back(space.parameters()[i].name);
    object["parameters"] = parameters_json(space, result.best().point);
    if (result.problem.has_mass) object["mass"] = result.kilograms * result.best().mass;
    const RomExtremes& extremes = result.answer.extremes;
    object["volume"] = result.answer.volume;
    object["displacement_max"] = extremes.displacement;
    object["von_mises_max"] = extremes.von_mises;
    object["von_mises_at"] = {extremes.von_mises_at[0], extremes.von_mises_at[1],
                              extremes.von_mises_at[2]};
    object["violation"] = result.best().violation;
    object["certificate"] = iga::to_string(result.answer.validity);
    object["estimates"] = {{"displacement", result.answer.errors.displacement.relative},
                           {"von_mises", result.answer.errors.von_mises}};
    if (result.full) {
        object["full"] = {{"displacement_max", result.full->extremes.displacement},
                          {"von_mises_max", result.full->extremes.von_mises},
                          {"violation", result.full->violation},
                          {"errors", to_json(result.full->errors)}};
    }
    object["starts"] = Json::array();
    for (const rom::MassSearch& search : result.minimum.searches) {
        object["starts"].push_back(start_json(space, result, search));
    }
    object["seconds"] = result.seconds;
    object["warnings"] = log::warnings();
    object["files"] = result.files;
    fmt::print("{}\n", object.dump(2));
}

std::string describe_free(const rom::ParameterSpace& space, const std::vector<int>& free,
                          const VectorX& point) {
    std::string text;
    for (const int i : free) {
        const rom::Parameter& one = space.parameters()[i];
        text += fmt::format("{}{} = {:.6g}{}{}", text.empty() ? "" : ", ", one.name, point[i],
                            one.unit.empty() ? "" : " ", one.unit);
    }
    return text;
}

void print_searches(const rom::ParameterSpace& space, const Result& result) {
    fmt::print("  {:>5} {:>13} {:>13} {:>13} {:>10} {:>6}\n", "start",
               result.problem.has_mass ? "mass, kg" : "volume", "von Mises", "displacement",
               "violation", "calls");
    const auto text = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.6g}", *value) : std::string("-");
    };
    for (std::size_t i = 0; i < result.minimum.searches.size(); ++i) {
        const rom::MassSearch& one = result.minimum.searches[i];
        fmt::print("  {:>4}{} {:>13.6g} {:>13} {:>13} {:>9.2g}% {:>6}  {}\n", i + 1,
                   static_cast<int>(i) == result.minimum.best ? "*" : " ",
                   result.kilograms * one.mass, text(one.von_mises), text(one.displacement),
                   100.0 * std::max(one.violation, 0.0), one.n_evaluations,
                   describe_free(space, result.problem.free, one.point));
    }
}

void print_table(const TrainedModel& trained, const Result& result) {
    const rom::ParameterSpace& space = trained.model().parameters();
    const rom::MassLimits& limits = result.problem.limits;
    std::string within;
    if (limits.von_mises) {
        within += fmt::format("von Mises up to {:.6g} {}", *limits.von_mises, result.units[2]);
    }
    if (limits.displacement) {
        within += fmt::format("{}displacement up to {:.6g} {}", within.empty() ? "" : ", ",
                              *limits.displacement, result.units[0]);
    }
    fmt::print("least {} with {}\n", result.problem.has_mass ? "mass" : "volume", within);
    print_searches(space, result);
    if (!result.minimum.is_feasible) {
        fmt::print("  no member keeps these limits: the nearest is {:.3g} % above one\n",
                   100.0 * result.best().violation);
    }
    const RomAnswer& answer = result.answer;
    fmt::print("{}\n", describe_point(space, result.best().point));
    const Vector3& at = answer.extremes.von_mises_at;
    fmt::print("  largest displacement   {:.6g} {}, expected error {:.2g} %\n",
               answer.extremes.displacement, result.units[0],
               100.0 * answer.errors.displacement.relative);
    fmt::print(
        "  largest von Mises      {:.6g} {} at ({:.4g}, {:.4g}, {:.4g}), expected error {:.2g} %\n",
        answer.extremes.von_mises, result.units[2], at[0], at[1], at[2],
        100.0 * answer.errors.von_mises);
    if (result.problem.has_mass) {
        fmt::print("  mass                   {:.6g} kg\n", result.kilograms * result.best().mass);
    }
    fmt::print("  volume                 {:.6g} {}^3; det J {}\n", answer.volume, result.units[0],
               iga::to_string(answer.validity));
    if (result.full) {
        const FullCheck& full = *result.full;
        fmt::print("  in full                displacement {:.6g}, von Mises {:.6g}\n",
                   full.extremes.displacement, full.extremes.von_mises);
        fmt::print(
            "  error                  displacement {:.3f} %, geometry {:.4f} %, von Mises {:.3f} "
            "%, its largest {:.3f} %\n",
            100.0 * full.errors.displacement, 100.0 * full.errors.geometry,
            100.0 * full.errors.von_mises, 100.0 * full.errors.von_mises_max);
    }
    fmt::print("  {:.1f} s", result.seconds);
    if (!result.files.empty()) fmt::print("; wrote");
    for (const std::string& file : result.files) fmt::print(" {}", file);
    fmt::print("\n");
}

}  // namespace

int run_rom_optimize(const RomOptimizeOptions& options, const CommonOptions& common) {
    const Timer timer;
    if (options.png) {
        if (const auto missing = io::missing_for_pictures()) {
            throw InputError("rom optimize: no picture can be drawn: {}", *missing);
        }
    }
    const TrainedModel trained(options.model);
    if (!options.no_solve) require_deck(trained, full_solution);
    const rom::FieldSampler sampler = answer_sampler(trained.model());
    Result result;
    result.problem =
        optimum_problem(trained, options.stress_limit, options.displacement_limit, options.fixed);
    const io::UnitSystem units = trained.deck_at(result.problem.point).units;
    result.units = units.unit_names();
    if (result.problem.has_mass) result.kilograms = units.scale(io::dimensions::mass);
    result.minimum =
        find_optimum(trained, result.problem, {.n_starts = options.n_starts, .seed = options.seed},
                     sampler.grids());
    result.answer = answer_at(trained, result.best().point, sampler);
    bool is_checked = true;
    if (!options.no_solve) {
        try {
            result.full = check_in_full(trained, result, sampler);
        } catch (const Error& error) {
            log::warn(fmt::format("the optimum can't be solved in full: {}", error.what()));
            is_checked = false;
        }
    }
    if (!options.out.empty() || options.png) {
        result.files = write_answer(trained, result.answer, options.out, options.png);
    }
    result.seconds = timer.seconds();
    if (common.json) {
        print_json(trained, result);
    } else if (!common.quiet) {
        print_table(trained, result);
    }
    return result.minimum.is_feasible && is_checked ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
