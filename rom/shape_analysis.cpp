#include "rom/shape_analysis.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "rom/pod.h"

namespace couture::rom {

namespace {

// Variation below this part of the coordinates is rounding.
constexpr double rounding = 1e-12;

/// x1 y1 z1 x2 ..., Eq. (1.15).
VectorX to_vector(const MatrixX& points) {
    const MatrixX columns = points.transpose();
    return Eigen::Map<const VectorX>(columns.data(), columns.size());
}

MatrixX to_points(const VectorX& vector) {
    return Eigen::Map<const MatrixX>(vector.data(), 3, vector.size() / 3).transpose();
}

MatrixX deviations(const AlignedPopulation& population) {
    MatrixX columns(population.mean.size(), population.shapes.size());
    for (std::size_t j = 0; j < population.shapes.size(); ++j) {
        columns.col(static_cast<Eigen::Index>(j)) =
            to_vector(population.shapes[j] - population.mean);
    }
    return columns;
}

double largest_norm(const std::vector<MatrixX>& shapes) {
    double norm = 0.0;
    for (const MatrixX& shape : shapes) norm = std::max(norm, shape.norm());
    return norm;
}

std::vector<int> find_mirrored(const AlignedPopulation& population) {
    std::vector<int> members;
    for (std::size_t j = 0; j < population.shapes.size(); ++j) {
        if (fits_mirrored(population.shapes[j], population.mean)) {
            members.push_back(static_cast<int>(j));
        }
    }
    return members;
}

Similarity motion_to(const ShapeModel& model, const MatrixX& points) {
    if (model.alignment == Alignment::none) return {};
    const double size = shape_size(points);
    if (model.alignment == Alignment::similarity && !(size > 0.0)) {
        throw InputError("project_shape: all points are one; the shape cannot be scaled");
    }
    // The size that all members of the model have: squares of mean and variation add up.
    const MatrixX& a = model.coefficients;
    const double common =
        std::sqrt(std::pow(shape_size(model.mean), 2) +
                  a.squaredNorm() / static_cast<double>(model.n_members() * model.n_points()));
    const double scale = model.alignment == Alignment::similarity ? common / size : 1.0;
    return fit_rigid(points, model.mean, scale);
}

std::vector<NearMember> nearest_members(const ShapeModel& model, const VectorX& coefficients) {
    constexpr std::size_t n_nearest = 3;
    std::vector<NearMember> members;
    for (int j = 0; j < model.n_members(); ++j) {
        const VectorX own = model.coefficients.col(j).head(coefficients.size());
        members.push_back({j, (own - coefficients).norm() / std::sqrt(model.n_points())});
    }
    std::ranges::stable_sort(members, {}, &NearMember::distance);
    members.resize(std::min(members.size(), n_nearest));
    return members;
}

}  // namespace

ShapeModel make_shape_model(const std::vector<MatrixX>& shapes, const AlignmentOptions& options) {
    if (shapes.size() < 2) {
        throw InputError("make_shape_model: {} members; a population has 2 or more", shapes.size());
    }
    const AlignedPopulation population = align_population(shapes, options);
    const MatrixX columns = deviations(population);
    const PodBasis basis =
        make_pod_basis(columns, InnerProduct(3), {.n_modes = static_cast<int>(shapes.size()) - 1});
    const double least = rounding * largest_norm(shapes);
    const auto n_modes =
        std::min(basis.modes.cols(), (basis.singular_values.array() > least).count());
    if (n_modes == 0) {
        throw InputError(
            "make_shape_model: the {} members are equal{}; there is no variation to be analysed",
            shapes.size(), options.alignment == Alignment::none ? "" : " but for their places");
    }
    ShapeModel model;
    model.alignment = options.alignment;
    model.mean = population.mean;
    model.modes = basis.modes.leftCols(n_modes);
    model.coefficients = model.modes.transpose() * columns;
    model.standard_deviations =
        basis.singular_values.head(n_modes) / std::sqrt(static_cast<double>(shapes.size() - 1));
    model.motions = population.motions;
    model.reference = population.reference;
    model.n_iterations = population.n_iterations;
    model.has_converged = population.has_converged;
    if (options.alignment != Alignment::none) model.mirrored_members = find_mirrored(population);
    return model;
}

ShapeProjection project_shape(const ShapeModel& model, const MatrixX& points, int n_modes) {
    if (points.rows() != model.n_points() || points.cols() != 3 || !points.allFinite()) {
        throw InputError(
            "project_shape: {} x {} coordinates; the population has {} x 3, and all are finite",
            points.rows(), points.cols(), model.n_points());
    }
    if (n_modes < 1 || n_modes > model.n_modes()) {
        throw InputError("project_shape: {} modes; there are 1 to {}", n_modes, model.n_modes());
    }
    ShapeProjection projection;
    projection.motion = motion_to(model, points);
    const MatrixX moved = projection.motion.apply(points);
    const auto modes = model.modes.leftCols(n_modes);
    projection.coefficients = modes.transpose() * to_vector(moved - model.mean);
    projection.scores =
        projection.coefficients.cwiseQuotient(model.standard_deviations.head(n_modes));
    projection.points = virtual_member(model, projection.coefficients);
    projection.distance = rms_distance(moved, projection.points);
    projection.max_distance = (moved - projection.points).rowwise().norm().maxCoeff();
    projection.distance_to_mean = rms_distance(moved, model.mean);
    projection.nearest = nearest_members(model, projection.coefficients);
    return projection;
}

MatrixX virtual_member(const ShapeModel& model, const VectorX& coefficients) {
    if (coefficients.size() > model.n_modes() || !coefficients.allFinite()) {
        throw InputError(
            "virtual_member: {} coefficients; there are {} modes, and all coefficients must be "
            "finite",
            coefficients.size(), model.n_modes());
    }
    return model.mean + to_points(model.modes.leftCols(coefficients.size()) * coefficients);
}

MatrixX mode_shape(const ShapeModel& model, int i_mode) {
    return to_points(model.modes.col(i_mode));
}

}  // namespace couture::rom
