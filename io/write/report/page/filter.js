// SPDX-License-Identifier: Apache-2.0
// Which loops are shown: kind, mark, cause, diameter from and to, least confidence. Sliders and number fields say the same.

class LoopFilter {
  // `on_change()` after each change, at most once a picture.
  constructor(loops, units, marks, on_change) {
    Object.assign(this, {loops, marks, on_change});
    this.clear();
    const sizes = Array.from(loops.diameter).filter((value) => value > 0);
    this.least = sizes.reduce((a, b) => Math.min(a, b), Infinity);
    this.most = sizes.reduce((a, b) => Math.max(a, b), 0);
    this.scale = units.scale(this.most, 1);
    find("size-unit").textContent = this.scale.name;
    this.connect();
  }

  // The least and the largest diameter are in the scan's unit.
  clear() { Object.assign(this, {kind: "all", mark: "any", cause: "any", size: 0, most_size: Infinity, confidence: 0}); }

  connect() {
    for (const radio of document.getElementsByName("kind")) {
      radio.addEventListener("change", () => { this.kind = radio.value; this.changed(); });
    }
    find("mark-filter").addEventListener("change", () => { this.mark = find("mark-filter").value; this.changed(); });
    find("cause-filter").addEventListener("change", () => { this.cause = find("cause-filter").value; this.changed(); });
    const {least, most} = this;
    const slider = find("size-slider"), number = find("size-number");
    slider.disabled = !(most > 0);
    slider.addEventListener("input", () => {
      const part = slider.value / 1000;
      // A little beyond the largest at the end, so that the slider can leave out all.
      this.size = part === 0 ? 0 : least * Math.pow((most * 1.02) / least, part);
      number.value = Number((this.size * this.scale.factor).toPrecision(3));
      typed_number(number);
      this.changed();
    });
    number.addEventListener("input", () => {
      this.size = Math.max(0, typed_number(number) || 0) / this.scale.factor;
      slider.value = this.size <= least || !(most > least) ? 0
          : Math.round((1000 * Math.log(this.size / least)) / Math.log((most * 1.02) / least));
      this.changed();
    });
    const largest = find("size-most");
    largest.addEventListener("input", () => {
      const value = typed_number(largest);
      this.most_size = Number.isNaN(value) ? Infinity : value / this.scale.factor;
      this.changed();
    });
    const confidence = find("confidence-slider"), field = find("confidence-number");
    confidence.addEventListener("input", () => {
      this.confidence = Number(confidence.value);
      field.value = confidence.value;
      typed_number(field);
      this.changed();
    });
    field.addEventListener("input", () => {
      this.confidence = Math.max(0, typed_number(field) || 0);
      confidence.value = this.confidence;
      this.changed();
    });
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
    return parts.join(", ");
  }

  passes(i) {
    const {is_hole, diameter, confidence} = this.loops;
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
