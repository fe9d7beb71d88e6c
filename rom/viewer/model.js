// What the page carries, as typed arrays.

const kinds = {
  f64: Float64Array, f32: Float32Array, i32: Int32Array, i16: Int16Array, i8: Int8Array, u8: Uint8Array
};

/** {"type": "f64", "data": base64} to a typed array; little endian, as all browsers' machines are. */
export function decode(packed) {
  const text = atob(packed.data);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new kinds[packed.type](bytes.buffer);
}

/** A mode, from integers and the size of their unit if it was rounded. */
function decodeMode(packed) {
  const values = decode(packed);
  return packed.unit === undefined ? values : Float32Array.from(values, (v) => v * packed.unit);
}

/** All {"type", "data"} below an object decoded; modes by their own rule. */
export function unpack(object) {
  if (Array.isArray(object)) return object.map(unpack);
  if (object === null || typeof object !== "object") return object;
  if (object.data !== undefined) return object.unit === undefined ? decode(object) : decodeMode(object);
  return Object.fromEntries(Object.entries(object).map(([key, value]) => [key, unpack(value)]));
}
