// SPDX-License-Identifier: Apache-2.0
// The sheet of `lacuna check --report`, by which a survey is accepted or not. It has the answer, the rule and its source, and a
// map of density and voids. Then come the largest voids, the basis, and what the check does not show. The reader fills in the
// fields for project, client and dates. It shows what voids.json has.

const kRowsOfVoids = 8;
const kSheetWidth = 600;  // of the map, in pixels; the style stretches it
const kMostTiles = 10000;  // of the data
const kFields = ["Project", "Client", "Surveyed on", "Checked on", "Checked by", "Accepted"];
const kSources = [
  ["anps:", "U.S. Geological Survey, Lidar Base Specification: a data void has four nominal spacings"],
  ["spacing2:", "English Heritage, draft specification for laser scanning: twice the nominal spacing"],
  ["", "a length, as it was ordered"],
];

// Four digits at least, without zeros at the end, and no exponent: 138,944, 0.01234 and 5.
function figure(value) {
  if (!is_number(value)) return "";
  const size = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
  return value.toLocaleString("en-US", {maximumFractionDigits: Math.min(12, Math.max(0, 3 - size))});
}

function share_text(value) {
  return is_number(value) ? `${(100 * value).toFixed(value < 0.9995 ? 2 : 3)} %` : "";
}

// Lengths and areas in the unit of the scan, by its own name.
function sheet_units(unit) {
  const of = (value, sign) => figure(value) + (unit ? ` ${unit}${sign}` : "");
  return {length: (value) => of(value, ""), area: (value) => of(value, "²")};
}

// Points over the part of a square that lies in the area, voids and all: a sliver with points is not the densest place.
function tile_density({points, area}) {
  return area > 0 ? points / area : 0;
}

// Leaves out the densest twentieth of the squares: overlaps would make all others pale.
function darkest_density(tiles) {
  const densities = tiles.map(tile_density).filter((density) => density > 0).sort((a, b) => a - b);
  return densities.length === 0 ? 0 : densities[Math.floor(0.95 * (densities.length - 1))];
}

// Draws in pixels, y up. Corners nearer than a third of a pixel to the one before are left out.
function map_scale(polygons, width) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const corner of polygons.flatMap(({outline}) => outline.flat())) {
    for (const k of [0, 1]) {
      low[k] = Math.min(low[k], corner[k]);
      high[k] = Math.max(high[k], corner[k]);
    }
  }
  const extent = Math.max(high[0] - low[0], high[1] - low[1]);
  const scale = extent > 0 ? width / extent : 1;
  const place = ([x, y]) => [(x - low[0]) * scale, (high[1] - y) * scale];
  const ring_text = (ring) => {
    let last = null, text = "";
    for (const at of ring.map(place)) {
      if (last && Math.hypot(at[0] - last[0], at[1] - last[1]) < 1 / 3) continue;
      text += `${last ? "L" : "M"}${at[0].toFixed(1)} ${at[1].toFixed(1)}`;
      last = at;
    }
    return `${text}Z`;
  };
  return {extent, scale, place, size: [0, 1].map((k) => (high[k] - low[k]) * scale), path: (rings) => rings.map(ring_text).join("")};
}

// The outline of a square of the table, from its least corner.
function map_square([x, y], edge) {
  return [[[x, y], [x + edge, y], [x + edge, y + edge], [x, y + edge]]];
}

function scale_bar({extent, scale, size}, units) {
  const bar = round_step(0.2 * extent), end = bar * scale, y = size[1] + 10;
  return [drawing("path", {class: "sheet", d: `M0 ${y.toFixed(1)}H${end.toFixed(1)}`}),
          drawing("text", {x: end.toFixed(1), dx: 4, y: y.toFixed(1), dy: 3}, units.length(bar))];
}

