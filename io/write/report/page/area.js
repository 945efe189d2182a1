// SPDX-License-Identifier: Apache-2.0
// The check of an area: whether it is covered, a map of its voids, and the largest of them.

const kMapWidth = 300;  // pixels; the style stretches it
const kVoidRows = 10;

// The map has the area as a sheet, the squares of the table as lines, and voids by whether they count.
function area_map({polygons, voids, tiles, tile_edge}) {
  const places = polygons.flatMap(({outline}) => outline.flat());
  const low = [0, 1].map((k) => Math.min(...places.map((place) => place[k])));
  const high = [0, 1].map((k) => Math.max(...places.map((place) => place[k])));
  const scale = kMapWidth / Math.max(high[0] - low[0], high[1] - low[1]);
  const size = [0, 1].map((k) => (high[k] - low[k]) * scale);
  const digits = (value) => String(Math.round(10 * value) / 10);
  const path = (rings) => rings.map((ring) => ring.map(
      ([x, y], i) => `${i === 0 ? "M" : "L"}${digits((x - low[0]) * scale)} ${digits((high[1] - y) * scale)}`).join("") + "Z").join("");
  const shape = (rings, style, title) => drawing("path", {d: path(rings), class: style, "fill-rule": "evenodd"},
                                                 ...(title ? [drawing("title", {}, title)] : []));
  const square = ([x, y]) => [[[x, y], [x + tile_edge, y], [x + tile_edge, y + tile_edge], [x, y + tile_edge]]];
  return drawing("svg", {class: "area-map", viewBox: `-2 -2 ${digits(size[0] + 4)} ${digits(size[1] + 4)}`, role: "img",
                         "aria-label": "Map of the area and its voids"},
                 ...polygons.map(({outline, answer}) => shape(outline, "sheet", answer)),
                 ...voids.map((each) => shape(each.outline, each.counts ? "counts" : "excepted", `void ${each.id}, ${each.kind}`)),
                 ...tiles.map(({corner}) => shape(square(corner), "tile")));
}

function area_basis({basis, not_shown}) {
  return element("details", {}, element("summary", {}, "Basis, and what is not shown"),
                 description(basis.map(([thing, what]) => [thing, what, "wide"])),
                 element("p", {}, "This check does not show:"),
                 element("ul", {}, ...not_shown.map((text) => element("li", {}, text))));
}

function area_facts({report}, units) {
  const {area} = report;
  if (!area) return null;
  const excepted = area.all - area.counting;
  const share = (part) => `${(100 * part / area.area).toPrecision(3)} %`;
  const rows = [["Answer", [area.answer, ...area.undecided].join(", "), "changed"],
                ["Area", units.area(area.area, 4)],
                ...(area.undecided.length === 0 ? [["Covered", share(area.area - area.missing_area)]] : []),
                [`Voids of ${units.length(area.void_size)} or more`, format_count(area.counting)],
                ...(excepted > 0 ? [["Voids in exceptions", format_count(excepted)]] : []),
                ...area.classes.map(({name, voids_area}) => [`Voids in ${name}`, units.area(voids_area)]),
                ["Points in it", format_count(area.points)],
                ["Polygons", area.file, "wide"],
                ...(area.except ? [["Exceptions", area.except, "wide"]] : [])];
  const made = facts_part("Area", description(rows), area_map(area), area_basis(area));
  if (area.voids.length === 0) return made;
  const decimals = Math.max(0, place_decimals(area.void_size) - 1);
  made.append(place_table(area.voids.slice(0, kVoidRows), [
    ["Id", ({id}) => String(id)], ["Kind", ({kind, counts}) => (counts ? kind : `${kind}, excepted`)],
    ["Area", (each) => units.area(each.area)], ["Circle", ({circle}) => units.length(circle)],
    ["x  y", ({middle}) => middle.map((value) => format_place(value, decimals)).join("  ")]]));
  if (area.all > kVoidRows)
    made.append(element("p", {class: "quiet"}, `These are the largest of ${format_count(area.all)}; voids.csv has all.`));
  return made;
}
