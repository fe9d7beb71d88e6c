// Position, displacement and stress at the points of the outer sides' grids, from control points, as
// rom/field_sampler.h: sums are factorized, first across the side, then along its two directions.

/** Fields of one node: position, then displacement. */
const nFields = 6;

/** Homogeneous numbers of a side's nodes, contracted across the side: value and slope of each field. */
function contractAcross(grid, nodeFields, count, net) {
  const layer = grid.a.n_functions * grid.b.n_functions;
  for (let i = 0; i < layer; ++i) {
    const to = i * 2 * count;
    for (let f = 0; f < count; ++f) {
      let value = 0;
      let slope = 0;
      for (let n = 0; n < grid.across_values.length; ++n) {
        const at = n * layer + i;
        const v = nodeFields(at, f);
        value += grid.across_values[n] * v;
        slope += grid.across_derivatives[n] * v;
      }
      net[to + f] = value;
      net[to + count + f] = slope;
    }
  }
}

/** Along the first direction: [function of b][point of a][value, slope across, slope along a][field]. */
function contractA(grid, net, count, lines) {
  const { n_points: nPoints, n_functions: nFunctions, n_active: nActive, starts, values, derivatives } = grid.a;
  for (let j = 0; j < grid.b.n_functions; ++j) {
    for (let p = 0; p < nPoints; ++p) {
      const to = (j * nPoints + p) * 3 * count;
      lines.fill(0, to, to + 3 * count);
      for (let i = 0; i < nActive; ++i) {
        const from = (j * nFunctions + starts[p] + i) * 2 * count;
        const N = values[p * nActive + i];
        const dN = derivatives[p * nActive + i];
        for (let f = 0; f < count; ++f) {
          const v = net[from + f];
          lines[to + f] += N * v;
          lines[to + count + f] += N * net[from + count + f];
          lines[to + 2 * count + f] += dN * v;
        }
      }
    }
  }
}

/** Along the second, at a line of points: [point of a][value, slope across, slope along a][field], and slopes along b. */
function contractB(grid, lines, count, pb, row, slopes) {
  const { n_active: nActive, starts, values, derivatives } = grid.b;
  const length = 3 * count * grid.a.n_points;
  row.fill(0, 0, length);
  slopes.fill(0, 0, count * grid.a.n_points);
  for (let j = 0; j < nActive; ++j) {
    const from = (starts[pb] + j) * length;
    const N = values[pb * nActive + j];
    const dN = derivatives[pb * nActive + j];
    for (let i = 0; i < length; ++i) row[i] += N * lines[from + i];
    for (let i = 0, at = from; at < from + length; at += 3 * count) {
      for (let f = 0; f < count; ++f, ++i) slopes[i] += dN * lines[at + f];
    }
  }
}

/** 6 x 6, row by row; Voigt order 11, 22, 33, 23, 13, 12. */
export function isotropicStiffness(E, nu) {
  const lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const mu = E / (2 * (1 + nu));
  const C = new Float64Array(36);
  for (let i = 0; i < 3; ++i) {
    for (let j = 0; j < 3; ++j) C[6 * i + j] = lambda + (i === j ? 2 * mu : 0);
    C[6 * (i + 3) + i + 3] = mu;
  }
  return C;
}

