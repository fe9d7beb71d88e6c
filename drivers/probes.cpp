#include "drivers/probes.h"

#include <algorithm>

#include "iga/core/error.h"
#include "iga/post/finite_stress.h"

namespace couture::drivers {

namespace {

/// Relative to the part's size: points of decks are given with few digits.
constexpr double location_tolerance = 1e-6;

std::string place_of(const io::Probe& probe) {
    if (probe.at) {
        return fmt::format(" at ({:g}, {:g}, {:g})", (*probe.at)[0], (*probe.at)[1],
                           (*probe.at)[2]);
    }
    if (probe.patch) {
        return fmt::format(" at patch {} ({:g})", *probe.patch, fmt::join(probe.xi, ", "));
    }
    return probe.on.empty() ? "" : fmt::format(" on '{}'", probe.on);
}

std::string time_of(const io::Probe& probe) {
    return probe.t ? fmt::format(", t = {:g}", *probe.t) : "";
}

int axis_of(const std::string& quantity) { return quantity.back() - 'x'; }

int voigt_index(const std::string& quantity) {
    static const std::vector<std::string> names = {"xx", "yy", "zz", "yz", "xz", "xy"};
    const std::string component = quantity.substr(quantity.size() - 2);
    return static_cast<int>(std::find(names.begin(), names.end(), component) - names.begin());
}

/// @param result  a load case or a step
template <typename Result>
double scalar_of(const io::Probe& probe, const Result& result) {
    if (probe.quantity == "energy") {
        return result.energy;
    }
    if (probe.quantity.starts_with("applied_force_")) {
        return result.applied_force[axis_of(probe.quantity)];
    }
    const auto reaction = result.reactions.find(probe.on);
    return reaction == result.reactions.end() ? 0.0 : reaction->second[axis_of(probe.quantity)];
}

double displacement_quantity(const std::string& quantity, const VectorX& u) {
    if (quantity == "displacement_magnitude") {
        return u.norm();
    }
    const int axis = quantity == "potential" ? 0 : axis_of(quantity);
    return axis < u.size() ? u[axis] : 0.0;
}

double state_quantity(const std::string& quantity, const iga::StressState& state) {
    if (quantity == "von_mises") {
        return iga::von_mises(state.stress);
    }
    if (quantity.starts_with("principal_")) {
        return iga::principal_stresses(state.stress)[quantity.back() - '1'];
    }
    if (quantity.starts_with("flux_")) {
        return state.stress[axis_of(quantity)];
    }
    const int component = voigt_index(quantity);
    return quantity.starts_with("strain") ? state.strain[component] : state.stress[component];
}

}  // namespace

template <int d>
std::vector<std::optional<iga::Location<d>>> locate_probes(const io::Deck& deck,
                                                           const iga::MultiPatch<d>& geometry) {
    std::vector<std::optional<iga::Location<d>>> locations(deck.probes.size());
    std::optional<iga::Locator<d>> locator;
    for (std::size_t i = 0; i < deck.probes.size(); ++i) {
        const io::Probe& probe = deck.probes[i];
        if (probe.patch) {
            iga::Location<d> location{*probe.patch, {}};
            for (int k = 0; k < d; ++k) {
                location.xi[k] = probe.xi[static_cast<std::size_t>(k)];
                const auto& knots =
                    geometry.patches[static_cast<std::size_t>(*probe.patch)].knots(k);
                if (location.xi[k] < knots.front() || location.xi[k] > knots.back()) {
                    throw InputError("{}",
                                     io::located_in(deck, probe.source, "xi",
                                                    fmt::format("xi_{} = {} lies outside "
                                                                "[{}, {}] of patch {}",
                                                                k, location.xi[k], knots.front(),
                                                                knots.back(), *probe.patch)));
                }
            }
            locations[i] = location;
        } else if (probe.at) {
            if (!locator) {
                locator.emplace(geometry);
            }
            const auto [location, distance] = locator->nearest(*probe.at);
            if (distance > location_tolerance * geometry.size()) {
                const VectorX nearest =
                    geometry.patches[static_cast<std::size_t>(location.patch)].point(location.xi);
                throw InputError(
                    "{}", io::located_in(
                              deck, probe.source, "at",
                              fmt::format("the point is {:.3g} away from the body; the "
                                          "nearest point is ({:.6g}) in patch {}",
                                          distance, fmt::join(nearest, ", "), location.patch)));
            }
            locations[i] = location;
        }
    }
    return locations;
}

template <int d>
double quantity_at(const iga::Problem& problem, const iga::CaseResult<d>& result,
                   const std::string& quantity, const iga::Location<d>& location) {
    if (quantity == "potential" || quantity.starts_with("displacement")) {
        return displacement_quantity(quantity,
                                     result.displacement.value(location.patch, location.xi));
    }
    return state_quantity(quantity, iga::stress_at<d>(problem, result.displacement, result.name,
                                                      location.patch, location.xi));
}

template <int d>
std::vector<ProbeResult> evaluate_probes(
    const io::Deck& deck, const iga::Problem& problem,
    const std::vector<std::optional<iga::Location<d>>>& locations,
    const iga::LinearStaticResult<d>& result, double volume) {
    std::vector<ProbeResult> values;
    for (std::size_t i = 0; i < deck.probes.size(); ++i) {
        const io::Probe& probe = deck.probes[i];
        const auto load_case =
            std::find_if(result.cases.begin(), result.cases.end(),
                         [&](const auto& entry) { return entry.name == probe.load_case; });
        if (load_case == result.cases.end() && probe.quantity != "volume") {
            throw InputError("{}: there is no result for load case '{}'", probe.source,
                             probe.load_case);
        }
        double value = 0.0;
        if (probe.quantity == "volume") {
            value = volume;
        } else if (locations[i]) {
            value = quantity_at<d>(problem, *load_case, probe.quantity, *locations[i]);
        } else {
            value = scalar_of(probe, *load_case);
        }
        values.push_back(probe_result(probe, value));
    }
    return values;
}

ProbeResult probe_result(const io::Probe& probe, double value) {
    ProbeResult result;
    result.name =
        probe.name.empty() ? probe.quantity + place_of(probe) + time_of(probe) : probe.name;
    result.quantity = probe.quantity;
    result.load_case = probe.load_case;
    result.t = probe.t;
    result.value = value;
    result.expected = probe.expect;
    result.allowed_error = probe.allowed_error();
    result.passed = probe.passes(value);
    return result;
}

template <int d>
double quantity_of(const io::Deck& deck, const iga::Problem& problem,
                   const iga::AcceptedStep<d>& step, const io::Probe& probe,
                   const std::optional<iga::Location<d>>& location) {
    if (location && probe.quantity.starts_with("displacement")) {
        const iga::Field<d> u{step.state.reference->space, step.state.displacement};
        return displacement_quantity(probe.quantity, u.value(location->patch, location->xi));
    }
    if (!location && probe.quantity != "volume") {
        return scalar_of(probe, step);
    }
    const iga::FiniteStresses<d> stresses(problem, step.state, deck.stepping.n_gauss_points,
                                          deck.stepping.volumetric);
    return location
               ? state_quantity(probe.quantity, stresses.at(location->patch, location->xi).state)
               : stresses.volume();
}

template std::vector<std::optional<iga::Location<2>>> locate_probes<2>(const io::Deck&,
                                                                       const iga::MultiPatch<2>&);
template std::vector<std::optional<iga::Location<3>>> locate_probes<3>(const io::Deck&,
                                                                       const iga::MultiPatch<3>&);
template std::vector<ProbeResult> evaluate_probes<2>(
    const io::Deck&, const iga::Problem&, const std::vector<std::optional<iga::Location<2>>>&,
    const iga::LinearStaticResult<2>&, double);
template std::vector<ProbeResult> evaluate_probes<3>(
    const io::Deck&, const iga::Problem&, const std::vector<std::optional<iga::Location<3>>>&,
    const iga::LinearStaticResult<3>&, double);
template double quantity_at<2>(const iga::Problem&, const iga::CaseResult<2>&, const std::string&,
                               const iga::Location<2>&);
template double quantity_at<3>(const iga::Problem&, const iga::CaseResult<3>&, const std::string&,
                               const iga::Location<3>&);
template double quantity_of<2>(const io::Deck&, const iga::Problem&, const iga::AcceptedStep<2>&,
                               const io::Probe&, const std::optional<iga::Location<2>>&);
template double quantity_of<3>(const io::Deck&, const iga::Problem&, const iga::AcceptedStep<3>&,
                               const io::Probe&, const std::optional<iga::Location<3>>&);

}  // namespace couture::drivers
