#include "drivers/distributed_run.h"

#include <fmt/core.h>

#include <algorithm>

#include "drivers/job_geometry.h"
#include "drivers/job_summary.h"
#include "drivers/probes.h"
#include "drivers/result_files.h"
#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/distributed/distributed_static.h"
#include "io/atomic_file.h"
#include "io/pvtu_writer.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

void require_distributable(const io::Deck& deck) {
    const auto refuse = [&](const char* what) {
        throw InputError("{}: {} in one process only; start it without mpirun, or leave it out",
                         deck.path.string(), what);
    };
    if (deck.is_hyperelastic()) {
        refuse("hyperelastic bodies are solved");
    }
    if (deck.output.png) {
        refuse("pictures are drawn");
    }
    if (deck.output.gauss_points) {
        refuse("Gauss points are written");
    }
    if (deck.discretization.interpolates_geometry) {
        refuse("a geometry is interpolated");
    }
}

/// One deck on all ranks.
template <int d>
class DistributedRun {
  public:
    DistributedRun(const iga::Communicator& ranks, const io::Deck& deck,
                   const iga::MultiPatch<d>& geometry, const fs::path& folder)
        : ranks_(ranks), deck_(deck), folder_(folder) {
        Timer timer;
        ranks.together([&] {
            certificate_ = check_deck<d>(deck, geometry);
            locations_ = locate_probes<d>(deck, geometry);
            summary_ = describe_job<d>(deck, geometry, certificate_);
            summary_.volume = iga::body_volume(deck.problem, geometry);
            const io::Discretization& discretization = deck.discretization;
            try {
                geometry_.emplace(geometry, discretization.degree,
                                  elements_per_direction<d>(discretization));
            } catch (const InputError& error) {
                throw InputError("{}: [discretization]: {}", discretization.source, error.what());
            }
        });
        add_phase("geometry", timer);
        space_.emplace(iga::distribute<d>(*geometry_, ranks));
        add_phase("distribution", timer);
    }

    [[nodiscard]] Summary solve() {
        iga::LinearStaticOptions options;
        options.solver = deck_.solver;
        options.n_gauss_points = deck_.discretization.n_gauss_points;
        const iga::LinearStaticResult<d> result =
            iga::solve_linear_static<d>(ranks_, *geometry_, *space_, deck_.problem, options);
        summary_.phases.insert(summary_.phases.end(), result.phases.begin(), result.phases.end());
        summary_.n_elements = result.n_elements;
        summary_.n_unknowns = result.n_unknowns;
        summary_.solver = result.solver;
        for (const auto& one : result.cases) {
            summary_.cases.push_back({one.name, one.energy, one.applied_force, one.foundation_force,
                                      one.reactions, one.balance});
        }
        Timer timer;
        on_pieces_ = iga::on_pieces(deck_.problem, space_->pieces.boxes);
        probe(result);
        add_phase("probes", timer);
        if (deck_.output.vtu) {
            for (const auto& one : result.cases) {
                write(one);
            }
        }
        add_phase("output", timer);
        describe_ranks();
        summary_.warnings = log::warnings();
        return std::move(summary_);
    }

  private:
    void add_phase(const std::string& name, Timer& timer) {
        summary_.phases.push_back({name, ranks_.max(timer.seconds()), peak_memory()});
        timer = {};
    }

    /// A value at a place is that of the rank whose elements contain it.
    void probe(const iga::LinearStaticResult<d>& result) {
        MatrixX values = MatrixX::Zero(static_cast<Eigen::Index>(deck_.probes.size()), 1);
        std::vector<std::optional<iga::Location<d>>> elsewhere = locations_;
        ranks_.together([&] {
            for (std::size_t i = 0; i < deck_.probes.size(); ++i) {
                if (!locations_[i]) {
                    continue;
                }
                const auto& [patch, xi] = *locations_[i];
                const std::array<int, d> element = geometry_->find_element(patch, xi);
                const auto& boxes = space_->pieces.boxes;
                for (std::size_t b = 0; b < boxes.size(); ++b) {
                    if (boxes[b].patch == patch && boxes[b].contains(element)) {
                        values(static_cast<Eigen::Index>(i), 0) =
                            quantity_at<d>(on_pieces_, case_of(result, deck_.probes[i]),
                                           deck_.probes[i].quantity, {static_cast<int>(b), xi});
                    }
                }
                elsewhere[i].reset();
            }
        });
        values = ranks_.sum(values);
        summary_.probes = evaluate_probes<d>(deck_, elsewhere, result, summary_.volume);
        for (std::size_t i = 0; i < deck_.probes.size(); ++i) {
            if (locations_[i]) {
                summary_.probes[i] =
                    probe_result(deck_.probes[i], values(static_cast<Eigen::Index>(i), 0));
            }
        }
    }

