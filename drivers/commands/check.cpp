#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "drivers/commands/commands.h"
#include "drivers/deck_check.h"
#include "drivers/job_geometry.h"
#include "drivers/own_layout.h"
#include "drivers/prepared_surface.h"
#include "drivers/probes.h"
#include "drivers/remesher.h"
#include "drivers/rom_samples.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "meshing/topology/invariants.h"

namespace couture::drivers {

namespace {

/// What a run does before it assembles: expressions are asked for wherever it needs them.
template <int d>
void check_problem(const io::Deck& deck, const iga::Space<d>& space) {
    // Loads over time are asked for at the end.
    const double end = deck.stepping.end;
    const iga::Problem problem =
        deck.is_hyperelastic() ? iga::at_time(deck.problem, end, end) : deck.problem;
    const std::optional<int> n_points = deck.discretization.n_gauss_points;
    try {
        iga::require_held<d>(space, problem,
                             iga::make_constraints<d>(space, problem, problem.load_cases()),
                             iga::assemble_foundations<d>(space, problem, n_points));
        for (const std::string& load_case : problem.load_cases()) {
            static_cast<void>(iga::assemble_loads<d>(space, problem, load_case, n_points));
        }
    } catch (const InputError& error) {
        const std::string name = deck.path.filename().string();
        const std::string what = error.what();
        throw InputError("{}{}", what.starts_with(name) ? "" : name + ": ", what);
    }
}

/// The design of a reduced model, and that what is factored can be.
template <int d>
std::optional<RomPlan> check_rom(const SolveOptions& options, const io::Deck& deck,
                                 const iga::SpacePtr<d>& space) {
    if (!deck.rom) return {};
    const RomSamples samples(options.deck, options.overrides);
    if constexpr (d == 3) {
        samples.check_factored(space);
        samples.check_periodic(space);
        samples.check_ends();
    } else {
        throw InputError("{}: {}", deck.path.filename().string(), rom_needs_volume);
    }
    return samples.plan();
}

template <int d>
int check_on(const SolveOptions& options, const io::Deck& deck, const iga::MultiPatch<d>& geometry,
             const CommonOptions& common) {
    check_deck<d>(deck, geometry);
    static_cast<void>(locate_probes<d>(deck, geometry));
    const auto space = make_space<d>(deck, geometry);
    static_cast<void>(make_remeshing<d>(deck, space->geometry()));
    // Nothing is solved of shapes alone.
    if (!deck.rom || moves(deck)) check_problem<d>(deck, *space);
    const std::optional<RomPlan> plan = check_rom<d>(options, deck, space);
    const int n_components = deck.problem.physics == iga::Physics::poisson ? 1 : d;
    const int n_unknowns = n_components * space->n_dofs();
    if (common.json) {
        nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                         {"status", "valid"},
                                         {"deck", deck.path.string()},
                                         {"title", deck.title},
                                         {"patches", geometry.n_patches()},
                                         {"unknowns", n_unknowns}};
        if (plan) object["snapshots"] = plan->n_snapshots();
        object["warnings"] = log::warnings();
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("{}: valid; patches {}, unknowns {}\n", deck.path.filename().string(),
                   geometry.n_patches(), n_unknowns);
        if (plan) {
            fmt::print("  {} x {} loads x {} materials = {} snapshots\n", plan->geometries_text(),
                       plan->n_loads(), plan->n_materials(), plan->n_snapshots());
        }
    }
    return ExitCode::done;
}

// The surface is read and opened; its corners, the record, templates, given loops and points, and
// the nodes of a layout are found; no handles and cycles are looked for.
int check_mesh_deck(const io::MeshDeck& deck, const CommonOptions& common) {
    PreparedSurface surface = prepare_surface(deck, {});
    const std::size_t n_triangles = surface.mesh.n_faces();
    static_cast<void>(template_library(deck));
    if (!deck.layout.empty()) {
        const meshing::Features features = find_features(deck, surface);
        static_cast<void>(read_own_layout(deck, surface.mesh, features, surface.landmarks));
    }
    meshing::check_given_curves(surface.mesh, pants_options(deck, surface));
    const std::string name = meshing::surface_name(surface.mesh);
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "valid"},
                                               {"deck", deck.path.string()},
                                               {"title", deck.title},
                                               {"triangles", n_triangles},
                                               {"surface", name},
                                               {"warnings", log::warnings()}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("{}: valid; triangles {}, {}\n", deck.path.filename().string(), n_triangles,
                   name);
    }
    return ExitCode::done;
}

}  // namespace

int run_check(const SolveOptions& options, const CommonOptions& common) {
    if (io::is_mesh_deck(options.deck)) {
        return check_mesh_deck(io::read_mesh_deck(options.deck, options.overrides), common);
    }
    const io::Deck deck = io::read_deck(options.deck, options.overrides);
    const io::AnyMultiPatch geometry = load_geometry(deck);
    return std::visit(
        [&]<int d>(const iga::MultiPatch<d>& multipatch) {
            return check_on<d>(options, deck, multipatch, common);
        },
        geometry);
}

}  // namespace couture::drivers
