// SPDX-License-Identifier: Apache-2.0
// The 3D view: connects canvas, camera, scenes and pointer, and draws a picture when something has changed. A slow
// machine draws fewer points while the view moves.

const kStillMilliseconds = 160;  // after this all points are drawn

class Frames {
  // `move()` before each picture; `draw(count)` draws the first `count` of `points` points.
  constructor(points, {move, draw}) {
    Object.assign(this, {points, move, draw});
    this.budget = points;  // points drawn while the view moves
    this.last_change = 0;
    this.is_begun = false;  // a picture is there: changes before it need none of their own
    this.requested = false;
  }

  // The picture moves: `budget` points are enough for now.
  changed() {
    this.last_change = performance.now();
    this.request();
  }

  request() {
    if (this.requested || !this.is_begun) return;
    this.requested = true;
    requestAnimationFrame((now) => this.step(now));
  }

  // One picture; goes on only while something moves.
  step(now) {
    this.requested = false;
    this.move();
    const is_moving = performance.now() - this.last_change < kStillMilliseconds;
    this.adapt(now, is_moving);
    this.draw(is_moving ? this.budget : this.points);
    if (is_moving && this.budget < this.points) {
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
    if (interval > 45) this.budget = Math.max(Math.min(60000, this.points), Math.round(this.budget * (interval > 150 ? 0.4 : 0.75)));
    if (interval < 20) this.budget = Math.min(this.points, Math.round(this.budget * 1.15) + 1);
  }
}

const kPrintRatio = 1.5;  // of pixels in pictures for paper: lines and points as thick as these

class View {
  // `on_frame(view)` after each picture, `on_loop(index or -1, x, y)` for a click, `on_hover(index or -1, x, y)`.
  // `on_pick(x, y)` may take a click before the loops: then it returns true.
  constructor(canvas, context, data, {on_frame, on_loop, on_hover, on_pick}) {
    Object.assign(this, {canvas, data, on_frame});
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.renderer.autoClear = false;
    this.uniforms = make_camera_uniforms();
    this.spacing = sample_spacing(data);
    this.frames = new Frames(data.points.count, {move: () => this.navigation.move(), draw: (count) => this.draw(count)});
    this.scenes = new Scenes(data, this.spacing, this.uniforms, () => this.frames.request());
    this.bounds = scene_bounds(data);
    this.navigation = new Navigation(canvas, data, this.bounds, this.spacing, this.frames);
    this.picker = new LoopPicker(this.renderer, this.scenes.pick);
    this.cut = Infinity;    // how far before the middle of the picture what is shown begins
    this.is_cutting = true;  // unless the reader wants to see all
    connect_pointer(canvas, {
      zoom: (factor, x, y) => this.navigation.zoom(factor, x, y),
      click: (x, y) => { if (!on_pick(x, y)) on_loop(this.loop_at(x, y), x, y); },
      double_click: (x, y) => this.centre_at(x, y),
      hover: (x, y) => on_hover(this.loop_at(x, y), x, y),
      leave: () => on_hover(-1, 0, 0),
      is_busy: () => Boolean(this.navigation.flight),
    });
    this.set_heights();
    this.begin();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    canvas.addEventListener("webglcontextrestored", () => this.frames.request());
  }

  set_heights() {
    const {up} = this.data.frame;
    this.uniforms.up.value.set(...upright(0, 0, 1, up));
    this.scenes.cloud.set_heights(this.bounds.box.low[up], this.bounds.box.high[up]);
  }

  // After frame.up has changed.
  turn_up() {
    this.set_heights();
    this.navigation.flight = null;
    this.navigation.make_controls();
    this.navigation.set_pose(this.navigation.fit_pose(kHomePolar, kHomeAzimuth));
  }

  // Index of the loop drawn nearest to the place of the window, -1 if none is near.
  loop_at(x, y) {
    if (!this.target || !this.scenes.are_loops_shown) return -1;
    const box = this.canvas.getBoundingClientRect();
    return this.picker.loop_at(x - box.left, y - box.top, this.navigation.camera, this.target);
  }

  // {place, distance} of the nearest point of the sample under the pointer; null without any.
  point_at(x, y) {
    const {navigation} = this;
    const tangent = (2 * 6 * Math.tan((kFieldOfView * Math.PI) / 360)) / this.canvas.clientHeight;
    return point_along(this.data.points, navigation.camera.position.toArray(), navigation.ray_at(x, y).toArray(),
                       tangent, this.spacing, this.nearest(), this.uniforms.section.value, this.data.frame.up);
  }

