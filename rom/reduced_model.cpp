#include "rom/reduced_model.h"

#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/core/error.h"
#include "iga/solve/static_system.h"
#include "rom/member_geometry.h"

namespace couture::rom {

namespace {

int n_components(const ReducedModelOptions& options) {
    return options.basis == BasisKind::stacked ? 6 : 3;
}

SparseMatrix mass_matrix(const iga::Space<3>& space) {
    std::vector<int> kept;
    return iga::to_scalar(iga::assemble(space, iga::scalar_form<3>(0.0, 1.0)), {}, false, kept);
}

double root_mean_square(const MatrixX& fields, const InnerProduct& product) {
    return std::sqrt(lengths(fields, product).cwiseAbs2().mean());
}

/// Columns of geometries, repeated for each combination of loads and materials.
MatrixX repeated(const MatrixX& columns, int n_times) {
    MatrixX result(columns.rows(), columns.cols() * n_times);
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
        result.col(j) = columns.col(j / n_times);
    }
    return result;
}

/// Control points and displacement of each snapshot, scaled, 6 numbers at each node.
MatrixX stack(const MatrixX& geometry, double geometry_scale, const MatrixX& displacement,
              double displacement_scale) {
    MatrixX stacked(2 * geometry.rows(), geometry.cols());
    for (Eigen::Index j = 0; j < stacked.cols(); ++j) {
        for (Eigen::Index i = 0; i < geometry.rows() / 3; ++i) {
            stacked.col(j).segment<3>(6 * i) = geometry.col(j).segment<3>(3 * i) / geometry_scale;
            stacked.col(j).segment<3>(6 * i + 3) =
                displacement.col(j).segment<3>(3 * i) / displacement_scale;
        }
    }
    return stacked;
}

/// Of the columns that were not refused; 1 if they vanish.
double block_scale(const MatrixX& fields, const InnerProduct& product) {
    const double scale = root_mean_square(fields(Eigen::all, accepted_columns(fields)), product);
    return scale > 0.0 ? scale : 1.0;
}

/// Makes the models and the parts of a family.
class Trainer {
  public:
    Trainer(const SnapshotSet& set, const ReducedModelOptions& options)
        : set_(set), options_(options), space_(set.reference) {
        if (options.product == ModeProduct::l2) {
            mass_ = mass_matrix(space_);
        }
    }

    [[nodiscard]] ReducedModelParts parts() const {
        ReducedModelParts parts{set_.parameters,
                                set_.factor_power,
                                set_.reference_point,
                                set_.reference,
                                options_,
                                {},
                                {},
                                {},
                                {}};
        if (options_.basis == BasisKind::stacked) {
            train_stacked(parts);
        } else {
            train_separate(parts);
        }
        parts.geometry.size = length_about_centroid(to_field(space_, set_.reference), product(3));
        return parts;
    }

  private:
    [[nodiscard]] InnerProduct product(int n) const {
        return options_.product == ModeProduct::l2 ? InnerProduct(mass_, n) : InnerProduct(n);
    }

    [[nodiscard]] FieldModelOptions field_options() const {
        return {{.n_modes = options_.n_modes, .tolerance = options_.tolerance}, options_.kriging};
    }

    [[nodiscard]] MatrixX geometry_inputs() const {
        const auto sampled =
            sampled_parameters(set_.parameters, set_.factor_power, ParameterGroup::geometry);
        return KrigingInputs(set_.parameters, sampled).of_design(set_.geometry_points);
    }
    // Of the inputs of kriging.
    [[nodiscard]] TensorDesign design() const {
        TensorDesign design = set_.design();
        if (set_.geometry_points.cols() > 0) design.factors.front() = geometry_inputs();
        return design;
    }

