#include "drivers/rom_learning_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "iga/core/error.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

double mean_error(const rom::ReducedModel& model, bool is_geometry_only,
                  const std::vector<SolvedPoint>& solved) {
    const rom::InnerProduct product =
        rom::mode_product(*model.space(), model.parts().options.product);
    std::vector<double> errors;
    for (const SolvedPoint& full : solved) {
        const rom::Evaluation evaluation = model.evaluate(full.point);
        errors.push_back(
            is_geometry_only
                ? geometry_error(product, full.control_points, evaluation.control_points)
                : displacement_error(product, full.displacement, evaluation.displacement));
    }
    return statistics_of(errors).mean;
}

}  // namespace

std::vector<int> space_filling_order(const MatrixX& points) {
    const Eigen::Index n = points.rows();
    if (n == 0) return {};
    constexpr double middle = 0.5;
    Eigen::Index next = 0;
    (points.array() - middle).matrix().rowwise().squaredNorm().minCoeff(&next);
    VectorX distance = VectorX::Constant(n, std::numeric_limits<double>::infinity());
    std::vector<int> order;
    while (true) {
        order.push_back(static_cast<int>(next));
        distance[next] = -1.0;
        if (order.size() == static_cast<std::size_t>(n)) return order;
        for (Eigen::Index i = 0; i < n; ++i) {
            distance[i] = std::min(distance[i], (points.row(i) - points.row(next)).squaredNorm());
        }
        distance.maxCoeff(&next);
    }
}

rom::SnapshotSet part_of(const rom::SnapshotSet& snapshots, const std::vector<int>& geometries) {
    rom::SnapshotSet part = snapshots;
    part.geometry_points = snapshots.geometry_points(geometries, Eigen::all);
    part.control_points = snapshots.control_points(Eigen::all, geometries);
    const int n_mechanics = snapshots.n_mechanics();
    std::vector<int> columns;
    for (const int g : geometries) {
        for (int m = 0; m < n_mechanics; ++m) columns.push_back(g * n_mechanics + m);
    }
    part.displacements = snapshots.displacements(Eigen::all, columns);
    return part;
}

std::vector<LearningPoint> learning_curve(const TrainedModel& trained,
                                          const rom::SnapshotSet& snapshots,
                                          const std::vector<SolvedPoint>& solved,
                                          const Validation& validation) {
    const bool is_geometry_only = trained.is_geometry_only();
    std::vector<int> accepted = rom::accepted_columns(snapshots.control_points);
    const std::vector<int> order =
        space_filling_order(snapshots.geometry_points(accepted, Eigen::all));
    std::vector<int> geometries;
    for (const int i : order) geometries.push_back(accepted[i]);
    const auto n = static_cast<int>(geometries.size());
    std::vector<LearningPoint> curve;
    constexpr int n_parts = 4;
    for (int k = 1; k < n_parts; ++k) {
        const int n_taken = n * k / n_parts;
        if (n_taken < 2 || (!curve.empty() && curve.back().n_geometries == n_taken)) continue;
        try {
            const rom::ReducedModel model(
                part_of(snapshots, {geometries.begin(), geometries.begin() + n_taken}),
                trained.model().parts().options);
            curve.push_back({n_taken, mean_error(model, is_geometry_only, solved)});
        } catch (const InputError& error) {
            log::detail(fmt::format("rom: no model of {} geometries: {}", n_taken, error.what()));
        }
    }
    const auto measure =
        is_geometry_only ? &PredictionErrors::geometry : &PredictionErrors::displacement;
    curve.push_back({n, statistics_of(validation.errors(measure)).mean});
    return curve;
}

}  // namespace couture::drivers
