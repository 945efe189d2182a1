// SPDX-License-Identifier: Apache-2.0
// Colour maps of the points: even steps of lightness in OKLab (Ottosson 2020), so that equal differences look equal. And
// what lies over the view: the legend of colours and lines, the scale, the axes.

// sRGB bytes of lightness, chroma and hue (degrees).
function oklch(lightness, chroma, hue) {
  const a = chroma * Math.cos((hue * Math.PI) / 180);
  const b = chroma * Math.sin((hue * Math.PI) / 180);
  const l = Math.pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const m = Math.pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const s = Math.pow(lightness - 0.0894841775 * a - 1.291485548 * b, 3);
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((value) => {
    const bounded = Math.min(1, Math.max(0, value));
    const encoded = bounded <= 0.0031308 ? 12.92 * bounded : 1.055 * Math.pow(bounded, 1 / 2.4) - 0.055;
    return Math.round(255 * encoded);
  });
}

// Stops [lightness, chroma, hue]; more is farther from the background.
const kRamps = {
  light: {
    probability: [[0.87, 0.008, 220], [0.77, 0.035, 205], [0.60, 0.08, 192], [0.38, 0.08, 185]],
    height: [[0.42, 0.11, 275], [0.56, 0.09, 230], [0.68, 0.09, 180], [0.79, 0.11, 130], [0.87, 0.13, 100]],
    plain: [[0.80, 0.006, 230]],
  },
  dark: {
    probability: [[0.47, 0.012, 235], [0.58, 0.04, 215], [0.74, 0.10, 190], [0.93, 0.11, 168]],
    height: [[0.42, 0.11, 275], [0.56, 0.09, 230], [0.68, 0.09, 180], [0.80, 0.11, 130], [0.90, 0.13, 100]],
    plain: [[0.74, 0.008, 230]],
  },
};

// 256 colours of a ramp, 4 bytes each.
function ramp_bytes(theme, name) {
  const stops = kRamps[theme][name];
  const out = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const place = (i / 255) * (stops.length - 1);
    const from = stops[Math.floor(place)];
    const to = stops[Math.min(stops.length - 1, Math.floor(place) + 1)];
    const part = place - Math.floor(place);
    out.set(oklch(...from.map((value, k) => value + (to[k] - value) * part)), 4 * i);
    out[4 * i + 3] = 255;
  }
  return out;
}

function ramp_colour(bytes, value) {
  const at = 4 * Math.round(255 * Math.min(1, Math.max(0, value)));
  return `rgb(${bytes[at]}, ${bytes[at + 1]}, ${bytes[at + 2]})`;
}

// A CSS gradient from the ramp's start to its end.
function ramp_gradient(bytes, direction) {
  const parts = Array.from({length: 9}, (_, i) => ramp_colour(bytes, i / 8));
  return `linear-gradient(${direction}, ${parts.join(", ")})`;
}

// [r, g, b] from 0 to 1 of a CSS colour such as #1d63b8.
function css_rgb(text) {
  const value = parseInt(text.slice(1), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

// `heights`: real heights at the two ends of the colours. `lines`: lists
// of elements that say what loops and markers are. `hidden`: what the section hides, may be empty.
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
    parts.push(element("div", {class: "ramp-text"}, text(0), element("div", {class: "ramp", style: `background:${ramp_gradient(ramp, "90deg")}`}), text(1)));
  } else if (names[colouring]) {
    parts.push(element("p", {class: "legend-name"}, names[colouring]));
  }
  for (const line of lines) if (line.length > 0) parts.push(element("p", {class: "legend-lines"}, ...line));
  if (hidden) parts.push(element("p", {}, hidden));
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
  const {width, focal} = view_pixels(view);
  const unit_pixels = focal / view.navigation.target_distance() / view.data.frame.edge;
  const length = round_step(Math.min(130, 0.3 * width) / unit_pixels);
  if (!Number.isFinite(length) || !(length > 0)) return;
  find("scale-line").style.width = `${(length * unit_pixels).toFixed(1)}px`;
  find("scale-text").textContent = units.length(length, 1);
}

// Names of the axes: east and north of a projected coordinate system.
function draw_triad(camera, names) {
  const e = camera.matrixWorldInverse.elements;
  const axes = names.map((name, k) => ({name, x: e[4 * k], y: -e[4 * k + 1], z: e[4 * k + 2]}));
  axes.sort((a, b) => a.z - b.z);
  find("triad").replaceChildren(...axes.map(({name, x, y, z}) => drawing("g", {class: z < -0.2 ? "far" : null},
      drawing("line", {x1: 0, y1: 0, x2: (19 * x).toFixed(2), y2: (19 * y).toFixed(2)}),
      drawing("text", {x: (26 * x).toFixed(2), y: (26 * y + 3.5).toFixed(2)}, name))));
}
