#include "meshing/volume/shape_descent.h"

#include <algorithm>

namespace couture::meshing {

namespace {

/// Part of the elements' size that a control point moves per step, and the shortest step worth it.
constexpr double max_step = 0.5;
constexpr double min_length = 0.01;
/// Of the first step along the gradient.
constexpr double first_step = 0.1;
/// Armijo's condition: the part of the linear decrease asked for.
constexpr double sufficient_decrease = 1e-4;
constexpr int max_halvings = 20;

}  // namespace

void ShapeDescent::start(const MatrixX& points, const ShapeMeasure& measure) {
    measure_ = measure;
    sizes_ = energy_.sizes(points);
    memory_.clear();
}

double ShapeDescent::longest_step(const MatrixX& step) const {
    double result = 1.0;
    for (int i = 0; i < step.cols(); ++i) {
        result = std::min(result, max_step * sizes_[i] / step.col(i).norm());
    }
    return result;
}

MatrixX ShapeDescent::direction(const MatrixX& gradient, const TangentFrames& tangents) const {
    MatrixX step = memory_.direction(gradient.reshaped()).reshaped(3, gradient.cols());
    tangents.project(step);
    if (memory_.is_empty()) {
        const double largest = step.colwise().norm().maxCoeff();
        step *= largest > 0.0 ? first_step / largest : 0.0;
    }
    return step;
}

MatrixX ShapeDescent::descend(MatrixX points, const TangentFrames& tangents, int n_steps,
                              const StepLimit& limit) {
    const auto scaled_gradient = [&](MatrixX gradient) {
        tangents.project(gradient);
        gradient *= sizes_.asDiagonal();
        return gradient;
    };
    EnergyGradient here = energy_.with_gradient(points, measure_);
    MatrixX gradient = scaled_gradient(std::move(here.gradient));
    for (int i = 0; i < n_steps; ++i) {
        MatrixX step = direction(gradient, tangents);
        double slope = step.cwiseProduct(gradient).sum();
        if (!(slope < 0.0)) {
            memory_.clear();
            step = direction(gradient, tangents);
            slope = step.cwiseProduct(gradient).sum();
        }
        if (!(slope < 0.0)) break;
        const MatrixX change = step * sizes_.asDiagonal();
        double length = longest_step(change);
        if (limit) length = std::min(length, limit(points, change));
        if (length < min_length) break;
        bool is_lower = false;
        for (int k = 0; k < max_halvings && !is_lower; ++k) {
            MatrixX next = points + length * change;
            EnergyGradient there = energy_.with_gradient(next, measure_);
            is_lower = there.value <= here.value + sufficient_decrease * length * slope;
            if (is_lower) {
                MatrixX next_gradient = scaled_gradient(std::move(there.gradient));
                memory_.add(length * step.reshaped(), (next_gradient - gradient).reshaped());
                points = std::move(next);
                gradient = std::move(next_gradient);
                here.value = there.value;
            } else {
                length *= 0.5;
            }
        }
        if (!is_lower) break;
    }
    return points;
}

}  // namespace couture::meshing
