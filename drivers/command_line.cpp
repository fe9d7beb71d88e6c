#include "drivers/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "drivers/bench.h"
#include "drivers/summary.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/spline/knot_vector.h"
#include "io/did_you_mean.h"

namespace couture::drivers {

namespace {

constexpr int max_threads = 1024;
constexpr int most_hex_points = 1000;
constexpr int most_halvings = 6;

CLI::App* add_command(CLI::App& app, Command& command, const std::string& name,
                      const std::string& what, std::function<int()> run) {
    CLI::App* sub = app.add_subcommand(name, what);
    CommonOptions& common = command.common;
    sub->add_flag("--json", common.json,
                  "print one JSON object on standard output, all else on standard error");
    sub->add_flag("--quiet", common.quiet, "print warnings and errors only");
    sub->add_flag("--verbose", common.verbose, "print details");
    sub->add_option("--threads", common.n_threads, "number of threads (default: all cores)")
        ->check(CLI::Range(1, max_threads));
    sub->callback([&command, run, name] {
        command.run = run;
        command.name = name;
    });
    return sub;
}

void add_deck_options(CLI::App* sub, SolveOptions& options) {
    sub->add_option("deck", options.deck, "the deck (TOML)")->required();
    sub->add_option("--set", options.overrides,
                    "change a value of the deck: section.key=value (lists by index: "
                    "pressure.0.value=5)")
        ->allow_extra_args(false);
}

/// What is told about a surface besides its name.
template <typename Options>
void add_surface_options(CLI::App* sub, Options& options) {
    sub->add_option("--set", options.overrides,
                    "a dimension of the part: NAME=VALUE (of a deck section.key=value)")
        ->allow_extra_args(false);
    sub->add_option("--edge-length", options.edge_length, "of the part's triangles");
    sub->add_flag(
        "--fix", options.fix,
        "also weld points up to 1e-9 of the diagonal apart, remove triangles flatter than "
        "1e-9, part what touches at a vertex");
    sub->add_flag("--fill-holes", options.fill_holes, "close the surface at every boundary loop");
    sub->add_option(
        "--shell", options.shell,
        "take one shell of several with its cavities, counted from 0; the wall of a cavity: what "
        "lies inside it");
}

void add_shape_options(CLI::App* sub, ShapeOptions& options) {
    sub->add_option("members", options.inputs,
                    "meshes with equal polygons (.vtp, .obj, .off, .ply), spline volumes of one "
                    "signature, the folder of a family's run, or its deck (results in out/NAME)");
    sub->add_option("--modes", options.n_modes,
                    "modes that are written and projected onto (default: as many as leave a "
                    "relative error below 0.1)");
    sub->add_option("--reference", options.reference,
                    "the member where all are moved to (default: the family's, or the nearest to "
                    "the mean)");
    sub->add_flag("--no-align", options.no_align, "members stay where they are");
    sub->add_flag("--scale", options.scale, "members are also scaled to one size");
    sub->add_option("--project", options.project, "a shape to be expressed by the modes")
        ->allow_extra_args(false);
    sub->add_option("--virtual", options.virtual_members,
                    "a member to be made: C1,C2,... standard deviations of the first modes")
        ->allow_extra_args(false);
    sub->add_option("--out", options.out, "folder of the results (default: out/shape)");
    sub->add_flag("--png", options.png, "draw members, modes and curves");
}

void add_inflate_options(CLI::App* sub, ShapeInflateOptions& options) {
    sub->add_option("surface", options.surface,
                    "the wall of a cavity with any defects (.stl, .obj, .off, .ply, .vtp)")
        ->required();
    sub->add_option("--center", options.center, "X,Y,Z inside (default: farthest from the wall)");
    sub->add_option(
        "--radius", options.radius,
        "of the sphere at the start (default: nine tenths of the distance to the wall)");
    sub->add_option("--strain-limit", options.strain_limit,
                    "an edge that is longer by this part stops (default: 3)");
    sub->add_option("--outlet-strain-limit", options.outlet_strain_limit,
                    "the same where no wall is ahead (default: as elsewhere)");
    sub->add_option("--ball", options.balls, "X,Y,Z,RADIUS,LIMIT: another strain limit in a ball")
        ->allow_extra_args(false);
    sub->add_option("--box", options.boxes,
                    "X0,Y0,Z0,X1,Y1,Z1,LIMIT: another strain limit in a box")
        ->allow_extra_args(false);
    sub->add_option("--hole-size", options.hole_size,
                    "holes narrower than this are closed (default: as long as most edges)");
    sub->add_option("--divisions", options.n_divisions,
                    "n: the sphere has 6 n^2 quads (default: 16)");
    sub->add_option("--out", options.out, "folder of the results (default: out/<name>)");
    sub->add_flag("--png", options.png, "draw the quads in the cavity");
}

/// A word that is no command gets a message of its own: CLI11's names no alternatives.
std::optional<std::string> unknown_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') {
        return {};
    }
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands({})) {
        names.push_back(sub->get_name());
    }
    if (std::find(names.begin(), names.end(), argv[1]) != names.end()) {
        return {};
    }
    return fmt::format(
        "there is no command '{}' in version {}{} There are {}", argv[1], COUTURE_VERSION,
        io::did_you_mean(argv[1], names).empty() ? "." : io::did_you_mean(argv[1], names),
        io::quoted_list(names));
}

