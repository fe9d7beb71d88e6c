#include "meshing/volume/optimize_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/topology/jacobian_certificate.h"
#include "meshing/volume/boundary_slide.h"
#include "meshing/volume/shape_descent.h"
#include "meshing/volume/volume_points.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Far from the optimum a small power of the plain mean ratio converges in few steps; then shape
/// ratios near the aim and above it count, so that the others do not suffer for the worst.
constexpr std::array<ShapeMeasure, 4> measures{{{.power = 2},
                                                {.power = 4, .shape_ratio_power = 8},
                                                {.power = 4, .shape_ratio_power = 16},
                                                {.power = 4, .shape_ratio_power = 32}}};
/// The aim: this part of the start's worst shape ratio, but not below `good_shape_ratio`.
constexpr double aimed_shape_ratio = 0.6;
constexpr double good_shape_ratio = 2.0;
/// What is reported as energy.
constexpr ShapeMeasure reported_measure{.power = 2, .shape_ratio_weight = 0.0};
/// All but the last need not be minimised exactly.
constexpr double first_tolerance = 0.02;
/// Part of the start's worst scaled Jacobian that must be left: it is often that of the angle
/// between two faces, and falls a little wherever elements are not at right angles to the edge.
constexpr double kept_scaled_jacobian = 0.97;
/// Part of the elements' size that points of curved features move per round, and below which these
/// are held.
constexpr double max_slide = 0.3;
constexpr double min_slide = 0.01;
/// Regularisation of a folded start, halved after each round down to the last.
constexpr double first_regularization = 0.5;
constexpr double last_regularization = 1e-3;
/// Keeps elements from shrinking while they unfold.
constexpr double size_weight = 0.2;
/// A sample counts as unfolded above this inverse mean ratio.
constexpr double unfolded = 1e-6;

/// The worst certificate of all patches, or the first that is worse than degenerate.
iga::Validity validity(const MultiPatch<3>& volume) {
    iga::Validity worst = iga::Validity::valid;
    for (const iga::Volume& patch : volume.patches) {
        worst = std::max(worst, iga::certify<3>(patch).validity);
        if (worst > iga::Validity::degenerate) {
            break;
        }
    }
    return worst;
}

/// State of the minimisation.
class Minimizer {
  public:
    Minimizer(const ShapeEnergy& energy, const BoundarySlide& slide,
              const BoundaryFeatures& features, const VolumeOptimizationOptions& options,
              double body_size)
        : energy_(energy),
          descent_(energy),
          slide_(slide),
          features_(features),
          options_(options),
          max_distance_(options.boundary_tolerance * body_size) {}

    /// Starts with another measure.
    void start(const MatrixX& points, const ShapeMeasure& measure) {
        points_ = points;
        value_ = energy_.value(points, measure);
        descent_.start(points, measure);
        reach_ = max_slide;
    }

    [[nodiscard]] const MatrixX& points() const { return points_; }

    /// One round; the part by which the energy fell, nothing if no step lowers it.
    std::optional<double> round() {
        while (true) {
            const bool holds_curved = reach_ < min_slide;
            MatrixX moved = slid(holds_curved);
            if (slide_.has_curved() && options_.slide_boundary && !holds_curved) {
                moved = slide_.retracted(moved);
            }
            const double value = energy_.value(moved, descent_.measure());
            if (value < value_ && slide_.distance(moved, 1) <= max_distance_) {
                const double decrease = (value_ - value) / value_;
                value_ = value;
                points_ = std::move(moved);
                return decrease;
            }
            if (holds_curved || !slide_.has_curved() || !options_.slide_boundary) {
                return std::nullopt;
            }
            reach_ *= 0.3;
            descent_.forget();
        }
    }

  private:
    [[nodiscard]] TangentFrames frames(bool holds_curved) const {
        TangentFrames result = slide_.frames(points_);
        for (int i = 0; i < points_.cols(); ++i) {
            if (options_.hold_reentrant_edges && features_.is_near_reentrant_edge(i)) {
                result.set(i, Freedom::fixed, Vector3::Zero());
            } else if (features_.freedom(i) != Freedom::interior &&
                       (!options_.slide_boundary || (holds_curved && slide_.is_curved(i)))) {
                result.set(i, Freedom::fixed, Vector3::Zero());
            }
        }
        return result;
    }

