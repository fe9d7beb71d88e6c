#include "drivers/rom_model.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "rom/galerkin_newton.h"

namespace couture::drivers {

namespace {

constexpr const char* deck_key = "deck file";
constexpr const char* settings_key = "deck settings";
constexpr const char* job_key = "job";
// The deck's own geometry may be out of reach, and is of no use beside the model's.
constexpr const char* no_geometry = "geometry={part = \"box\"}";

io::Deck deck_of(const io::ReducedModelFile& file, const std::filesystem::path& name,
                 const std::vector<std::string>& overrides,
                 const std::vector<std::string>& point = {}) {
    std::vector<std::string> all = overrides;
    all.emplace_back(no_geometry);
    all.insert(all.end(), point.begin(), point.end());
    return io::parse_deck(file.deck, name, all);
}

double read_value(const rom::Parameter& parameter, const std::string& text,
                  const std::string& option) {
    const auto fail = [&](const std::string& why) {
        throw InputError("{} {}={}: {}; write a number in {}, from {} to {}", option,
                         parameter.name, text, why,
                         parameter.unit.empty() ? "the deck's units" : parameter.unit,
                         parameter.lower, parameter.upper);
    };
    double value = 0.0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) fail("is no number");
    std::string unit(stop, text.data() + text.size());
    unit.erase(0, unit.find_first_not_of(' '));
    if (!unit.empty() && unit != parameter.unit) {
        if (parameter.unit.empty()) fail("has a unit, the parameter has none");
        const io::Quantity given = io::parse_unit(unit);
        const io::Quantity wanted = io::parse_unit(parameter.unit);
        if (!(given.dimension == wanted.dimension)) {
            fail("is " + given.dimension.name() + ", not " + wanted.dimension.name());
        }
        value *= given.value / wanted.value;
    }
    if (!std::isfinite(value)) fail("is not finite");
    return value;
}

}  // namespace

rom::ReducedModelOptions model_options(const io::RomSection& section) {
    rom::ReducedModelOptions options;
    options.basis = section.is_stacked ? rom::BasisKind::stacked : rom::BasisKind::separate;
    options.product = section.is_l2 ? rom::ModeProduct::l2 : rom::ModeProduct::euclidean;
    options.amplitude = section.has_amplitude ? rom::Amplitude::automatic : rom::Amplitude::none;
    options.n_modes = section.n_modes;
    options.tolerance = section.tolerance;
    options.kriging.correlation = section.correlation;
    options.kriging.trend = section.trend;
    return options;
}

std::map<std::string, std::string> model_provenance(const RomSamples& samples) {
    return {{deck_key, std::filesystem::absolute(samples.deck().path).lexically_normal().string()},
            {settings_key, nlohmann::json(samples.overrides()).dump()},
            {job_key, text_hash(samples.job())}};
}

TrainedModel::TrainedModel(const std::filesystem::path& path)
    : path_(path),
      file_(io::read_reduced_model(path)),
      section_(deck_of(file_, path.filename(), overrides()).rom.value()),
      is_geometry_only_(!moves(deck_at(model().parts().reference_point))) {}

std::filesystem::path TrainedModel::deck_path() const {
    const auto found = file_.provenance.find(deck_key);
    if (found == file_.provenance.end()) return {};
    return found->second;
}

std::vector<std::string> TrainedModel::overrides() const {
    const auto found = file_.provenance.find(settings_key);
    if (found == file_.provenance.end()) return {};
    return nlohmann::json::parse(found->second).get<std::vector<std::string>>();
}

io::Deck TrainedModel::deck_at(const VectorX& point) const {
    return deck_of(file_, path_.filename(), overrides(), section_.overrides(point));
}

void TrainedModel::require_job(const io::SnapshotStore& store) const {
    const auto job = file_.provenance.find(job_key);
    if (job != file_.provenance.end() && job->second == text_hash(store.job())) return;
    throw InputError("{}: was not made of the snapshots in {}; run couture rom train again",
                     path_.string(), store.folder().string());
}

VectorX TrainedModel::point_of(const std::vector<std::string>& settings,
                               const std::string& option) const {
    const rom::ParameterSpace& space = model().parameters();
    VectorX point = model().parts().reference_point;
    for (const std::string& setting : settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos) {
            throw InputError("{} {}: must read NAME=VALUE", option, setting);
        }
        const int i = space.index_of(setting.substr(0, equals));
        point[i] = read_value(space.parameters()[i], setting.substr(equals + 1), option);
    }
    return point;
}

void TrainedModel::check_inside(const VectorX& point, bool is_forced,
                                const std::string& way_out) const {
    const rom::ParameterSpace& space = model().parameters();
    constexpr double most_outside = 0.2;
    constexpr double rounding = 1e-12;
    for (int i = 0; i < space.size(); ++i) {
        const rom::Parameter& one = space.parameters()[i];
        if (one.is_periodic) continue;
        const double outside = std::max(one.lower - point[i], point[i] - one.upper);
        if (outside <= rounding * (one.upper - one.lower)) continue;
        const double part = outside / (one.upper - one.lower);
        const std::string text = fmt::format(
            "{} = {:.6g} lies outside of [{}, {}], where the model learned, by {:.0f} % "
            "of that range",
            one.name, point[i], one.lower, one.upper, 100.0 * part);
        if (part > most_outside && !is_forced) {
            throw InputError("{}; beyond 20 % {}", text, way_out);
        }
        log::warn(text);
    }
}

rom::GalerkinSolution solve_projected(const rom::ReducedModel& model,
                                      const rom::Evaluation& evaluation, const io::Deck& deck) {
    const std::optional<int>& n_gauss_points = deck.discretization.n_gauss_points;
    if (!deck.is_hyperelastic()) {
        return rom::solve_galerkin(model, evaluation, deck.problem, "", n_gauss_points);
    }
    return rom::galerkin_newton_step(model, evaluation, deck.problem,
                                     {.end = deck.stepping.end,
                                      .n_gauss_points = n_gauss_points,
                                      .volumetric = deck.stepping.volumetric});
}

}  // namespace couture::drivers
