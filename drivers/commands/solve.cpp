#include "drivers/commands/commands.h"
#include "drivers/deck_check.h"
#include "drivers/distributed_run.h"
#include "drivers/job_geometry.h"
#include "drivers/job_summary.h"
#include "drivers/linear_run.h"
#include "drivers/stepped_run.h"
#include "iga/core/error.h"
#include "iga/distributed/communicator.h"
#include "io/atomic_file.h"
#include "io/picture.h"

namespace couture::drivers {

int run_solve(const SolveOptions& options, const CommonOptions& common) {
    if (iga::is_distributed_run()) {
        return run_distributed(options, common);
    }
    const Timer timer;
    io::Deck deck = io::read_deck(options.deck, options.overrides);
    deck.output.linear = deck.output.linear || options.linear;
    deck.output.png = deck.output.png || options.png;
    if (deck.output.png) {
        if (const auto missing = io::missing_for_pictures()) {
            throw InputError("{}: no picture can be drawn: {}", deck.path.string(), *missing);
        }
    }
    if (options.resume && !deck.is_hyperelastic()) {
        throw InputError(
            "{}: --resume goes on from the states of a hyperelastic run; the materials of this "
            "deck are linear, leave it out",
            deck.path.string());
    }
    const std::string name = deck.path.stem().string();
    const std::filesystem::path folder =
        options.out.empty() ? std::filesystem::path("out") / name : options.out;
    io::require_writable(folder);

    const io::AnyMultiPatch geometry = load_geometry(deck);
    Summary summary = std::visit(
        [&]<int d>(const iga::MultiPatch<d>& multipatch) {
            const GeometryCertificate certificate = check_deck<d>(deck, multipatch);
            const std::vector<Phase> phases = {{"geometry", timer.seconds(), peak_memory()}};
            return deck.is_hyperelastic()
                       ? run_stepped<d>(deck, multipatch, certificate, folder, options.resume,
                                        phases)
                       : run_linear<d>(deck, multipatch, certificate, folder, phases);
        },
        geometry);
    const std::filesystem::path json_file = folder / (name + ".json");
    summary.files.push_back(json_file.string());
    return report_run(summary, json_file, common);
}

}  // namespace couture::drivers
