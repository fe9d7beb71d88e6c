#include "drivers/mesh_family.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "drivers/mesh_stages.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/core/timer.h"
#include "iga/topology/space.h"
#include "io/family_members.h"
#include "io/pants_file.h"
#include "io/picture.h"
#include "io/scene.h"
#include "io/spline_file.h"
#include "meshing/pipeline/homology.h"
#include "meshing/pipeline/midpoint.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// What became of a member.
struct MemberResult {
    io::FamilyMember member;
    // Why it failed; empty if it did not.
    std::string failure;
    double seconds = 0.0;
    std::string signature;
    std::optional<meshing::LayoutVolumeReport> report;
    // Of parts.
    std::optional<meshing::HomologyReport> homology;
    // Half way to the reference, and to the member before that was made.
    std::optional<iga::Validity> to_reference;
    std::optional<iga::Validity> to_previous;
    fs::path file;

    [[nodiscard]] bool has_certified_midpoints() const {
        return to_reference.value_or(iga::Validity::valid) == iga::Validity::valid &&
               to_previous.value_or(iga::Validity::valid) == iga::Validity::valid;
    }
};

struct MeshedMember {
    MeshStages stages;
    [[nodiscard]] const meshing::LayoutVolume& made() const { return *stages.solid->volume; }
    [[nodiscard]] const iga::MultiPatch<3>& volume() const { return made().volume; }
};

class Family {
  public:
    Family(const io::MeshDeck& deck, fs::path folder, std::string name, bool png,
           std::string provenance)
        : deck_(deck),
          folder_(std::move(folder)),
          name_(std::move(name)),
          has_pictures_(png),
          provenance_(std::move(provenance)) {}

    void run() {
        const std::vector<io::FamilyMember> members = io::family_members(deck_);
        for (std::size_t m = 0; m < members.size(); ++m) {
            log::info(fmt::format("family: {} ({} of {})", members[m].name, m + 1, members.size()));
            MemberResult& result = results_.emplace_back();
            result.member = members[m];
            const Timer timer;
            if (m == 0) {
                run_reference(result);
            } else {
                run_member(result);
            }
            result.seconds = timer.seconds();
            if (!result.failure.empty()) {
                log::warn(fmt::format("family: {} failed: {}", result.member.name, result.failure));
            }
        }
        if (has_pictures_) draw();
    }

    [[nodiscard]] const std::vector<MemberResult>& results() const { return results_; }
    [[nodiscard]] const std::vector<fs::path>& files() const { return files_; }

  private:
    [[nodiscard]] MeshedMember mesh(const io::FamilyMember& member) const {
        io::MeshDeck deck = deck_;
        deck.family.reset();
        deck.parameters = member.parameters;
        deck.surface = member.surface;
        deck.like = record_;
        return {run_mesh_stages(deck, folder_ / (member.name + "_problems.vtp"))};
    }

    void run_reference(MemberResult& result) {
        MeshedMember meshed = mesh(result.member);
        const auto validity = meshed.made().report.parameterization.validity;
        if (validity != iga::Validity::valid) {
            throw GeometryError(
                "family: the reference '{}' is {} in patch {}; nothing can be repeated from it. "
                "Try other cuts, templates or smaller elements",
                result.member.name, iga::to_string(validity),
                meshed.made().report.parameterization.worst_patch);
        }
        reference_ = meshed.volume();
        previous_ = reference_;
        if (meshed.stages.part) {
            images_ = meshing::find_feature_images(reference_,
                                                   meshing::named_features(*meshed.stages.part));
        }
        examine(meshed, result);
        if (!result.failure.empty()) {
            throw GeometryError("family: the reference '{}': {}", result.member.name,
                                result.failure);
        }
        record_ = folder_ / (result.member.name + "_layout.json");
        io::write_layout_record(record_, *meshed.stages.record, meshed.stages.solid->cuboids.record,
                                provenance_);
        files_.push_back(record_);
        write(meshed, result);
    }

