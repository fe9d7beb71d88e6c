#include "drivers/ranks_bench.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

constexpr const char* deck_text = R"(title = "pipe tee on several ranks"
[geometry]
part = "pipe_tee"
[geometry.parameters]
inner_radius = 70
outer_radius = 100
run_half_length = 250
branch_length = 250
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[[fixed]]
on = ["run_end_low", "run_end_high"]
directions = ["x"]
[[fixed]]
on = "branch_end"
directions = ["z"]
[[fixed]]
on = "mid_plane"
directions = ["y"]
[[pressure]]
on = "inner"
value = "10 MPa"
[output]
vtu = false
)";

/// A folder of its own, removed at the end.
class WorkFolder {
  public:
    WorkFolder() : path_(fs::temp_directory_path() / fmt::format("couture_ranks_{}", ::getpid())) {
        fs::create_directories(path_);
    }
    ~WorkFolder() {
        std::error_code code;
        fs::remove_all(path_, code);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

double most(const nlohmann::json& ranks, const char* key) {
    double result = 0.0;
    for (const double value : ranks.at(key)) {
        result = std::max(result, value);
    }
    return result;
}

RankRow measure(const fs::path& folder, const RankRow& asked) {
    log::info(fmt::format("{} scaling: {}, p{} n{}, {} ranks", asked.task, asked.solver,
                          asked.degree, asked.n_elements, asked.n_ranks));
    // MPI that was started in this process (petsc) leaves traces that a new mpirun stumbles over;
    // roots of containers are refused by Open MPI unless told so.
    const std::string command = fmt::format(
        "cd '{0}' && "
        "for v in $(env | sed -n 's/^\\(OMPI_[^=]*\\|PMIX_[^=]*\\|ORTE_[^=]*\\)=.*/\\1/p'); "
        "do unset $v; done; export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 && "
        "mpirun --oversubscribe -n {1} '{2}' solve tee.toml --quiet --out out "
        "--set solver.linear={3} --set solver.tolerance=1e-8 --set discretization.degree={4} "
        "--set discretization.elements={5} >log 2>&1",
        folder.string(), asked.n_ranks, fs::read_symlink("/proc/self/exe").string(), asked.solver,
        asked.degree, asked.n_elements);
    if (std::system(command.c_str()) != 0) {
        throw SolverError("the run of {} ranks failed: {}", asked.n_ranks,
                          io::read_text(folder / "log"));
    }
    const auto json = nlohmann::json::parse(io::read_text(folder / "out" / "tee.json"));
    RankRow row = asked;
    row.n_unknowns = json.at("unknowns");
    row.iterations = json.at("solver").at("iterations");
    for (const auto& phase : json.at("phases")) {
        const std::string name = phase.at("name");
        double* seconds = name == "assembly"        ? &row.assembly_seconds
                          : name == "factorization" ? &row.setup_seconds
                          : name == "solution"      ? &row.solve_seconds
                                                    : nullptr;
        if (seconds != nullptr) {
            *seconds = phase.at("seconds");
        }
    }
    row.unknowns_of_rank = row.n_unknowns;
    row.peak_memory = json.at("peak_memory");
    if (json.contains("ranks")) {
        const auto& ranks = json.at("ranks");
        row.unknowns_of_rank = most(ranks, "unknowns");
        row.neighbours = most(ranks, "neighbours");
        row.bytes_sent = most(ranks, "bytes_sent");
        row.peak_memory = most(ranks, "peak_memory");
    }
    return row;
}

}  // namespace

std::vector<RankRow> measure_ranks(bool quick) {
    if (std::system("command -v mpirun >/dev/null 2>&1") != 0) {
        log::info("ranks: there is no mpirun, left out");
        return {};
    }
    const WorkFolder folder;
    io::write_text(folder.path() / "tee.toml", deck_text);
    struct Size {
        int n_ranks;
        int n_elements;
    };
    // 12 (n + 2)^3 functions, about: 2 to 3 thousand of them (quick), 11 thousand for each rank.
    const std::vector<Size> weak = quick ? std::vector<Size>{{1, 4}, {2, 5}}
                                         : std::vector<Size>{{1, 8}, {2, 10}, {4, 13}, {8, 17}};
    const std::vector<Size> strong = quick ? std::vector<Size>{{1, 5}, {2, 5}}
                                           : std::vector<Size>{{1, 13}, {2, 13}, {4, 13}, {8, 13}};
    std::vector<RankRow> rows;
    for (const char* solver : {"petsc", "matrix_free"}) {
        for (const auto& [task, sizes] : {std::pair("strong", &strong), std::pair("weak", &weak)}) {
            for (const auto& [n_ranks, n_elements] : *sizes) {
                RankRow asked;
                asked.task = task;
                asked.solver = solver;
                asked.degree = 2;
                asked.n_elements = n_elements;
                asked.n_ranks = n_ranks;
                rows.push_back(measure(folder.path(), asked));
            }
        }
    }
    return rows;
}

std::string ranks_text(const std::vector<RankRow>& rows) {
    std::string text =
        "\nRanks of mpirun: pipe tee to 1e-8; of the rank that has most: unknowns, neighbours, "
        "sent "
        "in one product, memory\n"
        "  task    solver       p   n  ranks  unknowns  assembly s  set-up s   solve s  iterations "
        " "
        "of rank  nbrs  sent kB  memory MB\n";
    for (const RankRow& row : rows) {
        text += fmt::format(
            "  {:6}  {:11}  {}  {:2}  {:5}  {:8}  {:10.2f}  {:8.2f}  {:8.2f}  {:10}  {:7.0f}  "
            "{:4.0f}  {:7.1f}  {:9.0f}\n",
            row.task, row.solver, row.degree, row.n_elements, row.n_ranks, row.n_unknowns,
            row.assembly_seconds, row.setup_seconds, row.solve_seconds, row.iterations,
            row.unknowns_of_rank, row.neighbours, 1e-3 * row.bytes_sent, 1e-6 * row.peak_memory);
    }
    return text;
}

}  // namespace couture::drivers
