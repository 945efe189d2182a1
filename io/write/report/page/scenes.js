// SPDX-License-Identifier: Apache-2.0
// What is drawn: the points, their shading on the screen, the loops over them, and the loops as numbers for picking.

const kDimmed = 0.3;  // opacity of the other loops when one is chosen

class Scenes {
  constructor(data, spacing, uniforms, on_change) {
    Object.assign(this, {data, uniforms, on_change});
    this.through = true;
    this.selected = -1;
    this.by_cause = false;  // colours of loops; else by kind
    this.are_loops_shown = true;
    this.points = new THREE.Scene();
    this.loops = new THREE.Scene();
    this.pick = new THREE.Scene();
    this.screen = new THREE.Scene();
    this.cloud = new PointCloud(data, spacing, uniforms);
    this.points.add(this.cloud.object);
    this.eye_dome = eye_dome_material(uniforms);
    this.eye_dome.uniforms.strength.value = data.has_normals ? 60 : 150;
    const screen = new THREE.Mesh(screen_geometry(), this.eye_dome);
    screen.frustumCulled = false;
    this.screen.add(screen);
    this.make_lines(data.loops);
    this.veil = new Veil(data, uniforms);
  }

  make_lines(loops) {
    const corners = new LineCorners(loops);
    const sizes = {outer: 0, hole: 0, selected: 0};
    for (let i = 0; i < loops.count; ++i) {
      const edges = loops.first[i + 1] - loops.first[i];
      sizes[loops.is_hole[i] ? "hole" : "outer"] += edges;
      sizes.selected = Math.max(sizes.selected, edges);
    }
    this.lines = {};
    for (const name of Object.keys(sizes)) this.lines[name] = new LoopLines(corners, sizes[name], this.uniforms);
    const add = (name, style) => this.lines[name].add_pass(this.loops, style);
    this.passes = {
      outer_casing: add("outer", {width: 3.6, order: 1, opacity: 0.75}),
      outer: add("outer", {width: 2, order: 2}),
      hole_casing: add("hole", {width: 5.2, order: 3, opacity: 0.85}),
      hole: add("hole", {width: 3.2, order: 4}),
      selected_casing: add("selected", {width: 8.4, order: 5}),
      selected: add("selected", {width: 5.4, order: 6}),
    };
    this.opacities = Object.entries(this.passes).map(([name, {opacity}]) => [name, opacity.value]);
    const rows = Math.max(1, Math.ceil(loops.count / 256));
    this.loop_colours = new THREE.DataTexture(new Uint8Array(1024 * rows), 256, rows, THREE.RGBAFormat);
    this.passes.hole.loop_colours.value = this.passes.outer.loop_colours.value = this.loop_colours;
    const pick = (name) => this.lines[name].add_pass(this.pick, {width: 8}, true);
    this.picks = [pick("outer"), pick("hole")];
  }

  // Loops that pass the filters (indices, any order).
  set_loops(visible) {
    const {is_hole} = this.data.loops;
    // Line width of those that look small, as a part of the full one.
    const crowded = Math.min(1, Math.max(0.35, Math.pow(400 / Math.max(1, visible.length), 0.3)));
    for (const name of ["outer", "outer_casing", "hole", "hole_casing"]) this.passes[name].crowded.value = crowded;
    this.lines.hole.show(visible.filter((i) => is_hole[i]));
    this.lines.outer.show(visible.filter((i) => !is_hole[i]));
    this.update_lines();
  }

  // -1 for none.
  set_selected(index) {
    this.lines.selected.show(index < 0 ? [] : [index]);
    this.selected = index;
    this.veil.choose(index);
    // A chosen loop stands out from the others.
    for (const [name, opacity] of this.opacities) {
      this.passes[name].opacity.value = index < 0 || name.startsWith("selected") ? opacity : kDimmed * opacity;
    }
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
    for (const line of Object.values(this.lines)) line.set_visible(this.are_loops_shown);
    const hidden = this.through ? 0.3 : 0;
    for (const name of Object.keys(this.passes)) this.passes[name].hidden.value = hidden;
    this.passes.selected.hidden.value = this.passes.selected_casing.hidden.value = Math.max(hidden, 0.5);
    for (const pick of this.picks) pick.hidden.value = this.through ? 1 : 0;
    this.on_change();
  }

  set_theme(theme, colouring) {
    this.cloud.set_colouring(colouring, theme);
    this.eye_dome.uniforms.background.value.set(...css_rgb(style_value("--view")));
    this.set_colours();
  }

  set_by_cause(by_cause) {
    this.by_cause = by_cause;
    this.set_colours();
  }

  set_colours() {
    const {loops} = this.data;
    const set = (pass, name) => this.passes[pass].colour.value.set(...css_rgb(style_value(name)));
    set("hole", "--hole");
    set("outer", this.by_cause ? cause_style(kNoCause) : "--outer");
    this.passes.hole.rows.value = this.by_cause ? this.loop_colours.image.height : 0;
    this.passes.outer.rows.value = loops.has_changes ? this.passes.hole.rows.value : 0;
    if (this.by_cause) this.write_cause_colours(loops);
    set("hole_casing", "--casing");
    set("outer_casing", "--casing");
    set("selected_casing", "--casing");
    set("selected", this.selected < 0 ? "--hole" : loop_style(loops, this.selected, this.by_cause));
    this.on_change();
  }

  write_cause_colours({cause, causes}) {
    const names = [...causes, kNoCause];
    const colours = new Map(names.map((name) => [name, css_rgb(style_value(cause_style(name))).map((value) => Math.round(255 * value))]));
    cause.forEach((name, i) => this.loop_colours.image.data.set(colours.get(name) || colours.get(kNoCause), 4 * i));
    this.loop_colours.needsUpdate = true;
  }

  // The picture of `count` points over `target`, which holds points before their shading.
  draw(renderer, target, camera, count, to_target) {
    this.cloud.set_drawn(count);
    const pixel = to_target / this.uniforms.focal.value;
    const dash = Math.pow(2, Math.round(Math.log2(13 * this.uniforms.pixel_ratio.value * pixel)));
    this.eye_dome.uniforms.slack.value = 0.3 * this.cloud.uniforms.size.value;
    const pull = 2.5 * this.cloud.spacing;
    for (const uniforms of [...Object.values(this.passes), ...this.picks]) uniforms.pull.value = pull;
    // A machine that does not keep up draws no casings while the view moves.
    for (const name of ["outer", "hole"]) this.lines[name].set_casing(count === this.cloud.count);
    this.passes.outer.dash.value = this.passes.outer_casing.dash.value = dash;
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.points, camera);
    this.eye_dome.uniforms.pull.value = pull;
    this.veil.draw(renderer, camera, target, this.eye_dome.uniforms);
    renderer.setRenderTarget(null);
    renderer.render(this.screen, camera);
    renderer.render(this.loops, camera);
  }
}
