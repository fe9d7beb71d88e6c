#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "drivers/commands/commands.h"
#include "drivers/mesh_stages.h"
#include "drivers/surface_input.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"

namespace couture::drivers {

namespace {

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
    object["features"] = {{"curves", stages.features.curves.size()},
                          {"corners", stages.features.corners.size()},
                          {"faces", stages.features.regions.size()}};
    if (!stages.pants) return object;
    auto& curves = object["curves"] = nlohmann::ordered_json::array();
    for (const auto& curve : stages.pants->curves) {
        curves.push_back({{"kind", std::string(meshing::to_string(curve.kind))},
                          {"length", curve.length},
                          {"vertices", curve.curve.vertices.size()}});
    }
    auto& patches = object["patches"] = nlohmann::ordered_json::array();
    for (const auto& patch : stages.pants->patches) {
        auto sides = nlohmann::ordered_json::array();
        for (const auto& side : patch.boundary) {
            sides.push_back({{"curve", side.curve}, {"left", side.is_left}});
        }
        patches.push_back({{"genus", patch.genus}, {"boundary", sides}});
    }
    return object;
}

void print_text(const MeshStages& stages, MeshStage last) {
    const auto& invariants = stages.invariants;
    fmt::print(
        "surface   {} vertices, {} edges, {} triangles: {}, {} boundaries, Euler characteristic "
        "{}\n",
        invariants.n_vertices, invariants.n_edges, invariants.n_faces, stages.surface_name,
        invariants.n_boundaries, invariants.euler_characteristic);
    if (last >= MeshStage::features) {
        fmt::print("features  {} curves, {} corners, {} smooth faces\n",
                   stages.features.curves.size(), stages.features.corners.size(),
                   stages.features.regions.size());
    }
    if (!stages.pants) return;
    for (const auto& curve : stages.pants->curves) {
        if (last == MeshStage::loops && curve.kind == meshing::PantsCurveKind::cycle) continue;
        fmt::print("{:<9} length {:.6g}\n", meshing::to_string(curve.kind), curve.length);
    }
    if (last == MeshStage::pants) {
        const bool are_pants = stages.invariants.euler_characteristic < 0;
        fmt::print("patches   {}{}\n", stages.pants->patches.size(),
                   are_pants ? " pants" : fmt::format(" ({})", stages.surface_name));
    }
}

}  // namespace

int run_mesh(const MeshOptions& options, const CommonOptions& common) {
    const MeshStage last = read_mesh_stage(options.stage);
    constexpr double degree = std::numbers::pi / 180.0;
    const meshing::FeatureOptions features{.angle = options.feature_angle * degree};
    const meshing::PantsOptions pants{
        .cycle = read_weights(options.cycle_weights, "--cycle"),
        .merge = read_weights(options.merge_weights, "--merge"),
        .progress = [](std::string_view what, double fraction) {
            log::detail(fmt::format("{} ({:.0f} %)", what, 100.0 * fraction));
        }};

    const std::string name = std::filesystem::path(options.surface).stem().string();
    const std::filesystem::path folder =
        options.out.empty() ? std::filesystem::path("out") / name : options.out;
    const Timer timer;
    const io::DescribedSurface surface = load_surface("mesh", {.surface = options.surface,
                                                               .overrides = options.overrides,
                                                               .edge_length = options.edge_length,
                                                               .fix = options.fix,
                                                               .fill_holes = options.fill_holes,
                                                               .shell = options.shell});
    const MeshStages stages =
        run_mesh_stages(make_checked_mesh("mesh", surface, folder / (name + "_problems.vtp")), last,
                        features, pants);
    const double seconds = timer.seconds();
    const std::string provenance = fmt::format("couture {} mesh {} --stage {}", COUTURE_VERSION,
                                               options.surface, options.stage);
    std::vector<std::string> files;
    for (int stage = 0; stage <= static_cast<int>(last); ++stage) {
        const auto which = static_cast<MeshStage>(stage);
        for (const auto& file :
             write_mesh_stage(folder / fmt::format("{}_{}", name, to_string(which)), stages, which,
                              options.png, provenance)) {
            files.push_back(file.string());
        }
    }
    if (common.json) {
        auto object = to_json(stages);
        object["program"] = "couture " COUTURE_VERSION;
        object["status"] = "done";
        object["seconds"] = seconds;
        object["files"] = files;
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        print_text(stages, last);
        fmt::print("{:.3f} s; wrote", seconds);
        for (const std::string& file : files) fmt::print(" {}", file);
        fmt::print("\n");
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