    /// Lengths of the displacements (1 where refused) if all are within 60 degrees of the direction
    /// that they have in common; else nothing.
    [[nodiscard]] std::optional<VectorX> amplitudes(const InnerProduct& inner) const {
        constexpr double least_cosine = 0.5;
        const std::vector<int> accepted = accepted_columns(set_.displacements);
        if (options_.amplitude == Amplitude::none || set_.design().n_parameters() == 0 ||
            accepted.size() < 2) {
            return {};
        }
        const VectorX size = lengths(set_.displacements(Eigen::all, accepted), inner);
        if (!(size.minCoeff() > 0.0)) return {};
        const MatrixX unit =
            set_.displacements(Eigen::all, accepted) * size.cwiseInverse().asDiagonal();
        const PodBasis direction = make_pod_basis(unit, inner, {.n_modes = 1});
        const MatrixX cosines =
            project(direction, inner, unit) / std::sqrt(inner.squared_norms(unit.col(0))[0]);
        const double sign = cosines.sum() < 0.0 ? -1.0 : 1.0;
        if ((sign * cosines).minCoeff() < least_cosine) return {};
        VectorX all = VectorX::Ones(set_.displacements.cols());
        all(accepted) = size;
        return all;
    }

    void train_separate(ReducedModelParts& parts) const {
        const InnerProduct inner = product(3);
        TensorDesign geometries;
        if (set_.geometry_points.cols() > 0) {
            geometries.factors = {geometry_inputs()};
        }
        parts.models.emplace_back(geometries, set_.control_points, to_field(space_, set_.reference),
                                  inner, field_options());
        const std::optional<VectorX> amplitude = amplitudes(inner);
        const MatrixX fields = amplitude
                                   ? set_.displacements * amplitude->cwiseInverse().asDiagonal()
                                   : set_.displacements;
        parts.models.emplace_back(design(), fields, VectorX::Zero(fields.rows()), inner,
                                  field_options());
        parts.geometry = measure({}, parts.models[0], set_.control_points, inner);
        parts.displacement.i_model = 1;
        parts.displacement = measure(parts.displacement, parts.models[1], fields, inner);
        if (!amplitude) return;
        const std::vector<int> accepted = accepted_columns(fields);
        const VectorX logarithms = (*amplitude)(accepted).array().log();
        parts.amplitude = learned_coefficients(design(), accepted, logarithms, options_.kriging);
        parts.displacement = with_amplitude(parts.displacement, *parts.amplitude);
    }

    void train_stacked(ReducedModelParts& parts) const {
        const InnerProduct inner = product(3);
        parts.displacement.first_component = 3;
        parts.geometry.scale = block_scale(set_.control_points, inner);
        parts.displacement.scale = block_scale(set_.displacements, inner);
        const MatrixX stacked =
            stack(repeated(set_.control_points, set_.n_mechanics()), parts.geometry.scale,
                  set_.displacements, parts.displacement.scale);
        parts.models.emplace_back(design(), stacked, VectorX::Zero(stacked.rows()), product(6),
                                  field_options());
        parts.geometry = measure(parts.geometry, parts.models[0], stacked, inner);
        parts.displacement = measure(parts.displacement, parts.models[0], stacked, inner);
    }

    [[nodiscard]] FieldPart measure(const FieldPart& part, const FieldModel& model,
                                    const MatrixX& fields, const InnerProduct& inner) const {
        return measured(part, model, fields(Eigen::all, accepted_columns(fields)),
                        n_components(options_), inner);
    }