  // Turns about the nearest point under the pointer from now on.
  centre_at(x, y) {
    const {navigation} = this;
    const found = this.point_at(x, y);
    if (!found) return;
    const pose = navigation.pose();
    navigation.fly({...pose, target: found.place, distance: Math.min(pose.distance, found.distance)});
  }

  // Leaves out what is more than `before` nearer than the middle of the picture, in scene coordinates.
  set_cut(before) {
    this.cut = before;
    this.frames.changed();
  }

  // The distance from the eye at which what is shown begins.
  nearest() { return this.is_cutting ? Math.max(0, this.navigation.target_distance() - this.cut) : 0; }

  set_cutting(is_cutting) {
    this.is_cutting = is_cutting;
    this.frames.changed();
  }

  // Hides what lies below and above, in scene coordinates.
  set_section(low, high) {
    this.uniforms.section.value.set(low, high);
    this.frames.changed();
  }

  // As a page begins: all of it in the picture.
  begin() {
    this.resize();
    this.navigation.set_pose(this.navigation.fit_pose(kHomePolar, kHomeAzimuth));
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const size = [clientWidth, clientHeight, ratio];
    if (clientWidth === 0 || clientHeight === 0 || String(size) === String(this.size)) return;
    this.size = size;
    this.set_size(...size);
    if (this.frames.is_begun) this.draw();
  }

  // `wide` and `tall` in units that look equally large at each `ratio` of pixels.
  set_size(wide, tall, ratio) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(wide, tall, false);
    this.navigation.camera.aspect = wide / tall;
    const {width, height} = this.canvas;
    if (this.target) this.target.setSize(width, height); else this.make_target(width, height);
    this.uniforms.resolution.value.set(width, height);
    this.uniforms.pixel_ratio.value = ratio;
  }

  // Calls `take` with a function that gives the address of a JPEG picture of this size, in pixels, from a pose. Each
  // has a cut of its own. Afterwards the view is as before.
  take_pictures(width, height, take) {
    const {navigation} = this;
    const former = navigation.pose(), {cut, is_cutting} = this;
    this.is_cutting = true;
    const ratio = kPrintRatio;
    this.set_size(width / ratio, height / ratio, ratio);
    take((pose, its_cut, units) => {
      navigation.set_pose(pose);
      this.cut = its_cut;
      this.render(this.data.points.count);
      const [canvas, pen] = paper(this.canvas.width, this.canvas.height);
      pen.drawImage(this.canvas, 0, 0);
      draw_bar(pen, canvas.width, canvas.height, this.data.frame.edge * pose.distance / this.uniforms.focal.value, units);
      return canvas.toDataURL("image/jpeg", 0.88);
    });
    if (this.size) this.set_size(...this.size);
    Object.assign(this, {cut, is_cutting});
    navigation.set_pose(former);
  }

  // Points are drawn to it first: their depths hide lines, and shade edges.
  make_target(width, height) {
    this.target = new THREE.WebGLRenderTarget(width, height, {minFilter: THREE.NearestFilter,
                                                              magFilter: THREE.NearestFilter, stencilBuffer: false});
    if (this.renderer.extensions.get("WEBGL_depth_texture")) {
      this.target.depthTexture = new THREE.DepthTexture(width, height, THREE.UnsignedIntType);
      this.uniforms.has_depth.value = 1;
    }
    this.uniforms.depth_map.value = this.target.depthTexture;
    this.scenes.eye_dome.uniforms.colour_map.value = this.target.texture;
  }

  draw(count = this.data.points.count) {
    if (!this.target) return;
    this.frames.is_begun = true;
    this.render(count);
    this.on_frame(this);
  }

  render(count) {
    const {camera} = this.navigation;
    this.navigation.update_depths(this.nearest());
    update_camera_uniforms(this.uniforms, camera, this.canvas.height);
    this.scenes.draw(this.renderer, this.target, camera, count, this.navigation.target_distance());
  }

  // The picture as a PNG file, for `take(blob)`.
  save_picture(take) {
    this.draw();
    this.canvas.toBlob(take, "image/png");
  }
}

// The canvas' WebGL context; null where the browser gives none.
function webgl_context(canvas) {
  return canvas.getContext("webgl", {antialias: false, alpha: false, depth: false, stencil: false, powerPreference: "high-performance"});
}
