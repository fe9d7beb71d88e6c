#include "meshing/volume/parameterize_volume.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "iga/core/error.h"
#include "iga/topology/dof_map.h"
#include "meshing/volume/shape_descent.h"
#include "meshing/volume/volume_points.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

/// Far from the optimum a small power converges in few steps, then the worst elements count.
constexpr std::array<int, 3> powers{2, 4, 8};
/// Regularisation of a folded start, halved after each round down to the last.
constexpr double first_regularization = 0.5;
constexpr double last_regularization = 1e-3;
/// Keeps elements from shrinking while they unfold.
constexpr double size_weight = 0.2;
/// A sample counts as unfolded above this inverse mean ratio.
constexpr double unfolded = 1e-6;
/// States that are unfolded at all samples, but not between them, start again with more samples,
/// as do those whose scaled Jacobian falls below this part of their minimum between them.
constexpr int max_attempts = 4;
constexpr double hidden_part = 0.9;
/// Boxes are no flatter than this: thin layers may have more even elements.
constexpr double max_aspect = 20.0;

void check_options(const ParameterizationOptions& options) {
    if (options.max_rounds < 0 || options.steps_per_round < 1 ||
        options.max_untangling_rounds < 0 || !(options.tolerance >= 0.0)) {
        throw InputError(
            "parameterize_volume: max_rounds = {}, steps_per_round = {}, max_untangling_rounds = "
            "{}, tolerance = {}; none must be negative, and steps at least 1",
            options.max_rounds, options.steps_per_round, options.max_untangling_rounds,
            options.tolerance);
    }
}

// Mean length of an element's edges per direction, along the control polygons of the patch's edges.
Vector3 box_of(const iga::Volume& patch) {
    Vector3 box;
    for (int k = 0; k < 3; ++k) {
        double length = 0.0;
        for (const auto& edge : iga::entities_of_patch<3>(0, 1)) {
            if (edge.position[k] != iga::End::free) continue;
            const auto functions = iga::functions_on<3>(patch.space(), edge.position);
            for (std::size_t i = 1; i < functions.size(); ++i) {
                length += (patch.control_points().row(functions[i]) -
                           patch.control_points().row(functions[i - 1]))
                              .norm();
            }
        }
        box[k] = length / (4.0 * patch.knots(k).n_elements());
    }
    return box.cwiseMax(box.maxCoeff() / max_aspect);
}

class Parameterizer {
  public:
    Parameterizer(const MultiPatch<3>& start, const ParameterizationOptions& options)
        : start_(start),
          options_(options),
          dofs_(iga::make_dof_map<3>(start, spaces_of(start))),
          points_(points_of(start, dofs_)),
          energy_(start, dofs_, std::vector<int>(start.patches.size(), 1), boxes_of(start), 0),
          judge_(start, dofs_, std::vector<int>(start.patches.size(), 1), boxes_of(start)),
          descent_(energy_),
          tangents_(dofs_.n_dofs) {
        for (const auto& side : start.outer_sides()) {
            for (const int function :
                 iga::functions_on<3>(start.patches[side.patch].space(), side.position)) {
                tangents_.set(dofs_.global[side.patch][function], Freedom::fixed, Vector3::Zero());
            }
        }
    }

    ParameterizedVolume run() {
        ParameterizationReport report;
        report.min_scaled_jacobian_before = keep();
        for (int attempt = 0; attempt < max_attempts; ++attempt) {
            unfold(report);
            improve(report);
            const bool has_learnt = choose(report);
            if (is_proven(result_->report) ? !see_between_samples() : !has_learnt) break;
            points_ = states_.front().points;
            (void)keep();
        }
        result_->report.rounds = report.rounds;
        result_->report.untangling_rounds = report.untangling_rounds;
        return std::move(*result_);
    }

  private:
    struct State {
        MatrixX points;
        double min_scaled_jacobian = 0.0;
    };

    static std::vector<iga::TensorSpace<3>> spaces_of(const MultiPatch<3>& volume) {
        std::vector<iga::TensorSpace<3>> spaces;
        for (const auto& patch : volume.patches) spaces.push_back(patch.space());
        return spaces;
    }
    static std::vector<Vector3> boxes_of(const MultiPatch<3>& volume) {
        std::vector<Vector3> boxes;
        for (const auto& patch : volume.patches) boxes.push_back(box_of(patch));
        return boxes;
    }

    // Records the present state; its smallest scaled Jacobian.
    double keep() {
        const ShapeSummary summary = judge_.summary(points_);
        min_inverse_mean_ratio_ = summary.min_inverse_mean_ratio;
        states_.push_back({points_, summary.min_scaled_jacobian});
        return summary.min_scaled_jacobian;
    }

    [[nodiscard]] bool is_unfolded() const { return min_inverse_mean_ratio_ >= unfolded; }

