// SPDX-License-Identifier: Apache-2.0
// What lies over the view. First scene positions in pixels, then ids of holes, then stations with the places to stand
// next. The line from a station to what hides the selected hole follows, and measures.

// [right, up, ahead] of the eye.
function seen_from(camera, place) {
  const e = camera.matrixWorldInverse.elements;
  const along = (k) => e[k] * place[0] + e[4 + k] * place[1] + e[8 + k] * place[2] + e[12 + k];
  return [along(0), along(1), -along(2)];
}

// {width, height, focal}: the view in pixels of the page; `focal` is at distance 1.
function view_pixels({canvas, navigation}) {
  const {clientWidth: width, clientHeight: height} = canvas;
  return {width, height, focal: height / (2 * Math.tan((navigation.camera.fov * Math.PI) / 360))};
}

function to_pixel({width, height, focal}, [right, up, ahead]) {
  return [width / 2 + (focal * right) / ahead, height / 2 - (focal * up) / ahead];
}

// The pixel of a place; null behind the eye, or more than `margin` pixels outside of the view.
function pixel_of(view, place, margin) {
  const seen = seen_from(view.navigation.camera, place);
  if (!(seen[2] > 0)) return null;
  const pixels = view_pixels(view);
  const [x, y] = to_pixel(pixels, seen);
  return x > -margin && x < pixels.width + margin && y > -margin && y < pixels.height + margin ? [x, y] : null;
}

// The part of an edge that the view shows, as {x1, y1, x2, y2} in pixels; null without one.
function pixels_of_edge(view, from, to) {
  const pixels = view_pixels(view);
  const a = seen_from(view.navigation.camera, from), b = seen_from(view.navigation.camera, to);
  // Inside of five planes through the eye: linear in the part of the edge (Liang, Barsky 1984).
  const wide = pixels.width / 2 / pixels.focal, tall = pixels.height / 2 / pixels.focal;
  const planes = [([, , z]) => z - 1e-7, ([x, , z]) => wide * z - x, ([x, , z]) => wide * z + x,
                  ([, y, z]) => tall * z - y, ([, y, z]) => tall * z + y];
  let begin = 0, end = 1;
  for (const inside of planes) {
    const at_a = inside(a), at_b = inside(b);
    if (at_a < 0 && at_b < 0) return null;
    if (at_a < 0) begin = Math.max(begin, at_a / (at_a - at_b));
    if (at_b < 0) end = Math.min(end, at_a / (at_a - at_b));
  }
  if (!(begin < end)) return null;
  const at = (part) => to_pixel(pixels, a.map((value, k) => value + part * (b[k] - value)));
  const [x1, y1] = at(begin), [x2, y2] = at(end);
  return {x1, y1, x2, y2};
}

const kMostNames = 60, kMostCorners = 400;  // of a loop, to find a place for its id
const kNamePixels = 15;  // height of an id

// The pixels of a loop's vertices, or of so many of them; null where one is behind the eye.
function pixels_of_loop(view, {first, vertices}, index, most = Infinity) {
  const pixels = view_pixels(view), {camera} = view.navigation;
  const step = Math.ceil((first[index + 1] - first[index]) / most) || 1;
  const places = [];
  for (let i = first[index]; i < first[index + 1]; i += step) {
    const seen = seen_from(camera, vertices.subarray(3 * i, 3 * i + 3));
    if (!(seen[2] > 0)) return null;
    places.push(to_pixel(pixels, seen));
  }
  return places;
}

// Twice the area of a polygon.
function doubled_area(places) {
  return Math.abs(places.reduce((sum, [x, y], i) => {
    const [next_x, next_y] = places[(i + 1) % places.length];
    return sum + x * next_y - next_x * y;
  }, 0));
}

function is_inside(places, x, y) {
  let inside = false;
  places.forEach(([ax, ay], i) => {
    const [bx, by] = places[(i + 1) % places.length];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) inside = !inside;
  });
  return inside;
}

// The hole of `shown` that looks smallest around a place of the window; -1 without any.
function hole_around(view, loops, shown, x, y) {
  const box = view.canvas.getBoundingClientRect();
  let best = -1, least = Infinity;
  for (const index of shown) {
    if (!loops.is_hole[index]) continue;
    const places = pixels_of_loop(view, loops, index);
    if (!places || !is_inside(places, x - box.left, y - box.top)) continue;
    const area = doubled_area(places);
    if (area < least) { least = area; best = index; }
  }
  return best;
}

class LoopNames {
  constructor(view, loops) {
    Object.assign(this, {view, loops});
    const size = (i) => (loops.diameter[i] >= 0 ? loops.diameter[i] : -1);
    const largest = (is_hole) => Array.from(loops.id.keys()).filter((i) => loops.is_hole[i] === is_hole).sort((a, b) => size(b) - size(a)).slice(0, kMostNames);
    this.largest = largest(1);
    this.drawn = [...this.largest, ...largest(0)];
    this.boxes = new Map(this.drawn.map((i) => [i, loop_box(loops, i)]));
    this.nodes = this.largest.map((i) => drawing("text", {}, String(loops.id[i])));
    find("names-over").replaceChildren(...this.nodes);
  }

  // Whether the picture may have this loop.
  is_seen(index) {
    const box = this.boxes.get(index), {section} = this.view.uniforms, {up} = this.view.data.frame;
    return Boolean(box) && this.is_shown.has(index) && box.low[up] <= section.value.y && box.high[up] >= section.value.x &&
           seen_from(this.view.navigation.camera, box.middle)[2] > this.view.nearest();
  }

  // After each picture. An id stands in the middle of its hole, where it covers no line and no other id. The chosen one
  // comes first, then the largest.
  draw(shown, selected) {
    if (this.shown !== shown) Object.assign(this, {shown, is_shown: new Set(shown)});
    const drawn = new Map(find("show-loops").checked ? this.drawn.filter((i) => this.is_seen(i)).map((i) => [i, pixels_of_loop(this.view, this.loops, i, kMostCorners)]) : []);
    const lines = Array.from(drawn.values()).filter(Boolean).flat(), taken = [];
    for (const k of Array.from(this.largest.keys()).sort((a, b) => (this.largest[b] === selected) - (this.largest[a] === selected) || a - b)) {
      const node = this.nodes[k], places = drawn.get(this.largest[k]);
      const half = [4 * node.textContent.length + 2, kNamePixels / 2];
      const ends = places && [0, 1].map((axis) => places.reduce(([low, high], at) => [Math.min(low, at[axis]), Math.max(high, at[axis])], [Infinity, -Infinity]));
      const at = ends && ends.map(([low, high]) => (low + high) / 2);
      const is_free = Boolean(at) && ends.every(([low, high], axis) => high - low > 2 * half[axis]) &&
          !lines.some((place) => place.every((value, axis) => Math.abs(value - at[axis]) < half[axis])) &&
          taken.every((other) => at.some((value, axis) => Math.abs(value - other.at[axis]) >= half[axis] + other.half[axis]));
      node.toggleAttribute("hidden", !is_free);
      if (!is_free) continue;
      taken.push({at, half});
      node.setAttribute("transform", `translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})`);
    }
  }
}

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
    const places = station ? [loops.hidden_from_place, loops.hidden_by, loops.centroid] : [];
    this.places = places.map((column) => to_scene(frame, vector_of(column, index)));
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
