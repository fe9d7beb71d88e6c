#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/surface_input.h"

namespace couture::drivers {

/// Exit codes of the program.
enum ExitCode : int { done = 0, run_failed = 1, bad_input = 2, interrupted = 130 };

/// What every command takes.
struct CommonOptions {
    /// One JSON object on standard output, everything else on standard error.
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    /// 0: all cores.
    int n_threads = 0;
};

struct SolveOptions {
    std::filesystem::path deck;
    std::vector<std::string> overrides;
    /// Empty: out/<deck name> below the working folder.
    std::filesystem::path out;
    bool linear = false;
    bool png = false;
    /// Goes on from the newest state of a hyperelastic run.
    bool resume = false;
};

struct MeshOptions {
    /// A surface file, the name of a part, a deck, or a spline file (see mesh_splines).
    std::string surface;
    /// The last stage that is made; empty: the deck's, or pants.
    std::string stage;
    /// Dimensions of a part: name=value; of a deck section.key=value.
    std::vector<std::string> overrides;
    /// Caps that are opened: by name ("caps": all), by points "x,y,z", by normals.
    std::vector<std::string> open;
    std::vector<std::string> open_at;
    std::vector<std::string> open_facing;
    /// Terms of the criteria of pants: name=weight.
    std::vector<std::string> cycle_weights;
    std::vector<std::string> merge_weights;
    /// Degrees.
    std::optional<double> feature_angle;
    std::optional<int> most_boundaries;
    /// Of spline elements; 0: by the size of the surface.
    double element_size = 0.0;
    /// Of splines.
    std::optional<int> degree;
    /// A coarse mesh of cuboids to be placed on the surface; may be empty.
    std::filesystem::path layout;
    /// Decisions of another member, to be repeated; may be empty.
    std::filesystem::path like;
    /// Edge length of a part's triangles; 0: its default.
    double edge_length = 0.0;
    /// Points per direction of each patch's hexahedra; nothing: as many as control points.
    std::optional<int> n_points;
    /// As in SurfaceInputOptions.
    bool fix = false;
    bool fill_holes = false;
    std::optional<int> shell;
    /// Empty: out/<name> below the working folder.
    std::filesystem::path out;
    bool png = false;
    /// Of a family: members that an earlier run has done are left as they are.
    bool resume = false;
};

/// What the commands that make snapshots take.
struct RomTrainOptions {
    std::filesystem::path deck;
    std::vector<std::string> overrides;
    /// Empty: out/<deck name> below the working folder.
    std::filesystem::path out;
    /// Processes; 0: as many as cores, each with one thread.
    int n_jobs = 0;
    /// "2/4": of four equal parts of the work the second, and no model; empty: all.
    std::string shard;
    /// Samples that were refused are tried again.
    bool retry = false;
};

struct RomEvalOptions {
    std::filesystem::path model;
    /// NAME=VALUE; parameters that are not named are in the middle of their ranges.
    std::vector<std::string> settings;
    /// Answers also far outside of the training box.
    bool is_forced = false;
    /// Projects the full equations onto the modes, too.
    bool galerkin = false;
    /// Solves in full, too, and compares.
    bool solve = false;
    /// Where fields are written; empty: nowhere, with `png` out/<model name>.
    std::filesystem::path out;
    bool png = false;
};

struct RomExportOptions {
    std::filesystem::path model;
    /// The page that is written; empty: <model name>.html.
    std::filesystem::path html;
    /// Written instead, for rom/embed/couture_rom.h; may be empty.
    std::filesystem::path binary;
};

struct RomOptimizeOptions {
    std::filesystem::path model;
    /// A number in the deck's units or with a unit; empty: without limit.
    std::string stress_limit;
    std::string displacement_limit;
    /// NAME=VALUE of geometric parameters that stay, and of loads and materials.
    std::vector<std::string> fixed;
    int n_starts = 8;
    std::uint64_t seed = 1;
    /// Trusts the model: without a full solution of the optimum.
    bool no_solve = false;
    /// Where fields of the optimum are written; empty: nowhere, with `png` out/<model name>.
    std::filesystem::path out;
    bool png = false;
};

struct RomSensitivityOptions {
    std::filesystem::path model;
    /// NAME=VALUE of parameters that stay; all others vary.
    std::vector<std::string> fixed;
    int n_samples = 1024;
    /// Of the bootstrap.
    std::uint64_t seed = 1;
};

struct RomEnrichOptions {
    RomTrainOptions campaign;
    /// Wanted relative error of the displacement, as the model expects it.
    double tolerance = 0.01;
    /// Geometries that are added at most.
    int max_points = 20;
};

struct RomMergeOptions {
    /// Deck, settings and folder of the store that takes the others' snapshots.
    RomTrainOptions campaign;
    /// Of shards that were made apart.
    std::vector<std::filesystem::path> folders;
};

struct RomValidateOptions {
    /// Its deck, folder and processes are those of the model's training.
    RomTrainOptions campaign;
    int n_points = 20;
    std::uint64_t seed = 1;
    bool galerkin = false;
    bool png = false;
};

struct CompareOptions {
    std::filesystem::path first;
    std::filesystem::path second;
    /// See drivers/comparison.h.
    double tolerance = 1e-9;
};

struct BenchCommandOptions {
    bool quick = false;
    /// Where the numbers are also written as JSON; may be empty.
    std::filesystem::path save;
    /// Numbers of an earlier run to set beside these; may be empty.
    std::filesystem::path compare;
    /// Sections to run; empty: all.
    std::vector<std::string> only;
};

struct VerifyOptions {
    /// Cases whose name contains it; empty: all.
    std::string filter;
    bool with_long = false;
};

struct ShapeOptions {
    /// Files of members, or one folder or deck of a family.
    std::vector<std::string> inputs;
    /// Name of the member where the population stands; empty: the family's, or the nearest to the
    /// mean.
    std::string reference;
    /// Nothing: as many as leave less than a tenth of the population's norm.
    std::optional<int> n_modes;
    bool no_align = false;
    bool scale = false;
    /// Files of shapes that are projected.
    std::vector<std::string> project;
    /// "c1,c2,...", in standard deviations.
    std::vector<std::string> virtual_members;
    /// Empty: out/shape, or out/<family>_shape, below the working folder.
    std::filesystem::path out;
    bool png = false;
};

struct ShapeInflateOptions {
    /// A surface file.
    std::string surface;
    /// "X,Y,Z"; empty: found.
    std::string center;
    std::optional<double> radius;
    std::optional<double> strain_limit;
    std::optional<double> outlet_strain_limit;
    /// "X,Y,Z,RADIUS,LIMIT"
    std::vector<std::string> balls;
    /// "X0,Y0,Z0,X1,Y1,Z1,LIMIT"
    std::vector<std::string> boxes;
    std::optional<double> hole_size;
    std::optional<int> n_divisions;
    /// Empty: out/<name> below the working folder.
    std::filesystem::path out;
    bool png = false;
};

/// Each returns the exit code and throws what is wrong.
int run_solve(const SolveOptions& options, const CommonOptions& common);
int run_check(const SolveOptions& options, const CommonOptions& common);
int run_mesh(const MeshOptions& options, const CommonOptions& common);
/// The options' surface may be a spline file here.
int run_info(const SurfaceInputOptions& options, const CommonOptions& common);
/// @param n_halvings  times that each element of a spline file is halved in each direction
int run_convert(const SurfaceInputOptions& from, const std::filesystem::path& to, int n_halvings,
                const CommonOptions& common);
int run_rom_train(const RomTrainOptions& options, const CommonOptions& common);
int run_rom_eval(const RomEvalOptions& options, const CommonOptions& common);
int run_rom_export(const RomExportOptions& options, const CommonOptions& common);
int run_rom_enrich(const RomEnrichOptions& options, const CommonOptions& common);
int run_rom_merge(const RomMergeOptions& options, const CommonOptions& common);
/// Without a member within the limits, or if it can't be solved in full: ExitCode::run_failed.
int run_rom_optimize(const RomOptimizeOptions& options, const CommonOptions& common);
int run_rom_sensitivity(const RomSensitivityOptions& options, const CommonOptions& common);
int run_rom_validate(const RomValidateOptions& options, const CommonOptions& common);
int run_bench(const BenchCommandOptions& options, const CommonOptions& common);
int run_verify(const VerifyOptions& options, const CommonOptions& common);
int run_shape(const ShapeOptions& options, const CommonOptions& common);
int run_shape_inflate(const ShapeInflateOptions& options, const CommonOptions& common);
int run_compare(const CompareOptions& options, const CommonOptions& common);

}  // namespace couture::drivers
