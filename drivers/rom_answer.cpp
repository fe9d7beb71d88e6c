#include "drivers/rom_answer.h"

#include "drivers/deck_check.h"
#include "drivers/result_files.h"
#include "iga/assembly/assembler.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/solve/static_system.h"
#include "rom/member_geometry.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

iga::Validity validity_of(const iga::MultiPatch<3>& geometry) {
    iga::Validity worst = iga::Validity::valid;
    for (const auto& patch : geometry.patches) {
        worst = std::max(worst, iga::certify(patch).validity);
    }
    return worst;
}

}  // namespace

RomExtremes extremes_of(const rom::FieldSamples& samples) {
    RomExtremes extremes;
    extremes.displacement = samples.displacements.colwise().norm().maxCoeff();
    Eigen::Index worst = 0;
    extremes.von_mises = samples.von_mises.maxCoeff(&worst);
    extremes.von_mises_at = samples.points.col(worst);
    return extremes;
}

rom::FieldSampler answer_sampler(const rom::ReducedModel& model) {
    return {model.space(), rom::make_sample_grids(*model.space(), rom::SampleRegion::volume)};
}

RomAnswer answer_at(const TrainedModel& trained, const VectorX& point,
                    const rom::FieldSampler& sampler) {
    const rom::ReducedModel& model = trained.model();
    const io::Deck deck = trained.deck_at(point);
    RomAnswer answer;
    const Timer timer;
    answer.evaluation = model.evaluate(point);
    if (!trained.is_geometry_only()) {
        answer.extremes = extremes_of(sampler.sample(answer.evaluation.control_points,
                                                     answer.evaluation.displacement, deck.problem));
    }
    answer.seconds = timer.seconds();
    answer.errors = model.errors(point);
    const iga::MultiPatch<3> member = model.member(answer.evaluation);
    answer.validity = validity_of(member);
    if (answer.validity != iga::Validity::valid) {
        log::warn(fmt::format("the predicted geometry is {}", iga::to_string(answer.validity)));
    }
    answer.volume = iga::volume(member);
    return answer;
}

void require_deck(const TrainedModel& trained, const std::string& option) {
    const fs::path deck = trained.deck_path();
    if (deck.empty() || !fs::exists(deck)) {
        throw InputError(
            "{}: {} needs the deck that the model was trained by, {}, which is not there any more",
            trained.path().string(), option, deck.string());
    }
}

FullSolution solve_in_full(const TrainedModel& trained, const VectorX& point,
                           const std::string& option) {
    require_deck(trained, option);
    RomSamples samples(trained.deck_path(), trained.overrides());
    io::SnapshotStore store(trained.path().parent_path() / "snapshots", samples.job());
    const auto reference = samples.make_reference(store);
    const auto member = samples.make_member(point, store);
    return {rom::to_field(*reference, member->geometry()), samples.solve(member, {point}).col(0)};
}

PredictionErrors errors_against(const TrainedModel& trained, const FullSolution& full,
                                const rom::Evaluation& predicted, const iga::Problem& problem,
                                const rom::FieldSampler& sampler) {
    const rom::ReducedModel& model = trained.model();
    return measure_prediction(rom::mode_product(*model.space(), model.parts().options.product),
                              sampler, problem, full.control_points, full.displacement,
                              predicted.control_points, predicted.displacement);
}

std::vector<std::string> write_answer(const TrainedModel& trained, const RomAnswer& answer,
                                      fs::path folder, bool has_picture) {
    io::Deck deck = trained.deck_at(answer.evaluation.point);
    deck.path = trained.path();
    deck.output.vtu = true;
    deck.output.png = has_picture;
    const auto space =
        std::make_shared<const iga::Space<3>>(trained.model().member(answer.evaluation));
    iga::LinearStaticResult<3> result;
    result.cases.emplace_back();
    result.cases.back().displacement = {space, iga::unflatten(answer.evaluation.displacement, 3)};
    const GeometryCertificate certificate{answer.validity, 0.0, 0};
    if (folder.empty()) folder = fs::path("out") / trained.path().stem();
    std::vector<std::string> files;
    for (const fs::path& file : write_result_files<3>(deck, space, result, certificate, folder)) {
        files.push_back(file.string());
    }
    return files;
}

}  // namespace couture::drivers
