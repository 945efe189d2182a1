// SPDX-License-Identifier: Apache-2.0
// The section: a height above which, and another one below which, the view shows nothing.
//
// Shaders leave out what lies outside, so that a change costs one picture, whatever the number of points.

const kSliderSteps = 200;  // at least

// One of the two heights. At its end of the range it hides nothing.
class HeightLimit {
  // `name` of its controls, "above" or "below"; `on_change()` when the user has moved it. set_range() follows.
  constructor(name, units, on_change) {
    Object.assign(this, {name, units});
    this.slider = find(`${name}-slider`);
    this.slider.addEventListener("input", () => { this.set(Number(this.slider.value)); on_change(); });
  }

  // In the scan's unit; `off`: the end at which it hides nothing. It is there afterwards.
  set_range({low, high, step, decimals}, off) {
    Object.assign(this, {low, high, decimals, off});
    Object.assign(this.slider, {min: this.text(low), max: this.text(high), step: this.text(step)});
    this.set(off);
  }

  set(value) {
    this.value = Math.min(this.high, Math.max(this.low, value));
    this.slider.value = this.text(this.value);
    find(`${this.name}-text`).textContent = this.is_active() ? this.height() : "";
    this.slider.setAttribute("aria-valuetext", this.is_active() ? this.words() : "off");
  }

  is_active() { return this.value !== this.off; }

  text(value) { return value.toFixed(this.decimals); }

  height() { return `${this.text(this.value).replace("-", "−")}${this.units.name ? ` ${this.units.name}` : ""}`; }

  words() { return `${this.name} ${this.height()}`; }
}

class Section {
  // `on_change(low, high)` gives the heights that are shown, in scene coordinates, after each change.
  constructor(data, bounds, units, on_change) {
    Object.assign(this, {data, bounds, frame: data.frame, on_change});
    const changed = () => { this.former = null; this.changed(); };
    this.above = new HeightLimit("above", units, changed);
    this.below = new HeightLimit("below", units, changed);
    this.set_ranges();
  }

  // At first, and after frame.up has changed: all heights are shown.
  set_ranges() {
    const range = slider_range(...scene_heights(this.bounds, this.data).map((height) => real_height(this.frame, height)));
    this.former = null;  // heights before the flight to a loop that they hid
    this.above.set_range(range, range.high);
    this.below.set_range(range, range.low);
    find("section").disabled = this.data.points.count + this.data.loops.count === 0 || range.low === range.high;
  }

  is_active() { return this.above.is_active() || this.below.is_active(); }

  // What it hides; nothing if it hides nothing.
  words() {
    const active = [this.above, this.below].filter((limit) => limit.is_active());
    return active.length > 0 ? `Hidden: ${active.map((limit) => limit.words()).join(", ")}` : "";
  }

  // [low, high] in scene coordinates.
  heights() {
    return [this.below, this.above].map(
        (limit, i) => (limit.is_active() ? scene_height(this.frame, limit.value) : kAllHeights[i]));
  }

  changed() {
    const storey = this.storeys ? this.storeys.indexOf(this.above.value) : -1;
    find("storeys").value = this.is_active() ? (storey >= 0 ? storey : "") : "all";
    this.on_change(...this.heights());
  }

  reset() {
    this.former = null;
    this.set(this.above.off, this.below.off);
  }

  set(above, below) {
    this.above.set(above);
    this.below.set(below);
    this.changed();
  }

  // A list of the storeys of a scan within walls, by the heights below their ceilings, the highest first. This one is open.
  open_storeys(heights) {
    this.storeys = heights.map((height) => Number(height.toFixed(this.above.decimals)));
    const name = (i) => (heights.length === 1 ? "Ceiling off" : `Floor ${heights.length - i}`);
    find("storeys").append(element("option", {value: "all"}, "All heights"), ...heights.map((_, i) => element("option", {value: i}, name(i))));
    find("storey").hidden = heights.length === 0;
    find("storeys").addEventListener("change", () => {
      this.former = null;
      this.set(find("storeys").value === "all" ? this.above.off : this.storeys[find("storeys").value], this.below.off);
    });
    if (heights.length > 0) this.set(this.storeys[0], this.below.off);
  }

  // Moves the heights that hide any of the box (scene coordinates, may be null) to where they hide nothing.
  open_for(box) {
    const [low, high] = this.heights();
    const is_above = Boolean(box) && box.high[this.frame.up] > high, is_below = Boolean(box) && box.low[this.frame.up] < low;
    if (!is_above && !is_below) return;
    const now = [this.above.value, this.below.value];
    this.former = this.former || now;
    this.set(is_above ? this.above.off : now[0], is_below ? this.below.off : now[1]);
  }

  // To the heights before open_for(), unless the user has moved one since.
  close_again() {
    if (this.former) this.set(...this.former);
    this.former = null;
  }
}

// Whole steps around the heights: a few hundred of 1, 2 or 5 times a power of ten.
function slider_range(low, high) {
  const step = round_step(Math.max(high - low, 1e-6) / kSliderSteps);
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const whole = (value) => Number((value * step).toFixed(decimals));
  return {low: whole(Math.floor(low / step + 1e-6)), high: whole(Math.ceil(high / step - 1e-6)), step, decimals};
}