    /// Largest part of `step` that keeps curved features within reach of where they were.
    [[nodiscard]] double longest_slide(const MatrixX& from, const MatrixX& step) const {
        double result = 1.0;
        for (int i = 0; i < step.cols(); ++i) {
            if (slide_.is_curved(i)) {
                const double left =
                    reach_ * descent_.sizes()[i] - (from.col(i) - points_.col(i)).norm();
                result = std::min(result, std::max(left, 0.0) / step.col(i).norm());
            }
        }
        return result;
    }

    MatrixX slid(bool holds_curved) {
        return descent_.descend(
            points_, frames(holds_curved), options_.steps_per_round,
            [&](const MatrixX& from, const MatrixX& step) { return longest_slide(from, step); });
    }

    const ShapeEnergy& energy_;
    ShapeDescent descent_;
    const BoundarySlide& slide_;
    const BoundaryFeatures& features_;
    const VolumeOptimizationOptions& options_;
    double max_distance_;
    MatrixX points_;
    double value_ = infinity;
    double reach_ = max_slide;
};

void check_options(const VolumeOptimizationOptions& options) {
    if (options.max_rounds < 0 || options.steps_per_round < 1) {
        throw InputError(
            "optimize_volume: max_rounds = {} and steps_per_round = {}; there must be at least 0 "
            "rounds of 1 step",
            options.max_rounds, options.steps_per_round);
    }
    if (!(options.tolerance >= 0.0) || !(options.boundary_tolerance > 0.0)) {
        throw InputError(
            "optimize_volume: tolerance = {} and boundary_tolerance = {}; the first must not be "
            "negative, the second positive",
            options.tolerance, options.boundary_tolerance);
    }
}

/// Rounds with a regularised measure until no sample is folded.
void unfold(ShapeEnergy& energy, Minimizer& minimizer, const MatrixX& start, int max_rounds,
            VolumeOptimizationReport& report) {
    energy.set_reference(start);
    MatrixX points = start;
    double regularization = first_regularization;
    ShapeSummary worst = energy.summary(points);
    for (int i = 0; i < max_rounds && worst.min_inverse_mean_ratio < unfolded; ++i) {
        minimizer.start(points,
                        {.power = 1, .regularization = regularization, .size_weight = size_weight});
        report.untangling_rounds += minimizer.round() ? 1 : 0;
        points = minimizer.points();
        worst = energy.summary(points);
        regularization = std::max(0.5 * regularization, last_regularization);
    }
    if (worst.min_inverse_mean_ratio < unfolded) {
        throw GeometryError(
            "optimize_volume: patch {} is folded at xi = ({:.4g}, {:.4g}, {:.4g}), det J / |J|^3 * "
            "3 sqrt(3) = {:.3g}, and {} rounds did not unfold it; it must be positive. Remesh "
            "earlier, or mend the boundary there",
            worst.patch, worst.xi[0], worst.xi[1], worst.xi[2], worst.min_inverse_mean_ratio,
            max_rounds);
    }
    report.rounds += report.untangling_rounds;
}

VolumeQuality quality(const ShapeSummary& summary) {
    return {.max_shape_ratio = summary.max_shape_ratio,
            .min_scaled_jacobian = summary.min_scaled_jacobian,
            .min_inverse_mean_ratio = summary.min_inverse_mean_ratio};
}

}  // namespace

