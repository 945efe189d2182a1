// The 3D view: draws the points, their eye-dome shading and the loops over them, only when something has changed.

const kFlightMilliseconds = 700;
const kStillMilliseconds = 160;  // after this all points are drawn
const kPickPixels = 9;

class View {
  // `on_frame(view)` after each picture, `on_loop(index or -1)` for a click, `on_hover(index or -1, x, y)`.
  constructor(canvas, context, data, {on_frame, on_loop, on_hover}) {
    Object.assign(this, {canvas, data, on_frame, on_loop, on_hover});
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.renderer.autoClear = false;
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 10);
    this.camera.up.set(0, 0, 1);
    this.uniforms = make_camera_uniforms();
    this.through = false;
    this.selected = -1;
    this.are_loops_shown = true;
    this.is_reduced = matchMedia("(prefers-reduced-motion: reduce)");
    this.flight = null;
    this.held = new Map();  // key held down: function of seconds
    this.last_change = 0;
    this.budget = data.points.count;
    this.make_scenes();
    this.make_controls();
    this.find_bounds();
    this.resize();
    this.set_pose(this.fit_pose(0.95, -1.05));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    canvas.addEventListener("webglcontextrestored", () => this.request());
  }

  make_scenes() {
    const {report, frame, points, loops} = this.data;
    const sample = report.sample || {};
    const sparse = sample.of > 0 && points.count > 0 ? Math.sqrt(Math.max(1, sample.of / points.count)) : 1;
    const spacing = ((report.mean_edge_length || 0) * sparse) / frame.edge;
    this.spacing = spacing > 0 ? spacing : 1 / Math.sqrt(Math.max(16, points.count));
    this.point_scene = new THREE.Scene();
    this.line_scene = new THREE.Scene();
    this.pick_scene = new THREE.Scene();
    this.screen_scene = new THREE.Scene();
    this.cloud = new PointCloud(this.data, this.spacing, this.uniforms);
    this.point_scene.add(this.cloud.object);
    this.eye_dome = eye_dome_material(this.uniforms);
    this.eye_dome.uniforms.strength.value = this.data.has_normals ? 60 : 150;
    const screen = new THREE.Mesh(screen_geometry(), this.eye_dome);
    screen.frustumCulled = false;
    this.screen_scene.add(screen);

    const corners = new LineCorners(loops);
    const sizes = {outer: 0, hole: 0, selected: 0};
    for (let i = 0; i < loops.count; ++i) {
      const edges = loops.first[i + 1] - loops.first[i];
      sizes[loops.is_hole[i] ? "hole" : "outer"] += edges;
      sizes.selected = Math.max(sizes.selected, edges);
    }
    this.lines = {};
    for (const name of Object.keys(sizes)) this.lines[name] = new LoopLines(corners, sizes[name], this.uniforms);
    const add = (name, style) => this.lines[name].add_pass(this.line_scene, style);
    this.passes = {
      outer_casing: add("outer", {width: 3.6, order: 1, opacity: 0.75}),
      outer: add("outer", {width: 2, order: 2}),
      hole_casing: add("hole", {width: 5.2, order: 3, opacity: 0.85}),
      hole: add("hole", {width: 3.2, order: 4}),
      selected_casing: add("selected", {width: 8, order: 5}),
      selected: add("selected", {width: 3, order: 6}),
    };
    const pick = (name) => this.lines[name].add_pass(this.pick_scene, {width: 8}, true);
    this.picks = [pick("outer"), pick("hole")];
  }

  make_controls() {
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.minDistance = 1e-6;
    this.controls.maxDistance = 40;
    this.controls.addEventListener("change", () => this.changed());
    this.controls.addEventListener("start", () => { this.flight = null; });
    const frame = this.canvas.parentElement;
    frame.addEventListener("wheel", (event) => {
      if (event.target !== this.canvas) return;
      event.preventDefault();
      event.stopPropagation();
      const lines = event.deltaMode === 1 ? 16 : 1;
      const amount = Math.max(-120, Math.min(120, event.deltaY * lines));
      this.zoom(Math.exp(amount * 0.0016), event.clientX, event.clientY);
    }, {capture: true, passive: false});
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
      this.on_hover(-1, 0, 0);
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      down = null;
      this.on_loop(this.loop_at(event.clientX, event.clientY));
    });
    this.canvas.addEventListener("dblclick", (event) => this.centre_at(event.clientX, event.clientY));
    let hovered = 0;
    this.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0 || event.pointerType === "touch" || event.timeStamp < hovered || this.flight) return;
      const begin = performance.now();
      this.on_hover(this.loop_at(event.clientX, event.clientY), event.clientX, event.clientY);
      // A slow machine looks less often.
      hovered = event.timeStamp + 40 + 4 * (performance.now() - begin);
    });
    this.canvas.addEventListener("pointerleave", () => this.on_hover(-1, 0, 0));
  }

  find_bounds() {
    const {points, loops, report, frame} = this.data;
    const given = report.bounds
        ? {low: to_scene(frame, report.bounds.min), high: to_scene(frame, report.bounds.max)} : null;
    this.box = usual_box(points.positions) || usual_box(loops.vertices) || given ||
               {low: [-0.5, -0.5, -0.5], high: [0.5, 0.5, 0.5]};
    this.outline = outline_places(points.count > 0 ? points.positions : loops.vertices, this.box);
    const all = given || {low: [-0.5, -0.5, -0.5], high: [0.5, 0.5, 0.5]};
    this.middle = new THREE.Vector3(...[0, 1, 2].map((k) => (all.low[k] + all.high[k]) / 2));
    this.radius = Math.max(1e-3, Math.hypot(...[0, 1, 2].map((k) => (all.high[k] - all.low[k]) / 2)));
    this.cloud.set_heights(this.box.low[2], this.box.high[2]);
  }

  // ---- Poses

  pose() { return pose_of(this.camera, this.controls.target); }

  set_pose(pose) {
    const direction = pose_direction({...pose, polar: Math.min(Math.PI - kLeastPolar, Math.max(kLeastPolar, pose.polar))});
    this.controls.target.set(...pose.target);
    this.camera.position.set(...direction.map((value, axis) => pose.target[axis] + value * pose.distance));
    this.controls.update();
    this.changed();
  }

  fit_pose(polar, azimuth) {
    const pose = pose_of_places(this.outline, {polar, azimuth}, this.camera.aspect);
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

  loop_pose(index) {
    const {loops, frame} = this.data;
    const begin = loops.first[index], end = loops.first[index + 1];
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = begin; i < end; ++i) {
      for (let axis = 0; axis < 3; ++axis) {
        low[axis] = Math.min(low[axis], loops.vertices[3 * i + axis]);
        high[axis] = Math.max(high[axis], loops.vertices[3 * i + axis]);
      }
    }
    let target = to_scene(frame, Array.from(loops.centroid.subarray(3 * index, 3 * index + 3)));
    if (end > begin) target = low.map((value, axis) => (value + high[axis]) / 2);
    if (!target.every(Number.isFinite)) return this.pose();
    const size = end > begin ? Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2 : 0.01;
    const tall = Math.tan((kFieldOfView * Math.PI) / 360) * Math.min(1, this.camera.aspect);
    const distance = Math.max((2.1 * size) / tall, 12 * this.spacing);
    const normal = Array.from(loops.normal.subarray(3 * index, 3 * index + 3)).map((v) => (Number.isFinite(v) ? v : 0));
    return pose_along(normal, target, distance, this.pose());
  }

  fly(pose) {
    if (this.is_reduced.matches) {
      this.flight = null;
      this.set_pose(pose);
      return;
    }
    this.flight = {from: this.pose(), to: pose, start: performance.now()};
    this.request();
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
    this.changed();
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
    this.request();
  }

  release(key) {
    if (key === undefined) this.held.clear(); else this.held.delete(key);
  }

  // ---- What is under the pointer

  pixel_at(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return [x - box.left, y - box.top, box];
  }

  ray_at(x, y) {
    const [left, top, box] = this.pixel_at(x, y);
    return new THREE.Vector3((2 * left) / box.width - 1, 1 - (2 * top) / box.height, 0.5)
        .unproject(this.camera).sub(this.camera.position).normalize();
  }

  // Index of the loop drawn nearest to the place, -1 if none is near.
  loop_at(x, y) {
    if (!this.target || !this.are_loops_shown) return -1;
    const [left, top] = this.pixel_at(x, y);
    const ratio = this.renderer.getPixelRatio();
    const size = Math.round(kPickPixels * ratio) | 1;
    const column = Math.round(left * ratio) - (size >> 1);
    const row = this.target.height - 1 - Math.round(top * ratio) - (size >> 1);
    if (column < 0 || row < 0 || column + size > this.target.width || row + size > this.target.height) return -1;
    if (!this.pick_target) this.pick_target = new THREE.WebGLRenderTarget(1, 1, {depthBuffer: false});
    this.pick_target.setSize(this.target.width, this.target.height);
    this.pick_target.scissor.set(column, row, size, size);
    this.pick_target.scissorTest = true;
    this.renderer.setRenderTarget(this.pick_target);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear(true, false, false);
    this.renderer.render(this.pick_scene, this.camera);
    const pixels = new Uint8Array(4 * size * size);
    this.renderer.readRenderTargetPixels(this.pick_target, column, row, size, size, pixels);
    this.renderer.setRenderTarget(null);
    let best = -1, least = Infinity;
    for (let i = 0; i < size * size; ++i) {
      if (pixels[4 * i + 3] === 0) continue;
      const away = Math.hypot((i % size) - (size >> 1), Math.floor(i / size) - (size >> 1));
      if (away < least) {
        least = away;
        best = pixels[4 * i] + 256 * pixels[4 * i + 1] + 65536 * pixels[4 * i + 2];
      }
    }
    return best;
  }

  // Turns about the nearest point under the pointer from now on.
  centre_at(x, y) {
    const ray = this.ray_at(x, y).toArray();
    const eye = this.camera.position.toArray();
    const {positions, count} = this.data.points;
    const tangent = (2 * 6 * Math.tan((kFieldOfView * Math.PI) / 360)) / this.canvas.clientHeight;
    let best = -1, nearest = Infinity;
    for (let i = 0; i < count; ++i) {
      const px = positions[3 * i] - eye[0], py = positions[3 * i + 1] - eye[1], pz = positions[3 * i + 2] - eye[2];
      const along = px * ray[0] + py * ray[1] + pz * ray[2];
      if (along <= 0 || along >= nearest) continue;
      const aside = Math.sqrt(Math.max(0, px * px + py * py + pz * pz - along * along));
      if (aside < along * tangent + this.spacing * 0.6) { nearest = along; best = i; }
    }
    if (best < 0) return;
    const pose = this.pose();
    this.fly({...pose, target: Array.from(positions.subarray(3 * best, 3 * best + 3)),
              distance: Math.min(pose.distance, nearest)});
  }

  // ---- What is drawn

  // Loops that pass the filters (indices, any order), and the selected one, -1 for none.
  set_loops(visible) {
    const {is_hole} = this.data.loops;
    // Line width of those that look small, as a part of the full one.
    const crowded = Math.min(1, Math.max(0.35, Math.pow(400 / Math.max(1, visible.length), 0.3)));
    for (const name of ["outer", "outer_casing", "hole", "hole_casing"]) this.passes[name].crowded.value = crowded;
    this.lines.hole.show(visible.filter((i) => is_hole[i]));
    this.lines.outer.show(visible.filter((i) => !is_hole[i]));
    this.update_lines();
  }

  set_selected(index) {
    this.lines.selected.show(index < 0 ? [] : [index]);
    this.selected = index;
    this.set_colours();
  }

  set_shown(are_points, are_loops) {
    this.cloud.object.visible = are_points;
    this.are_loops_shown = are_loops;
    this.update_lines();
  }

  set_through(is_through) {
    this.through = is_through;
    this.update_lines();
  }

  update_lines() {
    for (const line of Object.values(this.lines)) line.set_visible(this.are_loops_shown !== false);
    const hidden = this.through ? 0.55 : 0;
    for (const name of Object.keys(this.passes)) this.passes[name].hidden.value = hidden;
    this.passes.selected.hidden.value = this.passes.selected_casing.hidden.value = Math.max(hidden, 0.35);
    for (const pick of this.picks) pick.hidden.value = this.through ? 1 : 0;
    this.request();
  }

  set_theme(theme, colouring) {
    this.theme = theme;
    this.cloud.set_colouring(colouring, theme);
    this.background = style_value("--view");
    this.eye_dome.uniforms.background.value.set(...css_rgb(this.background));
    this.set_colours();
  }

  set_colours() {
    const set = (pass, name) => this.passes[pass].colour.value.set(...css_rgb(style_value(name)));
    const is_hole = this.selected >= 0 && this.data.loops.is_hole[this.selected];
    set("hole", "--hole");
    set("outer", "--outer");
    set("hole_casing", "--casing");
    set("outer_casing", "--casing");
    set("selected_casing", is_hole ? "--hole" : "--outer");
    set("selected", "--marked");
    this.request();
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const size = `${clientWidth} ${clientHeight} ${ratio}`;
    if (clientWidth === 0 || clientHeight === 0 || size === this.size) return;
    this.size = size;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    const {width, height} = this.canvas;
    if (this.target) {
      this.target.setSize(width, height);
    } else {
      this.target = new THREE.WebGLRenderTarget(width, height, {minFilter: THREE.NearestFilter,
                                                                magFilter: THREE.NearestFilter, stencilBuffer: false});
      if (this.renderer.extensions.get("WEBGL_depth_texture")) {
        this.target.depthTexture = new THREE.DepthTexture(width, height, THREE.UnsignedIntType);
        this.uniforms.has_depth.value = 1;
      }
      this.uniforms.depth_map.value = this.target.depthTexture;
      this.eye_dome.uniforms.colour_map.value = this.target.texture;
    }
    this.uniforms.resolution.value.set(width, height);
    this.uniforms.pixel_ratio.value = ratio;
    if (this.is_begun) this.draw();
  }

  changed() {
    this.last_change = performance.now();
    this.request();
  }

  request() {
    if (this.requested || !this.is_begun) return;
    this.requested = true;
    requestAnimationFrame((now) => this.step(now));
  }

  // One picture: moves what moves, and goes on only while something does.
  step(now) {
    this.requested = false;
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
      this.request();
    }
    const is_moving = performance.now() - this.last_change < kStillMilliseconds;
    this.adapt(now, is_moving);
    this.draw(is_moving ? this.budget : undefined);
    if (is_moving && this.budget < this.cloud.count) {
      clearTimeout(this.still);
      this.still = setTimeout(() => this.request(), kStillMilliseconds + 20);
    }
  }

  // Fewer points while the view moves, if the machine does not keep up.
  adapt(now, is_moving) {
    const interval = now - (this.last_step || 0);
    const was_moving = this.was_moving;
    this.last_step = now;
    this.was_moving = is_moving;
    if (!is_moving || !was_moving) return;
    if (interval > 45) this.budget = Math.max(Math.min(60000, this.cloud.count), Math.round(this.budget * (interval > 150 ? 0.4 : 0.75)));
    if (interval < 20) this.budget = Math.min(this.cloud.count, Math.round(this.budget * 1.15) + 1);
  }

  draw(count = this.cloud.count) {
    if (!this.target) return;
    this.is_begun = true;
    const {camera, renderer} = this;
    const away = camera.position.distanceTo(this.middle);
    const to_target = camera.position.distanceTo(this.controls.target);
    camera.far = Math.max(away + this.radius, to_target) * 1.05;
    camera.near = Math.max((away - this.radius) * 0.95, Math.min(to_target * 0.01, camera.far * 0.01), camera.far * 1e-6);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    update_camera_uniforms(this.uniforms, camera, this.canvas.height);
    this.cloud.set_drawn(count);
    const pixel = to_target / this.uniforms.focal.value;
    const dash = Math.pow(2, Math.round(Math.log2(13 * this.uniforms.pixel_ratio.value * pixel)));
    this.eye_dome.uniforms.slack.value = 0.3 * this.cloud.uniforms.size.value;
    const pull = 2.5 * this.cloud.spacing;
    for (const uniforms of [...Object.values(this.passes), ...this.picks]) uniforms.pull.value = pull;
    // A machine that does not keep up draws no casings while the view moves.
    for (const name of ["outer", "hole"]) this.lines[name].set_casing(count === this.cloud.count);
    this.passes.outer.dash.value = this.passes.outer_casing.dash.value = dash;
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.point_scene, camera);
    renderer.setRenderTarget(null);
    renderer.render(this.screen_scene, camera);
    renderer.render(this.line_scene, camera);
    this.on_frame(this);
  }

  // The picture as {width, height, pixels}: rows from the bottom, 4 bytes a pixel.
  read_pixels() {
    this.draw();
    const gl = this.renderer.getContext();
    const {width, height} = this.canvas;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return {width, height, pixels};
  }
}

// The canvas' WebGL context; null where the browser gives none.
function webgl_context(canvas) {
  const wanted = {antialias: false, alpha: false, depth: false, stencil: false, powerPreference: "high-performance"};
  try {
    return canvas.getContext("webgl", wanted) || canvas.getContext("experimental-webgl", wanted);
  } catch (error) {
    return null;
  }
}
