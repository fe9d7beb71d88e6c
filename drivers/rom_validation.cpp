#include "drivers/rom_validation.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "drivers/result_files.h"
#include "drivers/rom_json.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/solve/static_system.h"
#include "io/line_plot.h"
#include "rom/member_geometry.h"

namespace couture::drivers {

namespace {

// Errors of the displacement with the first 1, 2, ... modes.
VectorX errors_by_modes(const rom::ReducedModel& model, const MatrixX& modes,
                        const rom::InnerProduct& product, const rom::Evaluation& evaluation,
                        const VectorX& displacement) {
    const double norm = std::sqrt(product.squared_norms(displacement)[0]);
    const double size = norm > 0.0 ? norm : 1.0;
    const VectorX& a = evaluation.displacement_coefficients;
    VectorX errors(a.size());
    VectorX u = evaluation.factor * model.displacement_mean();
    for (Eigen::Index k = 0; k < a.size(); ++k) {
        u += evaluation.factor * a[k] * modes.col(k);
        const VectorX difference = u - displacement;
        errors[k] = std::sqrt(product.squared_norms(difference)[0]) / size;
    }
    return errors;
}

rom::Calibration calibrate(const TrainedModel& trained, const Validation& validation,
                           const rom::Calibration& before) {
    const auto n = static_cast<Eigen::Index>(validation.points.size());
    VectorX geometry(n);
    VectorX displacement(n);
    VectorX von_mises(n);
    VectorX expected_geometry(n);
    VectorX expected_displacement(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const ValidationPoint& one = validation.points[i];
        const rom::ErrorEstimates estimates = trained.model().errors(one.point);
        geometry[i] = one.kriging.geometry;
        displacement[i] = one.kriging.displacement;
        von_mises[i] = one.kriging.von_mises;
        expected_geometry[i] = estimates.geometry.relative / before.geometry;
        expected_displacement[i] = estimates.displacement.relative / before.displacement;
    }
    rom::Calibration calibration;
    calibration.n_points = static_cast<int>(n);
    // A geometry that is known exactly has nothing to be calibrated by.
    constexpr double rounding = 1e-14;
    if (expected_geometry.minCoeff() > rounding) {
        calibration.geometry = rom::calibration_factor(geometry, expected_geometry);
    }
    if (trained.is_geometry_only()) return calibration;
    calibration.displacement = rom::calibration_factor(displacement, expected_displacement);
    calibration.von_mises =
        rom::calibration_factor(von_mises, calibration.displacement * expected_displacement);
    return calibration;
}

nlohmann::ordered_json to_json(const Statistics& one) {
    return {{"mean", one.mean}, {"median", one.median}, {"worst", one.worst}};
}

struct Measure {
    const char* name;
    const char* title;
    double PredictionErrors::*value;
    bool is_of_geometry = false;
};

constexpr std::array<Measure, 6> measures{{
    {"displacement", "displacement", &PredictionErrors::displacement},
    {"displacement_max", "  largest difference", &PredictionErrors::displacement_max},
    {"geometry", "geometry", &PredictionErrors::geometry, true},
    {"geometry_max", "  largest difference", &PredictionErrors::geometry_max, true},
    {"von_mises", "von Mises", &PredictionErrors::von_mises},
    {"von_mises_max", "  largest value", &PredictionErrors::von_mises_max},
}};

VectorX sorted(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Of what is positive; the rest is as small as the smallest that is.
VectorX log10_of(const VectorX& values) {
    constexpr double least = 1e-16;
    return values.cwiseMax(least).array().log10();
}

// Where a model is worst: by its displacement, or by its geometry if it has no other field.
Statistics worst_of(const TrainedModel& trained, const Validation& validation) {
    return statistics_of(validation.errors(trained.is_geometry_only()
                                               ? &PredictionErrors::geometry
                                               : &PredictionErrors::displacement));
}

io::Scene draw_learning(const std::vector<LearningPoint>& learning) {
    VectorX n_geometries(static_cast<Eigen::Index>(learning.size()));
    VectorX errors(n_geometries.size());
    for (Eigen::Index k = 0; k < errors.size(); ++k) {
        n_geometries[k] = learning[k].n_geometries;
        errors[k] = 100.0 * learning[k].error;
    }
    return io::make_line_plot(n_geometries, errors,
                              {"number of geometries", "geometries", "mean relative error, %"});
}

// The samples grey, the points of validation blue, the worst red and last.
io::Scene draw_design(const TrainedModel& trained, const RomPlan& design,
                      const Validation& validation) {
    constexpr io::Color grey{0.70, 0.72, 0.75};
    constexpr io::Color blue{0.12, 0.38, 0.68};
    constexpr io::Color red{0.78, 0.16, 0.12};
    std::vector<io::ParallelAxis> axes;
    for (const rom::Parameter& one : trained.model().parameters().parameters()) {
        axes.push_back({one.name, one.lower, one.upper});
    }
    const auto n_axes = static_cast<Eigen::Index>(axes.size());
    MatrixX samples(design.n_snapshots(), n_axes);
    Eigen::Index row = 0;
    for (int g = 0; g < design.n_geometries(); ++g) {
        for (int l = 0; l < design.n_loads(); ++l) {
            for (int m = 0; m < design.n_materials(); ++m) {
                samples.row(row++) = design.point(g, l, m).transpose();
            }
        }
    }
    MatrixX points(static_cast<Eigen::Index>(validation.points.size()), n_axes);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        points.row(i) = validation.points[i].point.transpose();
    }
    const MatrixX worst = points.row(worst_of(trained, validation).i_worst);
    return io::make_parallel_plot(axes,
                                  {{samples, grey, 1.0}, {points, blue, 1.5}, {worst, red, 3.0}},
                                  "samples grey, points of validation blue, the worst red");
}

}  // namespace

Statistics statistics_of(const std::vector<double>& values) {
    if (values.empty()) throw InputError("statistics: there are no numbers");
    Statistics result;
    result.mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    const auto worst = std::max_element(values.begin(), values.end());
    result.worst = *worst;
    result.i_worst = static_cast<int>(worst - values.begin());
    const VectorX rising = sorted(values);
    const Eigen::Index n = rising.size();
    result.median = 0.5 * (rising[(n - 1) / 2] + rising[n / 2]);
    return result;
}

std::vector<double> Validation::errors(double PredictionErrors::*measure) const {
    std::vector<double> values;
    for (const ValidationPoint& one : points) values.push_back(one.kriging.*measure);
    return values;
}

std::vector<double> Validation::galerkin_errors(double PredictionErrors::*measure) const {
    std::vector<double> values;
    for (const ValidationPoint& one : points) {
        if (one.galerkin) values.push_back((*one.galerkin).*measure);
    }
    return values;
}

VectorX Validation::mean_by_modes() const {
    VectorX sum = VectorX::Zero(points.front().by_modes.size());
    for (const ValidationPoint& one : points) sum += one.by_modes;
    return sum / static_cast<double>(points.size());
}

std::vector<SolvedPoint> solved_points(const RomSamples& samples, const io::SnapshotStore& store,
                                       const iga::MultiPatch<3>& reference) {
    const std::string signature = iga::signature(reference);
    std::vector<SolvedPoint> solved;
    for (int i = 0; i < samples.plan().n_geometries(); ++i) {
        if (!store.has_solution(i, 0)) continue;
        solved.push_back({samples.plan().point(i, 0, 0), iga::flatten(store.geometry(i, signature)),
                          store.solution(i, 0, signature).col(0)});
    }
    return solved;
}

Validation validate_model(const TrainedModel& trained, const std::vector<SolvedPoint>& solved,
                          bool with_galerkin) {
    const rom::ReducedModel& model = trained.model();
    if (with_galerkin && trained.is_geometry_only()) {
        throw InputError("rom validate: --galerkin solves for displacements; {} has geometry only",
                         trained.path().string());
    }
    if (solved.empty()) {
        throw InputError("rom validate: no point was solved; see what was refused above");
    }
    const rom::InnerProduct product =
        rom::mode_product(*model.space(), model.parts().options.product);
    const rom::FieldSampler sampler(
        model.space(), rom::make_sample_grids(*model.space(), rom::SampleRegion::volume));
    const MatrixX modes = model.displacement_modes();
    Validation validation;
    for (const SolvedPoint& full : solved) {
        ValidationPoint one;
        one.point = full.point;
        const io::Deck deck = trained.deck_at(one.point);
        const rom::Evaluation evaluation = model.evaluate(one.point);
        const auto measure = [&](const VectorX& displacement) {
            return measure_prediction(product, sampler, deck.problem, full.control_points,
                                      full.displacement, evaluation.control_points, displacement);
        };
        one.kriging = measure(evaluation.displacement);
        one.estimate = model.errors(one.point).displacement.relative;
        one.by_modes = errors_by_modes(model, modes, product, evaluation, full.displacement);
        if (with_galerkin) {
            one.galerkin = measure(solve_projected(model, evaluation, deck).displacement);
        }
        validation.points.push_back(std::move(one));
        log::detail(fmt::format("rom: compared {} of {}", validation.points.size(), solved.size()));
    }
    validation.calibration = calibrate(trained, validation, model.parts().calibration);
    return validation;
}

std::string validation_json(const TrainedModel& trained, const Validation& validation,
                            int n_refused, double seconds, const std::vector<std::string>& files) {
    nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                     {"status", n_refused > 0 ? "failed" : "done"},
                                     {"model", trained.path().string()},
                                     {"points", validation.points.size()},
                                     {"refused", n_refused}};
    for (const Measure& measure : measures) {
        object["errors"][measure.name] = to_json(statistics_of(validation.errors(measure.value)));
        const auto galerkin = validation.galerkin_errors(measure.value);
        if (!galerkin.empty()) {
            object["galerkin_errors"][measure.name] = to_json(statistics_of(galerkin));
        }
    }
    const VectorX by_modes = validation.mean_by_modes();
    object["error_by_modes"] = std::vector<double>(by_modes.begin(), by_modes.end());
    object["error_by_geometries"] = nlohmann::ordered_json::array();
    for (const LearningPoint& one : validation.learning) {
        object["error_by_geometries"].push_back(
            {{"geometries", one.n_geometries}, {"error", one.error}});
    }
    object["calibration"] = {{"geometry", validation.calibration.geometry},
                             {"displacement", validation.calibration.displacement},
                             {"von_mises", validation.calibration.von_mises}};
    object["samples"] = nlohmann::ordered_json::array();
    const rom::ParameterSpace& space = trained.model().parameters();
    for (const ValidationPoint& one : validation.points) {
        nlohmann::ordered_json sample;
        sample["parameters"] = parameters_json(space, one.point);
        sample["errors"] = to_json(one.kriging);
        if (one.galerkin) sample["galerkin_errors"] = to_json(*one.galerkin);
        sample["estimate"] = one.estimate;
        object["samples"].push_back(std::move(sample));
    }
    object["seconds"] = seconds;
    object["warnings"] = log::warnings();
    object["files"] = files;
    return object.dump(2) + "\n";
}

