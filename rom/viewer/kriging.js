// Coefficients of modes at a point of the unit cube, as rom/coefficient_model.h and rom/kriging.h.

/** Correlation along one axis: rom/correlation.h. */
function correlation(isGaussian, difference, length) {
  const r = Math.abs(difference) / length;
  if (isGaussian) return Math.exp(-0.5 * r * r);
  const s = Math.sqrt(5) * r;
  return (1 + s + s * s / 3) * Math.exp(-s);
}

/** For each factor of the design the correlations of its points with a point: coefficient k. */
function correlations(model, k, point) {
  let first = 0;
  return model.factors.map((factor) => {
    const row = new Float64Array(factor.n_points).fill(1);
    for (let axis = 0; axis < factor.n_inputs; ++axis, ++first) {
      const length = model.lengths[k * model.inputs.length + first];
      for (let j = 0; j < factor.n_points; ++j) {
        row[j] *= correlation(model.is_gaussian, point[first] - factor.points[j * factor.n_inputs + axis], length);
      }
    }
    return row;
  });
}

/** All combinations of the factors' entries, the last factor fastest. */
function productRow(rows) {
  let product = Float64Array.of(1);
  for (const row of rows) {
    const next = new Float64Array(product.length * row.length);
    for (let i = 0; i < product.length; ++i) {
      for (let j = 0; j < row.length; ++j) next[i * row.length + j] = product[i] * row[j];
    }
    product = next;
  }
  return product;
}

function dot(a, b, offset = 0) {
  let sum = 0;
  for (let i = 0; i < a.length; ++i) sum += a[i] * b[offset + i];
  return sum;
}

/** Pairs of inputs whose products are trend functions: rom/trend.h. */
function trendPairs(model) {
  const pairs = [];
  if (model.trend_degree < 2) return pairs;
  for (let i = 0; i < model.inputs.length; ++i) for (let j = i; j < model.inputs.length; ++j) pairs.push([i, j]);
  return pairs;
}

/** Trend functions at a point. */
function trendFunctions(model, point) {
  if (model.trend_degree === 0) return Float64Array.of(1);
  return Float64Array.of(1, ...point, ...trendPairs(model).map(([i, j]) => point[i] * point[j]));
}

/** For each coefficient the first one with the same lengths and nugget: correlations are shared. */
function firstAlike(model) {
  const n = model.inputs.length;
  const seen = new Map();
  return Array.from({ length: model.n_coefficients }, (_, k) => {
    const key = [...model.lengths.slice(k * n, (k + 1) * n), model.nuggets[k]].join();
    if (!seen.has(key)) seen.set(key, k);
    return seen.get(key);
  });
}

/** Coefficients at a point of the unit cube. */
export function coefficients(model, point) {
  if (model.inputs.length === 0) return Float64Array.from(model.constants);
  model.first_alike ??= firstAlike(model);
  const f = trendFunctions(model, point);
  const values = new Float64Array(model.n_coefficients);
  let row;
  for (let k = 0; k < values.length; ++k) {
    if (k === 0 || model.first_alike[k] !== model.first_alike[k - 1]) row = productRow(correlations(model, k, point));
    values[k] = dot(f, model.trends, k * f.length) + dot(row, model.weights, k * row.length);
  }
  return values;
}

/** Lower factor L of a symmetric positive definite matrix, row by row. */
function cholesky(A, n) {
  const L = new Float64Array(n * n);
  for (let i = 0; i < n; ++i) {
    for (let j = 0; j <= i; ++j) {
      let sum = A[i * n + j];
      for (let k = 0; k < j; ++k) sum -= L[i * n + k] * L[j * n + k];
      L[i * n + j] = i === j ? Math.sqrt(sum) : sum / L[j * n + j];
    }
  }
  return L;
}

/** L^-1 b. */
function forward(L, b) {
  const n = b.length;
  const x = new Float64Array(n);
  for (let i = 0; i < n; ++i) {
    let sum = b[i];
    for (let k = 0; k < i; ++k) sum -= L[i * n + k] * x[k];
    x[i] = sum / L[i * n + i];
  }
  return x;
}

