// SPDX-License-Identifier: Apache-2.0
// Measures in the view: coordinates of a point of the sample, and the distance of two.

class Measure {
  // `view`, not null; places have `decimals`.
  constructor(view, units, decimals) {
    Object.assign(this, {view, units, decimals});
    this.is_on = false;
    this.places = [];  // at most two, in scene coordinates
    find("measure").addEventListener("click", () => this.set(!this.is_on));
    find("measure-close").addEventListener("click", () => this.set(false));
  }

  set(is_on) {
    this.is_on = is_on;
    this.places = [];
    find("measure").setAttribute("aria-pressed", String(is_on));
    find("view").classList.toggle("measuring", is_on);
    this.show();
  }

  // A third point begins anew.
  pick(x, y) {
    const found = this.view.point_at(x, y);
    if (!found) {
      find("measure-text").textContent = "No point is there.";
      return;
    }
    if (this.places.length === 2) this.places = [];
    this.places.push(found.place);
    this.show();
  }

  real(place) { return to_real(this.view.data.frame, place); }

  words(place) { return this.real(place).map((value) => format_place(value, this.decimals)); }

  show() {
    const {places} = this;
    find("measure-panel").hidden = !this.is_on;
    const parts = places.length === 0 ? ["Choose a point."] : [axes(this.words(places[places.length - 1]))];
    if (places.length === 2) {
      const [from, to] = places.map((place) => this.real(place));
      const steps = to.map((value, axis) => format_place(value - from[axis], this.decimals));
      const length = Math.hypot(...to.map((value, axis) => value - from[axis]));
      parts.unshift(element("strong", {}, this.units.length(length, 4)));
      parts.push(element("span", {class: "quiet"}, `Δ ${steps.join("  ")}`));
    }
    find("measure-text").replaceChildren(...parts);
    this.draw();
  }

  // After each picture: signs at the points, and the line.
  draw() {
    const ends = this.places.length === 2 ? pixels_of_edge(this.view, ...this.places) : null;
    const at = this.places.map((place) => pixel_of(this.view, place, 0)).filter(Boolean);
    find("measure-over").replaceChildren(
        ...(ends ? [drawing("line", {...ends, class: "casing"}), drawing("line", ends)] : []),
        ...at.map(([cx, cy]) => drawing("circle", {cx, cy, r: 5})));
  }
}
