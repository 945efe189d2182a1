// SPDX-License-Identifier: Apache-2.0
// The table of loops: sorted, filtered, and only the rows in sight are in the document.

const kRowPixels = 30;

// {key, name, kind of value, pixels, rank}; "place" sorts by x. A table that is too narrow for all leaves out the last ranks.
const kColumns = [
  {key: "id", name: "Id", kind: "count", wide: 66, rank: 0},
  {key: "kind", name: "Kind", kind: "kind", wide: 84, rank: 1},
  {key: "mark", name: "Mark", kind: "mark", wide: 118, rank: 7},
  {key: "cause", name: "Cause", kind: "cause", wide: 118, rank: 3},
  {key: "area", name: "Area", kind: "area", wide: 92, rank: 2},
  {key: "perimeter", name: "Perimeter", kind: "length", wide: 116, rank: 8},
  {key: "diameter", name: "Diameter", kind: "length", wide: 112, rank: 4},
  {key: "confidence", name: "Confidence", kind: "fraction", wide: 108, rank: 5},
  {key: "points", name: "Points", kind: "count", wide: 84, rank: 9},
  {key: "place", name: "Place x, y, z", kind: "place", rank: 6},
];

class LoopTable {
  // `on_choose(index)` when a row is clicked or Enter is pressed on it.
  constructor(loops, units, decimals, marks, on_choose) {
    Object.assign(this, {loops, units, decimals, marks, on_choose});
    this.sort = {key: "area", is_falling: true, holes_first: true};
    this.shown = [];      // indices of loops, in the order of the rows
    this.selected = -1;
    this.focused = 0;     // row
    this.scales = {};
    const longest = Array.from(loops.id, (_, i) => this.place(i).join("  ").length).reduce((a, b) => Math.max(a, b), 11);
    const own = {cause: {name: loops.cause_word, wide: loops.has_changes ? 140 : 118}, place: {wide: 8.1 * longest + 22}};
    this.all_columns = kColumns.filter(({key}) => key !== "cause" || loops.has_causes).map((column) => ({...column, ...own[column.key]}));
    for (const column of this.all_columns) {
      const {key, kind} = column;
      if (kind !== "length" && kind !== "area") continue;
      const most = loops[key].reduce((a, b) => (b > a ? b : a), 0);
      this.scales[key] = units.scale(most, kind === "area" ? 2 : 1);
      column.wide = Math.max(column.wide, 8.1 * format_number(most * this.scales[key].factor).length + 22);
    }
    this.frame = find("rows");
    this.body = find("body");
    this.frame.addEventListener("scroll", () => this.render(), {passive: true});
    this.fit_columns();
    new ResizeObserver(() => { this.fit_columns(); this.render(); }).observe(this.frame);
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (!row || String(getSelection()).length > 0) return;
      this.focused = Number(row.dataset.row);
      this.on_choose(this.shown[this.focused]);
    });
    this.body.addEventListener("keydown", (event) => this.key(event));
  }

  // Shows the columns that the width holds. The others are in the details of a loop and in the CSV.
  fit_columns() {
    let left = this.frame.clientWidth;
    const fit = new Set([...this.all_columns].sort((a, b) => a.rank - b.rank).filter(({wide, rank}) => (left -= wide) >= 0 || rank === 0));
    const columns = this.all_columns.filter((column) => fit.has(column));
    if (this.columns && columns.length === this.columns.length) return;
    this.columns = columns;
    this.make_head();
    this.rendered = "";
  }

  make_head() {
    find("head").replaceChildren();
    for (const {key, name, kind, wide} of this.columns) {
      const unit = this.scales[key] ? this.scales[key].name : kind === "place" ? this.units.name : "";
      const button = element("button", {type: "button"}, element("span", {class: "arrow", "aria-hidden": "true"}), name,
                             unit ? element("span", {class: "unit"}, unit) : null);
      button.addEventListener("click", () => this.sort_by(key));
      find("head").append(element("th", {scope: "col", "data-key": key, class: `${kind} column-${key}`, style: `width:${wide}px`}, button));
    }
    find("table").setAttribute("aria-colcount", this.columns.length);
    this.mark_sort();
  }

  mark_sort() {
    for (const head of find("head").children) {
      const is_sorted = head.dataset.key === this.sort.key;
      const direction = this.sort.is_falling ? "descending" : "ascending";
      if (is_sorted) head.setAttribute("aria-sort", direction); else head.removeAttribute("aria-sort");
    }
  }

  sort_by(key) {
    const is_same = this.sort.key === key && !this.sort.holes_first;
    const starts_falling = !["id", "kind", "mark", "cause", "place"].includes(key);
    this.sort = {key, is_falling: is_same ? !this.sort.is_falling : starts_falling, holes_first: false};
    this.order = null;
    this.show(this.passes);
    this.frame.scrollTop = 0;
  }

  // All loops in the order of the sort; missing values come last, equal ones by index.
  sorted() {
    if (this.order) return this.order;
    const {loops, sort} = this;
    const values = sort.key === "kind" ? loops.is_hole.map((is_hole) => 1 - is_hole)
        : sort.key === "mark" ? this.mark_ranks()
        : sort.key === "cause" ? cause_ranks(loops)
        : sort.key === "place" ? Float64Array.from(loops.id, (_, i) => loops.centroid[3 * i]) : loops[sort.key];
    const sign = sort.is_falling ? -1 : 1;
    this.order = Array.from({length: loops.count}, (_, i) => i).sort((a, b) => {
      if (sort.holes_first && loops.is_hole[a] !== loops.is_hole[b]) return loops.is_hole[b] - loops.is_hole[a];
      const x = values[a], y = values[b];
      if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y) || a - b;
      return sign * (x - y) || a - b;
    });
    return this.order;
  }

  // Places in kMarks; NaN without a mark.
  mark_ranks() {
    return this.marks.mark.map((name) => (name === kNoMark ? NaN : kMarkNames.indexOf(name)));
  }

  // Marks have changed.
  update_marks() {
    if (this.sort.key === "mark") this.order = null;
  }

  show(passes) {
    this.passes = passes;
    this.shown = this.sorted().filter(passes);
    this.focused = Math.max(0, Math.min(this.focused, this.shown.length - 1));
    this.mark_sort();
    find("table").setAttribute("aria-rowcount", this.shown.length + 1);
    find("table").hidden = this.loops.count === 0;
    find("nothing").hidden = this.shown.length > 0;
    find("nothing").textContent = this.loops.count === 0 ? "No loops: the scan has no holes and no outer curve."
                                                         : "No loop passes the filters.";
    this.rendered = "";
    this.render();
  }

  render() {
    const height = this.frame.clientHeight || 300;
    const begin = Math.max(0, Math.floor(this.frame.scrollTop / kRowPixels) - 8);
    const end = Math.min(this.shown.length, begin + Math.ceil(height / kRowPixels) + 18);
    const state = `${begin} ${end} ${this.selected}`;
    if (state === this.rendered) return;
    this.rendered = state;
    const had_focus = this.body.contains(document.activeElement);
    const space = (count) => element("tr", {class: "space", "aria-hidden": "true"},
        element("td", {colspan: this.columns.length, style: `height:${count * kRowPixels}px`}));
    const rows = [];
    if (begin > 0) rows.push(space(begin));
    for (let row = begin; row < end; ++row) rows.push(this.row(row));
    if (end < this.shown.length) rows.push(space(this.shown.length - end));
    this.body.replaceChildren(...rows);
    if (had_focus) this.focus_row(this.focused, false);
  }

  row(row) {
    const i = this.shown[row];
    const is_selected = i === this.selected;
    const made = element("tr", {"data-row": row, "data-id": this.loops.id[i], tabindex: row === this.focused ? 0 : -1,
                                "aria-rowindex": row + 2, "aria-current": is_selected ? "true" : null,
                                class: is_selected ? "selected" : null});
    for (const column of this.columns) {
      const cell = this.cell(column, i);
      cell.classList.add(`column-${column.key}`);
      made.append(cell);
    }
    return made;
  }

  cell({key, kind}, i) {
    const {loops} = this;
    if (kind === "kind") {
      const name = loops.is_hole[i] ? "hole" : "outer";
      return element("td", {class: "kind"}, element("i", {class: `swatch ${name}`}), name);
    }
    if (kind === "mark") {
      const name = this.marks.mark[i];
      return name === kNoMark ? element("td", {class: "mark-cell"})
                              : element("td", {class: "mark-cell"}, mark_sign(name), mark_title(name));
    }
    if (kind === "cause") {
      const name = loops.cause[i];
      return name === kNoCause ? element("td") : element("td", {class: "cause"}, cause_swatch(name, "dot"), cause_title(name));
    }
    if (kind === "place") return element("td", {class: "place"}, this.place(i).join("  "));
    const value = loops[key][i];
    if (kind === "count") return element("td", {class: "number"}, format_count(value));
    if (kind === "fraction") {
      const is_shown = key === "confidence" && is_number(value);
      return element("td", {class: "number" + (is_shown ? " meter" : ""), style: is_shown ? `--part:${value}` : null},
                     format_fraction(value));
    }
    return element("td", {class: "number"}, format_number(value * this.scales[key].factor));
  }

  place(i) {
    return vector_of(this.loops.centroid, i).map((value) => format_place(value, this.decimals));
  }

  select(index) {
    this.selected = index;
    const row = this.shown.indexOf(index);
    if (row >= 0) {
      this.focused = row;
      this.scroll_to(row);
    }
    this.rendered = "";
    this.render();
  }

  scroll_to(row) {
    const head = find("head").offsetHeight;
    const top = row * kRowPixels, view = this.frame.clientHeight - head;
    if (top < this.frame.scrollTop) this.frame.scrollTop = top;
    if (top + kRowPixels > this.frame.scrollTop + view) this.frame.scrollTop = top + kRowPixels - view;
  }

  focus_row(row, is_scrolled = true) {
    this.focused = Math.max(0, Math.min(this.shown.length - 1, row));
    if (is_scrolled) { this.scroll_to(this.focused); this.rendered = ""; this.render(); }
    for (const made of this.body.querySelectorAll("tr[data-row]")) {
      made.tabIndex = Number(made.dataset.row) === this.focused ? 0 : -1;
      if (made.tabIndex === 0) made.focus({preventScroll: true});
    }
  }

  key(event) {
    const page = Math.max(1, Math.floor(this.frame.clientHeight / kRowPixels) - 2);
    const moves = {ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity};
    if (event.key in moves) {
      this.focus_row(Math.max(0, Math.min(this.shown.length - 1, this.focused + moves[event.key])));
    } else if (event.key === "Enter" || event.key === " ") {
      this.on_choose(this.shown[this.focused]);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  // Index of the loop whose row has the focus, -1 if none has it.
  focused_loop() {
    return document.activeElement.matches("#body tr[data-row]") ? this.shown[this.focused] : -1;
  }

  // The row after (1) or before (-1) the selected one, as an index; -1 without rows.
  neighbour(direction) {
    if (this.shown.length === 0) return -1;
    const row = this.shown.indexOf(this.selected);
    if (row < 0) return this.shown[direction > 0 ? 0 : this.shown.length - 1];
    return this.shown[(row + direction + this.shown.length) % this.shown.length];
  }

  // Comma-separated values of the rows shown, with the digits of the report: holes.csv has all of them.
  csv() {
    const {loops, marks} = this;
    const unit = this.units.unit ? ` (${this.units.unit})` : "", square = this.units.unit ? ` (${this.units.unit}^2)` : "";
    const text = (value) => (Number.isFinite(value) ? String(value) : "");
    const quoted = (words) => (/[",\r\n]/.test(words) ? `"${words.replace(/"/g, '""')}"` : words);
    const place = (value) => (Number.isFinite(value) ? String(short_place(value)) : "");
    const units = {first_scale: unit, last_scale: unit, perimeter: unit, area: square, diameter: unit};
    const vector = (names, column, words) => names.map((name, axis) => [name, (i) => words(column[3 * i + axis])]);
    const axes = (before) => ["x", "y", "z"].map((axis) => before + axis + unit);
    const has_shares = loops.has_causes && !loops.has_changes;
    const columns = [  // as in holes.csv
      ["id", (i) => loops.id[i]], ["kind", (i) => (loops.is_hole[i] ? "hole" : "outer")],
      ...kMeasures.map((name) => [name + (units[name] || ""), (i) => text(loops[name][i])]),
      ...(has_shares ? kCauses : []).map((name) => [name, (i) => text(loops.shares[name][i])]),
      ...vector(axes(""), loops.centroid, place), ...vector(["nx", "ny", "nz"], loops.normal, text),
      ...(loops.has_causes ? [[loops.cause_word.toLowerCase(), (i) => (loops.cause[i] === kNoCause ? "" : loops.cause[i])]] : []),
      ...(has_shares ? vector(axes("hidden_by_"), loops.hidden_by, place) : []),
      ["mark", (i) => (marks.mark[i] === kNoMark ? "" : marks.mark[i])], ["note", (i) => quoted(marks.note[i])],
    ];
    const lines = [columns.map(([name]) => name), ...this.shown.map((i) => columns.map(([, value]) => value(i)))];
    return lines.map((line) => line.join(",")).join("\n") + "\n";
  }
}