/** Von Mises stress from slopes of position and displacement by the parameters, at 6, 12, 18 of q. */
function vonMises(q, C) {
  // J = [t0 t1 t2]; rows of its inverse are cross products of its columns over det J.
  const ax = q[6], ay = q[7], az = q[8];
  const bx = q[12], by = q[13], bz = q[14];
  const cx = q[18], cy = q[19], cz = q[20];
  const r0x = by * cz - bz * cy, r0y = bz * cx - bx * cz, r0z = bx * cy - by * cx;
  const r1x = cy * az - cz * ay, r1y = cz * ax - cx * az, r1z = cx * ay - cy * ax;
  const r2x = ay * bz - az * by, r2y = az * bx - ax * bz, r2z = ax * by - ay * bx;
  const inverse = 1 / (ax * r0x + ay * r0y + az * r0z);
  const u0 = q[9] * inverse, u1 = q[15] * inverse, u2 = q[21] * inverse;
  const v0 = q[10] * inverse, v1 = q[16] * inverse, v2 = q[22] * inverse;
  const w0 = q[11] * inverse, w1 = q[17] * inverse, w2 = q[23] * inverse;
  const e0 = u0 * r0x + u1 * r1x + u2 * r2x;
  const e1 = v0 * r0y + v1 * r1y + v2 * r2y;
  const e2 = w0 * r0z + w1 * r1z + w2 * r2z;
  const e3 = v0 * r0z + v1 * r1z + v2 * r2z + w0 * r0y + w1 * r1y + w2 * r2y;
  const e4 = u0 * r0z + u1 * r1z + u2 * r2z + w0 * r0x + w1 * r1x + w2 * r2x;
  const e5 = u0 * r0y + u1 * r1y + u2 * r2y + v0 * r0x + v1 * r1x + v2 * r2x;
  const s = (i) => C[i] * e0 + C[i + 1] * e1 + C[i + 2] * e2 + C[i + 3] * e3 + C[i + 4] * e4 + C[i + 5] * e5;
  const s0 = s(0), s1 = s(6), s2 = s(12), s3 = s(18), s4 = s(24), s5 = s(30);
  const d0 = s0 - s1, d1 = s1 - s2, d2 = s2 - s0;
  return Math.sqrt(0.5 * (d0 * d0 + d1 * d1 + d2 * d2) + 3 * (s3 * s3 + s4 * s4 + s5 * s5));
}

/** The grids with their results, grid by grid, the first direction fastest. */
export class Surface {
  constructor(grids) {
    this.grids = grids;
    this.nPoints = 0;
    let largestNet = 0;
    let largestLines = 0;
    let longest = 0;
    for (const grid of grids) {
      grid.first = this.nPoints;
      this.nPoints += grid.a.n_points * grid.b.n_points;
      largestNet = Math.max(largestNet, grid.a.n_functions * grid.b.n_functions);
      largestLines = Math.max(largestLines, grid.a.n_points * grid.b.n_functions);
      longest = Math.max(longest, grid.a.n_points);
    }
    this.net = new Float64Array(2 * nFields * largestNet);
    this.lines = new Float64Array(3 * nFields * largestLines);
    this.row = new Float64Array(3 * nFields * longest);
    this.slopes = new Float64Array(nFields * longest);
    this.point = new Float64Array(4 * nFields);
    for (const grid of grids) if (grid.weights) grid.denominators = this.denominators(grid);
    this.x = new Float64Array(3 * this.nPoints);
    this.u = new Float64Array(3 * this.nPoints);
    // Slopes along both directions of the side, of position and displacement.
    this.tangents = new Float32Array(12 * this.nPoints);
    this.vonMises = new Float64Array(this.nPoints);
    this.magnitude = new Float64Array(this.nPoints);
  }

  /** W of rational functions and its slopes, of each point: they do not depend on parameters. */
  denominators(grid) {
    contractAcross(grid, (at) => grid.weights[at], 1, this.net);
    contractA(grid, this.net, 1, this.lines);
    const { n_points: na } = grid.a;
    const result = new Float64Array(4 * na * grid.b.n_points);
    for (let pb = 0, at = 0; pb < grid.b.n_points; ++pb) {
      contractB(grid, this.lines, 1, pb, this.row, this.slopes);
      for (let pa = 0; pa < na; ++pa, at += 4) {
        result.set(this.row.subarray(3 * pa, 3 * pa + 3), at);
        result[at + 3] = this.slopes[pa];
      }
    }
    return result;
  }

  /**
   * @param x, u  three numbers of each node: control points and displacement
   * @param stiffnesses  36 numbers for each patch, or nothing: no stress
   */
  evaluate(x, u, stiffnesses) {
    for (const grid of this.grids) {
      const { nodes, weights } = grid;
      const field = (at, f) => {
        const value = f < 3 ? x[3 * nodes[at] + f] : u[3 * nodes[at] + f - 3];
        return weights ? weights[at] * value : value;
      };
      contractAcross(grid, field, nFields, this.net);
      contractA(grid, this.net, nFields, this.lines);
      this.evaluatePoints(grid, stiffnesses && stiffnesses[grid.patch]);
    }
  }

