// The page: parameters in, picture and numbers out. Scripts find it as window.couture; the address
// may set parameters, "part.html#P1=30&load=250".
import { Camera } from "./camera.js";
import { controlCamera, element, format, ParameterControl, ticks } from "./controls.js";
import { Evaluator } from "./evaluator.js";
import { unpack } from "./model.js";
import { Renderer } from "./renderer.js";

const $ = (id) => document.getElementById(id);
const model = unpack(JSON.parse($("model").textContent));
const evaluator = new Evaluator(model);
const { surface } = evaluator;
const isDark = window.matchMedia("(prefers-color-scheme: dark)");
const withUnit = (name, unit) => (unit ? `${name} [${unit}]` : name);
const quantities = {
  displacement: { values: surface.magnitude, title: withUnit("displacement", model.units.length) },
  ...(model.no_stress ? {} : { von_mises: { values: surface.vonMises, title: withUnit("von Mises", model.units.stress) } })
};

const arrays = {
  position: new Float32Array(3 * surface.nPoints), normal: new Float32Array(3 * surface.nPoints),
  value: new Float32Array(surface.nPoints), outline: new Float32Array(3 * surface.nPoints)
};
let answer = {};
let range = [0, 1];
/** Factor on displacements at the slider's 1: the reference member's largest is a twelfth of its size. */
let unitScale = 1;

// ---- answers

const controls = model.parameters.map((one, i) => new ParameterControl(one, i, changed));
$("parameters").append(...controls.map((control) => control.root));

function currentPoint() {
  return Float64Array.from(controls, (control) => control.value);
}

function deformationScale() {
  return unitScale * Number($("deformation").value);
}

function evaluate() {
  const start = performance.now();
  answer = evaluator.evaluate(currentPoint());
  answer.milliseconds = performance.now() - start;
}

function showNumbers() {
  const { length, stress } = model.units;
  const expected = answer.errors;
  const row = (name, value) => element("tr", {}, element("td", {}, name), element("td", {}, value));
  const error = (relative) => (expected ? ` ± ${format(100 * relative(expected), 2)} %` : "");
  const rows = [row("displacement, largest",
    `${format(answer.displacement_max)} ${length}${error((e) => e.displacement.relative)}`)];
  if (!model.no_stress) {
    rows.push(row("von Mises, largest", `${format(answer.von_mises_max)} ${stress}${error((e) => e.von_mises)}`));
  }
  if (expected) {
    rows.push(row("displacement, std. error", `${format(expected.displacement.kriging, 2)} ${length}`));
    rows.push(row("geometry, std. error", `${format(expected.geometry.kriging, 2)} ${length}`));
  }
  $("answers").tBodies[0].replaceChildren(...rows);
  const outside = controls.filter((control) => control.outside() > 1e-9);
  $("outside").textContent = outside.map((control) =>
    `${control.one.name} is ${format(100 * control.outside(), 2)} % of its range outside of where the model learned.`).join(" ");
}

/** Expected errors cost more than the answer: when sliders rest. */
let errorsTimer = 0;
function laterErrors() {
  clearTimeout(errorsTimer);
  errorsTimer = setTimeout(() => {
    answer.errors = evaluator.errors(currentPoint());
    showNumbers();
  }, 60);
}

// ---- the picture

const { triangles, edges } = surface.topology();
let renderer = null;
let camera = null;

function updateRange() {
  if ($("hold").checked) return;
  const { values } = quantities[$("quantity").value];
  let low = Infinity;
  let high = -Infinity;
  for (const v of values) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  range = high > low ? [low, high] : [low, low + (Math.abs(low) || 1)];
}

function showLegend() {
  $("legend_title").textContent = quantities[$("quantity").value].title;
  $("legend_ticks").replaceChildren(...ticks(range).map((value) =>
    element("span", { style: `bottom: ${(100 * (value - range[0])) / (range[1] - range[0])}%` }, format(value))));
}

function upload() {
  surface.deform(deformationScale(), arrays.position, arrays.normal);
  surface.deform(0, arrays.outline, new Float32Array(arrays.normal.length));
  arrays.value.set(quantities[$("quantity").value].values);
  for (const [name, values] of Object.entries(arrays)) renderer.upload(name, values);
}

function draw() {
  if (!renderer) return;
  renderer.draw(camera, range, isDark.matches ? [0.92, 0.95, 1] : [0.06, 0.09, 0.14], $("outline").checked);
}

let isWaiting = { frame: false, upload: false };
function requestDraw(withUpload) {
  isWaiting.upload ||= withUpload;
  if (isWaiting.frame) return;
  isWaiting.frame = true;
  requestAnimationFrame(() => {
    if (isWaiting.upload && renderer) upload();
    isWaiting = { frame: false, upload: false };
    draw();
  });
}

function colored() {
  updateRange();
  showLegend();
  requestDraw(true);
}

function changed() {
  evaluate();
  showNumbers();
  colored();
  laterErrors();
}

function makePicture() {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  surface.x.forEach((v, i) => {
    low[i % 3] = Math.min(low[i % 3], v);
    high[i % 3] = Math.max(high[i % 3], v);
  });
  const extents = high.map((h, i) => h - low[i]);
  const size = Math.hypot(...extents);
  unitScale = answer.displacement_max > 0 ? size / 12 / answer.displacement_max : 1;
  unitScale = Number(unitScale.toPrecision(1));
  camera = new Camera(low.map((l, i) => (l + high[i]) / 2), 0.56 * size, extents);
  try {
    renderer = new Renderer($("view"), surface.nPoints, { triangles, edges }, model.colors);
  } catch (error) {
    $("no_gl").hidden = false;
    console.warn(error.message);
  }
  controlCamera($("view"), camera, () => requestDraw(false));
  new ResizeObserver(() => requestDraw(false)).observe($("view"));
}

