#include "meshing/layout/layout_record.h"

#include "iga/core/error.h"

namespace couture::meshing {

LayoutRecord record_layout(const SurfaceMesh& opened, const std::vector<PatchFeatures>& patches,
                           const LayoutChoice& choice) {
    LayoutRecord record;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        record.patches.push_back(
            {choice.templates[p], choice.matches[p], sketch_patch(opened, patches[p])});
    }
    record.rotations = choice.rotations;
    return record;
}

LayoutRecord carry_over(LayoutRecord record, const std::function<Vector3(const Vector3&)>& move) {
    for (LayoutRecord::Patch& patch : record.patches) {
        for (PatchSketch::Node& node : patch.features.nodes) node.place = move(node.place);
        for (PatchSketch::Curve& curve : patch.features.curves) curve.middle = move(curve.middle);
    }
    return record;
}

LayoutChoice repeat_choice(const SurfaceMesh& opened, const LayoutRecord& record,
                           std::vector<PatchFeatures>& patches) {
    if (patches.size() != record.patches.size()) {
        throw TopologyError(
            "layout: {} patches, but the recorded one has {}; cut this member as "
            "the reference was",
            patches.size(), record.patches.size());
    }
    LayoutChoice choice;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const LayoutRecord::Patch& recorded = record.patches[p];
        try {
            const SketchMatch match =
                match_sketches(recorded.features, sketch_patch(opened, patches[p]));
            patches[p] = in_order_of(recorded.features, match, patches[p]);
        } catch (const TopologyError& error) {
            throw TopologyError("layout: patch {}: {}", p, error.what());
        }
        choice.templates.push_back(recorded.shape);
        choice.matches.push_back(recorded.match);
    }
    choice.rotations = record.rotations;
    return choice;
}

}  // namespace couture::meshing
