#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "drivers/commands/commands.h"
#include "drivers/mesh_family.h"
#include "drivers/mesh_splines.h"
#include "drivers/mesh_stages.h"
#include "drivers/stage_sheets.h"
#include "drivers/surface_input.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/core/timer.h"
#include "iga/topology/element_quality.h"
#include "io/atomic_file.h"
#include "io/mesh_deck.h"
#include "io/spline_file.h"
#include "meshing/surface/curvature_clusters.h"

namespace couture::drivers {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

meshing::CriterionWeights read_weights(const std::vector<std::string>& settings,
                                       const char* option) {
    meshing::CriterionWeights weights;
    if (!settings.empty()) weights.length = 0.0;
    for (const std::string& setting : settings) {
        const auto [name, value] = read_setting("mesh", setting, option);
        if (name == "length") {
            weights.length = value;
        } else if (name == "symmetry") {
            weights.symmetry = value;
        } else if (name == "curvature") {
            weights.curvature = value;
        } else if (name == "sharp") {
            weights.sharp = value;
        } else {
            throw InputError(
                "mesh: {} has no term '{}'; there are length, symmetry, curvature, sharp", option,
                name);
        }
    }
    return weights;
}

// "x,y,z".
Vector3 read_point(const std::string& text, const char* option) {
    Vector3 x;
    const char* at = text.data();
    const char* end = text.data() + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [stop, error] = std::from_chars(at, end, x[i]);
        const bool goes_on = i < 2 ? stop != end && *stop == ',' : stop == end;
        if (error != std::errc() || !goes_on || !std::isfinite(x[i])) {
            throw InputError("mesh: {} '{}' is no point; write X,Y,Z without blanks", option, text);
        }
        at = stop + 1;
    }
    return x;
}

