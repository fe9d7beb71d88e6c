#pragma once

#include <vector>

#include "drivers/rom_validation.h"
#include "rom/snapshots.h"

namespace couture::drivers {

/// Positions of points in an order whose every beginning fills the space: first the one nearest the
/// middle of the unit cube, then again and again the one farthest from all before it.
///
/// @param points  n x parameters, in the unit cube
[[nodiscard]] std::vector<int> space_filling_order(const MatrixX& points);

/// Some geometries with all their solutions. @param geometries  positions
[[nodiscard]] rom::SnapshotSet part_of(const rom::SnapshotSet& snapshots,
                                       const std::vector<int>& geometries);

/// Mean errors of the displacement (of the geometry if the model has no other field) of models that
/// learn from a quarter, half and three quarters of the geometries, then of the model itself. Parts
/// that are too few for a model are left out.
///
/// @param snapshots   that the model learned from
/// @param solved      that all models are compared with
/// @param validation  of the model itself
[[nodiscard]] std::vector<LearningPoint> learning_curve(const TrainedModel& trained,
                                                        const rom::SnapshotSet& snapshots,
                                                        const std::vector<SolvedPoint>& solved,
                                                        const Validation& validation);

}  // namespace couture::drivers
