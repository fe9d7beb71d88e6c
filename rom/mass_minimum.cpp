#include "rom/mass_minimum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "iga/core/error.h"
#include "rom/bounded_minimum.h"
#include "rom/constrained_minimum.h"
#include "rom/designs.h"
#include "rom/smooth_maximum.h"

namespace couture::rom {

namespace {

/// Parts of a limit by which violations are told apart.
constexpr double same_violation = 1e-9;
/// Smooth maxima exceed the largest value by log(n) over these.
constexpr std::array<double, 3> sharpnesses = {30.0, 300.0, 3000.0};

LimitedMeasure limited(const VectorX& values, const MatrixX& gradients, double limit,
                       double sharpness) {
    const VectorX ratios = values / limit;
    const SmoothMaximum smooth = smooth_maximum(ratios, sharpness);
    return {ratios.maxCoeff(), {smooth.value, gradients.transpose() * smooth.weights / limit}};
}

/// Of what stresses depend on; loads do not matter to them.
bool has_other_stresses(const iga::Problem& one, const iga::Problem& other) {
    for (std::size_t i = 0; i < one.materials.size(); ++i) {
        const iga::Material& a = one.materials[i];
        const iga::Material& b = other.materials[i];
        if (a.hyperelastic || a.stiffness != b.stiffness ||
            a.thermal_expansion != b.thermal_expansion) {
            return true;
        }
    }
    return !one.temperatures.empty();
}

/// A search in the unit cube of the free parameters.
class FreeSearch {
  public:
    FreeSearch(const MemberMeasures& measures, const VectorX& point, const std::vector<int>& free,
               const MassLimits& limits)
        : measures_(measures),
          space_(measures.model().parameters()),
          unit_(space_.to_unit(point)),
          free_(free),
          limits_(limits),
          mass_scale_(measures.at(point, {}, {}, 1.0).mass.value) {}

    [[nodiscard]] VectorX point(const VectorX& x) const {
        VectorX unit = unit_;
        unit(free_) = x;
        return space_.from_unit(unit);
    }

    [[nodiscard]] MassSearch run(const VectorX& start) const {
        int n_evaluations = 0;
        VectorX x = minimum(start, n_evaluations);
        if (violation(x) > mass_tolerance) {
            x = least_violation(x, n_evaluations);
            if (violation(x) < 0.0) x = minimum(x, n_evaluations);
        }
        MassSearch search;
        search.start = point(start);
        search.point = point(x);
        search.violation = violation(x);
        search.n_evaluations = n_evaluations;
        const auto at = measures_.at(search.point, limits_, {}, 1.0);
        search.mass = at.mass.value;
        if (at.von_mises) search.von_mises = at.von_mises->largest * *limits_.von_mises;
        if (at.displacement) search.displacement = at.displacement->largest * *limits_.displacement;
        return search;
    }

  private:
    [[nodiscard]] VectorX to_unit_gradient(const VectorX& gradient) const {
        VectorX scaled(free_.size());
        for (std::size_t i = 0; i < free_.size(); ++i) {
            const Parameter& one = space_.parameters()[free_[i]];
            scaled[static_cast<Eigen::Index>(i)] = gradient[free_[i]] * (one.upper - one.lower);
        }
        return scaled;
    }

    /// Mass and limits with gradients in the unit cube.
    [[nodiscard]] VectorX functions(const VectorX& x, double sharpness, MatrixX& gradients) const {
        const auto at = measures_.at(point(x), limits_, free_, sharpness);
        std::vector<double> values = {at.mass.value / mass_scale_};
        std::vector<VectorX> columns = {to_unit_gradient(at.mass.gradient) / mass_scale_};
        for (const auto& one : {at.von_mises, at.displacement}) {
            if (!one) continue;
            values.push_back(one->smooth.value - 1.0);
            columns.push_back(to_unit_gradient(one->smooth.gradient));
        }
        gradients.resize(x.size(), static_cast<Eigen::Index>(columns.size()));
        for (std::size_t i = 0; i < columns.size(); ++i) {
            gradients.col(static_cast<Eigen::Index>(i)) = columns[i];
        }
        return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
    }

    [[nodiscard]] VectorX minimum(VectorX x, int& n_evaluations) const {
        for (const double sharpness : sharpnesses) {
            const ConstrainedMinimum found = constrained_minimum(
                [&](const VectorX& at, MatrixX& gradients) {
                    return functions(at, sharpness, gradients);
                },
                x, VectorX::Zero(x.size()), VectorX::Ones(x.size()), mass_tolerance);
            x = found.x;
            n_evaluations += found.n_evaluations;
        }
        return x;
    }

    [[nodiscard]] VectorX least_violation(VectorX x, int& n_evaluations) const {
        for (const double sharpness : sharpnesses) {
            x = bounded_minimum(
                    [&](const VectorX& at, VectorX& gradient) {
                        ++n_evaluations;
                        MatrixX gradients;
                        const VectorX values = functions(at, sharpness, gradients);
                        const Eigen::Index n = values.size() - 1;
                        const SmoothMaximum worst = smooth_maximum(values.tail(n), sharpness);
                        gradient = gradients.rightCols(n) * worst.weights;
                        return worst.value;
                    },
                    x, VectorX::Zero(x.size()), VectorX::Ones(x.size()), same_violation)
                    .x;
        }
        return x;
    }