// A deck as it would be written for the options.
io::MeshDeck deck_of(const MeshOptions& options) {
    if (std::filesystem::path(options.surface).extension() == ".toml") {
        const auto overrides = [&] {
            auto all = options.overrides;
            if (!options.stage.empty()) {
                all.push_back(fmt::format("meshing.stage=\"{}\"", options.stage));
            }
            if (options.n_points) {
                all.push_back(fmt::format("meshing.points={}", *options.n_points));
            }
            return all;
        };
        const bool has_more =
            options.edge_length != 0.0 || options.feature_angle || !options.cycle_weights.empty() ||
            !options.merge_weights.empty() || options.element_size != 0.0 || options.degree ||
            !options.layout.empty() || !options.open.empty() || !options.open_at.empty() ||
            !options.open_facing.empty() || options.most_boundaries || !options.like.empty() ||
            options.fix || options.fill_holes || options.shell;
        if (has_more) {
            throw InputError(
                "mesh: a deck says itself how it is meshed: write it into its section [meshing], "
                "or "
                "--set meshing.KEY=VALUE; only --stage, --points, --set, --out, --png, --resume "
                "and "
                "those of all commands stand beside it");
        }
        return io::read_mesh_deck(options.surface, overrides());
    }
    io::MeshDeck deck;
    deck.title = std::filesystem::path(options.surface).stem().string();
    if (is_part_input(options.surface)) {
        deck.part = options.surface;
        deck.edge_length = options.edge_length;
        for (const std::string& setting : options.overrides) {
            deck.parameters.insert(read_setting("mesh", setting, "--set"));
        }
    } else {
        if (!options.overrides.empty() || options.edge_length != 0.0) {
            throw InputError(
                "mesh: --set and --edge-length are for parts; '{}' is a file, which is taken as "
                "it is",
                options.surface);
        }
        deck.surface = options.surface;
    }
    deck.fix = options.fix;
    deck.fill_holes = options.fill_holes;
    deck.shell = options.shell;
    if (!options.stage.empty()) deck.stage = options.stage;
    if (options.feature_angle &&
        !(*options.feature_angle > 0.0 && *options.feature_angle < 180.0)) {
        throw InputError("mesh: --feature-angle {}; it must lie between 0 and 180 degrees",
                         *options.feature_angle);
    }
    if (options.feature_angle) deck.features.angle = *options.feature_angle * degree;
    for (const std::string& name : options.open) {
        if (name == "caps") {
            deck.open.all = true;
        } else {
            deck.open.names.push_back(name);
        }
    }
    for (const auto& text : options.open_at) {
        deck.open.points.push_back(read_point(text, "--open-at"));
    }
    for (const auto& text : options.open_facing) {
        deck.open.normals.push_back(read_point(text, "--open-facing"));
    }
    deck.pants.cycle = read_weights(options.cycle_weights, "--cycle");
    deck.pants.merge = read_weights(options.merge_weights, "--merge");
    deck.pants.most_boundaries = options.most_boundaries.value_or(deck.pants.most_boundaries);
    if (options.element_size < 0.0 || !std::isfinite(options.element_size)) {
        throw InputError("mesh: --element-size {}; it must be positive", options.element_size);
    }
    deck.solid.element_size = options.element_size;
    deck.solid.volume.degree = options.degree.value_or(deck.solid.volume.degree);
    deck.solid.n_points = options.n_points;
    deck.layout = options.layout;
    deck.like = options.like;
    if (!deck.layout.empty() && !deck.like.empty()) {
        throw InputError(
            "mesh: --layout takes the place of the cuts and cuboids that --like repeats; give one "
            "of them");
    }
    if (!deck.layout.empty() && (deck.stage == "loops" || deck.stage == "pants")) {
        throw InputError(
            "mesh: --layout takes the place of pants: stage {} has no place beside it; add --stage "
            "layout or a later one",
            deck.stage);
    }
    if (!deck.layout.empty() && (!options.cycle_weights.empty() || !options.merge_weights.empty() ||
                                 options.most_boundaries)) {
        throw InputError(
            "mesh: --layout takes the place of cuts; --cycle, --merge and --most-boundaries have "
            "no "
            "place beside it");
    }
    if (!deck.like.empty() && (!options.cycle_weights.empty() || !options.merge_weights.empty() ||
                               options.most_boundaries)) {
        throw InputError(
            "mesh: --like repeats the cuts of another member; --cycle, --merge and "
            "--most-boundaries have no place beside it");
    }
    return deck;
}

// The certificate of the last stage that has one.
const meshing::ParameterizationReport* certificate(const meshing::SolidMesh& solid) {
    if (solid.hexes) return &solid.hexes->report;
    return solid.volume ? &solid.volume->report.parameterization : nullptr;
}

// What is not positive everywhere, or empty.
std::string failure(const MeshStages& stages) {
    const auto* report = stages.solid ? certificate(*stages.solid) : nullptr;
    if (report == nullptr || report->validity <= iga::Validity::degenerate) return "";
    return fmt::format("the {} {}: det J is not positive everywhere in patch {}",
                       stages.solid->hexes ? "hexahedra are" : "volume is",
                       iga::to_string(report->validity), report->worst_patch);
}

int n_hexahedra(const iga::MultiPatch<3>& hexahedra) {
    int n = 0;
    for (const auto& patch : hexahedra.patches) {
        const auto [a, b, c] = patch.space().n_elements();
        n += a * b * c;
    }
    return n;
}

nlohmann::ordered_json field_json(const meshing::SolidMesh& solid) {
    const auto& [topology, field, report] = *solid.field;
    const meshing::SurfaceMesh& mesh = solid.cuboids.mesh;
    auto singularities = nlohmann::ordered_json::array();
    for (const auto& [vertex, index] : topology.singularities) {
        const Vector3& x = mesh.point(meshing::VertexHandle(vertex));
        singularities.push_back({{"point", {x.x(), x.y(), x.z()}}, {"quarter_turns", index}});
    }
    return {
        {"singularities", singularities},
        {"boundary_turns", topology.boundary_turns},
        {"generator_turns", topology.generator_turns},
        {"freedom", meshing::topological_freedom(meshing::compute_invariants(mesh),
                                                 static_cast<int>(topology.singularities.size()))},
        {"topological_energy", report.topological_energy},
        {"energy", report.energy},
        {"feature_angle", report.feature_angle}};
}