/// Of commands that make snapshots.
void add_campaign_options(CLI::App* sub, RomTrainOptions& options, bool has_shards = true) {
    sub->add_option("deck", options.deck, "the deck (TOML) with its section [rom]")->required();
    sub->add_option("--set", options.overrides, "change a value of the deck: section.key=value")
        ->allow_extra_args(false);
    sub->add_option("--out", options.out, "folder of the results (default: out/<deck name>)");
    sub->add_option("--jobs", options.n_jobs, "processes at once (default: as many as cores)")
        ->check(CLI::Range(1, max_threads));
    if (has_shards) {
        sub->add_option("--shard", options.shard,
                        "I/N: make only the I-th of N equal parts of the snapshots");
    }
    sub->add_flag("--retry", options.retry, "try samples again that were refused before");
}

/// `couture rom ...`
void add_rom_commands(CLI::App& app, Command& command) {
    CLI::App* rom = app.add_subcommand("rom", "reduced models: learn a family of solutions once");
    rom->require_subcommand(1);
    const auto train = std::make_shared<RomTrainOptions>();
    CLI::App* sub =
        add_command(*rom, command, "train", "solve the members of a deck's design, make a model",
                    [&command, train] { return run_rom_train(*train, command.common); });
    add_campaign_options(sub, *train);

    const auto eval = std::make_shared<RomEvalOptions>();
    sub = add_command(*rom, command, "eval", "answer at a point of the parameters",
                      [&command, eval] { return run_rom_eval(*eval, command.common); });
    sub->add_option("model", eval->model, "the model (.rom)")->required();
    sub->add_option("--set", eval->settings,
                    "a parameter: NAME=VALUE (default: the middle of its range)")
        ->allow_extra_args(false);
    sub->add_flag("--galerkin", eval->galerkin,
                  "also project the full equations onto the modes (at finite strain: one step of "
                  "Newton there), and say the residual");
    sub->add_flag("--solve", eval->solve, "also solve in full, and say the error");
    sub->add_flag("--force", eval->is_forced, "answer also far outside of the training box");
    sub->add_option("--out", eval->out, "write the fields (VTU) into this folder");
    sub->add_flag("--png", eval->png, "draw the deformed part");

    const auto exported = std::make_shared<RomExportOptions>();
    sub = add_command(*rom, command, "export",
                      "write a page that answers in a browser, or a file for other programs",
                      [&command, exported] { return run_rom_export(*exported, command.common); });
    sub->add_option("model", exported->model, "the model (.rom)")->required();
    CLI::Option* html =
        sub->add_option("--html", exported->html, "the page (default: <model name>.html)");
    sub->add_option("--binary", exported->binary,
                    "instead of a page the model as rom/embed/couture_rom.h reads it, a header for "
                    "C++ programs of any kind")
        ->excludes(html);

    const auto optimize = std::make_shared<RomOptimizeOptions>();
    sub = add_command(*rom, command, "optimize", "find the lightest member within limits",
                      [&command, optimize] { return run_rom_optimize(*optimize, command.common); });
    sub->add_option("model", optimize->model, "the model (.rom)")->required();
    sub->add_option("--stress-limit", optimize->stress_limit,
                    "of the largest von Mises stress: a number or a text as '120 MPa'");
    sub->add_option("--displacement-limit", optimize->displacement_limit,
                    "of the largest displacement, as '0.2 mm'");
    sub->add_option("--fix", optimize->fixed,
                    "a dimension that stays, a load or a material value: NAME=VALUE (default: "
                    "dimensions are free, all else is in the middle of its range)")
        ->allow_extra_args(false);
    constexpr int most_starts = 10'000;
    sub->add_option("--starts", optimize->n_starts, "searches from different members (default: 8)")
        ->check(CLI::Range(1, most_starts));
    sub->add_option("--seed", optimize->seed, "of the starts (default: 1)");
    sub->add_flag("--no-solve", optimize->no_solve, "do not solve the optimum in full");
    sub->add_option("--out", optimize->out, "write the optimum's fields (VTU) into this folder");
    sub->add_flag("--png", optimize->png, "draw the deformed optimum");

    const auto sensitivity = std::make_shared<RomSensitivityOptions>();
    sub = add_command(
        *rom, command, "sensitivity", "say which parameters results depend on (Sobol indices)",
        [&command, sensitivity] { return run_rom_sensitivity(*sensitivity, command.common); });
    sub->add_option("model", sensitivity->model, "the model (.rom)")->required();
    constexpr int fewest_samples = 16;
    constexpr int most_samples = 10'000'000;
    sub->add_option("--samples", sensitivity->n_samples,
                    "N: the model is evaluated N times per free parameter, and 2 N times more "
                    "(default: 1024)")
        ->check(CLI::Range(fewest_samples, most_samples));
    sub->add_option("--fix", sensitivity->fixed,
                    "a parameter that stays: NAME=VALUE (default: all vary in their ranges)")
        ->allow_extra_args(false);
    sub->add_option("--seed", sensitivity->seed, "of the confidence intervals (default: 1)");

    const auto enrich = std::make_shared<RomEnrichOptions>();
    sub = add_command(*rom, command, "enrich", "add samples where a model expects large errors",
                      [&command, enrich] { return run_rom_enrich(*enrich, command.common); });
    add_campaign_options(sub, enrich->campaign, false);
    sub->add_option("--tolerance", enrich->tolerance,
                    "wanted relative error of displacements (default: 0.01)")
        ->check(CLI::Range(1e-12, 1.0));
    sub->add_option("--max-points", enrich->max_points, "geometries added at most (default: 20)")
        ->check(CLI::Range(1, 100'000));

    const auto merge = std::make_shared<RomMergeOptions>();
    sub = add_command(*rom, command, "merge", "put snapshots together that were made apart",
                      [&command, merge] { return run_rom_merge(*merge, command.common); });
    sub->add_option("deck", merge->campaign.deck, "the deck that all were made by")->required();
    sub->add_option("folders", merge->folders, "folders of shards (--out of couture rom train)")
        ->required();
    sub->add_option("--set", merge->campaign.overrides,
                    "a value of the deck that was changed: section.key=value")
        ->allow_extra_args(false);
    sub->add_option("--out", merge->campaign.out,
                    "folder that takes them over (default: out/<deck name>)");

    const auto validate = std::make_shared<RomValidateOptions>();
    sub = add_command(*rom, command, "validate", "compare a model with full solutions",
                      [&command, validate] { return run_rom_validate(*validate, command.common); });
    add_campaign_options(sub, validate->campaign);
    constexpr int most_points = 100'000;
    sub->add_option("-n,--points", validate->n_points, "points to compare at (default: 20)")
        ->check(CLI::Range(2, most_points));
    sub->add_option("--seed", validate->seed, "of the points (default: 1)");
    sub->add_flag("--galerkin", validate->galerkin, "compare Galerkin solutions, too");
    sub->add_flag("--png", validate->png, "draw plots, and the worst point");
}

void apply(const CommonOptions& common) {
    log::set_level(common.quiet     ? log::Level::warnings
                   : common.verbose ? log::Level::detail
                                    : log::Level::progress);
    if (common.n_threads > 0) {
        set_n_threads(common.n_threads);
    }
}

}  // namespace

std::optional<int> read_command_line(int argc, char** argv, Command& command) {
    // The callbacks outlive this function.
    const auto solve = std::make_shared<SolveOptions>();
    const auto compare = std::make_shared<CompareOptions>();
    const auto from = std::make_shared<SurfaceInputOptions>();
    const auto to = std::make_shared<std::string>();
    const auto n_halvings = std::make_shared<int>(0);
    CLI::App app("Couture: isogeometric analysis of solids");
    app.set_version_flag("--version", "couture " COUTURE_VERSION);
    app.require_subcommand(1);

    CLI::App* sub = add_command(app, command, "solve", "run a deck",
                                [&command, solve] { return run_solve(*solve, command.common); });
    add_deck_options(sub, *solve);
    sub->add_option("--out", solve->out, "folder of the results (default: out/<deck name>)");
    sub->add_flag("--linear", solve->linear,
                  "write linear cells for programs that read no splines");
    sub->add_flag("--png", solve->png, "draw the deformed part");
    sub->add_flag("--resume", solve->resume,
                  "go on from the newest state of a hyperelastic run in the folder of the results");

    sub = add_command(app, command, "check", "validate a deck without running it",
                      [&command, solve] { return run_check(*solve, command.common); });
    add_deck_options(sub, *solve);

    const auto mesh = std::make_shared<MeshOptions>();
    sub =
        add_command(app, command, "mesh", "cut a surface into pants, and on to trivariate splines",
                    [&command, mesh] { return run_mesh(*mesh, command.common); });
    sub->add_option(
           "surface", mesh->surface,
           "a surface file (.stl, .obj, .off, .ply, .vtp), the name of a part (wheel, ...), a "
           "deck (.toml), or a spline file (.xml, .mesh, .txt, .inp, .h5)")
        ->required();
    sub->add_option(
        "--stage", mesh->stage,
        "the last stage: surface, features, loops, pants (default), layout, "
        "field, map, quads, surfaces, volume, hexes; of splines: volume (from surfaces), "
        "hexes");
    sub->add_option("--points", mesh->n_points,
                    "points per direction of the hexahedra in each patch (default: as many as "
                    "control points)")
        ->check(CLI::Range(2, most_hex_points));
    add_surface_options(sub, *mesh);
    sub->add_option("--feature-angle", mesh->feature_angle,
                    "angle between faces from which an edge is sharp, in degrees (default: 40)");
    sub->add_option("--open", mesh->open,
                    "take this plane face of a part off (caps: all that are made for it)")
        ->allow_extra_args(false);
    sub->add_option("--open-at", mesh->open_at, "take off the plane face at X,Y,Z")
        ->allow_extra_args(false);
    sub->add_option("--open-facing", mesh->open_facing,
                    "take off the plane faces whose outward normal is X,Y,Z")
        ->allow_extra_args(false);
    sub->add_option("--cycle", mesh->cycle_weights,
                    "what makes a cut short: length=1, symmetry=, curvature=, sharp=; once for "
                    "each term")
        ->allow_extra_args(false);
    sub->add_option("--merge", mesh->merge_weights, "which cut comes first: the same terms")
        ->allow_extra_args(false);
    sub->add_option("--most-boundaries", mesh->most_boundaries,
                    "put pants with short tubes between them together: patches of up to 3 "
                    "(default) to 6 boundary loops");
    sub->add_option("--element-size", mesh->element_size,
                    "length of a spline element (default: a twentieth of the diagonal)")
        ->check([](const std::string& text) {
            return std::strtod(text.c_str(), nullptr) > 0.0 ? "" : "must be positive";
        });
    sub->add_option("--degree", mesh->degree, "of the splines (default: 2)")
        ->check(CLI::Range(1, iga::max_degree));
    sub->add_option("--layout", mesh->layout,
                    "a coarse mesh of cuboids (.mesh, .vtk, or .toml: nodes and cuboids by "
                    "hand) that lies about where the solid does: "
                    "it is placed on the surface instead of templates")
        ->check(CLI::ExistingFile);
    sub->add_option(
           "--like", mesh->like,
           "cut as another member of the family was: its NAME_pants.json; or NAME_layout.json: "
           "also with its cuboids")
        ->check(CLI::ExistingFile);
    sub->add_option("--out", mesh->out, "folder of the results (default: out/<name>)");
    sub->add_flag("--png", mesh->png, "draw every stage");
    sub->add_flag("--resume", mesh->resume,
                  "of a family: only the members that an earlier run has not done");

    sub = add_command(app, command, "info",
                      "say what a spline, surface or hexahedral mesh file holds",
                      [&command, from] { return run_info(*from, command.common); });
    sub->add_option(
           "file", from->surface,
           "a spline file, a surface file (.stl, .obj, .off, .ply, .vtp), a hexahedral mesh "
           "(.vtk, Medit's .mesh), or the name of a part")
        ->required();
    add_surface_options(sub, *from);

    sub = add_command(app, command, "convert", "write a spline or surface file in another format",
                      [&command, from, to, n_halvings] {
                          return run_convert(*from, *to, *n_halvings, command.common);
                      });
    sub->add_option("in", from->surface,
                    "a spline file, a deck (its geometry), a surface file, or the name of a part")
        ->required();
    sub->add_option("out", *to,
                    "the extension decides: .xml, .mesh, .txt, .inp, .h5 for splines, .stl, .obj, "
                    ".off, .ply, .vtp for surfaces")
        ->required();
    sub->add_option("--refine", *n_halvings,
                    "times that each element of splines is halved in each direction; the shape "
                    "stays the same")
        ->check(CLI::Range(0, most_halvings));
    add_surface_options(sub, *from);

    add_rom_commands(app, command);

    const auto shape = std::make_shared<ShapeOptions>();
    const auto inflate = std::make_shared<ShapeInflateOptions>();
    // The command's callback comes behind that of its own subcommand.
    const auto run_either = [&command, shape, inflate] {
        return inflate->surface.empty() ? run_shape(*shape, command.common)
                                        : run_shape_inflate(*inflate, command.common);
    };
    sub = add_command(app, command, "shape", "mean, modes and members of a population of shapes",
                      run_either);
    add_shape_options(sub, *shape);
    sub = add_command(*sub, command, "inflate",
                      "a quad mesh in any cavity: a sphere inflated until it meets the wall",
                      run_either);
    add_inflate_options(sub, *inflate);

    const auto verify = std::make_shared<VerifyOptions>();
    sub = add_command(app, command, "verify", "solve problems with known answers and compare",
                      [&command, verify] { return run_verify(*verify, command.common); });
    sub->add_option("--filter", verify->filter, "only cases whose name contains this text");
    sub->add_flag("--long", verify->with_long, "the long cases too");

    const auto bench = std::make_shared<BenchCommandOptions>();
    sub = add_command(app, command, "bench", "time assembly, solvers and meshing on this machine",
                      [&command, bench] { return run_bench(*bench, command.common); });
    sub->add_flag("--quick", bench->quick, "small cases only, a few seconds");
    sub->add_option("--save", bench->save, "also write the numbers to this JSON file");
    sub->add_option("--compare", bench->compare,
                    "set the times beside those that an earlier --save wrote");
    sub->add_option("--only", bench->only, "run these sections only (default: all)")
        ->check(CLI::IsMember(bench_sections()));

    sub = add_command(app, command, "compare", "say what differs between two results",
                      [&command, compare] { return run_compare(*compare, command.common); });
    sub->add_option("first", compare->first, "a summary (.json), a field (.vtu) or a spline file")
        ->required();
    sub->add_option("second", compare->second, "another of the same kind")->required();
    sub->add_option("--tolerance", compare->tolerance, "relative difference that counts as none");

    const auto refuse = [&](const std::string& message) {
        fmt::print(stderr, "couture: {}\n", message);
        if (std::find(argv, argv + argc, std::string_view("--json")) != argv + argc) {
            fmt::print("{}", error_json(message, ExitCode::bad_input));
        }
        return ExitCode::bad_input;
    };
    if (const auto message = unknown_command(app, argc, argv)) {
        return refuse(*message);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return refuse(fmt::format("{}; see couture --help", error.what()));
    }
    apply(command.common);
    return {};
}

}  // namespace couture::drivers
