#include "drivers/rom_optimum.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "iga/core/error.h"
#include "iga/mechanics/kinematics.h"

namespace couture::drivers {

namespace {

std::optional<double> read_limit(const std::string& option, const std::string& text,
                                 const io::Dimension& dimension, const io::UnitSystem& units) {
    if (text.empty()) return {};
    const auto fail = [&](const std::string& why) {
        throw InputError("{} '{}': {}; write a positive number in units '{}' or with its unit",
                         option, text, why, units.name());
    };
    double value = 0.0;
    try {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_number = error == std::errc() && end == text.data() + text.size();
        if (!is_number) value = io::parse_quantity(text, dimension, units);
    } catch (const InputError& error) {
        fail(error.what());
    }
    if (!(value > 0.0 && std::isfinite(value))) fail("is not positive");
    return value;
}

// Of each patch; empty if no material has one.
VectorX densities_of(const iga::Problem& problem, int n_patches) {
    const auto has_density = [](const iga::Material& one) { return one.density.has_value(); };
    if (std::none_of(problem.materials.begin(), problem.materials.end(), has_density)) return {};
    VectorX densities(n_patches);
    const std::vector<int> materials = iga::materials_of_patches(problem, n_patches);
    for (int p = 0; p < n_patches; ++p) {
        const iga::Material& material = problem.materials[materials[p]];
        if (!material.density) {
            throw InputError(
                "rom optimize: [material.{}] has no 'density', other materials have one; give all "
                "or none (then the volume is minimised)",
                material.name);
        }
        densities[p] = *material.density;
    }
    return densities;
}

}  // namespace

OptimumProblem optimum_problem(const TrainedModel& trained, const std::string& stress_limit,
                               const std::string& displacement_limit,
                               const std::vector<std::string>& fixed) {
    const rom::ParameterSpace& space = trained.model().parameters();
    OptimumProblem result;
    result.point = trained.point_of(fixed, "--fix");
    trained.check_inside(result.point, false);
    const io::Deck deck = trained.deck_at(result.point);
    result.limits.von_mises =
        read_limit("--stress-limit", stress_limit, io::dimensions::pressure, deck.units);
    result.limits.displacement =
        read_limit("--displacement-limit", displacement_limit, io::dimensions::length, deck.units);
    if (!result.limits.von_mises && !result.limits.displacement) {
        throw InputError(
            "rom optimize: without a limit the lightest member is none worth knowing; give "
            "--stress-limit, --displacement-limit or both");
    }
    std::vector<int> fixed_parameters;
    for (const std::string& setting : fixed) {
        fixed_parameters.push_back(space.index_of(setting.substr(0, setting.find('='))));
    }
    for (const int i : space.group(rom::ParameterGroup::geometry)) {
        if (std::find(fixed_parameters.begin(), fixed_parameters.end(), i) ==
            fixed_parameters.end()) {
            result.free.push_back(i);
        }
    }
    if (result.free.empty()) {
        throw InputError(
            "rom optimize: no geometric parameter of {} is left to change; give fewer --fix",
            trained.path().string());
    }
    result.densities = densities_of(deck.problem, trained.model().space()->n_patches());
    result.has_mass = result.densities.size() > 0;
    if (!result.has_mass) result.densities.setOnes(trained.model().space()->n_patches());
    return result;
}

rom::MassMinimum find_optimum(const TrainedModel& trained, const OptimumProblem& problem,
                              const rom::MassOptions& options,
                              const std::vector<rom::SampleGrid>& grids) {
    // Stresses of a member depend on its materials and temperatures, which stay.
    const iga::Problem stays = trained.deck_at(problem.point).problem;
    const rom::MemberMeasures measures(
        trained.model(), [&](const VectorX&) { return stays; }, problem.densities, grids);
    return rom::minimize_mass(measures, problem.point, problem.free, problem.limits, options);
}

double violation_of(const rom::MassLimits& limits, const RomExtremes& extremes) {
    double worst = 0.0;
    if (limits.von_mises) worst = std::max(worst, extremes.von_mises / *limits.von_mises);
    if (limits.displacement) worst = std::max(worst, extremes.displacement / *limits.displacement);
    return worst - 1.0;
}

}  // namespace couture::drivers