void add_solid(const meshing::SolidMesh& solid, nlohmann::ordered_json& object) {
    object["layout"] = {{"cuboids", solid.cuboids.volume.n_cuboids()},
                        {"quads", solid.cuboids.surface.layout.n_quads()},
                        {"templates", solid.cuboids.templates}};
    if (solid.field) object["field"] = field_json(solid);
    if (solid.map) {
        const auto& report = solid.map->report;
        object["map"] = {{"energy", report.energies},
                         {"flipped", report.n_flipped},
                         {"max_angle_change", report.distortion.largest_angle_change},
                         {"mean_angle_change", report.distortion.mean_angle_change},
                         {"min_area_ratio", report.distortion.smallest_area_ratio},
                         {"max_area_ratio", report.distortion.largest_area_ratio}};
        if (solid.field) object["map"]["angle_to_field"] = report.mean_angle_to_directions;
    }
    if (solid.quads) {
        object["quads"] = {{"energy", solid.relocation->energies},
                           {"largest_move", solid.relocation->largest_move},
                           {"min_scaled_jacobian", solid.quad_quality->smallest_scaled_jacobian},
                           {"mean_scaled_jacobian", solid.quad_quality->mean_scaled_jacobian},
                           {"hausdorff", solid.quad_quality->hausdorff_distance}};
        if (solid.field) {
            object["quads"]["angle_to_field"] =
                meshing::mean_angle_to_field(*solid.quads, solid.cuboids.mesh, solid.field->field);
        }
    }
    if (solid.surfaces) {
        const auto& [surfaces, report] = *solid.surfaces;
        object["surfaces"] = {{"patches", surfaces.n_patches()},
                              {"control_points", surfaces.n_control_points()},
                              {"area", iga::volume(surfaces)},
                              {"max_distance", report.max_distance},
                              {"rms_distance", report.rms_distance}};
    }
    if (!solid.volume) return;
    const auto& report = solid.volume->report;
    object["volume"] = {{"patches", solid.volume->volume.n_patches()},
                        {"control_points", solid.volume->volume.n_control_points()},
                        {"signature", iga::signature(solid.volume->volume)},
                        {"certificate", iga::to_string(report.parameterization.validity)},
                        {"min_scaled_jacobian", report.quality.min_scaled_jacobian},
                        {"mean_scaled_jacobian", report.quality.mean_scaled_jacobian},
                        {"hausdorff", solid.distance->surface},
                        {"hausdorff_features", solid.distance->features}};
    if (!solid.hexes) return;
    const auto quality = iga::element_quality(solid.hexes->hexahedra);
    object["hexes"] = {{"elements", n_hexahedra(solid.hexes->hexahedra)},
                       {"certificate", iga::to_string(solid.hexes->report.validity)},
                       {"min_scaled_jacobian", quality.min_scaled_jacobian},
                       {"mean_scaled_jacobian", quality.mean_scaled_jacobian}};
}

