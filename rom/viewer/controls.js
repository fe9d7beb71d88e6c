// Elements of the page that are made for a model.

const mostOutside = 0.2;

export function format(value, digits = 4) {
  if (value === null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(digits - 1);
  return String(Number(value.toPrecision(digits)));
}

/** A new element. @param children  elements or texts */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Ends of a parameter's slider: the training box and a fifth of it on both sides, as `rom eval`. */
function sliderEnds(one) {
  const margin = mostOutside * (one.upper - one.lower);
  const low = one.lower - margin;
  const high = one.upper + margin;
  // Values that are positive stay so; Poisson's ratios stay below 1/2.
  return [one.lower > 0 ? Math.max(low, one.lower / 10) : low,
    one.is_poissons_ratio ? Math.max(one.upper, Math.min(high, 0.499)) : high];
}

/** Slider and number of a parameter; calls `changed` when a user moves them. */
export class ParameterControl {
  constructor(one, index, changed) {
    this.one = one;
    const [low, high] = sliderEnds(one);
    Object.assign(this, { low, high });
    const unit = one.unit ? ` ${one.unit}` : "";
    const id = `parameter_${index}`;
    const described = `${one.name}, learned from ${format(one.lower)} to ${format(one.upper)}${unit}`;
    this.slider = element("input", {
      type: "range", id, min: low, max: high, step: (high - low) / 1000, "aria-label": described
    });
    this.number = element("input", { type: "number", step: "any", "aria-label": `${one.name}, number` });
    const place = (value) => `calc(8px + (100% - 16px) * ${(value - low) / (high - low)})`;
    const box = element("div", { class: "box", title: "where the model learned",
      style: `left: ${place(one.lower)}; right: calc(100% - ${place(one.upper).slice(4)})` });
    const mark = (value) => element("span", { style: `left: ${place(value)}` }, `${format(value)}${unit}`);
    this.root = element("div", { class: "parameter" },
      element("div", { class: "row" }, element("label", { for: id }, one.name),
        element("span", {}, this.number, element("span", { class: "unit" }, unit))),
      element("div", { class: "track" }, box, this.slider),
      element("div", { class: "range" }, mark(one.lower), mark(one.upper)));
    this.slider.addEventListener("input", () => {
      // A slider's steps need not meet the value that it was set to.
      this.show(Number(this.slider.value), false);
      changed();
    });
    this.number.addEventListener("change", () => {
      const value = Number(this.number.value);
      this.show(this.number.value !== "" && Number.isFinite(value) ? Math.max(low, Math.min(high, value)) : this.value);
      changed();
    });
    this.show(one.reference);
  }

  show(value, movesSlider = true) {
    this.value = value;
    if (movesSlider) this.slider.value = value;
    this.number.value = Number(value.toPrecision(6));
    this.slider.setAttribute("aria-valuetext", `${format(value)} ${this.one.unit}`);
  }

  /** By how much of its range outside of it. */
  outside() {
    const { lower, upper } = this.one;
    return Math.max(0, lower - this.value, this.value - upper) / (upper - lower);
  }
}

/** Round numbers in a range, three to seven of them. */
export function ticks([low, high]) {
  const rough = (high - low) / 5;
  if (!(rough > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= rough);
  const result = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9); ++k) result.push(k * step);
  return result;
}

/** Turns, moves and zooms a camera by pointers and keys; calls `changed`. */
export function controlCamera(canvas, camera, changed) {
  const pointers = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
  });
  const release = (event) => pointers.delete(event.pointerId);
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const dx = (event.clientX - before.clientX) / canvas.clientHeight;
    const dy = (event.clientY - before.clientY) / canvas.clientHeight;
    if (pointers.size === 2) {
      const other = [...pointers.values()].find((one) => one.pointerId !== event.pointerId);
      const gap = (one) => Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
      camera.zoomBy(gap(event) / Math.max(1, gap(before)));
      camera.move(-dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      camera.move(-dx, dy);
    } else {
      camera.turn(-4 * dx, 4 * dy);
    }
    pointers.set(event.pointerId, event);
    changed();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoomBy(Math.exp(-event.deltaY / 800));
    changed();
  }, { passive: false });
  const step = 0.12;
  const keys = {
    ArrowLeft: () => camera.turn(-step, 0), ArrowRight: () => camera.turn(step, 0),
    ArrowUp: () => camera.turn(0, step), ArrowDown: () => camera.turn(0, -step),
    "+": () => camera.zoomBy(1.2), "=": () => camera.zoomBy(1.2), "-": () => camera.zoomBy(1 / 1.2)
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    keys[event.key]();
    event.preventDefault();
    changed();
  });
}
