#include "drivers/mesh_splines.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/hex_files.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/topology/element_quality.h"
#include "io/spline_file.h"
#include "io/vtk_writer.h"
#include "meshing/volume/hex_sampling.h"
#include "meshing/volume/volumes_from_surfaces.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::ordered_json;
using iga::MultiPatch;

void check_options(const MeshOptions& options) {
    if (options.stage != "volume" && options.stage != "hexes") {
        throw InputError("mesh: {} is a spline file; --stage must be volume or hexes{}",
                         options.surface,
                         options.stage.empty() ? "" : fmt::format(", not {}", options.stage));
    }
    const bool has_more = !options.overrides.empty() || options.edge_length != 0.0 ||
                          options.feature_angle || !options.cycle_weights.empty() ||
                          !options.merge_weights.empty() || !options.open.empty() ||
                          !options.open_at.empty() || !options.open_facing.empty() ||
                          options.most_boundaries || !options.like.empty() || options.fix ||
                          options.fill_holes || options.shell || options.png || options.resume;
    if (has_more) {
        throw InputError(
            "mesh: {} is a spline file: only --stage, --points and --out are options; the others "
            "are for surfaces of triangles",
            options.surface);
    }
    if (options.n_points && options.stage != "hexes") {
        throw InputError("mesh: --points {} is for --stage hexes, which samples them",
                         *options.n_points);
    }
}

bool is_certified(const meshing::ParameterizationReport& report) {
    return report.validity <= iga::Validity::degenerate;
}

// What the summary of one multipatch holds.
Json summary(const MultiPatch<3>& volume, const meshing::ParameterizationReport& report) {
    const auto quality = iga::element_quality(volume);
    return {{"patches", volume.n_patches()},
            {"interfaces", volume.interfaces.size()},
            {"volume", iga::volume(volume)},
            {"certificate", iga::to_string(report.validity)},
            {"worst_patch", report.worst_patch},
            {"min_scaled_jacobian", quality.min_scaled_jacobian},
            {"mean_scaled_jacobian", quality.mean_scaled_jacobian}};
}

void print_text(const char* stage, const Json& object) {
    fmt::print(
        "{:<9} {} patches, {} interfaces, volume {:.6g}: {}, scaled Jacobian at least {:.4f}, "
        "mean {:.4f}\n",
        stage, object["patches"].get<int>(), object["interfaces"].get<int>(),
        object["volume"].get<double>(), object["certificate"].get<std::string>(),
        object["min_scaled_jacobian"].get<double>(), object["mean_scaled_jacobian"].get<double>());
}

void warn_of(const std::string& file, const meshing::SurfacesReport& report) {
    const auto warn = [&](const std::string& text) {
        log::warn(fmt::format("{}: {}", file, text));
    };
    if (!report.unused.empty()) {
        warn(fmt::format("surfaces {} bound no volume", fmt::join(report.unused, ", ")));
    }
    if (!report.collapsed.empty()) {
        warn(fmt::format("surfaces {} have two corners in one; they must have four sides",
                         fmt::join(report.collapsed, ", ")));
    }
    for (const auto& six : report.enclosing) {
        warn(fmt::format("surfaces {} enclose other volumes; left out", fmt::join(six, ", ")));
    }
    for (const auto& [surface, original, gap] : report.duplicates) {
        log::info(
            fmt::format("{}: surface {} has the corners of surface {}, which was taken; they "
                        "are {:.3g} apart",
                        file, surface, original, gap));
    }
    if (report.n_fitted_edges > 0) {
        warn(
            fmt::format("{} edges have surfaces with other borders; they got the mean, up to "
                        "{:.3g} away",
                        report.n_fitted_edges, report.max_edge_gap));
    }
}

Json to_json(const meshing::SurfacesReport& report) {
    Json duplicates = Json::array();
    for (const auto& [surface, original, gap] : report.duplicates) {
        duplicates.push_back({{"surface", surface}, {"original", original}, {"gap", gap}});
    }
    return {{"duplicates", duplicates},
            {"collapsed", report.collapsed},
            {"unused", report.unused},
            {"enclosing", report.enclosing},
            {"fitted_edges", report.n_fitted_edges},
            {"max_edge_gap", report.max_edge_gap}};
}

