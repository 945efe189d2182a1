// SPDX-License-Identifier: Apache-2.0
// Ids of holes over the view, and the hole that a place of the view lies in.

const kMostNames = 60, kLeastPixels = 24;  // of a hole on the screen that has its id
const kNamePixels = 15;  // height of an id

// The pixels of a loop's vertices; null where one is behind the eye.
function pixels_of_loop(view, {first, vertices}, index) {
  const pixels = view_pixels(view), {camera} = view.navigation;
  const places = [];
  for (let i = first[index]; i < first[index + 1]; ++i) {
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
    Object.assign(this, {view});
    const size = (i) => (loops.diameter[i] >= 0 ? loops.diameter[i] : -1);
    this.largest = Array.from(loops.id.keys()).filter((i) => loops.is_hole[i]).sort((a, b) => size(b) - size(a)).slice(0, kMostNames);
    const middle = (i) => {
      const box = loop_box(loops, i);
      return box ? box.low.map((value, axis) => (value + box.high[axis]) / 2) : null;
    };
    this.middles = this.largest.map(middle);
    this.radii = this.largest.map((i) => loop_radius(loops.vertices, loops.first[i], loops.first[i + 1]));
    this.nodes = this.largest.map((i) => drawing("text", {}, String(loops.id[i])));
    find("names-over").replaceChildren(...this.nodes);
  }

  // After each picture.
  // The chosen one comes first, then the largest; an id that would lie on another one is left out.
  draw(shown, selected) {
    if (this.shown !== shown) Object.assign(this, {shown, is_shown: new Set(shown)});
    const are_shown = find("show-loops").checked;
    const {focal} = view_pixels(this.view), {camera} = this.view.navigation;
    const taken = [];
    const order = Array.from(this.largest.keys()).sort((a, b) => (this.largest[b] === selected) - (this.largest[a] === selected) || a - b);
    for (const k of order) {
      const index = this.largest[k];
      const place = are_shown && this.is_shown.has(index) ? this.middles[k] : null;
      const ahead = place ? seen_from(camera, place)[2] : 0;
      const is_large = ahead > this.view.nearest() && (2 * this.radii[k] * focal) / ahead >= kLeastPixels;
      const pixel = is_large ? pixel_of(this.view, place, 0) : null;
      const half = 4 * this.nodes[k].textContent.length + 2;
      const at = pixel && taken.every(([x, y, wide]) => Math.abs(pixel[0] - x) >= half + wide || Math.abs(pixel[1] - y) >= kNamePixels) ? pixel : null;
      if (at) taken.push([...at, half]);
      this.nodes[k].toggleAttribute("hidden", !at);
      if (at) this.nodes[k].setAttribute("transform", `translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})`);
    }
  }
}
