// SPDX-License-Identifier: Apache-2.0
// The page: makes its parts and connects them. Other scripts hold one part each.

class Page {
  constructor() {
    this.data = read_data();
    const {report, loops} = this.data;
    this.units = new Units(report.unit);
    this.decimals = place_decimals(report.median_distance);
    this.theme = document.documentElement.dataset.theme;
    this.colouring = "height";
    this.selected = -1;
    this.former = null;  // pose before the flight to a loop
    write_header(this.data, this.units);
    find("csv").disabled = loops.count === 0;
    this.marks = new Marks(this.data, () => this.apply_marks());
    connect_marks(this.marks, () => `${this.file_title()}_marks.json`);
    connect_causes(loops);
    this.filter = new LoopFilter(loops, this.units, this.marks, () => this.apply_filter());
    this.table = new LoopTable(loops, this.units, this.decimals, this.marks, (index) => this.toggle(index));
    this.details = new Details(this.data, this.units, this.decimals, this.marks,
                               {fly: (index) => this.select(index, true), close: () => this.deselect()});
    draw_facts(this.data, this.units);
    this.make_view();
    this.connect();
    this.apply_marks();
    this.set_theme(this.theme);
    if (this.view && loops.has_changes) this.set_by_cause(true);
    if (this.view) this.view.begin();  // the legend, the table and the foot have their sizes
    this.open_link(false);
    if (this.view) this.view.draw();
  }

  make_view() {
    this.view = null;
    const say = (text, more) => {
      find("message").replaceChildren(element("strong", {}, text), element("span", {}, more));
      find("message").hidden = false;
      find("view").classList.add("no-view");
    };
    try {
      const context = webgl_context(find("canvas"));
      if (!context) throw new Error("this browser gives none");
      this.view = new View(find("canvas"), context, this.data, {
        on_frame: (view) => {
          draw_scale(view, this.units);
          draw_triad(view.navigation.camera, this.data.report.crs ? ["E", "N", "z"] : ["x", "y", "z"]);
          if (!this.names) return;  // the last of them that is made
          this.sight.draw();
          this.station_marks.draw();
          this.names.draw(this.table.shown, this.selected);
          this.measure.draw();
        },
        on_pick: (x, y) => {
          if (!this.measure.is_on) return false;
          this.measure.pick(x, y);
          return true;
        },
        on_loop: (index, x, y) => this.click_loop(index >= 0 ? index : hole_around(this.view, this.data.loops, this.table.shown, x, y)),
        on_hover: (index, x, y) => this.hover(index, x, y),
      });
    } catch (error) {
      say("No 3D view", `WebGL: ${error.message}. The table and the facts work without it.`);
      return;
    }
    find("colouring").disabled = this.data.points.count === 0;
    if (this.data.points.count + this.data.loops.count === 0) say("Nothing to show", "The scan has no points.");
    const scanned = find("colouring").querySelector("[value=colour]");
    if (!this.data.points.colours) scanned.remove(); else if (are_colourful(this.data.points)) this.colouring = "colour";
    find("colouring").value = this.colouring;
  }

  connect() {
    connect_header((name) => this.set_theme(name));
    connect_tabs();
    window.addEventListener("hashchange", () => this.open_link(true));
    this.connect_view();
    this.print_pages = new PrintPages(this);
    find("csv").addEventListener("click", () => save_text(this.table.csv(), `${this.file_title()}_holes.csv`, "text/csv"));
    find("reset").addEventListener("click", () => this.reset());
    const step = (direction) => {
      const index = this.table.neighbour(direction);
      if (index >= 0) this.select(index, true);
    };
    connect_keys({navigation: this.view && this.view.navigation, press: {
      n: () => step(1), p: () => step(-1), escape: () => this.escape(), "?": () => find("help").showModal(),
      f: () => this.fly_to_side("fit"), 1: () => this.fly_to_side("top"), 2: () => this.fly_to_side("front"), 3: () => this.fly_to_side("side"),
      t: () => find("through").click(),
      m: () => find("measure").click(),
      0: () => this.set_mark(kNoMark), e: () => this.edit_note(),
      ...Object.fromEntries(kMarks.map(({name, key}) => [key, () => this.set_mark(name)])),
    }});
  }

