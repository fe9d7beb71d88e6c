#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "iga/topology/field.h"
#include "rom/field_part.h"
#include "rom/kriging_inputs.h"
#include "rom/snapshots.h"

namespace couture::rom {

enum class BasisKind {
    separate,  ///< modes of control points minus the reference member's, and modes of displacements
    stacked    ///< modes of both in one vector, each scaled by its root mean square
};

/// How displacements of all sizes are learned.
enum class Amplitude {
    none,      ///< as they are
    automatic  ///< where all point alike: of unit length, and the logarithm of their length
};

/// What modes are orthonormal in.
enum class ModeProduct {
    l2,        ///< the mass matrix of the reference member
    euclidean  ///< the numbers at the nodes
};

struct ReducedModelOptions {
    BasisKind basis = BasisKind::separate;
    ModeProduct product = ModeProduct::l2;
    /// Of separate bases.
    Amplitude amplitude = Amplitude::automatic;
    /// Of each basis, as in PodOptions.
    std::optional<int> n_modes = std::nullopt;
    double tolerance = 0.0;
    KrigingOptions kriging = {};
};

/// The product of displacements and of control points of a family.
///
/// @param reference  the reference member's own functions
[[nodiscard]] InnerProduct mode_product(const iga::Space<3>& reference, ModeProduct product);

/// All that a reduced model is made of, for files.
struct ReducedModelParts {
    ParameterSpace parameters;
    std::vector<int> factor_power;
    VectorX reference_point;
    iga::MultiPatch<3> reference;
    ReducedModelOptions options;
    /// Geometry and displacement, or both stacked (6 values at each node).
    std::vector<FieldModel> models;
    FieldPart geometry;
    FieldPart displacement;
    Calibration calibration;
    /// Logarithm of the displacement's length, which its model's fields are multiplied by; nothing:
    /// these are the displacements.
    std::optional<CoefficientModel> amplitude = std::nullopt;
};

/// Values at a point. Fields as in SnapshotSet, units of the deck.
struct Evaluation {
    /// Of all parameters.
    VectorX point;
    /// Coefficients of geometry modes and displacement modes; one vector twice if stacked. The
    /// displacement's are those at the reference values of the factored parameters.
    VectorX geometry_coefficients;
    VectorX displacement_coefficients;
    /// Of the factored parameters and the amplitude: the displacement is this times that of its
    /// coefficients.
    double factor = 1.0;
    VectorX control_points;
    VectorX displacement;
    /// By how much of its range the worst parameter is outside of it; 0 inside.
    double distance_outside = 0.0;
};

/// Several points at once: a column for each.
struct EvaluationBatch {
    MatrixX control_points;
    MatrixX displacements;
};

/// Derivatives by the parameters in units of the deck: 3 n_nodes x n_parameters.
struct EvaluationGradient {
    MatrixX control_points;
    MatrixX displacement;
};

/// Geometry and displacement of a part as functions of parameters, learned from full solutions.
///
/// Source: [Maquart19] Sec. 7.2. Differs: by default geometry and displacement have modes of their
/// own, intensities and moduli that the displacement is proportional to are factored exactly, and
/// where displacements point alike their length, which varies most, is learned by its logarithm.
class ReducedModel {
  public:
    /// @throws InputError  as `check` of the snapshots, make_pod_basis and Kriging
    ReducedModel(const SnapshotSet& snapshots, const ReducedModelOptions& options);
    /// @throws InputError  for parts that do not fit together
    explicit ReducedModel(ReducedModelParts parts);

    [[nodiscard]] const ReducedModelParts& parts() const { return parts_; }
    [[nodiscard]] const ParameterSpace& parameters() const { return parts_.parameters; }
    [[nodiscard]] int n_nodes() const { return space_->n_dofs(); }
    /// What the kriging of a field model sees of the parameters.
    [[nodiscard]] const KrigingInputs& kriging_inputs(int i_model) const {
        return inputs_[i_model];
    }
    /// Of the reference member: the functions that all members share.
    [[nodiscard]] const iga::SpacePtr<3>& space() const { return space_; }
    /// Factors of the error estimates, from validation.
    void set_calibration(const Calibration& calibration) { parts_.calibration = calibration; }

    /// @param point  a value for each parameter, units of the deck
    /// @throws InputError  for another number of values, or one that is not finite
    [[nodiscard]] Evaluation evaluate(const VectorX& point) const;
    /// @param points  n_points x n_parameters
    [[nodiscard]] EvaluationBatch evaluate_batch(const MatrixX& points) const;
    [[nodiscard]] EvaluationGradient gradient(const VectorX& point) const;
    [[nodiscard]] ErrorEstimates errors(const VectorX& point) const;
    /// Standard errors of the coefficients of `evaluate`.
    [[nodiscard]] VectorX geometry_standard_errors(const VectorX& point) const;
    [[nodiscard]] VectorX displacement_standard_errors(const VectorX& point) const;
    /// Standard error of each number of the displacement, by kriging alone.
    [[nodiscard]] VectorX displacement_error_field(const VectorX& point) const;

    /// Modes of the control points, 3 n_nodes x n_modes, and their mean: x = mean + modes a.
    [[nodiscard]] MatrixX geometry_modes() const;
    [[nodiscard]] VectorX geometry_mean() const;
    /// Those of the displacement: u = factor (mean + modes a).
    [[nodiscard]] MatrixX displacement_modes() const;
    [[nodiscard]] VectorX displacement_mean() const;

    /// The predicted geometry, and the predicted displacement on it.
    [[nodiscard]] iga::MultiPatch<3> member(const Evaluation& evaluation) const;
    [[nodiscard]] iga::Field<3> displacement_field(const Evaluation& evaluation) const;

  private:
    [[nodiscard]] bool is_stacked() const { return parts_.options.basis == BasisKind::stacked; }
    [[nodiscard]] const FieldModel& model_of(const FieldPart& part) const {
        return parts_.models[part.i_model];
    }
    /// The point in the unit cube. @throws InputError  as `evaluate`
    [[nodiscard]] VectorX unit_point(const VectorX& point) const;
    /// Inputs of a field model at a unit point.
    [[nodiscard]] VectorX inputs(int i_model, const VectorX& unit_point) const;
    /// Product of the factored parameters' powers over that at the reference, times the amplitude.
    [[nodiscard]] double factor(const VectorX& point) const;
    /// Standard error of the amplitude's logarithm.
    [[nodiscard]] double amplitude_standard_error(const VectorX& unit_point) const;
    [[nodiscard]] VectorX coefficients(const FieldPart& part, const VectorX& unit_point) const;
    [[nodiscard]] VectorX variances(const FieldPart& part, const VectorX& unit_point) const;
    /// Rows of fields of a model that a part has, scaled.
    [[nodiscard]] MatrixX part_of(const FieldPart& part, MatrixX fields) const;
    /// d field / d parameters of a part, at the reference values of the factored ones.
    [[nodiscard]] MatrixX part_gradient(const FieldPart& part, const VectorX& unit_point) const;

    ReducedModelParts parts_;
    iga::SpacePtr<3> space_;
    /// For each field model.
    std::vector<KrigingInputs> inputs_;
};

}  // namespace couture::rom
