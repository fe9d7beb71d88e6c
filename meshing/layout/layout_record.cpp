#include "meshing/layout/layout_record.h"

#include <algorithm>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// Turns a loop to begin at its vertex nearest to the recorded place; both sides of a cut find the
// same one.
void begin_near(const SurfaceMesh& opened, const LayoutRecord& record, PatchFeatures::Loop& loop) {
    const auto start = record.starts.find(loop.side.curve);
    if (start == record.starts.end()) {
        throw TopologyError(
            "layout: curve {} has no start in the record; there a sharp edge met it",
            loop.side.curve);
    }
    const auto nearest = std::ranges::min_element(loop.vertices, {}, [&](VertexHandle v) {
        return std::pair((opened.point(v) - start->second).norm(), v.idx());
    });
    std::ranges::rotate(loop.vertices, nearest);
}

}  // namespace

LayoutRecord record_layout(const SurfaceMesh& opened, const std::vector<PatchFeatures>& patches,
                           const LayoutChoice& choice) {
    LayoutRecord record;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        record.patches.push_back(
            {choice.templates[p], choice.matches[p], sketch_patch(opened, patches[p])});
        for (const PatchFeatures::Loop& loop : patches[p].loops) {
            if (!loop.nodes.empty()) continue;
            record.starts[loop.side.curve] = opened.point(loop.vertices[0]);
        }
    }
    record.rotations = choice.rotations;
    return record;
}

LayoutRecord carry_over(LayoutRecord record, const std::function<Vector3(const Vector3&)>& move) {
    for (LayoutRecord::Patch& patch : record.patches) {
        for (PatchSketch::Node& node : patch.features.nodes) node.place = move(node.place);
        for (PatchSketch::Curve& curve : patch.features.curves) curve.middle = move(curve.middle);
    }
    for (auto& [curve, place] : record.starts) place = move(place);
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
        for (PatchFeatures::Loop& loop : patches[p].loops) {
            if (loop.nodes.empty()) begin_near(opened, record, loop);
        }
        choice.templates.push_back(recorded.shape);
        choice.matches.push_back(recorded.match);
    }
    choice.rotations = record.rotations;
    return choice;
}

}  // namespace couture::meshing