std::string validation_csv(const TrainedModel& trained, const Validation& validation) {
    const rom::ParameterSpace& space = trained.model().parameters();
    const bool has_galerkin = validation.points.front().galerkin.has_value();
    std::string text;
    for (const rom::Parameter& one : space.parameters()) text += one.name + ",";
    for (const Measure& measure : measures) text += fmt::format("{},", measure.name);
    if (has_galerkin) {
        for (const Measure& measure : measures) text += fmt::format("galerkin_{},", measure.name);
    }
    text += "estimate\n";
    for (const ValidationPoint& one : validation.points) {
        for (const double value : one.point) text += fmt::format("{:.10g},", value);
        for (const Measure& measure : measures) {
            text += fmt::format("{:.6e},", one.kriging.*measure.value);
        }
        if (has_galerkin) {
            for (const Measure& measure : measures) {
                text += fmt::format("{:.6e},", (*one.galerkin).*measure.value);
            }
        }
        text += fmt::format("{:.6e}\n", one.estimate);
    }
    return text;
}

void print_validation(const TrainedModel& trained, const Validation& validation, int n_refused) {
    fmt::print("{}: {} points{}\n", trained.path().string(), validation.points.size(),
               n_refused > 0 ? fmt::format(", {} refused", n_refused) : "");
    fmt::print("  {:<22} {:>10} {:>10} {:>10}   (relative, %)\n", "error", "mean", "median",
               "worst");
    const auto print = [](const std::string& name, const Statistics& one) {
        fmt::print("  {:<22} {:>10.4f} {:>10.4f} {:>10.4f}\n", name, 100.0 * one.mean,
                   100.0 * one.median, 100.0 * one.worst);
    };
    for (const Measure& measure : measures) {
        if (trained.is_geometry_only() && !measure.is_of_geometry) continue;
        print(measure.title, statistics_of(validation.errors(measure.value)));
    }
    if (validation.points.front().galerkin) {
        fmt::print("  with Galerkin:\n");
        for (const Measure& measure : measures) {
            print(measure.title, statistics_of(validation.galerkin_errors(measure.value)));
        }
    }
    std::vector<std::string> learning;
    for (const LearningPoint& one : validation.learning) {
        learning.push_back(fmt::format("{:.4f} of {}", 100.0 * one.error, one.n_geometries));
    }
    if (!learning.empty()) {
        fmt::print("  mean by geometries     {}\n", fmt::join(learning, ", "));
    }
    const Statistics worst = worst_of(trained, validation);
    fmt::print("  worst at {}\n", describe_point(trained.model().parameters(),
                                                 validation.points[worst.i_worst].point));
}