    void unfold(ParameterizationReport& report) {
        energy_.set_reference(points_);
        double regularization = first_regularization;
        while (!is_unfolded() && report.untangling_rounds < options_.max_untangling_rounds) {
            descent_.start(
                points_,
                {.power = 1, .regularization = regularization, .size_weight = size_weight});
            points_ = descent_.descend(points_, tangents_, options_.steps_per_round);
            ++report.untangling_rounds;
            (void)keep();
            regularization = std::max(0.5 * regularization, last_regularization);
        }
    }

    void improve(ParameterizationReport& report) {
        for (std::size_t i = 0; i < powers.size() && is_unfolded(); ++i) {
            const ShapeMeasure measure{.power = powers[i]};
            descent_.start(points_, measure);
            double value = energy_.value(points_, measure);
            for (int round = 0; round < options_.max_rounds; ++round) {
                points_ = descent_.descend(points_, tangents_, options_.steps_per_round);
                ++report.rounds;
                (void)keep();
                const double next = energy_.value(points_, measure);
                if (!(next < (1.0 - options_.tolerance) * value)) break;
                value = next;
            }
        }
    }

    // Certifies states, the best first, until one is proven. Elements of which nothing is proven
    // get more samples, by which all states are judged again; whether it took such to find that no
    // state is unfolded.
    bool choose(const ParameterizationReport& report) {
        for (bool has_learnt = false;; has_learnt = true) {
            std::ranges::stable_sort(states_, std::greater{}, &State::min_scaled_jacobian);
            const State& best = states_.front();
            ParameterizedVolume found{with_points(start_, dofs_, best.points), report};
            found.report.min_scaled_jacobian_after = best.min_scaled_jacobian;
            const bool has_new_samples = certify(found);
            if (!result_ || is_better(found.report, result_->report)) result_ = std::move(found);
            if (is_proven(result_->report) || best.min_scaled_jacobian <= 0.0 || !has_new_samples) {
                return has_learnt;
            }
            judge_again();
        }
    }

    void judge_again() {
        for (State& state : states_) {
            state.min_scaled_jacobian = judge_.summary(state.points).min_scaled_jacobian;
        }
    }

    // Gives more samples to the elements that are worse between theirs than the result is said to
    // be; whether there are any.
    bool see_between_samples() {
        const MatrixX points = points_of(result_->volume, dofs_);
        double& least = result_->report.min_scaled_jacobian_after;
        const auto elements = judge_.elements_below(points, hidden_part * least);
        bool has_new_samples = false;
        for (std::size_t p = 0; p < elements.size(); ++p) {
            (void)energy_.sample_densely(static_cast<int>(p), elements[p]);
            has_new_samples =
                judge_.sample_densely(static_cast<int>(p), elements[p]) || has_new_samples;
        }
        if (!has_new_samples) return false;
        least = judge_.summary(points).min_scaled_jacobian;
        judge_again();
        std::ranges::stable_sort(states_, std::greater{}, &State::min_scaled_jacobian);
        return true;
    }

    static bool is_proven(const ParameterizationReport& report) {
        return report.validity <= iga::Validity::degenerate;
    }
    static bool is_better(const ParameterizationReport& a, const ParameterizationReport& b) {
        return a.validity < b.validity ||
               (a.validity == b.validity &&
                a.min_scaled_jacobian_after > b.min_scaled_jacobian_after);
    }

    // Whether elements of which nothing is proven get samples that they did not have.
    bool certify(ParameterizedVolume& found) {
        bool has_new_samples = false;
        auto& report = found.report;
        for (int p = 0; p < found.volume.n_patches(); ++p) {
            const auto certificate = iga::certify<3>(found.volume.patches[p]);
            // A patch that is left-handed all over lies inside out.
            const auto validity =
                certificate.orientation > 0 ? certificate.validity : iga::Validity::folded;
            const double coefficient = certificate.orientation * certificate.min_coefficient;
            if (p == 0 || coefficient < report.min_coefficient) {
                report.min_coefficient = coefficient;
            }
            if (p == 0 || validity > report.validity) {
                report.validity = validity;
                report.worst_patch = p;
            }
            (void)energy_.sample_densely(p, certificate.unproven);
            has_new_samples = judge_.sample_densely(p, certificate.unproven) || has_new_samples;
        }
        return has_new_samples;
    }

    const MultiPatch<3>& start_;
    const ParameterizationOptions& options_;
    iga::DofMap dofs_;
    MatrixX points_;
    /// At few points, for speed; and at all, for what is kept.
    ShapeEnergy energy_;
    ShapeEnergy judge_;
    ShapeDescent descent_;
    TangentFrames tangents_;
    std::vector<State> states_;
    double min_inverse_mean_ratio_ = 0.0;
    /// The best of those certified.
    std::optional<ParameterizedVolume> result_;
};

}  // namespace

ParameterizedVolume parameterize_volume(const MultiPatch<3>& start,
                                        const ParameterizationOptions& options) {
    check_options(options);
    return Parameterizer(start, options).run();
}

}  // namespace couture::meshing