    const SnapshotSet& set_;
    const ReducedModelOptions& options_;
    iga::Space<3> space_;
    SparseMatrix mass_;
};

ReducedModelParts trained(const SnapshotSet& snapshots, const ReducedModelOptions& options) {
    check(snapshots);
    return Trainer(snapshots, options).parts();
}

void check_parts(const ReducedModelParts& parts) {
    const auto n = static_cast<std::size_t>(parts.parameters.size());
    if (parts.factor_power.size() != n ||
        parts.reference_point.size() != static_cast<Eigen::Index>(n)) {
        throw InputError(
            "ReducedModel: {} powers and {} reference values for {} parameters; each takes one",
            parts.factor_power.size(), parts.reference_point.size(), n);
    }
    const int n_models = parts.options.basis == BasisKind::stacked ? 1 : 2;
    if (static_cast<int>(parts.models.size()) != n_models) {
        throw InputError("ReducedModel: {} field models; expected {}", parts.models.size(),
                         n_models);
    }
    for (const FieldPart* part : {&parts.geometry, &parts.displacement}) {
        if (part->i_model < 0 || part->i_model >= n_models || part->first_component < 0 ||
            part->first_component + 3 > n_components(parts.options)) {
            throw InputError(
                "ReducedModel: a field from component {} of model {}; there are {} models of {}",
                part->first_component, part->i_model, n_models, n_components(parts.options));
        }
        const int n_modes = parts.models[part->i_model].n_modes();
        if (part->gram.rows() != n_modes || part->gram.cols() != n_modes) {
            throw InputError("ReducedModel: products of modes are {} x {} for {} modes",
                             part->gram.rows(), part->gram.cols(), n_modes);
        }
    }
}

}  // namespace

InnerProduct mode_product(const iga::Space<3>& reference, ModeProduct product) {
    return product == ModeProduct::l2 ? InnerProduct(mass_matrix(reference), 3) : InnerProduct(3);
}

ReducedModel::ReducedModel(const SnapshotSet& snapshots, const ReducedModelOptions& options)
    : ReducedModel(trained(snapshots, options)) {}

ReducedModel::ReducedModel(ReducedModelParts parts) : parts_(std::move(parts)) {
    check_parts(parts_);
    space_ = std::make_shared<const iga::Space<3>>(parts_.reference);
    for (int i = 0; i < static_cast<int>(parts_.models.size()); ++i) {
        std::vector<int> sampled;
        const bool is_of_geometry = parts_.options.basis == BasisKind::separate && i == 0;
        for (const ParameterGroup group :
             {ParameterGroup::geometry, ParameterGroup::load, ParameterGroup::material}) {
            if (is_of_geometry && group != ParameterGroup::geometry) {
                continue;
            }
            for (const int p : sampled_parameters(parts_.parameters, parts_.factor_power, group)) {
                sampled.push_back(p);
            }
        }
        KrigingInputs inputs(parts_.parameters, sampled);
        const FieldModel& model = parts_.models[i];
        if (model.coefficients().n_inputs() != inputs.size() ||
            model.mean().size() !=
                static_cast<Eigen::Index>(n_components(parts_.options)) * n_nodes()) {
            throw InputError(
                "ReducedModel: field model {} has {} inputs and {} values; expected {} inputs, and "
                "{} values at each of {} nodes",
                i, model.coefficients().n_inputs(), model.mean().size(), inputs.size(),
                n_components(parts_.options), n_nodes());
        }
        inputs_.push_back(std::move(inputs));
    }
    if (parts_.amplitude &&
        (parts_.amplitude->n_coefficients() != 1 ||
         parts_.amplitude->n_inputs() != inputs_[parts_.displacement.i_model].size())) {
        throw InputError(
            "ReducedModel: the amplitude has {} coefficients of {} inputs; expected 1 of {}",
            parts_.amplitude->n_coefficients(), parts_.amplitude->n_inputs(),
            inputs_[parts_.displacement.i_model].size());
    }
}

VectorX ReducedModel::inputs(int i_model, const VectorX& unit_point) const {
    return inputs_[i_model].at(unit_point);
}

VectorX ReducedModel::unit_point(const VectorX& point) const {
    const int n = parameters().size();
    if (point.size() != n) {
        throw InputError(
            "ReducedModel: a point with {} values; expected one for each of {} "
            "parameters",
            point.size(), n);
    }
    for (int i = 0; i < n; ++i) {
        if (!std::isfinite(point[i]) || (parts_.factor_power[i] < 0 && point[i] == 0.0)) {
            throw InputError("ReducedModel: '{}' is {}; it must be finite{}",
                             parameters().parameters()[i].name, point[i],
                             parts_.factor_power[i] < 0 ? " and not 0" : "");
        }
    }
    return parameters().to_unit(point);
}