/** Eigenvalues and eigenvectors (columns of V) of a symmetric matrix, by Jacobi's rotations. */
function symmetricEigen(A, n) {
  const V = new Float64Array(n * n);
  for (let i = 0; i < n; ++i) V[i * n + i] = 1;
  for (let sweep = 0; sweep < 50; ++sweep) {
    let off = 0;
    for (let i = 0; i < n; ++i) for (let j = 0; j < i; ++j) off += A[i * n + j] ** 2;
    if (off < 1e-30 * n * n) break;
    for (let p = 0; p < n; ++p) {
      for (let q = p + 1; q < n; ++q) {
        if (A[p * n + q] === 0) continue;
        const theta = (A[q * n + q] - A[p * n + p]) / (2 * A[p * n + q]);
        const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.hypot(theta, 1));
        const c = 1 / Math.hypot(t, 1);
        const s = t * c;
        const turn = (M, i, j) => {
          const a = M[i];
          const b = M[j];
          M[i] = c * a - s * b;
          M[j] = s * a + c * b;
        };
        for (let k = 0; k < n; ++k) turn(A, k * n + p, k * n + q);
        for (let k = 0; k < n; ++k) turn(A, p * n + k, q * n + k);
        for (let k = 0; k < n; ++k) turn(V, k * n + p, k * n + q);
      }
    }
  }
  return { values: Float64Array.from({ length: n }, (_, i) => A[i * n + i]), V };
}

/** V^T b. */
function rotated(V, b) {
  const n = b.length;
  const x = new Float64Array(n);
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) x[j] += V[i * n + j] * b[i];
  return x;
}

/**
 * Square roots W of K^-1 for one coefficient: K^-1 = W^T W. One factor by Cholesky's method, several
 * by their eigenvectors, as rom/correlation_matrix.h.
 *
 * @return rows => W (rows_1 x rows_2 x ...)
 */
function inverseRoot(model, k) {
  let first = 0;
  const matrices = model.factors.map((factor) => {
    const { n_points: n, n_inputs: d, points } = factor;
    const K = new Float64Array(n * n).fill(1);
    for (let axis = 0; axis < d; ++axis, ++first) {
      const length = model.lengths[k * model.inputs.length + first];
      for (let i = 0; i < n; ++i) {
        for (let j = 0; j < n; ++j) {
          K[i * n + j] *= correlation(model.is_gaussian, points[i * d + axis] - points[j * d + axis], length);
        }
      }
    }
    return { K, n };
  });
  if (matrices.length === 1) {
    const { K, n } = matrices[0];
    for (let i = 0; i < n; ++i) K[i * n + i] += model.nuggets[k];
    const L = cholesky(K, n);
    return (rows) => forward(L, rows[0]);
  }
  const eigen = matrices.map(({ K, n }) => symmetricEigen(K, n));
  const scales = productRow(eigen.map((one) => one.values)).map((v) => 1 / Math.sqrt(v + model.nuggets[k]));
  return (rows) => productRow(rows.map((row, g) => rotated(eigen[g].V, row))).map((v, i) => v * scales[i]);
}

/** Trend functions at the design's points, each as a sum of products over the factors. */
function trendRows(model) {
  const ones = model.factors.map((factor) => new Float64Array(factor.n_points).fill(1));
  const terms = [ones];
  if (model.trend_degree === 0) return terms;
  const places = model.factors.flatMap((factor, g) => Array.from({ length: factor.n_inputs }, (_, axis) => ({ g, axis })));
  const times = (rows, { g, axis }) => {
    const { n_inputs, points } = model.factors[g];
    return rows.map((row, h) => (h === g ? row.map((value, j) => value * points[j * n_inputs + axis]) : row));
  };
  for (const place of places) terms.push(times(ones, place));
  for (const [i, j] of trendPairs(model)) terms.push(times(times(ones, places[i]), places[j]));
  return terms;
}

/** What variances of a coefficient need beyond its value; made when first asked for. */
function factored(model, k) {
  const root = inverseRoot(model, k);
  const WF = trendRows(model).map(root);
  const m = WF.length;
  const normal = new Float64Array(m * m);
  for (let i = 0; i < m; ++i) for (let j = 0; j < m; ++j) normal[i * m + j] = dot(WF[i], WF[j]);
  return { root, WF, L: cholesky(normal, m) };
}

/** Variances of the coefficients at a point: rom/kriging.h, Kriging::variance. */
export function variances(model, point) {
  const values = new Float64Array(model.n_coefficients);
  if (model.inputs.length === 0) return values;
  model.first_alike ??= firstAlike(model);
  model.factorizations ??= Array.from(values, (_, k) => (model.first_alike[k] === k ? factored(model, k) : null));
  const f = trendFunctions(model, point);
  const relative = new Float64Array(values.length);
  return values.map((_, k) => {
    const first = model.first_alike[k];
    if (first === k) {
      const { root, WF, L } = model.factorizations[k];
      const Wk = root(correlations(model, k, point));
      const u = forward(L, f.map((value, i) => dot(WF[i], Wk) - value));
      relative[k] = Math.max(0, 1 - dot(Wk, Wk) + dot(u, u));
    }
    return model.variances[k] * relative[first];
  });
}
