#include "drivers/linear_run.h"

#include "drivers/job_geometry.h"
#include "drivers/job_summary.h"
#include "drivers/probes.h"
#include "drivers/result_files.h"
#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

/// Phases that take longer are announced when they end.
constexpr double long_phase_seconds = 1.0;

CaseSummary to_summary(const auto& result) {
    return {result.name,      result.energy, result.applied_force, result.foundation_force,
            result.reactions, result.balance};
}

}  // namespace

template <int d>
Summary run_linear(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                   const GeometryCertificate& certificate, const std::filesystem::path& folder,
                   std::vector<Phase> phases) {
    const auto add_phase = [&](const std::string& name, double seconds) {
        phases.push_back({name, seconds, peak_memory()});
        if (seconds > long_phase_seconds) {
            log::info(fmt::format("{} {:.1f} s", name, seconds));
        }
    };
    Timer timer;
    const int n_components = deck.problem.physics == iga::Physics::poisson ? 1 : d;
    const auto locations = locate_probes<d>(deck, geometry);
    const iga::SpacePtr<d> space = make_space<d>(deck, geometry);
    add_phase("discretization", timer.seconds());
    log::info(fmt::format("solving for {} unknowns", n_components * space->n_dofs()));

    iga::LinearStaticOptions options;
    options.solver = deck.solver;
    options.n_gauss_points = deck.discretization.n_gauss_points;
    const iga::LinearStaticResult<d> result =
        iga::solve_linear_static<d>(space, deck.problem, options);
    for (const Phase& phase : result.phases) {
        add_phase(phase.name, phase.seconds);
        phases.back().peak_memory = phase.peak_memory;
    }

    for (const auto& load_case : result.cases) {
        if (load_case.displacement.coefficients.isZero(0.0)) {
            log::warn(fmt::format("case '{}': nothing loads the body, its displacement is zero",
                                  case_title(load_case.name)));
        }
    }

    timer = {};
    Summary summary = describe_job<d>(deck, geometry, certificate);
    summary.volume = iga::body_volume(
        deck.problem, deck.discretization.interpolates_geometry ? space->geometry() : geometry);
    // Locations stay valid: refinement and interpolation keep every patch's parameters.
    summary.probes = evaluate_probes<d>(deck, deck.problem, locations, result, summary.volume);
    add_phase("probes", timer.seconds());
    timer = {};
    for (const auto& file : write_result_files<d>(deck, space, result, certificate, folder)) {
        summary.files.push_back(file.string());
    }
    add_phase("output", timer.seconds());

    summary.n_elements = result.n_elements;
    summary.n_unknowns = result.n_unknowns;
    summary.solver = result.solver;
    for (const auto& load_case : result.cases) {
        summary.cases.push_back(to_summary(load_case));
    }
    summary.phases = std::move(phases);
    summary.warnings = log::warnings();
    return summary;
}

template Summary run_linear<2>(const io::Deck&, const iga::MultiPatch<2>&,
                               const GeometryCertificate&, const std::filesystem::path&,
                               std::vector<Phase>);
template Summary run_linear<3>(const io::Deck&, const iga::MultiPatch<3>&,
                               const GeometryCertificate&, const std::filesystem::path&,
                               std::vector<Phase>);

}  // namespace couture::drivers
