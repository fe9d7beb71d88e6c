#pragma once

#include <map>
#include <vector>

#include "meshing/layout/cap_pattern.h"

namespace couture::meshing {

/// What a candidate for a patch puts on one of the patch's cuts.
struct CutDemand {
    int cut = 0;
    CapPattern pattern;
    /// For each node of the pattern's loop where it lies on the cut: any number that means the same
    /// place on both sides, as a position along the curve.
    std::vector<int> places;
};

/// A template for a patch, with its caps laid on the patch's boundaries.
struct TemplateCandidate {
    double cost = 0.0;
    /// One for each boundary that is a cut, in any order; two where the patch meets itself.
    std::vector<CutDemand> cuts;
};

struct TemplateChoice {
    /// For each patch the number of its candidate.
    std::vector<int> candidates;
    double cost = 0.0;
    /// For each cut how its two caps match: that of the smaller patch is the first, or that which
    /// the candidate names first.
    std::map<int, int> rotations;
};

/// At which rotation two demands match, nodes on nodes at the same places; -1 if at none.
[[nodiscard]] int matching_rotation(const CutDemand& first, const CutDemand& second);

/// One candidate for each patch so that patterns and places agree on all cuts, at the least sum of
/// costs; the first found of several. Backtracking: candidates without a partner across a cut are
/// dropped after each decision, and branches that can't cost less than the best so far are left.
///
/// @param candidates  for each patch; those of one patch all name the same cuts
/// @throws InputError     if a patch has no candidates, a cut does not have two sides or places are
///                        not as many as nodes
/// @throws TopologyError  if nothing fits; names the cut and its patches
[[nodiscard]] TemplateChoice choose_templates(
    const std::vector<std::vector<TemplateCandidate>>& candidates);

}  // namespace couture::meshing