  connect_view() {
    find("back").addEventListener("click", () => this.escape());
    find("colouring").addEventListener("change", () => {
      this.colouring = find("colouring").value;
      this.update_colours();
    });
    connect_settings();
    if (!this.view) return;
    this.measure = new Measure(this.view, this.units, this.decimals);
    find("measure").disabled = this.data.points.count === 0;
    find("picture").addEventListener("click", () => this.view.save_picture((blob) => save_blob(blob, `${this.file_title()}_view.png`)));
    connect_shown(this.view.scenes);
    this.station_marks = new StationMarks(this.view, this.data);
    this.sight = new SightLine(this.view, this.data, this.station_marks);
    this.names = new LoopNames(this.view, this.data.loops);
    find("show-stations").addEventListener("change", () => this.update_legend());
    find("cut").addEventListener("change", () => this.view.set_cutting(find("cut").checked));
    find("loop-colouring").addEventListener("change", () => this.set_by_cause(find("loop-colouring").value === "cause"));
    find("up-axis").addEventListener("change", () => this.turn_up(Number(find("up-axis").value)));
    this.section = new Section(this.data, this.view.bounds, this.units, (low, high) => this.apply_section(low, high));
    this.section.open_storeys(this.data.report.ceilings || []);
    for (const button of document.querySelectorAll("[data-side]")) {
      button.addEventListener("click", () => this.fly_to_side(button.dataset.side));
    }
  }

  // 0, 1 or 2: x, y or z points up from now on.
  turn_up(up) {
    this.data.frame.up = up;
    this.former = null;
    find("storey").hidden = true;  // its heights are along z
    this.view.turn_up();
    this.view.set_cut(Infinity);
    this.section.set_ranges();
    this.section.changed();
    this.update_chip();
  }

  fly_to_side(name) {
    if (!this.view) return;
    const {navigation} = this.view;
    navigation.fly(navigation.side_pose(name));
    this.view.set_cut(Infinity);
  }

  // How names of saved files begin.
  file_title() {
    return (this.data.report.title || "scan").replace(/\.[a-z0-9]+$/i, "").replace(/[^\w.-]+/g, "_");
  }

  // Colours of loops: by cause, else by kind.
  set_by_cause(by_cause) {
    find("loop-colouring").value = by_cause ? "cause" : "kind";
    document.body.classList.toggle("by-cause", by_cause);
    this.view.scenes.set_by_cause(by_cause);
    this.update_legend();
  }

  set_theme(theme) {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.update_colours();
  }

  update_colours(theme = this.theme) {
    if (!this.view) return;
    this.view.scenes.set_theme(theme, this.colouring);
    this.update_legend();
  }

  update_legend() {
    const {low, high} = this.view.bounds.box;
    const {frame, loops} = this.data;
    const markers = this.station_marks && this.station_marks.is_shown ? station_legend(this.data) : [];
    const lines = [this.view.scenes.by_cause ? cause_legend(loops) : kind_legend(loops), markers, this.filter.fold_line()];
    const heights = [low[frame.up], high[frame.up]].map((height) => real_height(frame, height));
    draw_legend(this.data.points.count > 0 ? this.colouring : "plain", this.theme, heights, this.units, lines,
                this.section.words());
  }

  update_reset() {
    find("reset").disabled = !this.filter.is_active() && !(this.section && this.section.is_active());
  }

  reset() {
    this.filter.reset();
    if (this.section) this.section.reset();
  }

  // The section is that of the view alone: the table and the filters have all heights.
  apply_section(low, high) {
    this.view.set_section(low, high);
    this.update_legend();
    this.update_reset();
  }

  apply_filter() {
    const passes = (i) => this.filter.passes(i);
    this.table.show(passes);
    const count = this.table.shown.length, all = this.data.loops.count;
    find("shown").textContent = all === 0 ? "none" : `${format_count(count)} of ${format_count(all)} shown`;
    if (this.view) this.view.scenes.set_loops(this.table.shown);
    if (this.selected >= 0 && !passes(this.selected)) this.deselect();
    this.update_reset();
    if (this.view && this.section) this.update_legend();
  }