void add_pants(const MeshStages& stages, nlohmann::ordered_json& object) {
    auto& curves = object["curves"] = nlohmann::ordered_json::array();
    for (const auto& curve : stages.pants->curves) {
        curves.push_back({{"kind", std::string(meshing::to_string(curve.kind))},
                          {"name", curve.name},
                          {"length", curve.length},
                          {"vertices", curve.curve.vertices.size()}});
    }
    auto& tunnels = object["tunnels"] = nlohmann::ordered_json::array();
    for (const auto& tunnel : stages.pants->tunnels) {
        double length = 0.0;
        for (std::size_t k = 0; k < tunnel.size(); ++k) {
            length += (tunnel[(k + 1) % tunnel.size()] - tunnel[k]).norm();
        }
        tunnels.push_back(length);
    }
    auto& patches = object["patches"] = nlohmann::ordered_json::array();
    for (const auto& patch : stages.pants->patches) {
        auto sides = nlohmann::ordered_json::array();
        for (const auto& side : patch.boundary) {
            sides.push_back({{"curve", side.curve}, {"left", side.is_left}});
        }
        patches.push_back({{"shell", patch.shell}, {"genus", patch.genus}, {"boundary", sides}});
    }
}

nlohmann::ordered_json to_json(const MeshStages& stages) {
    const auto& invariants = stages.invariants;
    nlohmann::ordered_json object = {{"surface",
                                      {{"vertices", invariants.n_vertices},
                                       {"edges", invariants.n_edges},
                                       {"triangles", invariants.n_faces},
                                       {"euler_characteristic", invariants.euler_characteristic},
                                       {"genus", invariants.genus},
                                       {"boundaries", invariants.n_boundaries},
                                       {"betti", invariants.betti},
                                       {"name", stages.surface_name},
                                       {"area", meshing::surface_area(stages.mesh)},
                                       {"volume", meshing::signed_volume(stages.mesh)}}}};
    const auto clusters = meshing::find_curvature_clusters(stages.mesh);
    auto& list = object["curvature"]["clusters"] = nlohmann::ordered_json::array();
    for (const auto& cluster : clusters.clusters) {
        const Vector3& x = cluster.center;
        list.push_back({{"curvature", cluster.curvature},
                        {"quarter_turns", cluster.quarter_turns},
                        {"center", {x.x(), x.y(), x.z()}},
                        {"vertices", cluster.vertices.size()}});
    }
    object["curvature"]["rest"] = clusters.rest;
    object["curvature"]["missing_quarter_turns"] = clusters.missing_quarter_turns;
    object["features"] = {{"curves", stages.features.curves.size()},
                          {"corners", stages.features.corners.size()},
                          {"faces", stages.features.regions.size()}};
    if (stages.pants) add_pants(stages, object);
    if (stages.solid) add_solid(*stages.solid, object);
    return object;
}

// " pants", or what sorts of n-pants there are.
std::string kinds_of_patches(const meshing::PantsDecomposition& pants) {
    static const std::map<std::size_t, const char*> names{
        {3, "pants"}, {4, "shirt"}, {5, "suit"}, {6, "spacesuit"}};
    std::map<std::size_t, int> count;
    for (const auto& patch : pants.patches) ++count[patch.boundary.size()];
    if (count.size() == 1 && count.begin()->first == 3) return " pants";
    std::string text;
    for (const auto& [n, number] : count) {
        const auto name = names.find(n);
        text += fmt::format("{} {} {}", text.empty() ? ":" : ",", number,
                            name != names.end() ? name->second : fmt::format("{}-pants", n));
        if (number > 1 && n > 3 && name != names.end()) text += "s";
    }
    return text;
}

