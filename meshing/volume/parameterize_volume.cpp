#include "meshing/volume/parameterize_volume.h"

#include <algorithm>
#include <array>

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
/// A sample counts as unfolded above this inverse mean ratio.
constexpr double unfolded = 1e-6;
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
        unfold(report);
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
        return best(report);
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
            descent_.start(points_, {.power = 1, .regularization = regularization});
            points_ = descent_.descend(points_, tangents_, options_.steps_per_round);
            ++report.untangling_rounds;
            (void)keep();
            regularization = std::max(0.5 * regularization, last_regularization);
        }
    }

    // Certificates cost as much as some rounds: the first valid one in the order of the states ends
    // the search.
    ParameterizedVolume best(ParameterizationReport report) {
        std::stable_sort(states_.begin(), states_.end(), [](const State& a, const State& b) {
            return a.min_scaled_jacobian > b.min_scaled_jacobian;
        });
        std::optional<ParameterizedVolume> result;
        for (const State& state : states_) {
            if (result && state.min_scaled_jacobian <= 0.0) break;
            ParameterizedVolume found{with_points(start_, dofs_, state.points), report};
            certify(found);
            found.report.min_scaled_jacobian_after = state.min_scaled_jacobian;
            const bool is_better = !result || found.report.validity < result->report.validity;
            if (is_better) result = std::move(found);
            if (result->report.validity <= iga::Validity::degenerate) break;
        }
        return std::move(*result);
    }

    static void certify(ParameterizedVolume& found) {
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
        }
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
};

}  // namespace

ParameterizedVolume parameterize_volume(const MultiPatch<3>& start,
                                        const ParameterizationOptions& options) {
    check_options(options);
    return Parameterizer(start, options).run();
}

}  // namespace couture::meshing
