// SPDX-License-Identifier: Apache-2.0
// What tests need of the page; everything in real coordinates.

function expose(page) {
  const {view, data} = page;
  window.lacuna = {
    ready: true,
    times: page.times,
    view,
    has_view: Boolean(view),
    points: data.points.count,
    camera: () => (view ? to_real(data.frame, view.navigation.camera.position.toArray()) : null),
    target: () => (view ? to_real(data.frame, view.navigation.controls.target.toArray()) : null),
    is_still: () => !view || (!view.navigation.flight && !view.frames.requested),
    visible_loops: () => page.table.shown.length,
    mark: (id) => page.marks.mark[data.loops.id.indexOf(id)],
    note: (id) => page.marks.note[data.loops.id.indexOf(id)],
    marks_text: () => page.marks.text(),
    load_marks: (text) => page.marks.load(text),
    bounds: () => [0, 1, 2].map((axis) => [data.report.bounds.min[axis], data.report.bounds.max[axis]]),
    measured: () => page.measure.places.map((place) => to_real(data.frame, place)),
    diameters: () => Array.from(data.loops.diameter),
    unit: page.units.unit,
    crs: data.report.crs || null,
    short_place,
    seen: () => {
      const {passes} = view.scenes, {selected, selected_casing} = passes;
      const core = css_rgb(style_value(loop_style(data.loops, page.selected, view.scenes.by_cause))).map((value) => Math.round(255 * value));
      const count = (hidden) => {
        selected.hidden.value = selected_casing.hidden.value = hidden;
        const {pixels} = view.read_pixels();
        let found = 0;
        for (let i = 0; i < pixels.length; i += 4) if (core.every((value, k) => Math.abs(pixels[i + k] - value) <= 3)) ++found;
        return found;
      };
      view.scenes.set_loops([]);
      const [seen, all] = [count(0), count(1)];
      view.scenes.set_loops(page.table.shown);
      return all > 0 ? seen / all : 0;
    },
    selected: () => (page.selected < 0 ? null : data.loops.id[page.selected]),
    loop_heights: (id) => {
      const {low, high} = loop_box(data.loops, data.loops.id.indexOf(id));
      return [low, high].map((place) => to_real(data.frame, place)[data.frame.up]);
    },
    theme: (name) => page.set_theme(name),
    colouring: (name) => page.set_colouring(name),
    stations: data.stations.length,
    next_stations: data.next_stations.length,
    cause: (id) => data.loops.cause[data.loops.id.indexOf(id)],
    shares: (id) => Object.fromEntries(kCauses.map(({name}) => [name, data.loops.shares[name][data.loops.id.indexOf(id)]])),
    causes: () => Array.from(data.loops.cause),
    colours: () => Object.fromEntries(["view", "hole", "outer", ...data.loops.causes.map(({name}) => cause_style(name).slice(2))].map(
        (name) => [name, css_rgb(style_value(`--${name}`)).map((value) => Math.round(255 * value))])),
    read_pixels: () => view.read_pixels(),
    loop_at: (x, y) => { const at = view.loop_at(x, y); return at < 0 ? null : data.loops.id[at]; },
  };
}
