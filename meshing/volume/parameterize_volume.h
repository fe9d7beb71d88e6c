#pragma once

#include "iga/topology/element_quality.h"
#include "iga/topology/jacobian_certificate.h"

namespace couture::meshing {

struct ParameterizationOptions {
    /// Rounds of L-BFGS steps at most; 0 only unfolds.
    int max_rounds = 8;
    int steps_per_round = 12;
    /// Rounds at most that unfold a start.
    int max_untangling_rounds = 20;
    /// A round that lowers the energy by less than this part ends the measure.
    double tolerance = 0.01;
};

struct ParameterizationReport {
    double min_scaled_jacobian_before = 0.0;
    double min_scaled_jacobian_after = 0.0;
    int rounds = 0;
    int untangling_rounds = 0;
    /// The worst of all patches, and the first patch that has it.
    iga::Validity validity = iga::Validity::valid;
    int worst_patch = 0;
    /// Smallest Bernstein coefficient of det J of all patches.
    double min_coefficient = 0.0;
};

struct ParameterizedVolume {
    iga::MultiPatch<3> volume;
    ParameterizationReport report;
};

/// The same body with all control points moved that lie on no outer side, shared ones as one.
/// Elements tend to boxes with the proportions of their patch's mean edges: minimises the
/// ShapeEnergy with growing power; a folded start is first unfolded with a regularised measure. Of
/// the states passed the one with the largest minimum of the scaled Jacobian is returned among
/// those whose certificate is valid; elements of which a certificate proves nothing are sampled
/// densely from then on, also between the corners of their edges and faces, and if that leaves no
/// state unfolded it is done again from the best; so it is where elements of the result are worse
/// between their samples than at any. If none gets valid, the best: see the report.
///
/// Patches must be right-handed in intent: det J is to become positive. Results do not depend on
/// the number of threads.
///
/// @throws InputError  for options out of range
[[nodiscard]] ParameterizedVolume parameterize_volume(const iga::MultiPatch<3>& start,
                                                      const ParameterizationOptions& options = {});

}  // namespace couture::meshing