  // ---- Marks

  // The loop of the row in focus gets it, else the selected one.
  set_mark(name) {
    const focused = this.table.focused_loop();
    const index = focused >= 0 ? focused : this.selected;
    if (index >= 0) this.marks.set(index, name);
  }

  edit_note() {
    const note = find("note");
    if (!note) return;
    choose_tab("details");
    note.focus();
  }

  apply_marks() {
    update_mark_tools(this.marks);
    this.table.update_marks();
    if (this.selected >= 0) update_mark_fields(this.marks, this.selected);
    this.apply_filter();
  }

  // ---- Selection

  select(index, is_flight) {
    this.selected = index;
    set_link(this.data.loops.id[index]);
    this.table.select(index);
    this.details.show(index);
    if (this.view) {
      this.view.scenes.set_selected(index);
      this.sight.select(index);
      if (is_flight) {
        const {navigation} = this.view;
        if (!this.former) this.former = navigation.flight ? navigation.flight.to : navigation.pose();
        const pose = navigation.loop_pose(index);
        navigation.fly(pose);
        const box = loop_box(this.data.loops, index);
        this.view.set_cut(box ? navigation.loop_cut(index, pose) : Infinity);
        this.section.open_for(box);
      }
    }
    this.update_chip();
  }

  deselect() {
    this.selected = -1;
    set_link(null);
    this.table.select(-1);
    this.details.show(-1);
    if (this.view) {
      this.view.scenes.set_selected(-1);
      this.sight.select(-1);
    }
    this.update_chip();
  }

  // Selects the loop that the address names; filters that hide it are cleared. Without a flight, the page begins there.
  open_link(is_flight) {
    const id = linked_id(location.hash);
    if (id === null) return;
    const index = this.data.loops.id.indexOf(id);
    if (index < 0) {
      show_notice(`This page has no loop ${id}.`, true);
      return;
    }
    if (index === this.selected) return;
    if (!this.filter.passes(index)) {
      this.filter.reset();
      this.filter.set_folded(false);
      this.apply_filter();
    }
    this.select(index, true);
    if (!is_flight && this.view) this.view.navigation.end_flight();
  }

  // Ends a measurement; else deselects, and goes back to the view and the section before the flight.
  escape() {
    if (this.measure && this.measure.is_on) {
      this.measure.set(false);
      return;
    }
    if (this.former && this.view) {
      this.view.navigation.fly(this.former);
      this.view.set_cut(Infinity);
      this.section.close_again();
    }
    this.former = null;
    if (this.selected >= 0) this.deselect();
    this.update_chip();
  }

  // A row: flies to its loop, and from the loop where it is back again.
  toggle(index) {
    if (index === this.selected && (this.former || !this.view)) this.escape(); else this.select(index, true);
  }

  click_loop(index) { if (index >= 0) this.select(index, false); }

  hover(index, x, y) {
    const tag = find("hover");
    tag.hidden = index < 0;
    find("canvas").style.cursor = index < 0 ? "" : "pointer";
    if (index < 0) return;
    const {loops} = this.data;
    const box = find("stage").getBoundingClientRect();
    const cause = loops.cause[index] === kNoCause ? "" : ` · ${cause_title(loops.cause[index])}`;
    tag.textContent = `${loop_name(loops, index)} · ⌀ ${this.units.length(loops.diameter[index])}${cause}`;
    tag.style.transform = `translate(${Math.round(x - box.left + 14)}px, ${Math.round(y - box.top + 12)}px)`;
  }

  update_chip() {
    const {loops} = this.data;
    find("chip").hidden = this.selected < 0 && !this.former;
    find("back").lastChild.textContent = this.former ? "Back" : "Deselect";
    find("chip-text").textContent = this.selected < 0 ? ""
        : `${loop_name(loops, this.selected)} · ⌀ ${this.units.length(loops.diameter[this.selected])} · ` +
          `area ${this.units.area(loops.area[this.selected])}`;
  }
}

function start() {
  try {
    window.page = new Page();
  } catch (error) {
    find("message").textContent = `This report cannot be read: ${error.message}`;
    find("message").hidden = false;
    throw error;
  }
}

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start); else start();
