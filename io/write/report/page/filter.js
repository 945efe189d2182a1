// SPDX-License-Identifier: Apache-2.0
// Which loops are shown: by kind, mark, cause, diameter and confidence. Many loops near the spacing are folded.

class LoopFilter {
  // `on_change()` after each change, at most once a picture.
  constructor(loops, units, marks, on_change) {
    Object.assign(this, {loops, marks, on_change});
    this.clear();
    this.set_folded(loops.small_count > 0);
    this.scale = units.scale(loops.diameter.reduce((a, b) => (b > a ? b : a), 0), 1);
    find("size-unit").textContent = this.scale.name;
    this.connect();
  }

  // The least and the largest diameter are in the scan's unit.
  clear() { Object.assign(this, {kind: "all", mark: "any", cause: "any", size: 0, most_size: Infinity, confidence: 0}); }

  set_folded(is_folded) {
    this.is_folded = is_folded;
    find("fold").hidden = this.loops.small_count === 0;
    find("fold-text").textContent = this.fold_words() + (is_folded ? "" : " are shown");
    find("fold-switch").textContent = is_folded ? "Show" : "Hide";
    find("fold-switch").setAttribute("aria-pressed", String(!is_folded));
  }

  fold_words() {
    const {small_count, small_below} = this.loops;
    return small_count === 0 ? "" : `${plural(small_count, "loop", "loops")} below ${small_below} spacings`;
  }

  // For the legend: what the picture leaves out, to click.
  fold_line() {
    if (!this.is_folded) return [];
    const line = element("button", {type: "button", class: "link"}, `${this.fold_words()}: show`);
    line.addEventListener("click", () => find("fold-switch").click());
    return [line];
  }

  connect() {
    find("fold-switch").addEventListener("click", () => { this.set_folded(!this.is_folded); this.changed(); });
    for (const radio of document.getElementsByName("kind")) {
      radio.addEventListener("change", () => { this.kind = radio.value; this.changed(); });
    }
    find("mark-filter").addEventListener("change", () => { this.mark = find("mark-filter").value; this.changed(); });
    find("cause-filter").addEventListener("change", () => { this.cause = find("cause-filter").value; this.changed(); });
    const connect_number = (id, take) => find(id).addEventListener("input", () => { take(typed_number(find(id))); this.changed(); });
    connect_number("size-number", (value) => { this.size = Math.max(0, value || 0) / this.scale.factor; });
    connect_number("size-most", (value) => { this.most_size = Number.isNaN(value) ? Infinity : value / this.scale.factor; });
    connect_number("confidence-number", (value) => { this.confidence = Math.max(0, value || 0); });
    find("filters").addEventListener("submit", (event) => event.preventDefault());
  }

  reset() {
    find("filters").reset();
    for (const name of ["size-number", "size-most", "confidence-number"]) typed_number(find(name));
    this.clear();
    this.changed();
  }

  is_active() {
    return this.kind !== "all" || this.mark !== "any" || this.cause !== "any" || this.size > 0 || this.most_size < Infinity ||
           this.confidence > 0;
  }

  // What it leaves out, in words; nothing if nothing.
  words(units) {
    const parts = [];
    if (this.kind !== "all") parts.push(this.kind === "hole" ? "holes" : "outer curves");
    if (this.mark !== "any") parts.push(`mark: ${mark_title(this.mark).toLowerCase()}`);
    if (this.cause !== "any") parts.push(`${this.loops.cause_word.toLowerCase()}: ${cause_title(this.cause)}`);
    if (this.size > 0) parts.push(`diameter at least ${units.length(this.size)}`);
    if (this.most_size < Infinity) parts.push(`diameter at most ${units.length(this.most_size)}`);
    if (this.confidence > 0) parts.push(`confidence at least ${format_number(this.confidence, 2)}`);
    if (this.is_folded) parts.push(`without ${this.fold_words()}`);
    return parts.join(", ");
  }

  passes(i) {
    const {is_hole, is_small, diameter, confidence} = this.loops;
    if (this.is_folded && is_small[i] && this.marks.mark[i] === kNoMark) return false;
    if (this.kind === "hole" && !is_hole[i]) return false;
    if (this.kind === "outer" && is_hole[i]) return false;
    if (this.mark !== "any" && this.marks.mark[i] !== this.mark) return false;
    if (this.cause !== "any" && this.loops.cause[i] !== this.cause) return false;
    if (this.size > 0 && !(diameter[i] >= this.size)) return false;
    if (this.most_size < Infinity && !(diameter[i] <= this.most_size)) return false;
    return !(this.confidence > 0) || confidence[i] >= this.confidence;
  }

  changed() {
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame(() => {
      this.requested = false;
      this.on_change();
    });
  }
}
