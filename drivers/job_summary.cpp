#include "drivers/job_summary.h"

#include <fmt/core.h>

#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/core/text_hash.h"
#include "io/atomic_file.h"

namespace couture::drivers {

template <int d>
Summary describe_job(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                     const GeometryCertificate& certificate) {
    Summary summary;
    summary.deck = deck.path.string();
    summary.deck_hash = text_hash(deck.text);
    summary.title = deck.title;
    summary.units = deck.units.name();
    summary.signature = iga::signature(geometry);
    summary.certificate = certificate;
    summary.dimension = d;
    summary.n_patches = geometry.n_patches();
    summary.n_interfaces = static_cast<int>(geometry.interfaces.size());
    summary.n_control_points = geometry.n_control_points();
    summary.n_threads = n_threads();
    return summary;
}

template Summary describe_job(const io::Deck&, const iga::MultiPatch<2>&,
                              const GeometryCertificate&);
template Summary describe_job(const io::Deck&, const iga::MultiPatch<3>&,
                              const GeometryCertificate&);

int report_run(const Summary& summary, const std::filesystem::path& json_file,
               const CommonOptions& common) {
    const std::string json = to_json(summary);
    io::write_text(json_file, json);
    if (common.json) {
        fmt::print("{}", json);
        log::info(to_table(summary));
    } else if (!common.quiet) {
        fmt::print("{}", to_table(summary));
    }
    if (!summary.finished()) {
        fmt::print(stderr, "couture: the run did not reach its end: {}; {}\n",
                   summary.stepping->reason,
                   summary.stepping->n_steps() > 0
                       ? "its steps are kept: change [stepping] (a smaller smallest_step, more "
                         "max_iterations, control = \"arc_length\" at a limit point) and go on "
                         "with --resume"
                       : "not one step was found: make the loads smaller or the first step "
                         "shorter");
        return ExitCode::run_failed;
    }
    if (!summary.passed()) {
        fmt::print(stderr, "couture: an expectation is not met\n");
        return ExitCode::run_failed;
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
