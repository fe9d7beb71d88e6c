#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_answer.h"
#include "drivers/rom_json.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "rom/member_volume.h"
#include "rom/sobol_indices.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::pair<std::string, std::string>> quantities = {
    {"displacement_max", "largest displacement"},
    {"von_mises_max", "largest von Mises"},
    {"volume", "volume"}};

/// Largest values and volume over the unit cube of the free parameters.
class Quantities {
  public:
    Quantities(const TrainedModel& trained, const VectorX& point, std::vector<int> free)
        : trained_(trained),
          unit_(trained.model().parameters().to_unit(point)),
          free_(std::move(free)),
          sampler_(answer_sampler(trained.model())),
          volume_(trained.model().space()),
          problem_(trained.deck_at(point).problem) {
        for (const int i : free_) {
            const rom::Parameter& one = trained.model().parameters().parameters()[i];
            has_constant_problem_ &=
                one.group == rom::ParameterGroup::geometry ||
                (one.group == rom::ParameterGroup::load && problem_.temperatures.empty());
        }
    }

    /// @param points  n_points x n_free
    [[nodiscard]] MatrixX at(const MatrixX& points) const {
        MatrixX values(points.rows(), 3);
        // Decks are read one by one, what they say is evaluated side by side.
        constexpr Eigen::Index n_at_once = 256;
        for (Eigen::Index first = 0; first < points.rows(); first += n_at_once) {
            const auto n = static_cast<int>(std::min(n_at_once, points.rows() - first));
            std::vector<VectorX> members;
            std::vector<iga::Problem> problems;
            for (int i = 0; i < n; ++i) {
                VectorX unit = unit_;
                unit(free_) = points.row(first + i).transpose();
                members.push_back(trained_.model().parameters().from_unit(unit));
                if (!has_constant_problem_) {
                    problems.push_back(trained_.deck_at(members.back()).problem);
                }
            }
            parallel_for(n, [&](int i) {
                const rom::Evaluation evaluation = trained_.model().evaluate(members[i]);
                const RomExtremes extremes =
                    extremes_of(sampler_.sample(evaluation.control_points, evaluation.displacement,
                                                has_constant_problem_ ? problem_ : problems[i]));
                values.row(first + i) << extremes.displacement, extremes.von_mises,
                    volume_.values(evaluation.control_points).sum();
            });
        }
        return values;
    }

  private:
    const TrainedModel& trained_;
    VectorX unit_;
    std::vector<int> free_;
    rom::FieldSampler sampler_;
    rom::MemberVolume volume_;
    iga::Problem problem_;
    bool has_constant_problem_ = true;
};

std::vector<int> free_parameters(const rom::ParameterSpace& space,
                                 const std::vector<std::string>& fixed) {
    std::vector<int> free;
    for (int i = 0; i < space.size(); ++i) {
        if (std::none_of(fixed.begin(), fixed.end(), [&](const std::string& setting) {
                return setting.substr(0, setting.find('=')) == space.parameters()[i].name;
            })) {
            free.push_back(i);
        }
    }
    if (free.empty()) {
        throw InputError("rom sensitivity: all parameters are fixed; leave one free at least");
    }
    return free;
}

Json to_json(const rom::IndexEstimate& one) {
    return {{"value", one.value}, {"low", one.low}, {"high", one.high}};
}

struct Result {
    VectorX point;
    std::vector<int> free;
    std::vector<rom::SobolIndices> indices;
    int n_samples = 0;
    double seconds = 0.0;

    [[nodiscard]] int n_evaluations() const {
        return n_samples * (static_cast<int>(free.size()) + 2);
    }
};

void print_json(const rom::ParameterSpace& space, const Result& result) {
    Json object = {{"program", "couture " COUTURE_VERSION}, {"status", "done"}};
    object["fixed"] = Json::array();
    for (int i = 0; i < space.size(); ++i) {
        if (std::find(result.free.begin(), result.free.end(), i) == result.free.end()) {
            object["fixed"].push_back(
                {{"name", space.parameters()[i].name}, {"value", result.point[i]}});
        }
    }
    object["samples"] = result.n_samples;
    object["evaluations"] = result.n_evaluations();
    object["confidence"] = rom::SobolOptions{}.confidence;
    object["quantities"] = Json::array();
    for (std::size_t q = 0; q < quantities.size(); ++q) {
        const rom::SobolIndices& indices = result.indices[q];
        Json one = {{"name", quantities[q].first},
                    {"mean", indices.mean},
                    {"variance", indices.variance},
                    {"parameters", Json::array()}};
        for (std::size_t i = 0; i < result.free.size(); ++i) {
            one["parameters"].push_back({{"name", space.parameters()[result.free[i]].name},
                                         {"first", to_json(indices.first[i])},
                                         {"total", to_json(indices.total[i])}});
        }
        object["quantities"].push_back(std::move(one));
    }
    object["seconds"] = result.seconds;
    object["warnings"] = log::warnings();
    fmt::print("{}\n", object.dump(2));
}

void print_table(const rom::ParameterSpace& space, const Result& result) {
    fmt::print("Sobol indices, {} samples, in brackets the {:.0f} % interval\n", result.n_samples,
               100.0 * rom::SobolOptions{}.confidence);
    for (std::size_t q = 0; q < quantities.size(); ++q) {
        const rom::SobolIndices& indices = result.indices[q];
        fmt::print("  {}: mean {:.6g}, standard deviation {:.3g}\n", quantities[q].second,
                   indices.mean, std::sqrt(indices.variance));
        fmt::print("    {:<20} {:^26} {:^26}\n", "", "first order", "total");
        const auto text = [](const rom::IndexEstimate& one) {
            return fmt::format("{:>7.4f} [{:>7.4f}, {:>7.4f}]", one.value, one.low, one.high);
        };
        for (std::size_t i = 0; i < result.free.size(); ++i) {
            fmt::print("    {:<20} {:>26} {:>26}\n", space.parameters()[result.free[i]].name,
                       text(indices.first[i]), text(indices.total[i]));
        }
    }
    fmt::print("  {} evaluations, {:.1f} s\n", result.n_evaluations(), result.seconds);
}

}  // namespace

int run_rom_sensitivity(const RomSensitivityOptions& options, const CommonOptions& common) {
    const Timer timer;
    const TrainedModel trained(options.model);
    const rom::ParameterSpace& space = trained.model().parameters();
    Result result;
    result.point = trained.point_of(options.fixed, "--fix");
    trained.check_inside(result.point, false);
    result.free = free_parameters(space, options.fixed);
    result.n_samples = options.n_samples;
    const Quantities values(trained, result.point, result.free);
    result.indices = rom::sobol_indices(static_cast<int>(result.free.size()),
                                        [&](const MatrixX& points) { return values.at(points); },
                                        {.n_samples = options.n_samples, .seed = options.seed});
    result.seconds = timer.seconds();
    if (common.json) {
        print_json(space, result);
    } else if (!common.quiet) {
        print_table(space, result);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
