#include "rom/procrustes.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

Vector3 centroid(const MatrixX& points) { return points.colwise().mean().transpose(); }

/// SVD of the covariance of points and target around their centroids.
Eigen::JacobiSVD<Matrix<3>> covariance_svd(const MatrixX& points, const MatrixX& target) {
    const MatrixX from = points.rowwise() - centroid(points).transpose();
    const MatrixX to = target.rowwise() - centroid(target).transpose();
    const Matrix<3> covariance = from.transpose() * to;
    return Eigen::JacobiSVD<Matrix<3>>(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

void check(const std::vector<MatrixX>& shapes, const AlignmentOptions& options) {
    if (shapes.empty() || shapes.front().rows() == 0) {
        throw InputError("align_population: {} members of {} points; there must be one of one",
                         shapes.size(), shapes.empty() ? 0 : shapes.front().rows());
    }
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        if (shapes[j].rows() != shapes[0].rows() || shapes[j].cols() != 3) {
            throw InputError(
                "align_population: member {} has {} x {} coordinates, member 0 {} x 3; all must "
                "have the same points",
                j, shapes[j].rows(), shapes[j].cols(), shapes[0].rows());
        }
        if (!shapes[j].allFinite()) {
            throw InputError("align_population: member {} has coordinates that are not finite", j);
        }
        if (options.alignment == Alignment::similarity && !(shape_size(shapes[j]) > 0.0)) {
            throw InputError(
                "align_population: all points of member {} are one; it cannot be scaled", j);
        }
    }
    const int n_members = static_cast<int>(shapes.size());
    if (options.reference && (*options.reference < 0 || *options.reference >= n_members)) {
        throw InputError("align_population: reference {}; members are 0 to {}", *options.reference,
                         n_members - 1);
    }
}

/// What gives each member the mean of all sizes; 1 where sizes are shape.
std::vector<double> common_scales(const std::vector<MatrixX>& shapes, Alignment alignment) {
    std::vector<double> scales(shapes.size(), 1.0);
    if (alignment != Alignment::similarity) return scales;
    double mean = 0.0;
    for (const MatrixX& shape : shapes) mean += shape_size(shape) / shapes.size();
    for (std::size_t j = 0; j < shapes.size(); ++j) scales[j] = mean / shape_size(shapes[j]);
    return scales;
}

MatrixX mean_of(const std::vector<MatrixX>& shapes) {
    MatrixX mean = shapes.front();
    for (std::size_t j = 1; j < shapes.size(); ++j) mean += shapes[j];
    return mean / static_cast<double>(shapes.size());
}

/// Of equal distances (but for rounding) the first.
int nearest_to_mean(const AlignedPopulation& population) {
    constexpr double rounding = 1e-12;
    int best = 0;
    double least = rms_distance(population.shapes[0], population.mean);
    for (std::size_t j = 1; j < population.shapes.size(); ++j) {
        const double distance = rms_distance(population.shapes[j], population.mean);
        if (distance < least * (1.0 - rounding)) {
            best = static_cast<int>(j);
            least = distance;
        }
    }
    return best;
}

void iterate(const std::vector<MatrixX>& shapes, const AlignmentOptions& options,
             AlignedPopulation& population) {
    const std::vector<double> scales = common_scales(shapes, options.alignment);
    population.mean = scales[0] * shapes[0];
    population.has_converged = false;
    for (int i = 0; i < options.max_iterations && !population.has_converged; ++i) {
        for (std::size_t j = 0; j < shapes.size(); ++j) {
            population.motions[j] = fit_rigid(shapes[j], population.mean, scales[j]);
            population.shapes[j] = population.motions[j].apply(shapes[j]);
        }
        const MatrixX mean = mean_of(population.shapes);
        const double change = rms_distance(mean, population.mean);
        population.mean = mean;
        population.n_iterations = i + 1;
        // Coordinates far from the origin are no more exact than this.
        const double rounding = 1e-15 * mean.cwiseAbs().maxCoeff();
        population.has_converged =
            change <= std::max(options.tolerance * shape_size(mean), rounding);
    }
}

/// Moves the whole population to where the reference was given.
void move_to_reference(const std::vector<MatrixX>& shapes, AlignedPopulation& population) {
    const Similarity back = population.motions[population.reference].inverse();
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        population.motions[j] = static_cast<int>(j) == population.reference
                                    ? Similarity()
                                    : back.after(population.motions[j]);
        population.shapes[j] = population.motions[j].apply(shapes[j]);
    }
    population.mean = mean_of(population.shapes);
}

}  // namespace

MatrixX Similarity::apply(const MatrixX& points) const {
    return (scale * points * rotation.transpose()).rowwise() + translation.transpose();
}

Similarity Similarity::after(const Similarity& other) const {
    return {rotation * other.rotation, scale * other.scale,
            scale * (rotation * other.translation) + translation};
}

Similarity Similarity::inverse() const {
    const Matrix<3> back = rotation.transpose();
    return {back, 1.0 / scale, -(back * translation) / scale};
}

double rms_distance(const MatrixX& a, const MatrixX& b) {
    return (a - b).norm() / std::sqrt(static_cast<double>(a.rows()));
}

double shape_size(const MatrixX& points) {
    return (points.rowwise() - centroid(points).transpose()).norm() /
           std::sqrt(static_cast<double>(points.rows()));
}

Similarity fit_rigid(const MatrixX& points, const MatrixX& target, double scale) {
    const auto svd = covariance_svd(points, target);
    Vector3 signs = Vector3::Ones();
    signs[2] = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    Similarity motion;
    motion.rotation = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
    motion.scale = scale;
    motion.translation = centroid(target) - scale * (motion.rotation * centroid(points));
    return motion;
}

bool fits_mirrored(const MatrixX& points, const MatrixX& target) {
    MatrixX mirrored = points;
    mirrored.col(0) *= -1.0;
    const double as_it_is = rms_distance(fit_rigid(points, target).apply(points), target);
    const double as_image = rms_distance(fit_rigid(mirrored, target).apply(mirrored), target);
    return as_image < 0.5 * as_it_is;
}

AlignedPopulation align_population(const std::vector<MatrixX>& shapes,
                                   const AlignmentOptions& options) {
    check(shapes, options);
    AlignedPopulation population;
    population.shapes = shapes;
    population.motions.resize(shapes.size());
    if (options.alignment == Alignment::none) {
        population.mean = mean_of(shapes);
        population.reference = options.reference.value_or(nearest_to_mean(population));
        return population;
    }
    iterate(shapes, options, population);
    population.reference = options.reference.value_or(nearest_to_mean(population));
    move_to_reference(shapes, population);
    return population;
}

}  // namespace couture::rom