function drawLegendBar() {
  const bar = $("legend_bar").getContext("2d");
  for (let i = 0; i < 256; ++i) {
    bar.fillStyle = `rgb(${model.colors.slice(3 * i, 3 * i + 3).join(" ")})`;
    bar.fillRect(0, 255 - i, 1, 1);
  }
}

/** Picture, legend and title as one image. */
function snapshot() {
  upload();
  draw();
  const view = $("view");
  const scale = view.width / view.clientWidth;
  const style = getComputedStyle(document.body);
  const image = Object.assign(document.createElement("canvas"), { width: view.width, height: view.height });
  const c = image.getContext("2d");
  c.fillStyle = style.backgroundColor;
  c.fillRect(0, 0, image.width, image.height);
  c.drawImage(view, 0, 0);
  c.scale(scale, scale);
  c.font = `13px ${style.fontFamily}`;
  c.fillStyle = style.color;
  const bottom = view.clientHeight - 20;
  const height = 180;
  c.drawImage($("legend_bar"), 14, bottom - height, 16, height);
  for (const value of ticks(range)) {
    c.fillText(format(value), 38, bottom - (height * (value - range[0])) / (range[1] - range[0]) + 4);
  }
  c.fillText($("legend_title").textContent, 14, bottom - height - 12);
  const text = controls.map(({ one, value }) => `${one.name} = ${format(value)} ${one.unit}`).join(", ");
  c.fillText(`${text}; deformation × ${format(deformationScale(), 3)}`, 14, 22);
  const link = element("a", { href: image.toDataURL("image/png"), download: `${model.title || "part"}.png` });
  link.click();
}

// ---- the page

function showDeformation() {
  $("deformation_value").textContent = `× ${format(deformationScale(), 3)}`;
  requestDraw(true);
}

function setUp() {
  document.title = model.title;
  $("title").textContent = model.title;
  for (const [name, { title }] of Object.entries(quantities)) {
    $("quantity").append(element("option", { value: name }, title));
  }
  const stress = model.no_stress ? `No stresses: ${model.no_stress}. ` : "";
  const trust = model.n_validated > 0
    ? `Expected errors are calibrated with ${model.n_validated} full solutions.`
    : "Expected errors are not calibrated yet (couture rom validate does it).";
  $("note").textContent = `${stress}Largest values are those at corners of elements on the surface. ${trust}`;
  $("origin").textContent = `${model.program}; ${surface.nPoints} points, ${model.displacement.modes.length} displacement modes.`;
  $("quantity").addEventListener("change", () => { $("hold").checked = false; colored(); });
  $("hold").addEventListener("change", colored);
  $("outline").addEventListener("change", () => requestDraw(false));
  $("deformation").addEventListener("input", showDeformation);
  $("reset").addEventListener("click", () => {
    for (const control of controls) control.show(control.one.reference);
    changed();
  });
  $("true_scale").addEventListener("click", () => {
    $("deformation").step = "any";
    $("deformation").value = 1 / unitScale;
    showDeformation();
  });
  $("home").addEventListener("click", () => { camera.reset(); requestDraw(false); });
  $("snapshot").addEventListener("click", snapshot);
  isDark.addEventListener("change", () => requestDraw(false));
}

/** Moves sliders as a user does. @param values  by name */
function set(values) {
  for (const control of controls) {
    if (values[control.one.name] === undefined) continue;
    const { step } = control.slider;
    control.slider.step = "any";
    control.slider.value = Number(values[control.one.name]);
    control.slider.dispatchEvent(new Event("input", { bubbles: true }));
    control.slider.step = step;
  }
}

/** Answers at a point, with expected errors. @param values  by name; the reference's where not given */
function evaluateAt(values) {
  const point = evaluator.point(values);
  const start = performance.now();
  const result = evaluator.evaluate(point);
  result.milliseconds = performance.now() - start;
  result.errors = evaluator.errors(point);
  evaluator.evaluate(currentPoint());
  return result;
}

/** Milliseconds of an evaluation, of filling the buffers and of a frame with both, means of n. */
function time(n = 50) {
  const mean = (body) => {
    const start = performance.now();
    for (let i = 0; i < n; ++i) body(i / n);
    return (performance.now() - start) / n;
  };
  const evaluateThere = (t) => evaluator.evaluate(
    Float64Array.from(model.parameters, (one) => one.lower + t * (one.upper - one.lower)));
  const result = { evaluation: mean(evaluateThere) };
  if (renderer) {
    const pixel = new Uint8Array(4);
    const { gl } = renderer;
    result.upload = mean(upload);
    result.frame = mean((t) => {
      evaluateThere(t);
      upload();
      draw();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    });
  }
  changed();
  return result;
}

/** "#P1=30&load=250"; "&answer=fields" and "&answer=time" leave results in the page for scripts. */
function followAddress() {
  const values = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  if (quantities[values.color]) {
    $("quantity").value = values.color;
    colored();
  }
  set(values);
  if (!values.answer) return;
  answer.errors = evaluator.errors(currentPoint());
  showNumbers();
  const result = { ...answer, values: Object.fromEntries(controls.map(({ one, value }) => [one.name, value])) };
  if (values.answer === "fields") Object.assign(result, { x: surface.x, u: surface.u, von_mises: surface.vonMises });
  if (values.answer === "time") result.time = time();
  $("answer").textContent = JSON.stringify(result, (_, value) => (ArrayBuffer.isView(value) ? Array.from(value) : value));
}

evaluate();
setUp();
makePicture();
drawLegendBar();
changed();
showDeformation();
followAddress();
window.addEventListener("hashchange", followAddress);
window.couture = { model, set, evaluate: evaluateAt, time, get answer() { return answer; } };