void print_solid(const meshing::SolidMesh& solid) {
    const auto& layout = solid.cuboids.surface.layout;
    const auto& templates = solid.cuboids.templates;
    fmt::print("layout    {} cuboids, {} quads, {} arcs on the surface{}{}\n",
               solid.cuboids.volume.n_cuboids(), layout.n_quads(), layout.n_arcs(),
               templates.empty() ? "" : "; templates ", fmt::join(templates, ", "));
    if (solid.field) {
        const auto& [topology, field, report] = *solid.field;
        fmt::print(
            "field     {} singularities; sum of squares of connection angles {:.4g} by topology "
            "alone, {:.4g} along features; off features by up to {:.2g} rad\n",
            topology.singularities.size(), report.topological_energy, report.energy,
            report.feature_angle);
    }
    if (solid.map) {
        const auto& report = solid.map->report;
        fmt::print("map       energy {:.4g} to {:.4g} in {} steps, {} triangles flipped\n",
                   report.energies.front(), report.energies.back(), report.energies.size() - 1,
                   report.n_flipped);
    }
    if (solid.quads) {
        const auto& report = *solid.relocation;
        const auto& quality = *solid.quad_quality;
        fmt::print(
            "quads     nodes moved by up to {:.4g}, energy {:.4g} to {:.4g}; scaled Jacobian from "
            "{:.3f}, mean {:.3f}; distance from the surface {:.2e} of its diagonal\n",
            report.largest_move, report.energies.front(), report.energies.back(),
            quality.smallest_scaled_jacobian, quality.mean_scaled_jacobian,
            quality.hausdorff_distance);
    }
    if (solid.surfaces) {
        const auto& [surfaces, report] = *solid.surfaces;
        fmt::print("surfaces  {} patches, {} control points; {:.4g} from the surface at most\n",
                   surfaces.n_patches(), surfaces.n_control_points(), report.max_distance);
    }
    if (!solid.volume) return;
    const auto& report = solid.volume->report;
    fmt::print(
        "volume    {} patches, {} control points; det J {}, scaled Jacobian from {:.3f}, mean "
        "{:.3f}\ndistance  of splines and surface {:.2e} of its diagonal, of sharp edges {:.2e}\n",
        solid.volume->volume.n_patches(), solid.volume->volume.n_control_points(),
        iga::to_string(report.parameterization.validity), report.quality.min_scaled_jacobian,
        report.quality.mean_scaled_jacobian, solid.distance->surface, solid.distance->features);
    if (!solid.hexes) return;
    const auto quality = iga::element_quality(solid.hexes->hexahedra);
    fmt::print("hexes     {} hexahedra; det J {}, scaled Jacobian from {:.3f}, mean {:.3f}\n",
               n_hexahedra(solid.hexes->hexahedra), iga::to_string(solid.hexes->report.validity),
               quality.min_scaled_jacobian, quality.mean_scaled_jacobian);
}

void print_pants(const MeshStages& stages, MeshStage last) {
    for (const auto& curve : stages.pants->curves) {
        if (last == MeshStage::loops && curve.kind == meshing::PantsCurveKind::cycle) continue;
        fmt::print("{:<9} length {:.6g}{}\n", meshing::to_string(curve.kind), curve.length,
                   curve.name.empty() ? "" : ", cap " + curve.name);
    }
    if (last >= MeshStage::pants) {
        const bool are_pants = stages.invariants.euler_characteristic < 0;
        fmt::print("patches   {}{}\n", stages.pants->patches.size(),
                   are_pants ? kinds_of_patches(*stages.pants)
                             : fmt::format(" ({})", stages.surface_name));
    }
}

void print_text(const MeshStages& stages, MeshStage last) {
    const auto& invariants = stages.invariants;
    fmt::print("surface   {} vertices, {} edges, {} triangles: {}, Euler characteristic {}\n",
               invariants.n_vertices, invariants.n_edges, invariants.n_faces, stages.surface_name,
               invariants.euler_characteristic);
    if (last >= MeshStage::features) {
        fmt::print("features  {} curves, {} corners, {} smooth faces\n",
                   stages.features.curves.size(), stages.features.corners.size(),
                   stages.features.regions.size());
    }
    if (stages.pants) print_pants(stages, last);
    if (stages.solid) print_solid(*stages.solid);
}

// Writes all stages up to the last one as STEM_STAGE...
std::vector<std::string> write_stages(const std::filesystem::path& stem, const MeshStages& stages,
                                      MeshStage last, bool png, const std::string& provenance) {
    std::vector<std::string> files;
    for (int stage = 0; stage <= static_cast<int>(last); ++stage) {
        const auto which = static_cast<MeshStage>(stage);
        const bool has_no_pants = !stages.pants && last > MeshStage::pants;
        if (has_no_pants && (which == MeshStage::loops || which == MeshStage::pants)) continue;
        for (const auto& file :
             write_mesh_stage(fmt::format("{}_{}", stem.string(), to_string(which)), stages, which,
                              png, provenance)) {
            files.push_back(file.string());
        }
    }
    return files;
}

