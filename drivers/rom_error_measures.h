#pragma once

#include "iga/mechanics/problem.h"
#include "rom/field_sampler.h"
#include "rom/inner_product.h"

namespace couture::drivers {

/// A member predicted by a reduced model beside its full solution. Norms of control points and
/// displacements are those of the model's modes (L2 on the reference member, or Euclidean).
struct PredictionErrors {
    /// |u - u_rom| / |u|, and the largest |u - u_rom| at a node over the largest |u|.
    double displacement = 0.0;
    double displacement_max = 0.0;
    /// |x - x_rom| over |x - centroid|, and the largest distance over the size of the member.
    double geometry = 0.0;
    double geometry_max = 0.0;
    /// Root mean square over the sample points, over that of the full solution; and the
    /// difference of the largest values over the full one.
    double von_mises = 0.0;
    double von_mises_max = 0.0;
};

/// PredictionErrors::displacement, and PredictionErrors::geometry.
[[nodiscard]] double displacement_error(const rom::InnerProduct& product,
                                        const VectorX& displacement, const VectorX& predicted);
[[nodiscard]] double geometry_error(const rom::InnerProduct& product, const VectorX& control_points,
                                    const VectorX& predicted);

/// @param control_points, displacement  of the full solution, 3 n_nodes numbers
/// @param predicted_control_points, predicted_displacement  of the model
[[nodiscard]] PredictionErrors measure_prediction(
    const rom::InnerProduct& product, const rom::FieldSampler& sampler, const iga::Problem& problem,
    const VectorX& control_points, const VectorX& displacement,
    const VectorX& predicted_control_points, const VectorX& predicted_displacement);

}  // namespace couture::drivers
