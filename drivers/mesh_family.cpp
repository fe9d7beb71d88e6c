#include "drivers/mesh_family.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "drivers/family_results.h"
#include "drivers/mesh_stages.h"
#include "drivers/prepared_surface.h"
#include "drivers/surface_input.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/core/timer.h"
#include "iga/topology/space.h"
#include "io/atomic_file.h"
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

struct MeshedMember {
    MeshStages stages;
    [[nodiscard]] const meshing::LayoutVolume& made() const { return *stages.solid->volume; }
    [[nodiscard]] const iga::MultiPatch<3>& volume() const { return made().volume; }
};

class Family {
  public:
    Family(const io::MeshDeck& deck, const fs::path& folder, std::string name,
           const MeshOptions& options, std::string job)
        : deck_(deck),
          folder_(folder),
          name_(std::move(name)),
          has_pictures_(options.png),
          job_(std::move(job)),
          progress_(folder / (name_ + "_members.json")) {
        if (options.resume) earlier_ = read_family_progress(progress_, job_);
    }

    void run() {
        const std::vector<io::FamilyMember> members = io::family_members(deck_);
        for (std::size_t m = 0; m < members.size(); ++m) {
            log::info(fmt::format("family: {} ({} of {})", members[m].name, m + 1, members.size()));
            MemberResult& result = results_.emplace_back();
            result.member = members[m];
            const Timer timer;
            const MemberResult* earlier = find_earlier(members[m]);
            if (auto volume = earlier != nullptr ? read_earlier(members[m]) : std::nullopt) {
                result = *earlier;
                result.member = members[m];
                take_over(result.member, std::move(*volume));
                continue;
            }
            remove_earlier(members[m]);
            if (m == 0) {
                // What was repeated from another reference is of no use.
                earlier_.clear();
                run_reference(result);
            } else {
                run_member(result);
            }
            result.seconds = timer.seconds();
            if (!result.failure.empty()) {
                log::warn(fmt::format("family: {} failed: {}", result.member.name, result.failure));
            }
            write_family_progress(progress_, job_, results_);
        }
        files_.push_back(progress_);
        if (has_pictures_) draw();
    }

    [[nodiscard]] const std::vector<MemberResult>& results() const { return results_; }
    [[nodiscard]] const std::vector<fs::path>& files() const { return files_; }

  private:
    [[nodiscard]] io::MeshDeck deck_of(const io::FamilyMember& member) const {
        io::MeshDeck deck = deck_;
        deck.family.reset();
        deck.parameters = member.parameters;
        deck.surface = member.surface;
        deck.like = record_;
        deck.solid.node_tolerance = meshing::family_node_tolerance;
        return deck;
    }

    [[nodiscard]] fs::path problems_file(const io::FamilyMember& member) const {
        return folder_ / (member.name + "_problems.vtp");
    }

    [[nodiscard]] fs::path volume_file(const io::FamilyMember& member) const {
        return folder_ / (member.name + "_volume.xml");
    }

    // Of a member that failed.
    [[nodiscard]] fs::path picture_file(const io::FamilyMember& member, MeshStage reached) const {
        return folder_ / fmt::format("{}_failed_{}.png", member.name, to_string(reached));
    }

    [[nodiscard]] fs::path record_file(const io::FamilyMember& member) const {
        return folder_ / (member.name + "_layout.json");
    }

    // What an earlier run made of the same member, if its files are still there and not older than
    // its surface.
    [[nodiscard]] const MemberResult* find_earlier(const io::FamilyMember& member) const {
        const auto found = std::ranges::find_if(earlier_, [&](const MemberResult& one) {
            return one.member.name == member.name && one.member.parameters == member.parameters;
        });
        const fs::path volume = volume_file(member);
        if (found == earlier_.end() || !fs::exists(volume)) return nullptr;
        if (record_.empty() && !fs::exists(record_file(member))) return nullptr;
        const bool is_newer = member.surface.empty() ||
                              fs::last_write_time(volume) >= fs::last_write_time(member.surface);
        return is_newer ? &*found : nullptr;
    }

