// The page: makes its parts and connects them. Other scripts hold one part each; their order does not matter.

class Page {
  constructor() {
    const begin = performance.now();
    this.data = read_data();
    const {report, loops} = this.data;
    this.times = {decode: performance.now() - begin};
    this.units = new Units(report.unit);
    this.decimals = place_decimals(report.mean_edge_length);
    this.theme = document.documentElement.dataset.theme;
    this.colouring = "probability";
    this.selected = -1;
    this.former = null;  // pose before the flight to a loop
    this.write_header();
    this.filter = new LoopFilter(loops, this.units, () => this.apply_filter());
    this.table = new LoopTable(loops, this.units, this.decimals, (index) => this.toggle(index));
    this.details = new Details(this.data, this.units, this.decimals,
                               {fly: (index) => this.select(index, true), close: () => this.deselect()});
    draw_facts(this.data, this.units);
    this.make_view();
    this.times.view = performance.now() - begin;
    this.connect();
    this.apply_filter();
    this.set_theme(this.theme);
    this.times.parts = performance.now() - begin;
    if (this.view) this.view.draw();
    this.times.ready = performance.now() - begin;
    this.times.since_navigation = performance.now();
  }

  write_header() {
    const {report, loops} = this.data;
    const counts = report.counts || {};
    const title = report.title || "Scan";
    document.title = `${title} – Lacuna`;
    find("title").textContent = title;
    find("title").title = title;
    const parts = [];
    if (is_number(counts.holes)) parts.push(plural(counts.holes, "hole", "holes"));
    if (is_number(counts.outer)) parts.push(plural(counts.outer, "outer curve", "outer curves"));
    if (is_number(counts.points)) parts.push(plural(counts.points, "point", "points"));
    if (report.crs) parts.push(crs_name(report.crs));
    find("summary").replaceChildren(...parts.map((part) => element("span", {}, part)));
    if (loops.count === 0) find("csv").disabled = true;
  }

  make_view() {
    this.view = null;
    const say = (text, more) => {
      find("message").replaceChildren(element("strong", {}, text), element("span", {}, more));
      find("message").hidden = false;
      find("view").classList.add("no-view");
    };
    const context = webgl_context(find("canvas"));
    if (typeof THREE === "undefined" || !context) {
      say("No 3D view", "This browser gives no WebGL. The table, the charts and the facts work without it.");
      return;
    }
    try {
      this.view = new View(find("canvas"), context, this.data, {
        on_frame: (view) => { draw_scale(view, this.units); draw_triad(view.camera); },
        on_loop: (index) => this.click_loop(index),
        on_hover: (index, x, y) => this.hover(index, x, y),
      });
    } catch (error) {
      say("No 3D view", `WebGL failed: ${error.message}. The table, the charts and the facts work without it.`);
      return;
    }
    if (this.data.points.count === 0 && this.data.loops.count === 0) {
      say("Nothing to show", "The scan has no points.");
    } else if (this.data.points.count === 0) {
      find("colouring").disabled = true;
    }
    const scanned = find("colouring").querySelector("[value=colour]");
    if (!this.data.points.colours) scanned.remove();
  }

  connect() {
    this.connect_bar();
    this.connect_tabs();
    this.connect_view();
    const step = (direction) => {
      const index = this.table.neighbour(direction);
      if (index >= 0) this.select(index, true);
    };
    const side = (name) => { if (this.view) this.view.fly(this.view.side_pose(name)); };
    connect_keys({view: this.view, press: {
      n: () => step(1), p: () => step(-1), escape: () => this.escape(), "?": () => find("help").showModal(),
      f: () => side("fit"), 1: () => side("top"), 2: () => side("front"), 3: () => side("side"),
      c: () => this.next_colouring(), t: () => find("through").click(),
    }});
  }

