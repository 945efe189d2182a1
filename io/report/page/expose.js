// SPDX-License-Identifier: Apache-2.0
// What tests need of the page; everything in real coordinates.

function expose(page) {
  const {view, data} = page;
  window.lacuna = {
    ready: true,
    times: page.times,
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
    selected: () => (page.selected < 0 ? null : data.loops.id[page.selected]),
    loop_heights: (id) => {
      const {low, high} = loop_box(data.loops, data.loops.id.indexOf(id));
      return [low, high].map((place) => to_real(data.frame, place)[2]);
    },
    theme: (name) => page.set_theme(name),
    colouring: (name) => page.set_colouring(name),
    colours: () => Object.fromEntries(["view", "hole", "outer", "marked"].map(
        (name) => [name, css_rgb(style_value(`--${name}`)).map((value) => Math.round(255 * value))])),
    read_pixels: () => view.read_pixels(),
    loop_at: (x, y) => { const at = view.loop_at(x, y); return at < 0 ? null : data.loops.id[at]; },
  };
}