double ReducedModel::factor(const VectorX& point) const {
    double product = 1.0;
    for (int i = 0; i < point.size(); ++i) {
        const double ratio = point[i] / parts_.reference_point[i];
        if (parts_.factor_power[i] > 0) {
            product *= ratio;
        } else if (parts_.factor_power[i] < 0) {
            product /= ratio;
        }
    }
    if (parts_.amplitude) {
        const VectorX x = inputs(parts_.displacement.i_model, parameters().to_unit(point));
        product *= std::exp(parts_.amplitude->values(x)[0]);
    }
    return product;
}

double ReducedModel::amplitude_standard_error(const VectorX& unit_point) const {
    if (!parts_.amplitude) return 0.0;
    const VectorX x = inputs(parts_.displacement.i_model, unit_point);
    return std::sqrt(parts_.amplitude->variances(x)[0]);
}

VectorX ReducedModel::coefficients(const FieldPart& part, const VectorX& unit_point) const {
    return model_of(part).coefficients().values(inputs(part.i_model, unit_point));
}

VectorX ReducedModel::variances(const FieldPart& part, const VectorX& unit_point) const {
    return model_of(part).coefficients().variances(inputs(part.i_model, unit_point));
}

MatrixX ReducedModel::part_of(const FieldPart& part, MatrixX fields) const {
    return part.values(std::move(fields), n_components(parts_.options));
}

Evaluation ReducedModel::evaluate(const VectorX& point) const {
    const VectorX unit = unit_point(point);
    Evaluation evaluation;
    evaluation.point = point;
    evaluation.factor = factor(point);
    evaluation.distance_outside = parameters().distance_outside(point);
    evaluation.geometry_coefficients = coefficients(parts_.geometry, unit);
    evaluation.displacement_coefficients =
        is_stacked() ? evaluation.geometry_coefficients : coefficients(parts_.displacement, unit);
    VectorX first = model_of(parts_.geometry).field(evaluation.geometry_coefficients);
    if (is_stacked()) {
        evaluation.control_points = part_of(parts_.geometry, first);
        evaluation.displacement = part_of(parts_.displacement, std::move(first));
    } else {
        evaluation.control_points = std::move(first);
        evaluation.displacement =
            model_of(parts_.displacement).field(evaluation.displacement_coefficients);
    }
    evaluation.displacement *= evaluation.factor;
    return evaluation;
}

EvaluationBatch ReducedModel::evaluate_batch(const MatrixX& points) const {
    std::vector<MatrixX> values;
    for (const FieldModel& model : parts_.models) {
        values.emplace_back(model.n_modes(), points.rows());
    }
    VectorX factors(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const VectorX point = points.row(i);
        const VectorX unit = unit_point(point);
        factors[i] = factor(point);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k].col(i) =
                parts_.models[k].coefficients().values(inputs(static_cast<int>(k), unit));
        }
    }
    EvaluationBatch batch;
    MatrixX first = parts_.models[0].fields(values[0]);
    batch.control_points = part_of(parts_.geometry, first);
    batch.displacements = part_of(
        parts_.displacement, is_stacked() ? std::move(first) : parts_.models[1].fields(values[1]));
    batch.displacements *= factors.asDiagonal();
    return batch;
}

MatrixX ReducedModel::part_gradient(const FieldPart& part, const VectorX& unit_point) const {
    const FieldModel& model = model_of(part);
    const MatrixX by_inputs = model.coefficients().gradient(inputs(part.i_model, unit_point));
    const MatrixX fields = part_of(part, model.basis().modes * by_inputs);
    MatrixX gradient = MatrixX::Zero(fields.rows(), parameters().size());
    const std::vector<int> of_inputs = inputs_[part.i_model].parameters();
    const VectorX slopes = inputs_[part.i_model].slopes(unit_point);
    for (std::size_t i = 0; i < of_inputs.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const Parameter& parameter = parameters().parameters()[of_inputs[i]];
        gradient.col(of_inputs[i]) +=
            fields.col(k) * (slopes[k] / (parameter.upper - parameter.lower));
    }
    return gradient;
}