void draw_validation(const std::filesystem::path& path, const TrainedModel& trained,
                     const RomPlan& design, const Validation& validation) {
    const rom::ReducedModelParts& parts = trained.model().parts();
    const auto plot = [](const VectorX& values, const std::string& title, const std::string& x,
                         const std::string& y) {
        return io::make_line_plot(values, {title, x, y});
    };
    std::vector<std::vector<io::Scene>> rows(3);
    const auto draw_errors = [&](double PredictionErrors::*measure, const std::string& title) {
        rows[0].push_back(plot(100.0 * sorted(validation.errors(measure)), title,
                               "points, best first", "relative error, %"));
    };
    const auto draw_singular_values = [&](const rom::FieldPart& part, const std::string& title) {
        const VectorX& sigma = parts.models[part.i_model].basis().singular_values;
        rows[1].push_back(plot(log10_of(sigma / sigma[0]), "singular values of " + title,
                               "mode, from 0", "log10 of value / largest"));
    };
    if (trained.is_geometry_only()) {
        draw_errors(&PredictionErrors::geometry, "geometry");
        draw_singular_values(parts.geometry, "geometries");
    } else {
        draw_errors(&PredictionErrors::displacement, "displacement");
        draw_errors(&PredictionErrors::von_mises, "von Mises");
        rows[1].push_back(plot(log10_of(validation.mean_by_modes()), "number of modes",
                               "mode, from 0", "log10 of the mean error of displacements"));
        draw_singular_values(parts.displacement, "displacements");
    }
    if (!validation.learning.empty()) rows[2].push_back(draw_learning(validation.learning));
    rows[2].push_back(draw_design(trained, design, validation));
    io::render_png(path, rows);
}

