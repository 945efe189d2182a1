// SPDX-License-Identifier: Apache-2.0
// Moves the camera: to poses, in flights, by zoom, and by keys held down.

const kFlightMilliseconds = 700;
const kHomePolar = 0.95, kHomeAzimuth = -1.05;  // radians: where a page begins

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
    const pose = pose_of_places(this.bounds.outline, {polar, azimuth, up: this.data.frame.up}, this.camera.aspect);
    return {...pose, distance: pose.distance * 1.12};
  }

  // The pose of one of the buttons: "fit", "top", "front" or "side".
  side_pose(name) {
    const now = this.pose();
    if (name === "top") return this.fit_pose(kLeastPolar, -Math.PI / 2);
    if (name === "front") return this.fit_pose(Math.PI / 2, -Math.PI / 2);
    if (name === "side") return this.fit_pose(Math.PI / 2, 0);
    return this.fit_pose(now.polar, now.azimuth);
  }

  // `now`: the pose that says from which side; that of the camera without one.
  loop_pose(index, now = this.pose()) {
    const {loops} = this.data;
    const box = loop_box(loops, index);
    if (!box) return now;  // a loop through strays: it is not drawn
    const target = box.low.map((value, axis) => (value + box.high[axis]) / 2);
    const size = Math.hypot(...box.low.map((value, axis) => box.high[axis] - value)) / 2;
    const tall = Math.tan((kFieldOfView * Math.PI) / 360) * Math.min(1, this.camera.aspect);
    const distance = Math.max((2.1 * size) / tall, 12 * this.spacing);
    const normal = Array.from(loops.normal.subarray(3 * index, 3 * index + 3)).map((v) => (Number.isFinite(v) ? v : 0));
    return pose_along(normal, target, distance, now);
  }

  // How far before the loop what is shown begins, seen from loop_pose(): so near that no ceiling or wall hides it.
  loop_cut(index, pose) {
    const {first, vertices} = this.data.loops;
    const direction = pose_direction(pose);
    const size = Math.max(loop_radius(vertices, first[index], first[index + 1]), 3 * this.spacing);
    let before = 0;
    for (let i = first[index]; i < first[index + 1]; ++i) {
      before = Math.max(before, direction.reduce((sum, value, k) => sum + value * (vertices[3 * i + k] - pose.target[k]), 0));
    }
    return Math.max(0.9 * size, 1.2 * before);
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