function sheet_map({polygons, voids, tiles, tile_edge, unit}, units) {
  if (polygons.length === 0) return [];
  const to = map_scale(polygons, kSheetWidth), most = darkest_density(tiles);
  const shape = (rings, style, more = {}) => drawing("path", {class: style, "fill-rule": "evenodd", d: to.path(rings), ...more});
  const drawn = tiles.filter((tile) => tile_density(tile) > 0);
  const map = drawing("svg", {class: "area-map", role: "img", "aria-label": "Map of the density and of the voids",
                              viewBox: `-4 -4 ${(to.size[0] + 8).toFixed(1)} ${(to.size[1] + 26).toFixed(1)}`},
    drawing("clipPath", {id: "within"}, ...polygons.map(({outline}) => shape(outline, "within", {"clip-rule": "evenodd"}))),
    ...polygons.map(({outline}) => shape(outline, "sheet")),
    drawing("g", {"clip-path": "url(#within)"}, ...drawn.map((tile) => shape(map_square(tile.corner, tile_edge), "tile", {
      "fill-opacity": (Math.min(1, tile_density(tile) / most) * 0.75).toFixed(2)}))),
    ...voids.map(({outline, counts}) => shape(outline, counts ? "counts" : "excepted")),
    ...voids.slice(0, kRowsOfVoids).map(({id, middle}) => {
      const [x, y] = to.place(middle);
      return drawing("text", {x: x.toFixed(1), y: y.toFixed(1)}, String(id));
    }),
    ...scale_bar(to, units));
  const density = most > 0 ? `Blue: density of the points, by squares of ${units.length(tile_edge)}; darkest at ${figure(most)} or more ` +
                             `in a square of 1${unit ? ` ${unit}` : ""}. ` : "";
  const cut = tiles.length === kMostTiles ? `Only ${format_count(kMostTiles)} squares are drawn. ` : "";
  return [map, element("p", {class: "quiet"}, `Orange: voids that count, with their ids. ${density}${cut}x to the right, y to the top.`)];
}

function answer_text({answer, undecided, counting, void_size}, units) {
  if (undecided.length > 0) return `${answer}: ${undecided.join(", ")}`;
  return counting > 0 ? `${answer}: ${counting} of ${units.length(void_size)} or more` : answer;
}

function sheet_figures(area, units) {
  const excepted = area.all - area.counting;
  const name = /"([^"]*)"/.exec(area.crs ?? "");
  return description([
    ["Rule", `${area.void_rule}: voids of ${units.length(area.void_size)} or more`],
    ["Source", kSources.find(([start]) => area.void_rule.startsWith(start))[1]],
    ["Area", units.area(area.area)],
    ...(area.undecided.length === 0 && area.area > 0 ? [["Covered", share_text(1 - area.missing_area / area.area)]] : []),
    ["Voids that count", `${area.counting}, ${units.area(area.missing_area)}`],
    ...(excepted > 0 ? [["Voids in exceptions", String(excepted)]] : []),
    ...area.classes.map((each) => [`Of voids, in ${each.name}`, units.area(each.voids_area)]),
    ["Points", figure(area.points)],
    ["Unit", area.unit || "not stated"],
    ["CRS", name ? name[1] : area.crs || "not stated"],
  ]);
}

function sheet_table({all, voids, void_size}, units) {
  if (voids.length === 0) return null;
  const shown = voids.slice(0, kRowsOfVoids), decimals = Math.min(9, place_decimals(void_size) + 1);
  const columns = [
    ["Id", ({id}) => String(id)], ["Kind", ({kind}) => kind], ["Area", (each) => units.area(each.area)],
    ["Largest circle", ({circle}) => units.length(circle)], ["x", ({middle}) => middle[0].toFixed(decimals)],
    ["y", ({middle}) => middle[1].toFixed(decimals)], ["In exceptions", ({excepted}) => share_text(excepted)],
  ];
  const caption = shown.length < all ? `The ${shown.length} largest of ${all} voids; voids.csv has all` : "Voids";
  return element("div", {class: "table-box"}, element("table", {class: "print-table"}, element("caption", {}, caption),
    element("thead", {}, element("tr", {}, ...columns.map(([title]) => element("th", {scope: "col"}, title)))),
    element("tbody", {}, ...shown.map((each) => element("tr", {}, ...columns.map(([, text]) => element("td", {}, text(each))))))));
}

function show_sheet(area) {
  const units = sheet_units(area.unit);
  document.title = `Check of ${area.title}`;
  find("sheet").append(...[
    element("header", {class: "print-head"}, element("h1", {}, "Is the area covered?"), element("span", {}, `${area.title}, by lacuna check`)),
    element("div", {class: "fields"}, ...kFields.map((field) => element("label", {}, `${field} `, element("input")))),
    element("p", {class: area.answer.startsWith("covered") ? "answer" : "answer no"}, answer_text(area, units)),
    ...sheet_map(area, units),
    element("div", {class: "figures"}, sheet_figures(area, units)),
    sheet_table(area, units),
    element("div", {class: "print-columns"},
            element("div", {}, element("h3", {}, "Basis"), description(area.basis)),
            element("div", {}, element("h3", {}, "This check does not show"),
                    element("ul", {}, ...area.not_shown.map((text) => element("li", {}, text)))))].filter(Boolean));
}

show_sheet(JSON.parse(find("area").textContent));