    [[nodiscard]] static const iga::CaseResult<d>& case_of(const iga::LinearStaticResult<d>& result,
                                                           const io::Probe& probe) {
        const auto found =
            std::find_if(result.cases.begin(), result.cases.end(),
                         [&](const auto& one) { return one.name == probe.load_case; });
        if (found == result.cases.end()) {
            throw InputError("{}: there is no result for load case '{}'", probe.source,
                             probe.load_case);
        }
        return *found;
    }

    void write(const iga::CaseResult<d>& one) {
        const MatrixX stress =
            iga::project_stress<d>(ranks_, *space_, on_pieces_, one.displacement, one.name);
        const std::string stem =
            deck_.path.stem().string() + (one.name.empty() ? "" : "_" + one.name);
        const auto piece_name = [&](int rank) {
            return fmt::format("{}_pieces/{}_{:04}.vtu", stem, stem, rank);
        };
        const auto arrays = field_arrays<d>(deck_.problem, one, stress);
        io::VtuOptions options;
        options.linear = deck_.output.linear;
        options.provenance = provenance<d>(deck_, geometry_->geometry(), certificate_);
        const auto& patches = geometry_->geometry().patches;
        options.always_weights =
            std::any_of(patches.begin(), patches.end(),
                        [](const iga::Patch<d>& patch) { return patch.is_rational(); });
        for (const iga::ElementBox<d>& box : space_->pieces.boxes) {
            options.patch_numbers.push_back(box.patch);
        }
        ranks_.together([&] {
            io::write_vtu<d>(folder_ / piece_name(ranks_.rank()), *space_->pieces.space, arrays, {},
                             options);
            if (ranks_.rank() == 0) {
                std::vector<std::string> pieces;
                for (int r = 0; r < ranks_.size(); ++r) {
                    pieces.push_back(piece_name(r));
                }
                io::write_pvtu(folder_ / (stem + ".pvtu"), pieces, arrays, options);
            }
        });
        summary_.files.push_back((folder_ / (stem + ".pvtu")).string());
    }

    void describe_ranks() {
        double n_elements = 0.0;
        for (const iga::ElementBox<d>& box : space_->pieces.boxes) {
            n_elements += static_cast<double>(box.n_elements());
        }
        const iga::SharedNumbers& numbers = space_->numbers;
        const double nc = deck_.problem.physics == iga::Physics::poisson ? 1.0 : d;
        summary_.distribution = {
            ranks_.gather(n_elements), ranks_.gather(nc * numbers.n_owned()),
            ranks_.gather(numbers.n_neighbours()),
            ranks_.gather(nc * sizeof(double) * static_cast<double>(numbers.n_sent())),
            ranks_.gather(static_cast<double>(peak_memory()))};
    }

    const iga::Communicator& ranks_;
    const io::Deck& deck_;
    const fs::path& folder_;
    GeometryCertificate certificate_;
    std::vector<std::optional<iga::Location<d>>> locations_;
    std::optional<iga::RefinedGeometry<d>> geometry_;
    std::optional<iga::DistributedSpace<d>> space_;
    iga::Problem on_pieces_;
    Summary summary_;
};

int solve_on(const iga::Communicator& ranks, const SolveOptions& options,
             const CommonOptions& common) {
    const Timer timer;
    io::Deck deck;
    io::AnyMultiPatch geometry;
    fs::path folder;
    ranks.together([&] {
        deck = io::read_deck(options.deck, options.overrides);
        deck.output.linear = deck.output.linear || options.linear;
        deck.output.png = deck.output.png || options.png;
        require_distributable(deck);
        folder = options.out.empty() ? fs::path("out") / deck.path.stem() : options.out;
        io::require_writable(folder);
        geometry = load_geometry(deck);
    });
    Summary summary = std::visit(
        [&]<int d>(iga::MultiPatch<d>& multipatch) {
            DistributedRun<d> run(ranks, deck, multipatch, folder);
            multipatch = {};
            return run.solve();
        },
        geometry);
    const fs::path json_file = folder / (deck.path.stem().string() + ".json");
    summary.files.push_back(json_file.string());
    ranks.together([&] {
        if (ranks.rank() != 0) {
            return;
        }
        const std::string json = to_json(summary);
        io::write_text(json_file, json);
        if (common.json) {
            fmt::print("{}", json);
            log::info(to_table(summary));
        } else if (!common.quiet) {
            fmt::print("{}", to_table(summary));
        }
        if (!summary.passed()) {
            fmt::print(stderr, "couture: an expectation is not met\n");
        }
    });
    return summary.passed() ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace

int run_distributed(const SolveOptions& options, const CommonOptions& common) {
    const iga::Communicator ranks;
    if (ranks.rank() != 0) {
        log::set_level(log::Level::quiet);
    }
    const int n_here = ranks.size_here();
    if (common.n_threads == 0) {
        set_n_threads(std::max(1, n_threads() / n_here));
    }
    try {
        return solve_on(ranks, options, common);
    } catch (const std::exception& error) {
        ranks.end_unless_all_failed(error.what(), ExitCode::run_failed);
        if (ranks.rank() == 0) {
            throw;
        }
        return ExitCode::run_failed;
    }
}

}  // namespace couture::drivers