std::vector<std::string> write_worst_point(const std::filesystem::path& stem,
                                           const TrainedModel& trained,
                                           const std::vector<SolvedPoint>& solved,
                                           const Validation& validation, bool png) {
    const rom::ReducedModel& model = trained.model();
    const Statistics worst = worst_of(trained, validation);
    const SolvedPoint& full = solved[worst.i_worst];
    const rom::Evaluation evaluation = model.evaluate(full.point);
    io::Deck deck = trained.deck_at(full.point);
    deck.output.vtu = true;
    deck.output.png = png;
    std::vector<std::string> files;
    const auto result_of = [&](const VectorX& control_points, const VectorX& displacement) {
        iga::LinearStaticResult<3> result;
        result.cases.emplace_back();
        result.cases.back().displacement = {
            std::make_shared<const iga::Space<3>>(rom::to_member(*model.space(), control_points)),
            iga::unflatten(displacement, 3)};
        return result;
    };
    const auto write = [&](const char* name, const iga::LinearStaticResult<3>& result,
                           const std::optional<MatrixX>& stress = {}) {
        deck.path = std::filesystem::path(stem.filename().string() + "_worst_" + name + ".toml");
        deck.title = name;
        for (const auto& file : write_result_files<3>(deck, result.cases.back().displacement.space,
                                                      result, {}, stem.parent_path(), stress)) {
            files.push_back(file.string());
        }
    };
    const auto predicted = result_of(evaluation.control_points, evaluation.displacement);
    const auto computed = result_of(full.control_points, full.displacement);
    write("predicted", predicted);
    write("computed", computed);
    // Stresses at finite strain are not those of the difference.
    write("difference", result_of(full.control_points, evaluation.displacement - full.displacement),
          smooth_stress<3>(deck, predicted.cases.back()) -
              smooth_stress<3>(deck, computed.cases.back()));
    return files;
}

}  // namespace couture::drivers