    void run_member(MemberResult& result) {
        try {
            MeshedMember meshed = mesh(result.member);
            examine(meshed, result);
            if (!result.failure.empty()) return;
            result.to_reference =
                meshing::certified(meshing::midpoint(reference_, meshed.volume()));
            result.to_previous = meshing::certified(meshing::midpoint(previous_, meshed.volume()));
            write(meshed, result);
            previous_ = meshed.volume();
        } catch (const Error& error) {
            result.failure = error.what();
        }
    }

    // Whether the volume may stand beside the reference; if not, why.
    void examine(const MeshedMember& meshed, MemberResult& result) const {
        result.report = meshed.made().report;
        result.signature = iga::signature(meshed.volume());
        const auto& parameterization = result.report->parameterization;
        if (const std::string expected = iga::signature(reference_); result.signature != expected) {
            result.failure =
                fmt::format("not isotopological: its signature is {}, that of the reference {}",
                            result.signature, expected);
        } else if (parameterization.validity != iga::Validity::valid) {
            result.failure = fmt::format("its volume is {} in patch {}",
                                         iga::to_string(parameterization.validity),
                                         parameterization.worst_patch);
        }
        if (!meshed.stages.part || !result.failure.empty()) return;
        result.homology = meshing::measure_homology(
            meshed.volume(), meshing::named_features(*meshed.stages.part), images_);
        if (result.homology->is_homologous()) return;
        const auto& homology = *result.homology;
        const bool is_corner = homology.max_corner_distance > meshing::homology_tolerance;
        result.failure = fmt::format(
            "not homologous: {} '{}' is {:.3g} of the diagonal away from the {} that it lies on in "
            "the reference",
            is_corner ? "corner" : "feature curve",
            is_corner ? homology.worst_corner : homology.worst_curve,
            is_corner ? homology.max_corner_distance : homology.max_curve_distance,
            is_corner ? "node" : "arcs");
    }

    void write(const MeshedMember& meshed, MemberResult& result) {
        result.file = folder_ / (result.member.name + "_volume.xml");
        io::write_splines(result.file, meshed.volume());
        files_.push_back(result.file);
        if (!has_pictures_) return;
        io::SceneOptions options;
        options.title = result.member.name;
        io::Scene scene = io::make_scene(iga::Space<3>(meshed.volume()), options);
        constexpr int width = 400;
        constexpr int height = 300;
        scene.width = width;
        scene.height = height;
        scene.show_axes = false;
        scenes_.push_back(std::move(scene));
    }

    void draw() {
        std::size_t n_columns = 1;
        while (n_columns * n_columns < scenes_.size()) ++n_columns;
        std::vector<std::vector<io::Scene>> rows;
        for (std::size_t k = 0; k < scenes_.size(); ++k) {
            if (k % n_columns == 0) rows.emplace_back();
            rows.back().push_back(std::move(scenes_[k]));
        }
        files_.push_back(folder_ / (name_ + "_family.png"));
        io::render_png(files_.back(), rows);
    }

    const io::MeshDeck& deck_;
    fs::path folder_;
    std::string name_;
    bool has_pictures_;
    std::string provenance_;
    std::vector<MemberResult> results_;
    std::vector<fs::path> files_;
    std::vector<io::Scene> scenes_;
    // Empty until the reference is done.
    fs::path record_;
    iga::MultiPatch<3> reference_;
    iga::MultiPatch<3> previous_;
    meshing::FeatureImages images_;
};

ordered_json to_json(const meshing::HomologyReport& homology) {
    return {{"corners", homology.n_corners},
            {"curves", homology.n_curves},
            {"points_per_curve", homology.points_per_curve},
            {"max_corner_distance", homology.max_corner_distance},
            {"worst_corner", homology.worst_corner},
            {"max_curve_distance", homology.max_curve_distance},
            {"worst_curve", homology.worst_curve},
            {"homologous", homology.is_homologous()}};
}