    // Files of an earlier run that this one may not replace.
    void remove_earlier(const io::FamilyMember& member) const {
        std::vector<fs::path> files{problems_file(member), volume_file(member)};
        for (int stage = 0; stage <= static_cast<int>(MeshStage::hexes); ++stage) {
            files.push_back(picture_file(member, static_cast<MeshStage>(stage)));
        }
        for (const fs::path& file : files) {
            std::error_code ignored;
            fs::remove(file, ignored);
        }
    }

    // Nothing if its file was damaged since.
    [[nodiscard]] std::optional<iga::MultiPatch<3>> read_earlier(
        const io::FamilyMember& member) const {
        try {
            auto splines = io::read_splines(volume_file(member)).multipatch;
            if (auto* volume = std::get_if<iga::MultiPatch<3>>(&splines)) return std::move(*volume);
        } catch (const Error& error) {
            log::warn(fmt::format("family: {} is meshed again: {}", member.name, error.what()));
        }
        return {};
    }

    // Goes on from what an earlier run wrote.
    void take_over(const io::FamilyMember& member, iga::MultiPatch<3> volume) {
        log::info(fmt::format("family: {} is done already", member.name));
        if (record_.empty()) {
            const PreparedSurface surface = prepare_surface(deck_of(member), problems_file(member));
            reference_ = volume;
            if (surface.part) {
                images_ = meshing::find_feature_images(reference_,
                                                       meshing::named_features(*surface.part));
            }
            record_ = record_file(member);
            files_.push_back(record_);
        }
        files_.push_back(volume_file(member));
        if (has_pictures_) add_scene(member.name, volume);
        previous_ = std::move(volume);
    }

    void run_reference(MemberResult& result) {
        MeshedMember meshed;
        run_mesh_stages(deck_of(result.member), problems_file(result.member), meshed.stages);
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
        record_ = record_file(result.member);
        io::write_layout_record(record_, *meshed.stages.record, meshed.stages.solid->cuboids.record,
                                job_);
        files_.push_back(record_);
        write(meshed, result);
    }

    void run_member(MemberResult& result) {
        MeshedMember meshed;
        try {
            run_mesh_stages(deck_of(result.member), problems_file(result.member), meshed.stages);
            examine(meshed, result);
        } catch (const Error& error) {
            result.failure = error.what();
        }
        if (!result.failure.empty()) {
            draw_failure(meshed.stages, result.member);
            return;
        }
        const auto certificate = [&](const iga::MultiPatch<3>& other) {
            return iga::to_string(meshing::certified(meshing::midpoint(other, meshed.volume())));
        };
        result.to_reference = certificate(reference_);
        result.to_previous = certificate(previous_);
        write(meshed, result);
        previous_ = meshed.volume();
    }

    // The stage that a member reached, or what is wrong with its surface.
    void draw_failure(const MeshStages& stages, const io::FamilyMember& member) {
        const fs::path problems = problems_file(member);
        const bool has_problems = fs::exists(problems);
        if (has_problems) files_.push_back(problems);
        auto stage = reached_stage(stages);
        if (!stage && !has_problems) return;
        // A solid that was not cut is seen by its sharp edges.
        if (stage == MeshStage::pants && stages.pants->curves.empty()) stage = MeshStage::features;
        const fs::path path = picture_file(member, stage.value_or(MeshStage::surface));
        try {
            io::Scene scene =
                stage ? stage_scene(stages, *stage) : problems_scene(read_surface(deck_of(member)));
            scene.title = path.stem().string();
            io::render_png(path, scene);
            files_.push_back(path);
        } catch (const Error& error) {
            log::warn(error.what());
        }
    }

