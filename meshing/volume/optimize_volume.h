#pragma once

#include "meshing/volume/boundary_features.h"

namespace couture::meshing {

struct VolumeOptimizationOptions {
    /// Rounds at most; each does up to `steps_per_round` steps of L-BFGS and puts the boundary
    /// back.
    int max_rounds = 20;
    int steps_per_round = 15;
    /// A round that lowers the last energy by less than this part ends the optimisation.
    double tolerance = 1e-3;
    /// False: the boundary stays as it is.
    bool slide_boundary = true;
    /// The elements at re-entrant edges stay as they are: deformations are singular there, and a
    /// field on elements that moved there could not be carried over.
    bool hold_reentrant_edges = true;
    /// Largest distance that a curved boundary may move away from the old one, in parts of the
    /// body's size: rounds that go farther are done again with shorter steps.
    double boundary_tolerance = 0.01;
};

/// Quality of the elements; shape ratios and mean ratios at their corners and Gauss points.
struct VolumeQuality {
    double max_shape_ratio = 0.0;
    double min_scaled_jacobian = 0.0;
    /// Smallest 1 / mean ratio: 1 for cubes, negative where folded.
    double min_inverse_mean_ratio = 0.0;
};

struct VolumeOptimizationReport {
    VolumeQuality before;
    VolumeQuality after;
    /// Rounds accepted, of which `untangling_rounds` unfolded the start.
    int rounds = 0;
    int untangling_rounds = 0;
    /// Mean of (mean ratio)^2 over the elements (see ShapeEnergy), infinite for folded ones.
    double energy_before = 0.0;
    double energy_after = 0.0;
    /// Largest distance between the old boundary and the new one, sampled in both directions on
    /// curved faces and curves (plane ones are kept exactly).
    double boundary_distance = 0.0;
    /// (new - old) / old.
    double volume_change = 0.0;
};

struct OptimizedVolume {
    iga::MultiPatch<3> volume;
    VolumeOptimizationReport report;
};

/// The same body in better elements: inner control points move freely, those of faces and feature
/// curves along them, corners stay. Patches, knots, weights, interfaces and sets are kept. Where
/// det J of `deformed` is certified (see iga::certify), so is that of the result.
///
/// Elements tend to cubes of any size: minimises the ShapeEnergy by L-BFGS in the tangent space of
/// the boundary, with growing powers and the elements' shape ratio; a folded start is first
/// unfolded with a regularised measure. Of all states passed the one with the smallest worst shape
/// ratio is returned among those whose worst scaled Jacobian is not smaller than that of the start
/// by more than 3 %: perhaps the start itself. Results do not depend on the number of threads.
///
/// @param deformed  a state of the body from which `features` were found
/// @throws TopologyError  if the signature is not that of the features
/// @throws InputError     for options out of range
/// @throws GeometryError  if a folded start stays folded: names patch, place and value
[[nodiscard]] OptimizedVolume optimize_volume(const iga::MultiPatch<3>& deformed,
                                              const BoundaryFeatures& features,
                                              const VolumeOptimizationOptions& options = {});

}  // namespace couture::meshing
