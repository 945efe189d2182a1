// SPDX-License-Identifier: Apache-2.0
// The scan from above with the place of one loop, and a loop seen along its normal: drawn without WebGL, for paper.

const kPlanWidth = 900, kPlanHeight = 780;  // pixels at most

// One drawing of all points and loops, shared by the pages; the place of a loop lies over it.
class Plan {
  // `heights`: lowest and highest that is shown, in scene coordinates.
  constructor(data, heights) {
    this.data = data;
    const {low, high} = scene_bounds(data).box;
    const {up} = data.frame;
    this.axes = [(up + 1) % 3, (up + 2) % 3];  // to the right, and to the top of the plan
    const [a, b] = this.axes;
    const margin = 0.03 * Math.max(high[a] - low[a], high[b] - low[b], 1e-6);
    this.corner = [low[a] - margin, high[b] + margin];
    const wide = high[a] - low[a] + 2 * margin, tall = high[b] - low[b] + 2 * margin;
    this.factor = Math.min(kPlanWidth / wide, kPlanHeight / tall);
    this.size = [Math.ceil(wide * this.factor), Math.ceil(tall * this.factor)];
    this.source = this.draw(heights);
  }

  // Pixels of a scene position.
  at(values, i) {
    const [a, b] = this.axes;
    return [(values[3 * i + a] - this.corner[0]) * this.factor, (this.corner[1] - values[3 * i + b]) * this.factor];
  }

  draw([lowest, highest]) {
    const {points, loops, frame} = this.data;
    const [width, height] = this.size;
    const [canvas, pen] = paper(width, height);
    pen.fillStyle = "#c9cfd1";
    for (let i = 0; i < points.count; ++i) {
      const at_height = points.positions[3 * i + frame.up];
      if (at_height < lowest || at_height > highest) continue;
      const [x, y] = this.at(points.positions, i);
      pen.fillRect(x - 0.75, y - 0.75, 1.5, 1.5);
    }
    for (let loop = 0; loop < loops.count; ++loop) {
      pen.strokeStyle = style_value(loops.is_hole[loop] ? "--hole" : "--outer");
      pen.lineWidth = loops.is_hole[loop] ? 2 : 1.2;
      trace_loop(pen, loops, loop, (i) => this.at(loops.vertices, i));
      pen.stroke();
    }
    return canvas.toDataURL("image/png");
  }

  // The drawing, with a ring and lines to the edges at the loop; -1: without.
  figure(index) {
    const [width, height] = this.size;
    const over = drawing("svg", {viewBox: `0 0 ${width} ${height}`, class: "plan-over", "aria-hidden": "true"});
    const box = index < 0 ? null : loop_box(this.data.loops, index);
    if (box) {
      const middle = box.low.map((value, axis) => (value + box.high[axis]) / 2);
      const [x, y] = this.at(middle, 0);
      const radius = Math.max(16, 0.62 * Math.hypot(...this.axes.map((axis) => box.high[axis] - box.low[axis])) * this.factor);
      const line = (x1, y1, x2, y2) => drawing("line", {x1, y1, x2, y2});
      const {first, vertices} = this.data.loops;
      const step = Math.max(1, Math.floor((first[index + 1] - first[index]) / 300));
      const places = [];
      for (let i = first[index]; i < first[index + 1]; i += step) places.push(this.at(vertices, i).map((value) => value.toFixed(1)).join());
      over.append(drawing("polygon", {points: places.join(" ")}));
      over.append(drawing("circle", {cx: x, cy: y, r: radius}), line(0, y, x - radius, y), line(x + radius, y, width, y),
                  line(x, 0, x, y - radius), line(x, y + radius, x, height));
    }
    return element("figure", {class: "plan"},
                   element("div", {class: "plan-box", style: `aspect-ratio:${width}/${height};width:min(100%, ${(84 * width / height).toFixed(2)}mm)`},
                           element("img", {src: this.source, alt: ""}), over),
                   element("figcaption", {class: "quiet"}, `From above, ${"xyz"[this.axes[0]]} to the right, ${"xyz"[this.axes[1]]} to the top`));
  }
}

// A white canvas and its pen.
function paper(width, height) {
  const canvas = element("canvas", {width, height});
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, width, height);
  return [canvas, pen];
}

// The closed path of a loop; `at(i)`: pixels of its vertex.
function trace_loop(pen, {first}, loop, at) {
  pen.beginPath();
  for (let i = first[loop]; i < first[loop + 1]; ++i) pen.lineTo(...at(i));
  pen.closePath();
}

// A bar of a round length, in the lower right corner; `pixel`: its size in the scan's unit.
function draw_bar(pen, width, height, pixel, units) {
  const length = round_step(0.18 * width * pixel);
  if (!Number.isFinite(length) || !(length > 0)) return;
  const long = length / pixel, right = width - 30, base = height - 24, high = 12;
  pen.fillStyle = "#ffffffd9";
  pen.fillRect(right - long - 14, base - 44, long + 28, 58);
  pen.strokeStyle = pen.fillStyle = "#16191b";
  pen.lineWidth = 2.5;
  pen.beginPath();
  pen.moveTo(right - long, base - high);
  pen.lineTo(right - long, base);
  pen.lineTo(right, base);
  pen.lineTo(right, base - high);
  pen.stroke();
  pen.font = "22px sans-serif";
  pen.textAlign = "right";
  pen.fillText(units.length(length, 1), right, base - high - 6);
}

// The loop and what is around it, seen along its normal, as the address of a picture; null without vertices. Points far
// before or behind it are left out.
function painted_loop({points, loops, frame}, index, width, height, units) {
  const box = loop_box(loops, index);
  if (!box) return null;
  const middle = box.low.map((value, axis) => (value + box.high[axis]) / 2);
  const size = Math.max(1e-9, Math.hypot(...box.low.map((value, axis) => box.high[axis] - value)) / 2);
  const given = Array.from(loops.normal.subarray(3 * index, 3 * index + 3)).map((value) => (Number.isFinite(value) ? value : 0));
  const length = Math.hypot(...given);
  const side = given[frame.up] < 0 ? -1 : 1;
  const back = length > 0 ? given.map((value) => (side * value) / length) : upright(0, 0, 1, frame.up);
  const [first, second] = level_parts(back, frame.up);
  const flat = Math.hypot(first, second);
  const right = flat > 0.02 ? upright(-second / flat, first / flat, 0, frame.up) : upright(1, 0, 0, frame.up);
  const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]];
  const factor = height / (4.2 * size);
  const along = (axis, values, i) => axis.reduce((sum, value, k) => sum + value * (values[3 * i + k] - middle[k]), 0);
  const at = (values, i) => [width / 2 + factor * along(right, values, i), height / 2 - factor * along(up, values, i)];
  const [canvas, pen] = paper(width, height);
  const ramp = ramp_bytes("light", "probability");
  for (let i = 0; i < points.count; ++i) {
    if (Math.abs(along(back, points.positions, i)) > 2 * size) continue;
    const [x, y] = at(points.positions, i);
    if (x < 0 || y < 0 || x > width || y > height) continue;
    pen.fillStyle = ramp_colour(ramp, points.attributes[4 * i] / 255);
    pen.fillRect(x - 2, y - 2, 4, 4);
  }
  pen.strokeStyle = style_value(loops.is_hole[index] ? "--hole" : "--outer");
  pen.lineWidth = 4;
  trace_loop(pen, loops, index, (i) => at(loops.vertices, i));
  pen.stroke();
  draw_bar(pen, width, height, frame.edge / factor, units);
  return canvas.toDataURL("image/jpeg", 0.88);
}
