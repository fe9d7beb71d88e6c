// Answers of the model at a point of the parameters, as `couture rom eval`.
import { coefficients, variances } from "./kriging.js";
import { isotropicStiffness, Surface } from "./surface.js";

/** mean + modes a, times a factor. */
function addModes(part, a, factor, values) {
  if (part.mean) values.set(part.mean);
  else values.fill(0);
  for (let k = 0; k < part.modes.length; ++k) {
    const mode = part.modes[k];
    const c = a[k];
    for (let i = 0; i < mode.length; ++i) values[i] += c * mode[i];
  }
  if (factor !== 1) for (let i = 0; i < values.length; ++i) values[i] *= factor;
}

/** Of some points. */
function largest(values, points) {
  let most = -Infinity;
  for (let i = 0; i < points.length; ++i) if (values[points[i]] > most) most = values[points[i]];
  return most;
}

/** rom/field_part.h, estimate_error. */
function estimateError(part, v, factor, length, amplitudeError = 0) {
  const n = v.length;
  let square = 0;
  for (let k = 0; k < n; ++k) square += v[k] * part.gram[k * n + k];
  const size = Math.abs(factor);
  const kriging = Math.hypot(size * Math.sqrt(square), amplitudeError);
  const total = part.calibration * Math.hypot(size * part.truncation, part.leave_one_out_ratio * kriging);
  return { truncation: size * part.truncation, kriging, total, relative: length > 0 ? total / length : 0 };
}

/** rom/field_part.h, FieldPart::length. */
function fieldLength(part, a) {
  const n = a.length;
  let square = 0;
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) square += a[i] * part.gram[i * n + j] * a[j];
  return Math.sqrt(part.size * part.size + Math.max(0, square));
}

export class Evaluator {
  constructor(model) {
    this.model = model;
    this.surface = new Surface(model.grids);
    this.ends = Int32Array.from(this.surface.elementEnds(model.n_cells));
    this.x = new Float64Array(3 * model.n_nodes);
    this.u = new Float64Array(3 * model.n_nodes);
  }

  /** Values of all parameters: the reference member's where none is given. @param values  by name */
  point(values = {}) {
    return Float64Array.from(this.model.parameters, (one) => values[one.name] ?? one.reference);
  }

  unit(point) {
    return this.model.parameters.map((one, i) => (point[i] - one.lower) / (one.upper - one.lower));
  }

  /** What a model of coefficients sees of a point. */
  inputs({ inputs, waves }, unit) {
    // Of a periodic parameter its cosine (1) and its sine (2).
    return inputs.map((i, k) => {
      if (waves[k] === 0) return unit[i];
      const angle = 2 * Math.PI * unit[i];
      return 0.5 * (1 + (waves[k] === 1 ? Math.cos(angle) : Math.sin(angle)));
    });
  }

  /** Product of the factored parameters' powers over that at the reference, times the amplitude. */
  factor(point) {
    return this.model.parameters.reduce(
      (product, one, i) => product * (point[i] / one.reference) ** one.factor_power, this.amplitude(point, coefficients));
  }

  /** exp of the logarithm of the amplitude, or with `variances` its relative standard error. */
  amplitude(point, evaluate) {
    const { amplitude } = this.model;
    if (!amplitude) return evaluate === variances ? 0 : 1;
    const unit = this.unit(point);
    const value = evaluate(amplitude, this.inputs(amplitude, unit))[0];
    return evaluate === variances ? Math.sqrt(value) : Math.exp(value);
  }

  stiffnesses(point) {
    const { materials, material_of_patch: ofPatch } = this.model;
    if (this.model.no_stress) return null;
    const modulus = (one) => (one.parameter === null ? one.value : one.value * point[one.parameter]);
    const C = materials.map((one) =>
      one.stiffness ?? isotropicStiffness(modulus(one.youngs_modulus), modulus(one.poissons_ratio)));
    return ofPatch.map((i) => C[i]);
  }

  /**
   * Geometry, displacement and stress on the surface, into `surface`; the largest values are those at
   * ends of elements, as `rom eval`.
   */
  evaluate(point) {
    const { geometry, displacement, models } = this.model;
    const unit = this.unit(point);
    const all = models.map((model) => coefficients(model, this.inputs(model, unit)));
    const a = all[geometry.i_model];
    const b = all[displacement.i_model];
    addModes(geometry, a, 1, this.x);
    addModes(displacement, b, this.factor(point), this.u);
    this.surface.evaluate(this.x, this.u, this.stiffnesses(point));
    return {
      geometry_coefficients: a, coefficients: b, displacement_max: largest(this.surface.magnitude, this.ends),
      von_mises_max: this.model.no_stress ? null : largest(this.surface.vonMises, this.ends)
    };
  }

  /** Expected errors, and standard errors of the displacement's coefficients. */
  errors(point) {
    const { geometry, displacement, models } = this.model;
    const unit = this.unit(point);
    const of = (part, evaluate) => evaluate(models[part.i_model], this.inputs(models[part.i_model], unit));
    const factor = this.factor(point);
    const v = of(displacement, variances);
    const length = Math.abs(factor) * fieldLength(displacement, of(displacement, coefficients));
    const expected = estimateError(displacement, v, factor, length, length * this.amplitude(point, variances));
    return {
      geometry: estimateError(geometry, of(geometry, variances), 1, geometry.size),
      displacement: expected,
      von_mises: this.model.von_mises_calibration * expected.relative,
      standard_errors: v.map(Math.sqrt)
    };
  }
}