// The folder, what has been written and said.
class SplineMeshing {
  public:
    explicit SplineMeshing(const MeshOptions& options)
        : options_(options),
          file_(std::filesystem::path(options.surface).filename().string()),
          stem_(std::filesystem::path(options.surface).stem().string()),
          provenance_(fmt::format("couture {} mesh {} --stage {}", COUTURE_VERSION, options.surface,
                                  options.stage)) {
        folder_ = options.out.empty() ? std::filesystem::path("out") / stem_ : options.out;
    }

    int run(const CommonOptions& common) {
        const Timer timer;
        const MultiPatch<3> volume = read();
        if (options_.stage == "hexes") make_hexahedra(volume);
        object_["program"] = "couture " COUTURE_VERSION;
        object_["status"] = is_valid_ ? "done" : "failed";
        object_["seconds"] = timer.seconds();
        object_["warnings"] = log::warnings();
        object_["files"] = files_;
        if (common.json) {
            fmt::print("{}\n", object_.dump(2));
        } else if (!common.quiet) {
            for (const char* stage : {"volume", "hexes"}) {
                if (object_.contains(stage)) print_text(stage, object_[stage]);
            }
            fmt::print("{:.3f} s; wrote {}\n", timer.seconds(), fmt::join(files_, " "));
        }
        return is_valid_ ? ExitCode::done : ExitCode::run_failed;
    }

  private:
    // The file's volumes, or those between its surfaces.
    MultiPatch<3> read() {
        const auto surfaces = io::read_spline_surfaces(options_.surface);
        if (!surfaces && options_.stage == "volume") {
            throw InputError(
                "mesh: {} holds volumes; --stage volume makes them from surfaces in space, --stage "
                "hexes samples them",
                options_.surface);
        }
        if (!surfaces) {
            return std::get<MultiPatch<3>>(io::read_splines(options_.surface).multipatch);
        }
        auto [volume, of_patches, report] = meshing::volumes_from_surfaces(*surfaces);
        warn_of(file_, report);
        object_["surfaces"] = to_json(report);
        object_["volume"] = summary(volume, report.parameterization);
        object_["volume"]["surfaces_of_patches"] = of_patches;
        judge("volume", report.parameterization);
        io::write_splines(path("volume", ".xml"), volume);
        io::write_vtu<3>(path("volume", ".vtu"), iga::Space<3>(volume), {}, {},
                         {.provenance = provenance_});
        return volume;
    }

    void make_hexahedra(const MultiPatch<3>& volume) {
        const auto sampled = meshing::sample_hexahedra(volume, options_.n_points);
        object_["hexes"] = summary(sampled.hexahedra, sampled.report);
        judge("hexahedra", sampled.report);
        const HexFiles written =
            write_hexahedra(folder_ / fmt::format("{}_hexes", stem_), sampled, provenance_);
        object_["hexes"]["nodes"] = written.n_nodes;
        object_["hexes"]["elements"] = written.n_elements;
        for (const auto& file : written.files) files_.push_back(file.string());
    }

    void judge(const char* what, const meshing::ParameterizationReport& report) {
        if (is_certified(report)) return;
        is_valid_ = false;
        log::warn(fmt::format("{}: {} of patch {}: {}; det J must be positive", file_, what,
                              report.worst_patch, iga::to_string(report.validity)));
    }

    std::filesystem::path path(const char* stage, const char* extension) {
        const auto result = folder_ / fmt::format("{}_{}{}", stem_, stage, extension);
        files_.push_back(result.string());
        return result;
    }

    const MeshOptions& options_;
    std::string file_;
    std::string stem_;
    std::string provenance_;
    std::filesystem::path folder_;
    std::vector<std::string> files_;
    Json object_;
    bool is_valid_ = true;
};

}  // namespace

int mesh_splines(const MeshOptions& options, const CommonOptions& common) {
    check_options(options);
    return SplineMeshing(options).run(common);
}

}  // namespace couture::drivers
