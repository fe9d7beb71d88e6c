#include <fmt/ranges.h>

#include "drivers/commands/commands.h"
#include "drivers/rom_campaign.h"
#include "drivers/rom_learning_curve.h"
#include "drivers/rom_training.h"
#include "drivers/rom_validation.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/core/timer.h"
#include "io/atomic_file.h"
#include "io/picture.h"

namespace couture::drivers {

namespace {

// Each design of tests has one of its own.
std::string validation_folder(const RomSamples& samples, const RomValidateOptions& options) {
    if (samples.section().design != io::GeometryDesign::list) {
        return fmt::format("validation_{}_{}", options.n_points, options.seed);
    }
    std::string texts = io::read_text(samples.section().validation);
    for (const io::FamilyMember& member : samples.plan().listed) {
        texts += text_hash(io::read_text(member.surface.empty() ? member.volume : member.surface));
    }
    return fmt::format("validation_{}_{}", text_hash(texts), options.seed);
}

}  // namespace

int run_rom_validate(const RomValidateOptions& options, const CommonOptions& common) {
    const Timer timer;
    const RomTrainOptions& campaign = options.campaign;
    RomSamples design(campaign.deck, campaign.overrides);
    RomSamples samples(campaign.deck, campaign.overrides);
    const std::filesystem::path folder = rom_folder(campaign);
    const std::string name = campaign.deck.stem().string();
    const std::filesystem::path model_file = folder / (name + ".rom");
    if (options.png) {
        if (const auto missing = io::missing_for_pictures()) {
            throw InputError("rom validate: no picture can be drawn: {}", *missing);
        }
    }
    if (!std::filesystem::exists(model_file)) {
        throw InputError("{}: there is no model; first run couture rom train {}",
                         model_file.string(), campaign.deck.string());
    }
    use_rom_threads(common);
    const io::SnapshotStore training(folder / "snapshots", samples.job());
    samples.use(make_validation_plan(samples.section(), options.n_points, options.seed));
    io::SnapshotStore store(folder / validation_folder(samples, options), samples.job());
    if (campaign.retry) store.clear_failures();
    store.take_reference(training);
    const auto reference = samples.make_reference(store);
    const bool is_whole =
        run_campaign(campaign, common, samples, *reference, store,
                     {"rom", "validate", "--points", std::to_string(options.n_points), "--seed",
                      std::to_string(options.seed)});
    if (!is_whole) return ExitCode::done;

    TrainedModel trained(model_file);
    trained.require_job(training);
    const std::vector<SolvedPoint> solved =
        solved_points(samples, store, trained.model().parts().reference);
    Validation validation = validate_model(trained, solved, options.galerkin);
    design.take_added(training);
    if (progress_of(design.plan(), training).n_missing == 0) {
        log::info("rom: learning again from parts of the geometries");
        validation.learning = learning_curve(trained, read_snapshots(design, *reference, training),
                                             solved, validation);
    }
    rom::ReducedModel calibrated = trained.model();
    calibrated.set_calibration(validation.calibration);
    io::write_reduced_model(model_file,
                            {calibrated, trained.file().deck, trained.file().provenance});

    std::vector<std::string> files = {model_file.string()};
    const std::filesystem::path stem = folder / (name + "_validation");
    files.push_back(stem.string() + ".csv");
    io::write_text(files.back(), validation_csv(trained, validation));
    for (const std::string& file :
         write_worst_point(stem, trained, solved, validation, options.png)) {
        files.push_back(file);
    }
    if (options.png) {
        files.push_back(stem.string() + ".png");
        draw_validation(files.back(), trained, design.plan(), validation);
    }
    const int n_refused = progress_of(samples.plan(), store).n_refused;
    files.push_back(stem.string() + ".json");
    const std::string json =
        validation_json(trained, validation, n_refused, timer.seconds(), files);
    io::write_text(files.back(), json);
    if (common.json) {
        fmt::print("{}", json);
    } else if (!common.quiet) {
        print_validation(trained, validation, n_refused);
        fmt::print("  {:.1f} s; wrote {}\n", timer.seconds(), fmt::join(files, " "));
    }
    return n_refused > 0 ? ExitCode::run_failed : ExitCode::done;
}

}  // namespace couture::drivers
