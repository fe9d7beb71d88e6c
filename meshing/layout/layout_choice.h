#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/patch_features.h"
#include "meshing/layout/template_match.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

/// What determines a layout before it is drawn.
struct LayoutChoice {
    /// For each patch the name of its template, and how that is laid on it.
    std::vector<std::string> templates;
    std::vector<TemplateMatch> matches;
    /// For each cut how its two caps match, see TemplateChoice.
    std::map<int, int> rotations;
};

/// Templates for all patches that fit their features, and each other across the cuts, at the least
/// sum of costs.
///
/// @param opened  with numbers of features and of the decomposition's curves on its edges
/// @throws TopologyError  if no template fits a patch (names the patch, how many feature curves and
///                        corners it has, and the templates that there are), or if no choice fits
///                        across the cuts
///
/// Source: [Maquart19] Sec. 3.2.3, 3.3.2.
[[nodiscard]] LayoutChoice choose_layout(const SurfaceMesh& opened,
                                         const std::vector<PatchFeatures>& patches,
                                         const PantsDecomposition& pants,
                                         const TemplateLibrary& library,
                                         const MatchOptions& options = {});

}  // namespace couture::meshing
