#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/deck_check.h"
#include "drivers/job_geometry.h"
#include "drivers/probes.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

/// Foundations may hold a body too: they need the assembly, so such decks are left to the run.
template <int d>
void check_held(const io::Deck& deck, const iga::Space<d>& space) {
    if (!deck.problem.foundations.empty()) {
        return;
    }
    const auto constraints =
        iga::make_constraints<d>(space, deck.problem, deck.problem.load_cases());
    const auto n_unknowns = static_cast<Eigen::Index>(constraints.is_fixed.size());
    const std::vector<std::string> free = iga::free_rigid_motions<d>(
        space, deck.problem, constraints, SparseMatrix(n_unknowns, n_unknowns));
    if (!free.empty()) {
        throw InputError(
            "{}: the body can move freely: {}; hold it by [[fixed]], [[symmetry]] or "
            "[[displacement]]",
            deck.path.filename().string(), fmt::join(free, ", "));
    }
}

template <int d>
int check_on(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
             const CommonOptions& common) {
    check_deck<d>(deck, geometry);
    static_cast<void>(locate_probes<d>(deck, geometry));
    const auto space = make_space<d>(deck, geometry);
    check_held<d>(deck, *space);
    // Expressions are asked for at every place where a run needs them.
    for (const std::string& load_case : deck.problem.load_cases()) {
        static_cast<void>(iga::assemble_loads<d>(*space, deck.problem, load_case,
                                                 deck.discretization.n_gauss_points));
    }
    const int n_components = deck.problem.physics == iga::Physics::poisson ? 1 : d;
    const int n_unknowns = n_components * space->n_dofs();
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "valid"},
                                               {"deck", deck.path.string()},
                                               {"title", deck.title},
                                               {"patches", geometry.n_patches()},
                                               {"unknowns", n_unknowns},
                                               {"warnings", log::warnings()}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("{}: valid; patches {}, unknowns {}\n", deck.path.filename().string(),
                   geometry.n_patches(), n_unknowns);
    }
    return ExitCode::done;
}

}  // namespace

int run_check(const SolveOptions& options, const CommonOptions& common) {
    const io::Deck deck = io::read_deck(options.deck, options.overrides);
    const io::AnyMultiPatch geometry = load_geometry(deck);
    return std::visit(
        [&]<int d>(const iga::MultiPatch<d>& multipatch) {
            return check_on<d>(deck, multipatch, common);
        },
        geometry);
}

}  // namespace couture::drivers