    /// Of the largest values themselves.
    [[nodiscard]] double violation(const VectorX& x) const {
        const auto at = measures_.at(point(x), limits_, {}, 1.0);
        return std::max(at.von_mises ? at.von_mises->largest : 0.0,
                        at.displacement ? at.displacement->largest : 0.0) -
               1.0;
    }

    const MemberMeasures& measures_;
    const ParameterSpace& space_;
    VectorX unit_;
    const std::vector<int>& free_;
    const MassLimits& limits_;
    double mass_scale_;
};

void check(const std::vector<int>& free, const MassLimits& limits, const MassOptions& options) {
    if (!limits.von_mises && !limits.displacement) {
        throw InputError("minimize_mass: there is no limit; give one of stress or displacement");
    }
    for (const std::optional<double>& limit : {limits.von_mises, limits.displacement}) {
        if (limit && !(*limit > 0.0 && std::isfinite(*limit))) {
            throw InputError("minimize_mass: a limit of {}; it must be positive", *limit);
        }
    }
    if (free.empty()) {
        throw InputError("minimize_mass: no parameter is free to change");
    }
    if (options.n_starts < 1) {
        throw InputError("minimize_mass: {} starts; there must be at least 1", options.n_starts);
    }
}

}  // namespace

MemberMeasures::MemberMeasures(const ReducedModel& model, ProblemOf problem_of, VectorX densities,
                               const std::vector<SampleGrid>& grids)
    : model_(model),
      problem_of_(std::move(problem_of)),
      densities_(std::move(densities)),
      volume_(model.space()),
      sampler_(model.space(), grids) {
    if (densities_.size() != model.space()->n_patches()) {
        throw InputError("MemberMeasures: {} densities for {} patches", densities_.size(),
                         model.space()->n_patches());
    }
}

std::vector<std::optional<ProblemChange>> MemberMeasures::changes(
    const VectorX& point, const iga::Problem& problem, const std::vector<int>& columns) const {
    constexpr double part_of_range = 1e-5;
    std::vector<std::optional<ProblemChange>> changes(point.size());
    for (const int i : columns) {
        const Parameter& one = model_.parameters().parameters()[i];
        if (one.group == ParameterGroup::geometry && problem.temperatures.empty()) {
            continue;
        }
        ProblemChange change{part_of_range * (one.upper - one.lower), {}, {}};
        VectorX moved = point;
        moved[i] = point[i] - change.step;
        change.below = problem_of_(moved);
        moved[i] = point[i] + change.step;
        change.above = problem_of_(moved);
        if (has_other_stresses(change.below, change.above)) {
            changes[i] = std::move(change);
        }
    }
    return changes;
}

MemberMeasures::At MemberMeasures::at(const VectorX& point, const MassLimits& limits,
                                      const std::vector<int>& columns, double sharpness) const {
    const Evaluation evaluation = model_.evaluate(point);
    At at;
    at.mass.value = densities_.dot(volume_.values(evaluation.control_points));
    at.mass.gradient = VectorX::Zero(point.size());
    EvaluationGradient gradient;
    if (!columns.empty()) {
        gradient = model_.gradient(point);
        at.mass.gradient(columns) =
            volume_.changes(evaluation.control_points, gradient.control_points(Eigen::all, columns))
                .transpose() *
            densities_;
    }
    if (!limits.von_mises && !limits.displacement) {
        return at;
    }
    const iga::Problem problem = problem_of_(point);
    const SampleGradients samples =
        sampler_.sample(evaluation, gradient, problem, changes(point, problem, columns), columns);
    if (limits.von_mises) {
        at.von_mises =
            limited(samples.von_mises, samples.von_mises_gradient, *limits.von_mises, sharpness);
    }
    if (limits.displacement) {
        at.displacement = limited(samples.displacement, samples.displacement_gradient,
                                  *limits.displacement, sharpness);
    }
    return at;
}

MassMinimum minimize_mass(const MemberMeasures& measures, const VectorX& point,
                          const std::vector<int>& free, const MassLimits& limits,
                          const MassOptions& options) {
    check(free, limits, options);
    const FreeSearch search(measures, point, free, limits);
    const auto n = static_cast<int>(free.size());
    MatrixX starts(options.n_starts, n);
    starts.row(0) = measures.model().parameters().to_unit(point)(free).transpose();
    if (options.n_starts > 1) {
        starts.bottomRows(options.n_starts - 1) =
            latin_hypercube_design(n, options.n_starts - 1, options.seed);
    }
    MassMinimum result;
    for (int i = 0; i < options.n_starts; ++i) {
        result.searches.push_back(search.run(starts.row(i).transpose()));
        const MassSearch& best = result.searches[result.best];
        const MassSearch& now = result.searches.back();
        const bool is_feasible = now.violation <= mass_tolerance;
        if (is_feasible == result.is_feasible
                ? (is_feasible ? now.mass < best.mass : now.violation < best.violation)
                : is_feasible) {
            result.best = i;
        }
        result.is_feasible = result.is_feasible || is_feasible;
    }
    return result;
}

}  // namespace couture::rom
