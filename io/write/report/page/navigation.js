// SPDX-License-Identifier: Apache-2.0
// Where the camera is: a pose looks at a target from a direction, with an axis that is up. It moves in flights from pose
// to pose, by zoom, and by keys held down.

// How far the scan and its loops reach, in scene coordinates.

const kFramed = 0.98, kFrameMore = 0.15;  // the part of the points that a picture holds; of its range, what it has around them
const kSure = 0.9;  // confidence of holes that it holds, too

// {box: of most positions, outline: some of the positions, surest: vertices of the surest holes, middle and radius: a ball around all}
function scene_bounds({points, loops, report, frame}) {
  const usual = {low: [-0.5, -0.5, -0.5], high: [0.5, 0.5, 0.5]};
  const given = report.bounds
      ? {low: to_scene(frame, report.bounds.min), high: to_scene(frame, report.bounds.max)} : null;
  const box = usual_box(points.positions) || usual_box(loops.vertices) || given || usual;
  const {low, high} = given || usual;
  return {
    box,
    outline: outline_places(points.count > 0 ? points.positions : loops.vertices),
    surest: Array.from(loops.id.keys()).filter((i) => loops.is_hole[i] && loops.confidence[i] >= kSure)
        .flatMap((i) => Array.from(loops.vertices.subarray(3 * loops.first[i], 3 * loops.first[i + 1]))),
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

// A few thousand of the positions; one without any.
function outline_places(positions) {
  const count = positions.length / 3;
  const step = Math.max(1, Math.floor(count / 6000));
  const places = [];
  for (let i = 0; i < count; i += step) places.push(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
  return places.length > 0 ? places : [0, 0, 0];
}

// The narrowest range that holds 98 in 100 of the values, and a little more.
function most_of(values) {
  const sorted = Float64Array.from(values).sort();
  const steps = Math.floor(kFramed * (sorted.length - 1));
  let at = 0;
  for (let i = 1; i + steps < sorted.length; ++i) if (sorted[i + steps] - sorted[i] < sorted[at + steps] - sorted[at]) at = i;
  const more = kFrameMore * (sorted[at + steps] - sorted[at]);
  return [sorted[at] - more, sorted[at + steps] + more];
}

// What a picture along these axes holds: far pieces do not make the rest small.
function framed_places({outline, surest}, axes) {
  const count = outline.length / 3;
  const along = axes.map((axis) => Array.from({length: count}, (_, i) => axis[0] * outline[3 * i] + axis[1] * outline[3 * i + 1] + axis[2] * outline[3 * i + 2]));
  const ranges = along.map(most_of);
  const is_held = (_, i) => ranges.every(([low, high], k) => along[k][Math.floor(i / 3)] >= low && along[k][Math.floor(i / 3)] <= high);
  return [...outline.filter(is_held), ...surest];
}

const kFieldOfView = 38;  // degrees, vertical
const kLeastPolar = 1e-4;

// {target: [x, y, z], distance, polar (from up), azimuth, up}
function pose_of(camera, target, up) {
  const offset = camera.position.clone().sub(target);
  const distance = Math.max(offset.length(), 1e-12);
  const [first, second, height] = level_parts(offset.toArray(), up);
  return {
    target: target.toArray(),
    distance,
    polar: Math.acos(Math.min(1, Math.max(-1, height / distance))),
    azimuth: Math.atan2(second, first),
    up,
  };
}

function pose_direction(pose) {
  const across = Math.sin(pose.polar);
  return upright(across * Math.cos(pose.azimuth), across * Math.sin(pose.azimuth), Math.cos(pose.polar), pose.up);
}

// Unit vectors to the right, up and to the eye.
function picture_axes(from) {
  const back = pose_direction(from);
  const right = upright(-Math.sin(from.azimuth), Math.cos(from.azimuth), 0, from.up);
  return [right, [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]], back];
}

// The pose that has all of `places` (numbers x, y, z, x, ...) in the middle of the picture, from the direction of `from`.
function pose_of_places(places, from, aspect) {
  const axes = picture_axes(from);
  const turned = new Float64Array(places.length);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < places.length; ++i) {
    const k = i % 3, at = i - k;
    turned[i] = places[at] * axes[k][0] + places[at + 1] * axes[k][1] + places[at + 2] * axes[k][2];
    low[k] = Math.min(low[k], turned[i]);
    high[k] = Math.max(high[k], turned[i]);
  }
  const middle = low.map((value, k) => (value + high[k]) / 2);
  const tall = Math.tan((kFieldOfView * Math.PI) / 360);
  const slopes = [tall * aspect, tall];
  let distance = 0;
  // Near parts look larger: the middle of the picture is found step by step.
  for (let step = 0; step < 4; ++step) {
    distance = 1e-6;
    for (let i = 0; i < turned.length; i += 3) {
      const toward = turned[i + 2] - middle[2];
      for (let k = 0; k < 2; ++k) distance = Math.max(distance, toward + Math.abs(turned[i + k] - middle[k]) / slopes[k]);
    }
    for (let k = 0; k < 2; ++k) {
      let least = Infinity, most = -Infinity;
      for (let i = 0; i < turned.length; i += 3) {
        const seen = (turned[i + k] - middle[k]) / Math.max(1e-9, distance - (turned[i + 2] - middle[2]));
        least = Math.min(least, seen);
        most = Math.max(most, seen);
      }
      if (step < 3) middle[k] += ((least + most) / 2) * distance * 0.9;
    }
  }
  const target = [0, 1, 2].map((axis) => axes.reduce((sum, unit, k) => sum + unit[axis] * middle[k], 0));
  return {target, distance, polar: from.polar, azimuth: from.azimuth, up: from.up};
}

// The direction from which the eye looks along a unit vector. Straight from above the picture keeps its turn.
function turn_along(direction, {azimuth, up}) {
  const [first, second, height] = level_parts(direction, up);
  const is_upright = Math.hypot(first, second) < 0.02;
  return {
    polar: Math.min(Math.PI - kLeastPolar, Math.max(kLeastPolar, Math.acos(Math.min(1, Math.max(-1, height))))),
    azimuth: is_upright ? azimuth : Math.atan2(second, first),
    up,
  };
}

// How many of the points stand over a loop, on both sides of its plane: [against the normal, along it]. They count as far
// away as the eye sees them, within the middle of the loop.
function points_over(positions, middle, normal, radius) {
  const counts = [0, 0];
  for (let i = 0; i < positions.length; i += 3) {
    const x = positions[i] - middle[0], y = positions[i + 1] - middle[1], z = positions[i + 2] - middle[2];
    const along = x * normal[0] + y * normal[1] + z * normal[2];
    const away = Math.abs(along);
    if (away > 0.1 * radius && away < kCutRadii * radius && x * x + y * y + z * z - along * along < 0.5 * radius * radius) ++counts[along > 0 ? 1 : 0];
  }
  return counts;
}

function poses_between(a, b, part) {
  const eased = part * part * (3 - 2 * part);
  const turn = Math.atan2(Math.sin(b.azimuth - a.azimuth), Math.cos(b.azimuth - a.azimuth));
  const mix = (from, to) => from + (to - from) * eased;
  const distance = Math.exp(mix(Math.log(a.distance), Math.log(b.distance)));
  // The target moves as the distance does: while far, the picture moves as much as while near.
  const moved = Math.abs(b.distance - a.distance) < 1e-3 * a.distance
      ? eased : (distance - a.distance) / (b.distance - a.distance);
  return {
    target: a.target.map((value, axis) => value + (b.target[axis] - value) * moved),
    distance,
    polar: mix(a.polar, b.polar),
    azimuth: a.azimuth + turn * eased,
    up: b.up,
  };
}

const kFlightMilliseconds = 700;
const kHomePolar = 0.95, kHomeAzimuth = -1.05;  // radians: where a page begins
const kLoopPart = 0.6;  // of the picture's width or height, which a chosen loop fills
const kCutRadii = 0.9;  // what is nearer to the eye than this before a chosen loop is not drawn

class Navigation {
  // `bounds` of scene_bounds(), `spacing` of sample_spacing().
  constructor(canvas, data, bounds, spacing, frames) {
    Object.assign(this, {canvas, data, bounds, spacing, frames});
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 10);
    this.is_reduced = matchMedia("(prefers-reduced-motion: reduce)");
    this.flight = null;
    this.held = new Map();  // key held down: function of seconds
    this.make_controls();
  }

  // OrbitControls keep the direction that is up when they are made.
  make_controls() {
    const target = this.controls ? this.controls.target : new THREE.Vector3();
    if (this.controls) this.controls.dispose();
    this.camera.up.set(...upright(0, 0, 1, this.data.frame.up));
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(target);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.minDistance = 1e-6;
    this.controls.maxDistance = 40;
    this.controls.addEventListener("change", () => this.frames.changed());
    this.controls.addEventListener("start", () => { this.flight = null; });
  }

  // ---- Poses

  pose() { return pose_of(this.camera, this.controls.target, this.data.frame.up); }

  set_pose(pose) {
    const direction = pose_direction({...pose, polar: Math.min(Math.PI - kLeastPolar, Math.max(kLeastPolar, pose.polar))});
    this.controls.target.set(...pose.target);
    this.camera.position.set(...direction.map((value, axis) => pose.target[axis] + value * pose.distance));
    this.controls.update();
    this.frames.changed();
  }

  fit_pose(polar, azimuth) {
    const from = {polar, azimuth, up: this.data.frame.up};
    const pose = pose_of_places(framed_places(this.bounds, picture_axes(from)), from, this.camera.aspect);
    return {...pose, distance: pose.distance * 1.06};
  }

  // The pose of one of the buttons: "fit", "top", "front" or "side".
  side_pose(name) {
    const {polar, azimuth} = this.pose();
    const poses = {top: [kLeastPolar, -Math.PI / 2], front: [Math.PI / 2, -Math.PI / 2], side: [Math.PI / 2, 0]};
    return this.fit_pose(...(poses[name] || [polar, azimuth]));
  }

  // `now`: the pose that says from which side; that of the camera without one.
  loop_pose(index, now = this.pose()) {
    const {loops} = this.data;
    const box = loop_box(loops, index);
    if (!box) return now;  // a loop through strays: it is not drawn
    const places = loops.vertices.subarray(3 * loops.first[index], 3 * loops.first[index + 1]);
    const pose = pose_of_places(places, {...now, ...this.open_side(index, box, now)}, this.camera.aspect);
    return {...pose, distance: Math.max(pose.distance / kLoopPart, 6 * this.spacing)};
  }

  // The direction along the normal, from the side where fewer points stand over the loop; else from that of the camera.
  open_side(index, {middle, radius}, now) {
    const normal = vector_of(this.data.loops.normal, index).map((v) => v || 0);
    if (!(Math.hypot(...normal) > 0)) return now;
    const [behind, before] = points_over(this.data.points.positions, middle, normal, radius);
    const eye = pose_direction(now).map((value, axis) => now.target[axis] + value * now.distance - middle[axis]);
    const toward = eye[0] * normal[0] + eye[1] * normal[1] + eye[2] * normal[2];
    const side = before > 2 * behind + 3 ? -1 : behind > 2 * before + 3 ? 1 : toward < 0 ? -1 : 1;
    return turn_along(normal.map((value) => side * value), now);
  }

  // How far before the loop what is shown begins, seen from loop_pose(): so near that no ceiling or wall hides it.
  loop_cut(index, pose) {
    const {first, vertices} = this.data.loops;
    const direction = pose_direction(pose);
    const size = Math.max(loop_box(this.data.loops, index).radius, 3 * this.spacing);
    let before = 0;
    for (let i = first[index]; i < first[index + 1]; ++i) {
      before = Math.max(before, direction.reduce((sum, value, k) => sum + value * (vertices[3 * i + k] - pose.target[k]), 0));
    }
    return Math.max(kCutRadii * size, 1.2 * before);
  }

  // ---- Movements

  fly(pose) {
    if (this.is_reduced.matches) {
      this.flight = null;
      this.set_pose(pose);
      return;
    }
    this.flight = {from: this.pose(), to: pose, start: performance.now()};
    this.frames.request();
  }

  // At once at the end of the flight.
  end_flight() {
    if (this.flight) this.set_pose(this.flight.to);
    this.flight = null;
  }

  zoom(factor, x, y) {
    this.flight = null;
    const pose = this.pose();
    const bounded = Math.min(40, Math.max(1e-6, pose.distance * factor)) / pose.distance;
    let pivot = this.controls.target.clone();
    if (x !== undefined) {
      const ray = this.ray_at(x, y);
      const forward = new THREE.Vector3();
      this.camera.getWorldDirection(forward);
      pivot = this.camera.position.clone().addScaledVector(ray, pose.distance / Math.max(0.1, ray.dot(forward)));
    }
    this.camera.position.sub(pivot).multiplyScalar(bounded).add(pivot);
    this.controls.target.sub(pivot).multiplyScalar(bounded).add(pivot);
    this.controls.update();
    this.frames.changed();
  }

  // Turns by angles and moves by parts of the picture's height.
  nudge(azimuth, polar, right, up) {
    this.flight = null;
    const pose = this.pose();
    const height = 2 * pose.distance * Math.tan((kFieldOfView * Math.PI) / 360);
    const elements = this.camera.matrixWorld.elements;
    pose.target = pose.target.map((value, k) => value + height * (right * elements[k] + up * elements[4 + k]));
    pose.azimuth += azimuth;
    pose.polar = Math.min(Math.PI - kLeastPolar, Math.max(kLeastPolar, pose.polar + polar));
    this.set_pose(pose);
  }

  // While the key is down, `act(seconds)` is called for each picture.
  hold(key, act) {
    if (this.held.has(key)) return;
    this.held.set(key, act);
    act(1 / 60);
    this.held_time = performance.now();
    this.frames.request();
  }

  release(key) {
    if (key === undefined) this.held.clear(); else this.held.delete(key);
  }

  // Before a picture: one step of the flight and of the keys held down.
  move() {
    if (this.flight) {
      const {from, to, start} = this.flight;
      const part = Math.min(1, (performance.now() - start) / kFlightMilliseconds);
      this.set_pose(poses_between(from, to, part));
      if (part >= 1) this.flight = null;
    }
    if (this.held.size > 0) {
      const seconds = Math.min(0.1, (performance.now() - this.held_time) / 1000);
      this.held_time = performance.now();
      for (const act of this.held.values()) act(seconds);
      this.frames.request();
    }
  }

  // ---- The camera's picture

  // From the eye to the place of the window.
  ray_at(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return new THREE.Vector3((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height, 0.5)
        .unproject(this.camera).sub(this.camera.position).normalize();
  }

  target_distance() { return this.camera.position.distanceTo(this.controls.target); }

  // Sets the depths between which all of the scan lies; `nearest` is the least of them.
  update_depths(nearest = 0) {
    const {camera} = this;
    const {middle, radius} = this.bounds;
    const away = camera.position.distanceTo(middle);
    const to_target = this.target_distance();
    camera.far = Math.max(away + radius, to_target) * 1.05;
    camera.near = Math.max(nearest, (away - radius) * 0.95, Math.min(to_target * 0.01, camera.far * 0.01), camera.far * 1e-6);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }
}
