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
    find("measure-copy").addEventListener("click", () => copy_text(this.copied(), find("measure-copy")));
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

  copied() {
    return this.places.map((place) => this.words(place).join(" ").replace(/−/g, "-")).join("\n");
  }

  show() {
    const {places} = this;
    find("measure-panel").hidden = !this.is_on;
    find("measure-copy").hidden = places.length === 0;
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
    const {camera} = this.view.navigation;
    const {clientWidth, clientHeight} = this.view.canvas;
    const over = find("measure-over");
    over.setAttribute("viewBox", `0 0 ${clientWidth} ${clientHeight}`);
    const at = this.places.map((place) => {
      const seen = new THREE.Vector3(...place).project(camera);
      return seen.z < 1 ? [(seen.x + 1) / 2 * clientWidth, (1 - seen.y) / 2 * clientHeight] : null;
    });
    const parts = [];
    if (at.length === 2 && at[0] && at[1]) {
      const ends = {x1: at[0][0], y1: at[0][1], x2: at[1][0], y2: at[1][1]};
      parts.push(drawing("line", {...ends, class: "casing"}), drawing("line", ends));
    }
    for (const place of at) if (place) parts.push(drawing("circle", {cx: place[0], cy: place[1], r: 5}));
    over.replaceChildren(...parts);
  }
}