ordered_json to_json(const MemberResult& result) {
    ordered_json object = {{"name", result.member.name},
                           {"parameters", result.member.parameters},
                           {"status", result.failure.empty() ? "done" : "failed"},
                           {"reason", result.failure},
                           {"seconds", result.seconds}};
    if (result.report) {
        const auto& report = *result.report;
        object["signature"] = result.signature;
        object["certificate"] = iga::to_string(report.parameterization.validity);
        object["min_scaled_jacobian"] = report.quality.min_scaled_jacobian;
        object["mean_scaled_jacobian"] = report.quality.mean_scaled_jacobian;
        object["max_distance"] = report.max_distance;
    }
    if (result.homology) object["homology"] = to_json(*result.homology);
    if (result.to_reference) {
        object["midpoint_with_reference"] = iga::to_string(*result.to_reference);
        object["midpoint_with_previous"] = iga::to_string(*result.to_previous);
    }
    return object;
}

void print_member(const MemberResult& result) {
    if (!result.failure.empty()) {
        fmt::print("{:<20} {:7.2f}  failed: {}\n", result.member.name, result.seconds,
                   result.failure);
        return;
    }
    const auto& quality = result.report->quality;
    fmt::print("{:<20} {:7.2f}  {}  {:.3f} {:.3f}", result.member.name, result.seconds,
               result.signature, quality.min_scaled_jacobian, quality.mean_scaled_jacobian);
    if (result.homology) {
        fmt::print("  {:.1e} {:.1e}", result.homology->max_corner_distance,
                   result.homology->max_curve_distance);
    }
    if (result.to_reference) {
        fmt::print("  {} {}", iga::to_string(*result.to_reference),
                   iga::to_string(*result.to_previous));
    }
    fmt::print("\n");
}

void print_text(const std::vector<MemberResult>& results) {
    fmt::print(
        "{:<20} {:>7}  {:<16}  scaled Jacobian from, mean; homology (corners, curves, of "
        "the diagonal); midpoints with the reference, the one before\n",
        "member", "s", "signature");
    for (const MemberResult& result : results) print_member(result);
}

}  // namespace

int mesh_family(const io::MeshDeck& deck, const MeshOptions& options, const CommonOptions& common) {
    const std::string name = deck.path.stem().string();
    const fs::path folder = options.out.empty() ? fs::path("out") / name : options.out;
    const Timer timer;
    Family family(deck, folder, name, options.png,
                  fmt::format("couture {} mesh {}; deck hash {}", COUTURE_VERSION, options.surface,
                              text_hash(deck.text)));
    family.run();
    const double seconds = timer.seconds();
    const auto& results = family.results();
    const auto n_failed = std::count_if(results.begin(), results.end(),
                                        [](const auto& result) { return !result.failure.empty(); });
    const auto n_folded = std::count_if(results.begin(), results.end(), [](const auto& result) {
        return !result.has_certified_midpoints();
    });
    const bool is_done = n_failed == 0 && n_folded == 0;
    if (common.json) {
        ordered_json object = {{"program", "couture " COUTURE_VERSION},
                               {"status", is_done ? "done" : "failed"},
                               {"title", deck.title},
                               {"reference", results.front().member.name},
                               {"signature", results.front().signature},
                               {"failed_members", n_failed},
                               {"failed_midpoints", n_folded}};
        for (const MemberResult& result : results) object["members"].push_back(to_json(result));
        object["seconds"] = seconds;
        object["warnings"] = log::warnings();
        for (const fs::path& file : family.files()) object["files"].push_back(file.string());
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        print_text(results);
        fmt::print("{} of {} members done, midpoints of {} not certified\n",
                   results.size() - n_failed, results.size(), n_folded);
        fmt::print("{:.1f} s; wrote {} files to {}\n", seconds, family.files().size(),
                   folder.string());
    }
    return is_done ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
