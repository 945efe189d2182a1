// SPDX-License-Identifier: Apache-2.0
// Stations, and the places to stand next: small markers over the view, with their names or numbers.

const kLongestName = 24;  // characters over the view; the facts have the whole name

// The shape of a marker around 0 0; the legend has the same ones.
function station_shape(is_next) {
  return is_next ? drawing("rect", {x: -8, y: -8, width: 16, height: 16, rx: 3, class: "next"})
                 : drawing("path", {d: "M0 -7 L6.5 5 L-6.5 5 Z", class: "station"});
}

class StationMarks {
  constructor(view, {frame, stations, next_stations}) {
    Object.assign(this, {view, is_shown: true, chosen: -1});
    const pen = document.createElement("canvas").getContext("2d");
    pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    const make = ({place, name, rank}) => {
      const is_next = rank !== undefined;
      const words = is_next ? String(rank) : name.length > kLongestName ? `${name.slice(0, kLongestName - 1)}…` : name;
      const text = drawing("text", is_next ? {class: "next", y: 4} : {}, words);
      return {place: to_scene(frame, place), is_next, text, wide: pen.measureText(words).width,
              node: drawing("g", {}, station_shape(is_next), text)};
    };
    this.marks = [...stations, ...next_stations].map(make);
    find("stations-over").append(drawing("g", {class: "sight"}), ...this.marks.map(({node}) => node));
    find("stations-check").hidden = this.marks.length === 0;
    find("show-stations").addEventListener("change", () => {
      this.is_shown = find("show-stations").checked;
      this.draw();
    });
  }

  // The station whose name comes first; -1 for none.
  choose(index) {
    if (this.chosen >= 0) this.marks[this.chosen].node.classList.remove("chosen");
    this.chosen = index;
    if (index >= 0) this.marks[index].node.classList.add("chosen");
  }

  // After each picture. A name that would be cut, or cover a marker or another name, is left out.
  draw() {
    find("stations-over").toggleAttribute("hidden", !this.is_shown);
    if (!this.is_shown) return;
    const places = this.marks.map(({place}) => pixel_of(this.view, place, 10));
    const taken = places.filter(Boolean).map(([x, y]) => [x - 8, y - 8, x + 8, y + 8]);
    const {width} = view_pixels(this.view);
    const is_free = ([left, top, right, bottom]) => left >= 0 && right <= width &&
        taken.every((box) => right <= box[0] || left >= box[2] || bottom <= box[1] || top >= box[3]);
    const first = this.chosen < 0 ? [] : [this.chosen];
    for (const i of new Set([...first, ...this.marks.keys()])) {
      const {node, text, wide, is_next} = this.marks[i], at = places[i];
      node.toggleAttribute("hidden", !at);
      if (!at) continue;
      const [x, y] = at.map((value) => Math.round(10 * value) / 10);
      node.setAttribute("transform", `translate(${x} ${y})`);
      if (is_next) continue;
      const sides = [[10, x + 9, x + 13 + wide], [-10 - wide, x - 13 - wide, x - 9]];
      const free = sides.map(([from, left, right]) => ({from, box: [left, y - 9, right, y + 9]})).find(({box}) => is_free(box));
      text.toggleAttribute("hidden", !free);
      if (!free) continue;
      text.setAttribute("x", free.from);
      text.setAttribute("y", 4);
      taken.push(free.box);
    }
  }
}

// Lines of the legend.
function station_legend({stations, next_stations}) {
  const line = (is_next, text) => element("span", {}, drawing("svg", {viewBox: "-9 -9 18 18", class: "stations-over sign"}, station_shape(is_next)), text);
  return [...(stations.length > 0 ? [line(false, "Station")] : []),
          ...(next_stations.length > 0 ? [line(true, "Stand next")] : [])];
}