  connect_bar() {
    find("help-open").addEventListener("click", () => find("help").showModal());
    find("help").addEventListener("click", (event) => { if (event.target === find("help")) find("help").close(); });
    find("theme").addEventListener("click", () => {
      this.is_theme_chosen = true;
      this.set_theme(this.theme === "dark" ? "light" : "dark");
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => {
      if (!this.is_theme_chosen) this.set_theme(event.matches ? "dark" : "light");
    });
    find("csv").addEventListener("click", () => {
      const title = (this.data.report.title || "scan").replace(/\.[a-z0-9]+$/i, "").replace(/[^\w.-]+/g, "_");
      save_text(this.table.csv(), `${title}_holes.csv`);
    });
  }

  connect_tabs() {
    const tabs = Array.from(document.querySelectorAll("[role=tab]"));
    const choose = (tab, is_focused) => {
      document.body.dataset.tab = tab.dataset.tab;
      for (const other of tabs) {
        other.setAttribute("aria-selected", String(other === tab));
        other.tabIndex = other === tab ? 0 : -1;
      }
      if (is_focused) tab.focus();
    };
    for (const [at, tab] of tabs.entries()) {
      tab.addEventListener("click", () => choose(tab, false));
      tab.addEventListener("keydown", (event) => {
        const move = {ArrowRight: 1, ArrowLeft: -1}[event.key];
        if (move) choose(tabs[(at + move + tabs.length) % tabs.length], true);
      });
    }
    choose(tabs[0], false);
    find("sheet").addEventListener("click", () => {
      const is_tall = document.body.classList.toggle("tall-sheet");
      find("sheet").setAttribute("aria-expanded", String(is_tall));
      find("sheet").setAttribute("aria-label", is_tall ? "Smaller panel" : "Larger panel");
    });
  }

  connect_view() {
    find("back").addEventListener("click", () => this.escape());
    find("colouring").addEventListener("change", () => this.set_colouring(find("colouring").value));
    find("view-more").addEventListener("click", () => {
      const is_open = find("view-settings").hidden;
      find("view-settings").hidden = !is_open;
      find("view-more").setAttribute("aria-expanded", String(is_open));
    });
    const {view} = this;
    if (!view) return;
    const size = () => {
      const factor = Math.pow(2, Number(find("point-size").value));
      find("point-size-value").textContent = `× ${format_number(factor, 2)}`;
      view.cloud.set_factor(factor);
      view.request();
    };
    find("point-size").addEventListener("input", size);
    size();
    const shown = () => view.set_shown(find("show-points").checked, find("show-loops").checked);
    find("show-points").addEventListener("change", shown);
    find("show-loops").addEventListener("change", shown);
    find("through").addEventListener("change", () => view.set_through(find("through").checked));
    for (const button of document.querySelectorAll("[data-side]")) {
      button.addEventListener("click", () => view.fly(view.side_pose(button.dataset.side)));
    }
  }

  next_colouring() {
    const names = Array.from(find("colouring").options, (option) => option.value);
    this.set_colouring(names[(names.indexOf(this.colouring) + 1) % names.length]);
  }

  set_colouring(name) {
    this.colouring = name;
    find("colouring").value = name;
    this.update_colours();
  }

  set_theme(theme) {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    find("theme").setAttribute("aria-pressed", String(theme === "dark"));
    this.update_colours();
    draw_charts(this.data, this.units, this.filter, theme);
  }

  update_colours() {
    if (!this.view) return;
    this.view.set_theme(this.theme, this.colouring);
    const {low, high} = this.view.box;
    const heights = [low[2], high[2]].map((z) => to_real(this.data.frame, [0, 0, z])[2]);
    draw_legend(this.data.points.count > 0 ? this.colouring : "plain", this.theme, heights, this.units, this.data.loops);
  }

  apply_filter() {
    const passes = (i) => this.filter.passes(i);
    this.table.show(passes);
    const count = this.table.shown.length, all = this.data.loops.count;
    find("shown").textContent = all === 0 ? "none" : `${format_count(count)} of ${format_count(all)} shown`;
    if (this.view) this.view.set_loops(this.table.shown);
    if (this.selected >= 0 && !passes(this.selected)) this.deselect();
    draw_charts(this.data, this.units, this.filter, this.theme);
  }

  // ---- Selection

  select(index, is_flight) {
    this.selected = index;
    this.table.select(index);
    this.details.show(index);
    if (this.view) {
      this.view.set_selected(index);
      if (is_flight) {
        if (!this.former) this.former = this.view.flight ? this.view.flight.to : this.view.pose();
        this.view.fly(this.view.loop_pose(index));
      }
    }
    this.update_chip();
  }

  deselect() {
    this.selected = -1;
    this.table.select(-1);
    this.details.show(-1);
    if (this.view) this.view.set_selected(-1);
    this.update_chip();
  }

  // Deselects, and goes back to the view before the flight.
  escape() {
    if (this.former && this.view) this.view.fly(this.former);
    this.former = null;
    if (this.selected >= 0) this.deselect();
    this.update_chip();
  }

  // A row: flies to its loop, and from the loop where it is back again.
  toggle(index) {
    if (index === this.selected && (this.former || !this.view)) this.escape(); else this.select(index, true);
  }

  click_loop(index) {
    if (index >= 0) this.select(index, false);
  }

  hover(index, x, y) {
    const tag = find("hover");
    tag.hidden = index < 0;
    find("canvas").style.cursor = index < 0 ? "" : "pointer";
    if (index < 0) return;
    const {loops} = this.data;
    const box = find("view").getBoundingClientRect();
    tag.textContent = `${loop_name(loops, index)} · ⌀ ${this.units.length(loops.diameter[index])}`;
    tag.style.transform = `translate(${Math.round(x - box.left + 14)}px, ${Math.round(y - box.top + 12)}px)`;
  }

  update_chip() {
    const {loops} = this.data;
    find("chip").hidden = this.selected < 0 && !this.former;
    find("back").lastChild.textContent = this.former ? "Back" : "Deselect";
    find("chip-text").textContent = this.selected < 0 ? ""
        : `${loop_name(loops, this.selected)} · ⌀ ${this.units.length(loops.diameter[this.selected])} · ` +
          `${this.units.area(loops.area[this.selected])}`;
  }
}

// What tests need; everything in real coordinates.
function expose(page) {
  const {view, data} = page;
  window.lacuna = {
    ready: true,
    times: page.times,
    has_view: Boolean(view),
    points: data.points.count,
    camera: () => (view ? to_real(data.frame, view.camera.position.toArray()) : null),
    target: () => (view ? to_real(data.frame, view.controls.target.toArray()) : null),
    is_still: () => !view || (!view.flight && !view.requested),
    visible_loops: () => page.table.shown.length,
    selected: () => (page.selected < 0 ? null : data.loops.id[page.selected]),
    theme: (name) => page.set_theme(name),
    colouring: (name) => page.set_colouring(name),
    colours: () => Object.fromEntries(["view", "hole", "outer", "marked"].map(
        (name) => [name, css_rgb(style_value(`--${name}`)).map((value) => Math.round(255 * value))])),
    read_pixels: () => view.read_pixels(),
    loop_at: (x, y) => { const at = view.loop_at(x, y); return at < 0 ? null : data.loops.id[at]; },
  };
}

function start() {
  try {
    expose(new Page());
  } catch (error) {
    find("message").textContent = `This report cannot be read: ${error.message}`;
    find("message").hidden = false;
    throw error;
  }
}

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start); else start();
