// SPDX-License-Identifier: Apache-2.0
// What lies over the view: the legend of colours and lines, the scale, the axes.

// `heights`: real heights at the two ends of the colours; `hidden`: what the section hides, may be empty. `lines`: lists
// of elements that say what loops and markers are.
function draw_legend(colouring, theme, heights, units, lines, hidden) {
  const parts = [];
  const names = {probability: "Boundary probability", height: "Height", colour: "Colours of the scan", plain: ""};
  if (colouring === "probability" || colouring === "height") {
    const ramp = ramp_bytes(theme, colouring);
    const [low, high] = colouring === "height" ? heights : [0, 1];
    const digits = place_decimals((high - low) / 10);
    const text = (part) => (colouring === "height" ? (low + (high - low) * part).toFixed(Math.max(0, digits - 1)) : String(part));
    const unit = colouring === "height" && units.name ? ` ${units.name}` : "";
    parts.push(element("p", {class: "legend-name"}, names[colouring], unit ? element("span", {class: "unit"}, unit) : null));
    parts.push(element("div", {class: "ramp", style: `background:${ramp_gradient(ramp, "90deg")}`}));
    parts.push(element("div", {class: "ramp-text"}, ...[0, 0.5, 1].map((part) => element("span", {}, text(part)))));
  } else if (names[colouring]) {
    parts.push(element("p", {class: "legend-name"}, names[colouring]));
  }
  for (const line of lines) if (line.length > 0) parts.push(element("p", {class: "legend-lines"}, ...line));
  if (hidden) parts.push(element("p", {class: "legend-section"}, hidden));
  find("legend").hidden = parts.length === 0;
  find("legend").replaceChildren(...parts);
}

// Lines of the legend where loops have the colours of their kinds.
function kind_legend({is_hole}) {
  const line = (name, text) => element("span", {}, element("i", {class: `swatch ${name}`}), text);
  return [...(is_hole.some((value) => value) ? [line("hole", "Hole")] : []),
          ...(is_hole.some((value) => !value) ? [line("outer", "Outer curve")] : [])];
}

// A bar of a round length at the distance of the target.
function draw_scale(view, units) {
  const {canvas, data} = view;
  const {camera} = view.navigation;
  const focal = canvas.clientHeight / (2 * Math.tan((camera.fov * Math.PI) / 360));
  const unit_pixels = focal / view.navigation.target_distance() / data.frame.edge;
  const length = round_step(Math.min(130, 0.3 * canvas.clientWidth) / unit_pixels);
  if (!Number.isFinite(length) || !(length > 0)) return;
  find("scale-line").style.width = `${(length * unit_pixels).toFixed(1)}px`;
  find("scale-text").textContent = units.length(length, 1);
}

// Where north is, the y axis of a projected coordinate system.
function draw_north(camera) {
  const e = camera.matrixWorldInverse.elements;
  const [x, y] = [e[4], -e[5]];
  const length = Math.hypot(x, y);
  find("north").toggleAttribute("hidden", length < 0.12);  // nearly along the view: its direction says nothing
  if (length < 0.12) return;
  const turn = (Math.atan2(x, -y) * 180) / Math.PI;
  find("north").replaceChildren(
      drawing("path", {d: "M0 -19 L6 13 L0 8 L-6 13 Z", transform: `rotate(${turn.toFixed(1)})`}),
      drawing("text", {x: (26 * x / length).toFixed(2), y: (26 * y / length + 3.5).toFixed(2)}, "N"));
}

function draw_triad(camera) {
  const e = camera.matrixWorldInverse.elements;
  const axes = ["x", "y", "z"].map((name, k) => ({name, x: e[4 * k], y: -e[4 * k + 1], z: e[4 * k + 2]}));
  axes.sort((a, b) => a.z - b.z);
  find("triad").replaceChildren(...axes.map(({name, x, y, z}) => drawing("g", {class: z < -0.2 ? "far" : null},
      drawing("line", {x1: 0, y1: 0, x2: (19 * x).toFixed(2), y2: (19 * y).toFixed(2)}),
      drawing("text", {x: (26 * x).toFixed(2), y: (26 * y + 3.5).toFixed(2)}, name))));
}
