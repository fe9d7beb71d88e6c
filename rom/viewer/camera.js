// A perspective camera that turns about a point. Matrices are 4 x 4, column by column.

function normalized(v) {
  const length = Math.hypot(...v);
  return v.map((c) => c / length);
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function inner(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function product(A, B) {
  const C = new Float32Array(16);
  for (let j = 0; j < 4; ++j) {
    for (let i = 0; i < 4; ++i) {
      for (let k = 0; k < 4; ++k) C[4 * j + i] += A[4 * k + i] * B[4 * j + k];
    }
  }
  return C;
}

const fieldOfView = 0.5;

export class Camera {
  /** Looks at a box so that a sphere of `radius` around `centre` fits. */
  constructor(centre, radius, extents) {
    this.initial = { centre, radius, extents };
    this.reset();
  }

  reset() {
    this.centre = [...this.initial.centre];
    this.radius = this.initial.radius;
    this.zoom = 1;
    // Flat parts are seen from their flat side; upright is y of these, z of all others.
    const thin = this.initial.extents.indexOf(Math.min(...this.initial.extents));
    this.up = thin === 2 ? [0, 1, 0] : [0, 0, 1];
    const front = [[1, 0, 0], [0, -1, 0], [0, 0, 1]][thin];
    const right = cross(this.up, front);
    this.back = normalized(front.map((f, i) => f + 0.45 * right[i] + 0.35 * this.up[i]));
  }

  frame() {
    const back = this.back;
    const right = normalized(cross(this.up, back));
    return { back, right, up: cross(back, right) };
  }

  /** Angles in radians: to the right, and up (never over the pole). */
  turn(right, up) {
    const height = Math.asin(Math.max(-1, Math.min(1, inner(this.back, this.up))));
    const limit = Math.PI / 2 - 0.02;
    const angle = Math.max(-limit, Math.min(limit, height + up)) - height;
    const frame = this.frame();
    const raised = this.back.map((c, i) => c * Math.cos(angle) + frame.up[i] * Math.sin(angle));
    const side = cross(this.up, raised);
    const along = inner(this.up, raised);
    this.back = normalized(raised.map((c, i) =>
      c * Math.cos(right) + side[i] * Math.sin(right) + this.up[i] * along * (1 - Math.cos(right))));
  }

  /** By parts of the picture's height. */
  move(right, up) {
    const frame = this.frame();
    const size = 2 * this.distance() * Math.tan(fieldOfView / 2);
    this.centre = this.centre.map((c, i) => c + size * (right * frame.right[i] + up * frame.up[i]));
  }

  zoomBy(factor) {
    this.zoom = Math.max(0.2, Math.min(50, this.zoom * factor));
  }

  distance(aspect = 1) {
    return (1.05 * this.radius) / Math.sin(fieldOfView / 2) / this.zoom / Math.min(1, aspect);
  }

  /** World to clip coordinates, and the rotation to the eye's axes. */
  matrices(aspect) {
    const { right, up, back } = this.frame();
    const distance = this.distance(aspect);
    const eye = this.centre.map((c, i) => c + distance * back[i]);
    const view = Float32Array.of(
      right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
      -inner(right, eye), -inner(up, eye), -inner(back, eye), 1);
    const near = Math.max(distance - 3 * this.radius, 0.01 * distance);
    const far = distance + 3 * this.radius;
    const f = 1 / Math.tan(fieldOfView / 2);
    const projection = Float32Array.of(
      f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0);
    return { transform: product(projection, view), rotation: view };
  }
}
