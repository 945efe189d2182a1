// SPDX-License-Identifier: Apache-2.0
// How far the scan and its loops reach, in scene coordinates.

// {box: of most positions, outline: places to fit a picture to, middle and radius: a ball around all}
function scene_bounds({points, loops, report, frame}) {
  const usual = {low: [-0.5, -0.5, -0.5], high: [0.5, 0.5, 0.5]};
  const given = report.bounds
      ? {low: to_scene(frame, report.bounds.min), high: to_scene(frame, report.bounds.max)} : null;
  const box = usual_box(points.positions) || usual_box(loops.vertices) || given || usual;
  const {low, high} = given || usual;
  return {
    box,
    outline: outline_places(points.count > 0 ? points.positions : loops.vertices, box),
    middle: new THREE.Vector3(...[0, 1, 2].map((k) => (low[k] + high[k]) / 2)),
    radius: Math.max(1e-3, Math.hypot(...[0, 1, 2].map((k) => (high[k] - low[k]) / 2))),
  };
}

// [low, high] of the scan; without far outliers, which would leave no more than a few steps of a slider for the rest.
function scene_heights(bounds, {report, frame}) {
  const usual = [bounds.box.low[frame.up], bounds.box.high[frame.up]];
  if (!report.bounds) return usual;
  const all = [report.bounds.min, report.bounds.max].map((place) => to_scene(frame, place)[frame.up]);
  return all[1] - all[0] <= 2 * (usual[1] - usual[0]) ? all : usual;
}

// Box of a loop's vertices, its middle and half its diagonal; null without vertices.
function loop_box({first, vertices}, index) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = first[index]; i < first[index + 1]; ++i) {
    for (let axis = 0; axis < 3; ++axis) {
      low[axis] = Math.min(low[axis], vertices[3 * i + axis]);
      high[axis] = Math.max(high[axis], vertices[3 * i + axis]);
    }
  }
  if (first[index + 1] <= first[index]) return null;
  const middle = low.map((value, axis) => (value + high[axis]) / 2);
  return {low, high, middle, radius: Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2};
}

// Box of most positions, so that a few outliers do not make the rest small. Null without positions.
function usual_box(positions) {
  const count = positions.length / 3;
  if (count === 0) return null;
  const step = Math.max(1, Math.floor(count / 20000));
  const low = [0, 0, 0], high = [0, 0, 0];
  for (let axis = 0; axis < 3; ++axis) {
    const values = new Float32Array(Math.ceil(count / step));
    for (let i = 0, k = 0; i < count; i += step) values[k++] = positions[3 * i + axis];
    values.sort();
    const at = (part) => values[Math.round(part * (values.length - 1))];
    const margin = 0.02 * (at(0.995) - at(0.005));
    low[axis] = Math.max(values[0], at(0.005) - margin);
    high[axis] = Math.min(values[values.length - 1], at(0.995) + margin);
  }
  return {low, high};
}

// A few thousand of the positions inside of the box, enough to fit a picture to; two corners of the box without any.
function outline_places(positions, {low, high}) {
  const count = positions.length / 3;
  const step = Math.max(1, Math.floor(count / 6000));
  const places = [];
  for (let i = 0; i < count; i += step) {
    const place = [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
    if (place.every((value, axis) => value >= low[axis] && value <= high[axis])) places.push(...place);
  }
  return places.length > 0 ? places : [...low, ...high];
}