    // Whether the volume may stand beside the reference; if not, why.
    void examine(const MeshedMember& meshed, MemberResult& result) const {
        const meshing::LayoutVolumeReport& report = meshed.made().report;
        const auto& parameterization = report.parameterization;
        result.signature = iga::signature(meshed.volume());
        result.certificate = iga::to_string(parameterization.validity);
        result.min_scaled_jacobian = report.quality.min_scaled_jacobian;
        result.mean_scaled_jacobian = report.quality.mean_scaled_jacobian;
        result.max_distance = report.max_distance;
        result.hausdorff = meshed.stages.solid->distance->surface;
        result.hausdorff_features = meshed.stages.solid->distance->features;
        if (const std::string expected = iga::signature(reference_); result.signature != expected) {
            result.failure =
                fmt::format("not isotopological: its signature is {}, that of the reference {}",
                            result.signature, expected);
        } else if (parameterization.validity != iga::Validity::valid) {
            result.failure = fmt::format(
                "its volume is {} in patch {}, where det J has a Bernstein coefficient of "
                "{:.3g}: it needs more elements (element_size) or a shape nearer to the reference",
                iga::to_string(parameterization.validity), parameterization.worst_patch,
                parameterization.min_coefficient);
        }
        if (!meshed.stages.part || !result.failure.empty()) return;
        result.homology = meshing::measure_homology(
            meshed.volume(), meshing::named_features(*meshed.stages.part), images_);
        if (result.homology->is_homologous()) return;
        const auto& homology = *result.homology;
        const bool is_corner = homology.max_corner_distance > meshing::homology_tolerance;
        result.failure = fmt::format(
            "not homologous: {} '{}' is {:.3g} of the diagonal away from the {} that it lies on in "
            "the reference; at most {:.3g} is taken: finer triangles (edge_length) or smaller "
            "elements (element_size) follow it better",
            is_corner ? "corner" : "feature curve",
            is_corner ? homology.worst_corner : homology.worst_curve,
            is_corner ? homology.max_corner_distance : homology.max_curve_distance,
            is_corner ? "node" : "arcs", meshing::homology_tolerance);
    }

    void write(const MeshedMember& meshed, const MemberResult& result) {
        files_.push_back(volume_file(result.member));
        io::write_splines(files_.back(), meshed.volume());
        if (has_pictures_) add_scene(result.member.name, meshed.volume());
    }

    void add_scene(const std::string& name, const iga::MultiPatch<3>& volume) {
        io::SceneOptions options;
        options.title = name;
        io::Scene scene = io::make_scene(iga::Space<3>(volume), options);
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
    std::string job_;
    fs::path progress_;
    // Done by an earlier run.
    std::vector<MemberResult> earlier_;
    std::vector<MemberResult> results_;
    std::vector<fs::path> files_;
    std::vector<io::Scene> scenes_;
    // Empty until the reference is done.
    fs::path record_;
    iga::MultiPatch<3> reference_;
    iga::MultiPatch<3> previous_;
    meshing::FeatureImages images_;
};

// What a deck says beside its members.
std::string job_of(const io::MeshDeck& deck, const MeshOptions& options) {
    std::string text = deck.text;
    for (const std::string& setting : options.overrides) {
        if (!setting.starts_with("family.")) text += "\n" + setting;
    }
    return fmt::format("couture {}; deck hash {}", COUTURE_VERSION, text_hash(text));
}

}  // namespace

int mesh_family(const io::MeshDeck& deck, const MeshOptions& options, const CommonOptions& common) {
    const std::string name = deck.path.stem().string();
    const fs::path folder = options.out.empty() ? fs::path("out") / name : options.out;
    io::require_writable(folder);
    const Timer timer;
    Family family(deck, folder, name, options, job_of(deck, options));
    family.run();
    const FamilySummary summary{deck.title, family.results(), timer.seconds(), family.files()};
    if (common.json) {
        fmt::print("{}\n", family_json(summary));
    } else if (!common.quiet) {
        print_family(summary, folder);
    }
    return summary.is_done() ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