EvaluationGradient ReducedModel::gradient(const VectorX& point) const {
    const VectorX unit = unit_point(point);
    EvaluationGradient gradient;
    gradient.control_points = part_gradient(parts_.geometry, unit);
    gradient.displacement = factor(point) * part_gradient(parts_.displacement, unit);
    const VectorX u = evaluate(point).displacement;
    if (parts_.amplitude) {
        const KrigingInputs& seen = inputs_[parts_.displacement.i_model];
        const std::vector<int> of_inputs = seen.parameters();
        const VectorX by_parameter = seen.slopes(unit);
        const MatrixX slopes = parts_.amplitude->gradient(seen.at(unit));
        for (std::size_t i = 0; i < of_inputs.size(); ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            const Parameter& one = parameters().parameters()[of_inputs[i]];
            gradient.displacement.col(of_inputs[i]) +=
                u * (slopes(0, k) * by_parameter[k] / (one.upper - one.lower));
        }
    }
    for (int i = 0; i < parameters().size(); ++i) {
        if (parts_.factor_power[i] == 1 && point[i] == 0.0) {
            VectorX moved = point;
            moved[i] = parts_.reference_point[i];
            gradient.displacement.col(i) = evaluate(moved).displacement / moved[i];
        } else if (parts_.factor_power[i] != 0) {
            gradient.displacement.col(i) = u * (parts_.factor_power[i] / point[i]);
        }
    }
    return gradient;
}

ErrorEstimates ReducedModel::errors(const VectorX& point) const {
    const VectorX unit = unit_point(point);
    const Calibration& calibration = parts_.calibration;
    const double scale = factor(point);
    ErrorEstimates errors;
    errors.geometry = estimate_error(parts_.geometry, variances(parts_.geometry, unit), 1.0,
                                     parts_.geometry.size, calibration.geometry);
    const double length =
        std::abs(scale) * parts_.displacement.length(coefficients(parts_.displacement, unit));
    errors.displacement =
        estimate_error(parts_.displacement, variances(parts_.displacement, unit), scale, length,
                       calibration.displacement, length * amplitude_standard_error(unit));
    errors.von_mises = calibration.von_mises * errors.displacement.relative;
    return errors;
}

VectorX ReducedModel::geometry_standard_errors(const VectorX& point) const {
    return variances(parts_.geometry, unit_point(point)).cwiseSqrt();
}

VectorX ReducedModel::displacement_standard_errors(const VectorX& point) const {
    return variances(parts_.displacement, unit_point(point)).cwiseSqrt();
}

VectorX ReducedModel::displacement_error_field(const VectorX& point) const {
    const FieldPart& part = parts_.displacement;
    const VectorX unit = unit_point(point);
    const VectorX errors = model_of(part).standard_errors(variances(part, unit));
    const VectorX scaled = std::abs(factor(point)) * part_of(part, errors);
    const VectorX by_amplitude = amplitude_standard_error(unit) * evaluate(point).displacement;
    return (scaled.cwiseAbs2() + by_amplitude.cwiseAbs2()).cwiseSqrt();
}

MatrixX ReducedModel::displacement_modes() const {
    return part_of(parts_.displacement, model_of(parts_.displacement).basis().modes);
}

VectorX ReducedModel::displacement_mean() const {
    return part_of(parts_.displacement, model_of(parts_.displacement).mean());
}

MatrixX ReducedModel::geometry_modes() const {
    return part_of(parts_.geometry, model_of(parts_.geometry).basis().modes);
}

VectorX ReducedModel::geometry_mean() const {
    return part_of(parts_.geometry, model_of(parts_.geometry).mean());
}

iga::MultiPatch<3> ReducedModel::member(const Evaluation& evaluation) const {
    return to_member(*space_, evaluation.control_points);
}

iga::Field<3> ReducedModel::displacement_field(const Evaluation& evaluation) const {
    return {std::make_shared<const iga::Space<3>>(member(evaluation)),
            iga::unflatten(evaluation.displacement, 3)};
}

}  // namespace couture::rom