  evaluatePoints(grid, C) {
    const q = this.point;
    const na = grid.a.n_points;
    const { row, slopes } = this;
    for (let pb = 0, i = grid.first, local = 0; pb < grid.b.n_points; ++pb) {
      contractB(grid, this.lines, nFields, pb, row, slopes);
      for (let pa = 0; pa < na; ++pa, ++i, ++local) {
        for (let k = 0; k < 3 * nFields; ++k) q[k] = row[3 * nFields * pa + k];
        for (let f = 0; f < nFields; ++f) q[3 * nFields + f] = slopes[nFields * pa + f];
        if (grid.denominators) this.divide(grid.denominators, 4 * local);
        for (let c = 0; c < 3; ++c) {
          this.x[3 * i + c] = q[c];
          this.u[3 * i + c] = q[3 + c];
        }
        for (let c = 0; c < 6; ++c) {
          this.tangents[12 * i + c] = q[12 + c];
          this.tangents[12 * i + 6 + c] = q[18 + c];
        }
        this.magnitude[i] = Math.sqrt(q[3] * q[3] + q[4] * q[4] + q[5] * q[5]);
        this.vonMises[i] = C ? vonMises(q, C) : NaN;
      }
    }
  }

  divide(W, at) {
    const q = this.point;
    const inverse = 1 / W[at];
    for (let f = 0; f < nFields; ++f) q[f] *= inverse;
    for (let k = 1; k < 4; ++k) {
      for (let f = 0; f < nFields; ++f) q[nFields * k + f] = (q[nFields * k + f] - q[f] * W[at + k]) * inverse;
    }
  }

  /** Numbers of the points at ends of elements, with `n` cells per element and direction. */
  elementEnds(n) {
    return this.grids.flatMap(({ first, a, b }) => Array.from({ length: a.n_points * b.n_points }, (_, i) => first + i)
      .filter((i) => ((i - first) % a.n_points) % n === 0 && Math.floor((i - first) / a.n_points) % n === 0));
  }

  /** Deformed positions and their normals, for drawing. */
  deform(scale, positions, normals) {
    const t = this.tangents;
    for (let i = 0; i < this.nPoints; ++i) {
      for (let c = 0; c < 3; ++c) positions[3 * i + c] = this.x[3 * i + c] + scale * this.u[3 * i + c];
      const at = 12 * i;
      const ax = t[at] + scale * t[at + 3], ay = t[at + 1] + scale * t[at + 4], az = t[at + 2] + scale * t[at + 5];
      const bx = t[at + 6] + scale * t[at + 9], by = t[at + 7] + scale * t[at + 10];
      const bz = t[at + 8] + scale * t[at + 11];
      const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
      const inverse = 1 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
      normals[3 * i] = nx * inverse;
      normals[3 * i + 1] = ny * inverse;
      normals[3 * i + 2] = nz * inverse;
    }
  }

  /** Corners of triangles, and ends of the lines around the sides. */
  topology() {
    const triangles = [];
    const edges = [];
    for (const { first, a, b } of this.grids) {
      const na = a.n_points;
      const nb = b.n_points;
      const at = (i, j) => first + j * na + i;
      for (let j = 0; j + 1 < nb; ++j) {
        for (let i = 0; i + 1 < na; ++i) {
          triangles.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
      for (let i = 0; i + 1 < na; ++i) edges.push(at(i, 0), at(i + 1, 0), at(i, nb - 1), at(i + 1, nb - 1));
      for (let j = 0; j + 1 < nb; ++j) edges.push(at(0, j), at(0, j + 1), at(na - 1, j), at(na - 1, j + 1));
    }
    return { triangles: Uint32Array.from(triangles), edges: Uint32Array.from(edges) };
  }
}