OptimizedVolume optimize_volume(const MultiPatch<3>& deformed, const BoundaryFeatures& features,
                                const VolumeOptimizationOptions& options) {
    check_options(options);
    if (iga::signature(deformed) != features.signature()) {
        throw TopologyError(
            "optimize_volume: the volume has signature {}, the features {}; both must come from "
            "the same initial body",
            iga::signature(deformed), features.signature());
    }
    const iga::DofMap& dofs = features.dofs();
    std::vector<int> orientations;
    orientations.reserve(deformed.patches.size());
    for (int p = 0; p < deformed.n_patches(); ++p) {
        orientations.push_back(features.orientation(p));
    }
    const MatrixX start = points_of(deformed, dofs);
    ShapeEnergy energy(deformed, dofs, orientations);
    const BoundarySlide slide(deformed, features);
    Minimizer minimizer(energy, slide, features, options, deformed.size());

    OptimizedVolume result{deformed, {}};
    VolumeOptimizationReport& report = result.report;
    const ShapeSummary summary = energy.summary(start);
    report.before = quality(summary);
    report.energy_before = energy.value(start, reported_measure);

    // All accepted states that are no worse than the start.
    struct State {
        MatrixX points;
        double shape_ratio;
    };
    std::vector<State> states;
    const auto keep = [&](const MatrixX& state) {
        const ShapeSummary found = energy.summary(state);
        const double least = kept_scaled_jacobian * summary.min_scaled_jacobian;
        if (found.min_scaled_jacobian >= least && found.max_shape_ratio < infinity) {
            states.push_back({state, found.max_shape_ratio});
        }
    };
    MatrixX points = start;
    if (summary.min_inverse_mean_ratio < unfolded) {
        unfold(energy, minimizer, start, options.max_rounds, report);
        points = minimizer.points();
        keep(points);
    }
    const double aim =
        std::max(aimed_shape_ratio * std::min(summary.max_shape_ratio, 1e3), good_shape_ratio);
    for (std::size_t i = 0; i < measures.size(); ++i) {
        ShapeMeasure measure = measures[i];
        measure.shape_ratio_weight =
            i > 0 ? std::pow(std::numbers::sqrt3 / aim, measure.shape_ratio_power) : 0.0;
        const bool is_last = i + 1 == measures.size();
        if (energy.value(points, measure) == infinity) {
            measure.shape_ratio_weight = 0.0;
        }
        minimizer.start(points, measure);
        while (report.rounds < options.max_rounds) {
            const std::optional<double> decrease = minimizer.round();
            if (!decrease) {
                break;
            }
            ++report.rounds;
            keep(minimizer.points());
            if (*decrease < (is_last ? options.tolerance : first_tolerance)) {
                break;
            }
        }
        points = minimizer.points();
    }

    // The best by shape ratio whose certificate holds, or is as good as that of the start, which
    // comes last.
    std::stable_sort(states.begin(), states.end(),
                     [](const State& a, const State& b) { return a.shape_ratio < b.shape_ratio; });
    while (summary.min_inverse_mean_ratio >= unfolded && !states.empty() &&
           states.back().shape_ratio >= summary.max_shape_ratio) {
        states.pop_back();
    }
    states.push_back({start, summary.max_shape_ratio});
    // A certificate costs as much as some rounds, and neighbours share their fate: in growing
    // steps.
    bool is_found = false;
    std::size_t step = 1;
    for (std::size_t i = 0; i < states.size() && !is_found; step *= 2) {
        points = states[i].points;
        result.volume = with_points(deformed, dofs, points);
        const iga::Validity found = validity(result.volume);
        is_found = found == iga::Validity::valid ||
                   (found == iga::Validity::degenerate && validity(deformed) >= found);
        i = i + 1 == states.size() ? states.size() : std::min(i + step, states.size() - 1);
    }
    if (!is_found) {
        throw GeometryError(
            "optimize_volume: det J is positive at all samples, but the certificate of no state is "
            "valid; refine the volume, or remesh earlier");
    }

    report.after = quality(energy.summary(points));
    report.energy_after = energy.value(points, reported_measure);
    const double old_volume = iga::volume(deformed);
    report.volume_change = (iga::volume(result.volume) - old_volume) / old_volume;
    if (slide.has_curved() && options.slide_boundary) {
        report.boundary_distance = std::max(
            slide.distance(points, 2), BoundarySlide(result.volume, features).distance(start, 2));
    }
    return result;
}

}  // namespace couture::meshing