// Splines that are farther from the surface than wanted.
void warn_of_distance(const io::MeshDeck& deck, const meshing::SolidMesh& solid) {
    if (!solid.distance) return;
    const double distance = solid.distance->surface;
    constexpr double too_far = 1e-2;
    if (deck.solid.element_size > 0.0) {
        if (distance < too_far) return;
        log::warn(fmt::format(
            "mesh: the splines are up to {:.2g} of the diagonal away from the surface: smaller "
            "elements, or a layout with nodes and arcs where it bends, would come nearer",
            distance));
    } else if (distance > deck.solid.tolerance) {
        log::warn(fmt::format(
            "mesh: the splines are up to {:.2g} of the diagonal away from the surface, the "
            "tolerance is {:.2g}; no element was made shorter than the triangles or after four "
            "rounds: finer triangles, or an element_size, would come nearer",
            distance, deck.solid.tolerance));
    }
}

}  // namespace

int run_mesh(const MeshOptions& options, const CommonOptions& common) {
    if (io::is_spline_file(options.surface)) return mesh_splines(options, common);
    const io::MeshDeck deck = deck_of(options);
    io::require_writable(options.out.empty() ? std::filesystem::path("out") : options.out);
    if (deck.solid.n_points && deck.stage != "hexes") {
        throw InputError("mesh: {} points are for stage hexes, which samples them, not for {}",
                         *deck.solid.n_points, deck.stage);
    }
    if (deck.family) return mesh_family(deck, options, common);
    if (options.resume) {
        throw InputError("mesh: --resume goes on with the members of a family; {} has no [family]",
                         options.surface);
    }
    const MeshStage last = read_mesh_stage(deck.stage);

    const std::string name = std::filesystem::path(options.surface).stem().string();
    const std::filesystem::path folder =
        options.out.empty() ? std::filesystem::path("out") / name : options.out;
    const std::string provenance =
        fmt::format("couture {} mesh {} --stage {}{}", COUTURE_VERSION, options.surface, deck.stage,
                    deck.text.empty() ? "" : fmt::format("; deck hash {}", text_hash(deck.text)));
    const Timer timer;
    MeshStages stages;
    try {
        run_mesh_stages(deck, folder / (name + "_problems.vtp"), stages);
    } catch (const Error&) {
        if (const auto reached = reached_stage(stages)) {
            const auto files =
                write_stages(folder / name, stages, *reached, options.png, provenance);
            log::info(fmt::format("mesh: it came as far as stage {}; wrote {}", to_string(*reached),
                                  fmt::join(files, " ")));
        }
        throw;
    }
    const double seconds = timer.seconds();
    const std::string not_positive = failure(stages);
    const bool is_done = not_positive.empty();
    if (!is_done) log::warn(not_positive);
    if (stages.solid) warn_of_distance(deck, *stages.solid);
    std::vector<std::string> files =
        write_stages(folder / name, stages, last, options.png, provenance);
    if (options.png) {
        for (const auto& file : write_stage_sheets(folder / name, stages)) {
            files.push_back(file.string());
        }
    }
    if (common.json) {
        auto object = to_json(stages);
        object["program"] = "couture " COUTURE_VERSION;
        object["status"] = is_done ? "done" : "failed";
        object["seconds"] = seconds;
        object["warnings"] = log::warnings();
        object["files"] = files;
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        print_text(stages, last);
        fmt::print("{:.3f} s; wrote", seconds);
        for (const std::string& file : files) fmt::print(" {}", file);
        fmt::print("\n");
    }
    return is_done ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
