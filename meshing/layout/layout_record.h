#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshing/layout/layout_choice.h"
#include "meshing/layout/patch_sketch.h"
#include "meshing/layout/volumetric_layout.h"
#include "meshing/topology/pants_record.h"

namespace couture::meshing {

/// What was decided of a layout on one member of a family, to be repeated on the others.
struct LayoutRecord {
    struct Patch {
        std::string shape;
        TemplateMatch match;
        /// What it was laid on.
        PatchSketch features;
    };
    /// In the order of the decomposition.
    std::vector<Patch> patches;
    /// For each cut, see TemplateChoice.
    std::map<int, int> rotations;
    /// For each curve that no sharp edge meets: where its first node lies.
    std::map<int, Vector3> starts;
    /// Of each sheet of cuboids, in the order of LayoutCells::sheets; empty until they are chosen.
    std::vector<int> elements;
    /// The same before a tolerance asked for more: these divide elements of the wanted shape, so
    /// that the others stay where they are. Empty: as `elements`.
    std::vector<int> base_elements;
    /// How nodes are placed, see NodeRelocationOptions::area_part; decided with the elements.
    double area_part = 0.0;
    /// Of the volumetric layout.
    std::map<std::string, std::vector<CuboidSide>> sets;
};

/// All that was decided on one member of a family.
struct MemberRecord {
    PantsRecord pants;
    /// Nothing: it was only cut.
    std::optional<LayoutRecord> layout;
};

/// Without elements and sets.
[[nodiscard]] LayoutRecord record_layout(const SurfaceMesh& opened,
                                         const std::vector<PatchFeatures>& patches,
                                         const LayoutChoice& choice);

/// The record with all places moved.
[[nodiscard]] LayoutRecord carry_over(LayoutRecord record,
                                      const std::function<Vector3(const Vector3&)>& move);

/// The recorded choice, for another member.
///
/// @param record   carried over to that member
/// @param patches  in the order of the record; their features are brought into its order, loops
///                 without feature nodes begin near the recorded starts
/// @throws TopologyError  if there are other patches, or their features don't match (names the
///                        patch, see match_sketches)
[[nodiscard]] LayoutChoice repeat_choice(const SurfaceMesh& opened, const LayoutRecord& record,
                                         std::vector<PatchFeatures>& patches);

}  // namespace couture::meshing
