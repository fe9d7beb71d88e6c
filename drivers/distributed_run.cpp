#include "drivers/distributed_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "drivers/distributed_steps.h"
#include "drivers/job_geometry.h"
#include "drivers/job_summary.h"
#include "drivers/probes.h"
#include "drivers/result_files.h"
#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/distributed/distributed_static.h"
#include "iga/post/stress.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

void require_distributable(const io::Deck& deck) {
    const auto refuse = [&](const char* what) {
        throw InputError("{}: {} in one process only; start it without mpirun, or leave it out",
                         deck.path.string(), what);
    };
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
        : ranks_(ranks), deck_(deck) {
        Timer timer;
        GeometryCertificate certificate;
        std::vector<std::optional<iga::Location<d>>> locations;
        ranks.together([&] {
            certificate = check_deck<d>(deck, geometry);
            locations = locate_probes<d>(deck, geometry);
            summary_ = describe_job<d>(deck, geometry, certificate);
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
        job_.reset(new DistributedJob<d>{ranks, deck, folder, certificate, std::move(locations),
                                         *geometry_, *space_,
                                         iga::on_pieces(deck.problem, space_->pieces.boxes)});
        add_phase("distribution", timer);
    }

    [[nodiscard]] Summary solve(bool resume) {
        describe_size();
        log::info(
            fmt::format("solving for {} unknowns on {} ranks", summary_.n_unknowns, ranks_.size()));
        if (deck_.is_hyperelastic()) {
            Timer timer;
            follow_on_ranks<d>(*job_, resume, summary_);
            add_phase("load steps", timer);
        } else {
            solve_linear();
        }
        summary_.distribution->peak_memory = ranks_.gather(static_cast<double>(peak_memory()));
        summary_.warnings = log::warnings();
        return std::move(summary_);
    }

  private:
    void add_phase(const std::string& name, Timer& timer) {
        summary_.phases.push_back({name, ranks_.max(timer.seconds()), peak_memory()});
        timer = {};
    }

    void describe_size() {
        double n_elements = 0.0;
        for (const iga::ElementBox<d>& box : space_->pieces.boxes) {
            n_elements += static_cast<double>(box.n_elements());
        }
        const iga::SharedNumbers& numbers = space_->numbers;
        const int nc = deck_.problem.physics == iga::Physics::poisson ? 1 : d;
        summary_.n_elements = static_cast<int>(ranks_.sum(n_elements));
        summary_.n_unknowns = nc * numbers.n_global();
        summary_.distribution = {
            ranks_.gather(n_elements),
            ranks_.gather(nc * numbers.n_owned()),
            ranks_.gather(numbers.n_neighbours()),
            ranks_.gather(nc * sizeof(double) * static_cast<double>(numbers.n_sent())),
            {}};
    }

    void solve_linear() {
        iga::LinearStaticOptions options;
        options.solver = deck_.solver;
        options.n_gauss_points = deck_.discretization.n_gauss_points;
        const iga::LinearStaticResult<d> result =
            iga::solve_linear_static<d>(ranks_, *geometry_, *space_, deck_.problem, options);
        summary_.phases.insert(summary_.phases.end(), result.phases.begin(), result.phases.end());
        summary_.solver = result.solver;
        for (const auto& one : result.cases) {
            summary_.cases.push_back({one.name, one.energy, one.applied_force, one.foundation_force,
                                      one.reactions, one.balance});
        }
        Timer timer;
        probe(result);
        add_phase("probes", timer);
        for (const auto& one : result.cases) {
            if (deck_.output.vtu) {
                write(one);
            }
        }
        add_phase("output", timer);
    }

    /// A value at a place is that of the rank whose elements contain it.
    void probe(const iga::LinearStaticResult<d>& result) {
        MatrixX values = MatrixX::Zero(static_cast<Eigen::Index>(deck_.probes.size()), 1);
        std::vector<std::optional<iga::Location<d>>> here(deck_.probes.size());
        std::vector<ProbeResult> shares;
        ranks_.together([&] {
            // Where a place is not here, the value is one of those without a place: not used.
            for (std::size_t i = 0; i < here.size(); ++i) {
                here[i] = job_->locations[i] ? job_->here(*job_->locations[i]) : std::nullopt;
            }
            shares = evaluate_probes<d>(deck_, job_->on_pieces, here, result, summary_.volume);
        });
        for (std::size_t i = 0; i < here.size(); ++i) {
            const bool is_shared = job_->locations[i].has_value();
            values(static_cast<Eigen::Index>(i), 0) = is_shared && !here[i] ? 0.0 : shares[i].value;
        }
        const MatrixX sums = ranks_.sum(values);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            summary_.probes.push_back(
                probe_result(deck_.probes[i], job_->locations[i] ? sums(row, 0) : values(row, 0)));
        }
    }

    void write(const iga::CaseResult<d>& one) {
        MatrixX integrals;
        ranks_.together([&] {
            integrals = iga::stress_integrals<d>(job_->on_pieces, one.displacement, one.name);
        });
        const MatrixX stress = iga::project<d>(ranks_, *space_, integrals);
        const std::string stem =
            deck_.path.stem().string() + (one.name.empty() ? "" : "_" + one.name);
        summary_.files.push_back(
            job_->write_pieces(stem, field_arrays<d>(deck_.problem, one, stress)).string());
    }

    const iga::Communicator& ranks_;
    const io::Deck& deck_;
    std::optional<iga::RefinedGeometry<d>> geometry_;
    std::optional<iga::DistributedSpace<d>> space_;
    std::unique_ptr<DistributedJob<d>> job_;
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
        if (options.resume && !deck.is_hyperelastic()) {
            throw InputError(
                "{}: --resume goes on from the states of a hyperelastic run; the materials of this "
                "deck are linear, leave it out",
                deck.path.string());
        }
        folder = options.out.empty() ? fs::path("out") / deck.path.stem() : options.out;
        io::require_writable(folder);
        geometry = load_geometry(deck);
    });
    Summary summary = std::visit(
        [&]<int d>(iga::MultiPatch<d>& multipatch) {
            DistributedRun<d> run(ranks, deck, multipatch, folder);
            multipatch = {};
            return run.solve(options.resume);
        },
        geometry);
    const fs::path json_file = folder / (deck.path.stem().string() + ".json");
    summary.files.push_back(json_file.string());
    ranks.together([&] {
        if (ranks.rank() != 0) {
            return;
        }
        static_cast<void>(report_run(summary, json_file, common));
    });
    return summary.finished() && summary.passed() ? ExitCode::done : ExitCode::run_failed;
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
