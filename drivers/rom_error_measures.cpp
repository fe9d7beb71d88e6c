#include "drivers/rom_error_measures.h"

#include <algorithm>
#include <cmath>

namespace couture::drivers {

namespace {

double norm(const rom::InnerProduct& product, const VectorX& field) {
    return std::sqrt(std::max(product.squared_norms(field)[0], 0.0));
}

// Of the nodes.
double largest_length(const VectorX& field) {
    return field.reshaped(3, field.size() / 3).colwise().norm().maxCoeff();
}

VectorX about_centroid(const VectorX& positions) {
    const MatrixX points = positions.reshaped(3, positions.size() / 3);
    const Vector3 centroid = points.rowwise().mean();
    return (points.colwise() - centroid).reshaped();
}

double ratio(double error, double size) { return size > 0.0 ? error / size : error; }

}  // namespace

double displacement_error(const rom::InnerProduct& product, const VectorX& displacement,
                          const VectorX& predicted) {
    return ratio(norm(product, predicted - displacement), norm(product, displacement));
}

double geometry_error(const rom::InnerProduct& product, const VectorX& control_points,
                      const VectorX& predicted) {
    return ratio(norm(product, predicted - control_points),
                 norm(product, about_centroid(control_points)));
}

PredictionErrors measure_prediction(const rom::InnerProduct& product,
                                    const rom::FieldSampler& sampler, const iga::Problem& problem,
                                    const VectorX& control_points, const VectorX& displacement,
                                    const VectorX& predicted_control_points,
                                    const VectorX& predicted_displacement) {
    PredictionErrors errors;
    const VectorX du = predicted_displacement - displacement;
    errors.displacement = displacement_error(product, displacement, predicted_displacement);
    errors.displacement_max = ratio(largest_length(du), largest_length(displacement));
    const VectorX dx = predicted_control_points - control_points;
    errors.geometry = geometry_error(product, control_points, predicted_control_points);
    errors.geometry_max =
        ratio(largest_length(dx), 2.0 * largest_length(about_centroid(control_points)));
    if (displacement.isZero(0.0) && predicted_displacement.isZero(0.0)) return errors;
    const VectorX full = sampler.sample(control_points, displacement, problem).von_mises;
    const VectorX predicted =
        sampler.sample(predicted_control_points, predicted_displacement, problem).von_mises;
    errors.von_mises = ratio((predicted - full).norm(), full.norm());
    errors.von_mises_max = ratio(std::abs(predicted.maxCoeff() - full.maxCoeff()), full.maxCoeff());
    return errors;
}

}  // namespace couture::drivers
