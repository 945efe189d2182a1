// SPDX-License-Identifier: Apache-2.0
// The line from a scanner to what hides the selected hole, and on to its middle, dashed where the station does not see.

class SightLine {
  constructor(view, data, marks) {
    Object.assign(this, {view, data, marks});
    this.places = [];  // of the station, of what hides, of the hole
  }

  // -1 for none. Loops that are hidden for the most part have a line.
  select(index) {
    const {loops, frame, stations} = this.data;
    const station = index >= 0 && loops.cause[index] === "hidden" ? stations[loops.hidden_from[index]] : undefined;
    const vector = (column) => to_scene(frame, Array.from(column.subarray(3 * index, 3 * index + 3)));
    this.places = station ? [loops.hidden_from_place, loops.hidden_by, loops.centroid].map(vector) : [];
    if (!this.places.every((place) => place.every(Number.isFinite))) this.places = [];
    this.marks.choose(this.places.length > 0 ? loops.hidden_from[index] : -1);
  }

  // After each picture.
  draw() {
    const parts = [];
    for (let i = 0; i + 1 < this.places.length; ++i) {
      const ends = pixels_of_edge(this.view, this.places[i], this.places[i + 1]);
      if (ends) parts.push(drawing("line", {...ends, class: "casing"}), drawing("line", {...ends, class: i === 0 ? "seen" : "behind"}));
    }
    const at = this.places.length > 0 ? pixel_of(this.view, this.places[1], 10) : null;
    if (at) parts.push(drawing("circle", {cx: at[0], cy: at[1], r: 4}));
    document.querySelector("#stations-over .sight").replaceChildren(...parts);
  }
}
