// Draws one coloured surface and lines by WebGL 2.

const surfaceVertex = `#version 300 es
uniform mat4 transform, rotation;
in vec3 position, normal;
in float value;
out vec3 eye_normal;
out float shade_value;
void main() {
  gl_Position = transform * vec4(position, 1.0);
  eye_normal = mat3(rotation) * normal;
  shade_value = value;
}`;

const surfaceFragment = `#version 300 es
precision highp float;
uniform sampler2D colors;
uniform vec2 range;
in vec3 eye_normal;
in float shade_value;
out vec4 color;
void main() {
  vec3 n = normalize(eye_normal);
  n *= n.z < 0.0 ? -1.0 : 1.0;
  float t = clamp((shade_value - range.x) / (range.y - range.x), 0.0, 1.0);
  vec3 base = texture(colors, vec2(mix(0.5, 255.5, t) / 256.0, 0.5)).rgb;
  float key = max(dot(n, normalize(vec3(0.35, 0.55, 0.75))), 0.0);
  float fill = max(dot(n, normalize(vec3(-0.6, -0.1, 0.6))), 0.0);
  float shine = pow(max(dot(n, normalize(vec3(0.2, 0.3, 1.0))), 0.0), 60.0);
  color = vec4(base * (0.5 + 0.5 * key + 0.2 * fill) + 0.12 * shine, 1.0);
}`;

const lineVertex = `#version 300 es
uniform mat4 transform;
uniform float lift;
in vec3 position;
void main() {
  gl_Position = transform * vec4(position, 1.0);
  gl_Position.z -= lift * gl_Position.w;
}`;

const lineFragment = `#version 300 es
precision highp float;
uniform vec4 line_color;
out vec4 color;
void main() { color = line_color; }`;

function makeProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

export class Renderer {
  /** @param colors  256 x 3 bytes. @throws Error  without WebGL 2 */
  constructor(canvas, nPoints, { triangles, edges }, colors) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    Object.assign(this, { canvas, gl, nTriangles: triangles.length, nEdges: edges.length });
    this.surface = makeProgram(gl, surfaceVertex, surfaceFragment);
    this.line = makeProgram(gl, lineVertex, lineFragment);
    this.buffers = {};
    for (const [name, size] of [["position", 3], ["normal", 3], ["value", 1], ["outline", 3]]) {
      this.buffers[name] = { buffer: gl.createBuffer(), size };
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name].buffer);
      gl.bufferData(gl.ARRAY_BUFFER, 4 * size * nPoints, gl.DYNAMIC_DRAW);
    }
    this.triangleArray = this.makeArray(this.surface, { position: "position", normal: "normal", value: "value" }, triangles);
    this.edgeArray = this.makeArray(this.line, { position: "position" }, edges);
    this.outlineArray = this.makeArray(this.line, { position: "outline" }, edges);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colors);
    for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.LINEAR);
    for (const key of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, key, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  makeArray(program, attributes, indices) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const [attribute, name] of Object.entries(attributes)) {
      const at = gl.getAttribLocation(program, attribute);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name].buffer);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, this.buffers[name].size, gl.FLOAT, false, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return array;
  }

  /** @param name  position, normal, value or outline; @param values  Float32Array of all points */
  upload(name, values) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name].buffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
  }

  resize() {
    const scale = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
  }

  /** @param lineColor  red, green, blue of lines */
  draw(camera, range, lineColor, hasOutline) {
    const { gl } = this;
    this.resize();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const { transform, rotation } = camera.matrices(this.canvas.width / this.canvas.height);
    gl.useProgram(this.surface);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.surface, "transform"), false, transform);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.surface, "rotation"), false, rotation);
    gl.uniform2f(gl.getUniformLocation(this.surface, "range"), ...range);
    gl.bindVertexArray(this.triangleArray);
    gl.drawElements(gl.TRIANGLES, this.nTriangles, gl.UNSIGNED_INT, 0);
    gl.useProgram(this.line);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.line, "transform"), false, transform);
    gl.uniform1f(gl.getUniformLocation(this.line, "lift"), 2e-4);
    const lines = (array, opacity) => {
      gl.uniform4f(gl.getUniformLocation(this.line, "line_color"), ...lineColor, opacity);
      gl.bindVertexArray(array);
      gl.drawElements(gl.LINES, this.nEdges, gl.UNSIGNED_INT, 0);
    };
    lines(this.edgeArray, 0.35);
    if (hasOutline) lines(this.outlineArray, 0.75);
  }
}
