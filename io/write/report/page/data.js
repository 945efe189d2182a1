// SPDX-License-Identifier: Apache-2.0
// The data elements of the page, decoded once into typed arrays.
//
// Scene coordinates are the frame's unit cube with its middle at zero: real = origin + (scene + 0.5) * edge. A scene
// coordinate is a multiple of 2^-22, so a 32-bit float holds it exactly, whatever the real coordinates are.

// Bytes of a base64 element; none without it. The element leaves the page, so its text is freed.
function take_bytes(id) {
  const element = document.getElementById(id);
  if (!element) return new Uint8Array(0);
  const text = element.textContent.trim();
  element.remove();
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// Points are drawn in this order: any first part of them is spread over the whole sample.
function spread_step(count) {
  const common = (a, b) => (b === 0 ? a : common(b, a % b));
  let step = Math.max(1, Math.round(count * 0.6180339887));
  while (common(step, count) !== 1) ++step;
  return step;
}

// Scene coordinates, three per position, from 8 bytes each; `step` permutes them (1: as they are).
function unpack_positions(bytes, step) {
  const count = Math.floor(bytes.length / 8);
  const words = new DataView(bytes.buffer, bytes.byteOffset, count * 8);
  const out = new Float32Array(count * 3);
  const scale = 1 / 2097152;
  for (let i = 0, from = 0, to = 0; i < count; ++i, from = (from + step) % count) {
    const low = words.getUint32(8 * from, true);
    const high = words.getUint32(8 * from + 4, true);
    out[to++] = ((low & 0x1fffff) + 0.5) * scale - 0.5;
    out[to++] = (((low >>> 21) | ((high & 0x3ff) << 11)) + 0.5) * scale - 0.5;
    out[to++] = (((high >>> 10) & 0x1fffff) + 0.5) * scale - 0.5;
  }
  return out;
}

// Four bytes per point, in the order in which points are drawn; `of(from)` gives those of a point of the report.
function pack(count, step, of) {
  const out = new Uint8Array(count * 4);
  for (let i = 0, from = 0; i < count; ++i, from = (from + step) % count) out.set(of(from), 4 * i);
  return out;
}

// Probability and the two numbers of the normal, which a shader reads as 0 to 1 (normals: 128 is 0).
function pack_attributes(count, step, probabilities, normals) {
  const has_normals = normals.length >= 2 * count;
  const part = (at) => (has_normals ? normals[at] ^ 0x80 : 128);  // int8 + 128
  return pack(count, step, (from) => [probabilities[from] || 0, part(2 * from), part(2 * from + 1), 0]);
}

// Numbers of a column; NaN stands for null, which is a value that is not finite.
function number_column(values, count) {
  const out = new Float64Array(count).fill(NaN);
  for (let i = 0; i < count && values; ++i) {
    if (typeof values[i] === "number") out[i] = values[i];
  }
  return out;
}

function vector_column(values, count) {
  return number_column(values && values.flatMap((vector) => vector || [null, null, null]), 3 * count);
}

// The three numbers of a row of such a column.
function vector_of(column, index) {
  return Array.from(column.subarray(3 * index, 3 * index + 3));
}

// The measures of a loop, in the order of holes.csv.
const kMeasures = ["points", "confidence", "prominence", "first_scale", "last_scale", "perimeter", "area", "diameter", "planarity", "mean_probability"];

// `has_stations`: causes are known from stations. Changes since an earlier result take their place.
function read_loops(loops, has_stations) {
  const count = loops && loops.id ? loops.id.length : 0;
  const has_changes = Boolean(loops && loops.change);
  const column = (name) => number_column(loops && loops[name], count);
  const small = (loops && loops.small) || [];
  return {
    count,
    all: loops && Number.isFinite(loops.all) ? loops.all : count,
    is_hole: Uint8Array.from({length: count}, (_, i) => (loops.kind[i] === "hole" ? 1 : 0)),
    is_small: Uint8Array.from(small),  // near the spacing; none where they are few
    small_count: small.filter(Boolean).length,
    small_below: loops && loops.small_below,  // spacings
    ...Object.fromEntries(["id", ...kMeasures].map((name) => [name, column(name)])),
    centroid: vector_column(loops && loops.centroid, count),
    normal: vector_column(loops && loops.normal, count),
    has_changes,
    has_causes: has_stations || has_changes,
    causes: has_changes ? kChanges : kCauses,
    cause_word: has_changes ? "Change" : "Cause",
    cause: Array.from({length: count}, (_, i) => (has_changes ? loops.change[i] : loops.cause && loops.cause[i]) || kNoCause),
    earlier: (loops && loops.earlier) || [],
    shares: Object.fromEntries(kCauses.map((name) => [name, column(name)])),
    hidden_by: vector_column(loops && loops.hidden_by, count),
    hidden_from: column("hidden_from"),
    hidden_from_place: vector_column(loops && loops.hidden_from_place, count),
    first: loops && loops.first ? loops.first : [0],
    vertices: unpack_positions(take_bytes("loop_vertices"), 1),
  };
}

// { report, frame, stations, points: {count, positions, attributes, colours or null}, loops }
function read_data() {
  const element = document.getElementById("report");
  const report = element ? JSON.parse(element.textContent) : {};
  const frame = {...(report.frame || {origin: [0, 0, 0], edge: 1}), up: 2};
  const bytes = take_bytes("positions");
  const count = Math.floor(bytes.length / 8);
  const step = spread_step(count);
  const sample = report.sample || {};
  const stations = report.stations || [];
  const has_normals = Boolean(sample.has_normals);
  const colours = take_bytes("colours");
  return {
    report,
    frame,
    stations,
    next_stations: report.next_stations || [],
    has_normals,
    points: {
      count,
      positions: unpack_positions(bytes, step),
      attributes: pack_attributes(count, step, take_bytes("probabilities"),
                                  has_normals ? take_bytes("normals") : new Uint8Array(0)),
      colours: sample.has_colours && colours.length >= 3 * count ? pack(count, step, (from) => [...colours.subarray(3 * from, 3 * from + 3), 255]) : null,
    },
    loops: read_loops(report.loops, stations.length > 0),
  };
}

// Between real and scene coordinates, as plain arrays of three.
function to_scene(frame, real) {
  return real.map((value, axis) => (value - frame.origin[axis]) / frame.edge - 0.5);
}

function to_real(frame, scene) {
  return scene.map((value, axis) => frame.origin[axis] + (value + 0.5) * frame.edge);
}

// Which axis points up: z, unless the reader chooses another one. frame.up has its number: 0, 1 or 2 for x, y or z.
//
// The two level axes follow it in the order x, y, z, x, so that a view from above is never a mirror image.

// [x, y, z] of a vector that is given along the two level axes and up.
function upright(first, second, height, up) {
  const vector = [0, 0, 0];
  vector[(up + 1) % 3] = first;
  vector[(up + 2) % 3] = second;
  vector[up] = height;
  return vector;
}

// The parts of a vector along the level axes, then that along up.
function level_parts(vector, up) {
  return [vector[(up + 1) % 3], vector[(up + 2) % 3], vector[up]];
}

// Between heights in scene coordinates and real ones.
function real_height(frame, height) {
  return to_real(frame, upright(0, 0, height, frame.up))[frame.up];
}

function scene_height(frame, height) {
  return to_scene(frame, upright(0, 0, height, frame.up))[frame.up];
}
