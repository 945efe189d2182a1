// SPDX-License-Identifier: Apache-2.0
// Facts of the scan and of the run: sources, counts, parameters, times.

const kLeastCertainty = 0.98;  // of a station that counts, as in io/explain/stations/station_views.hpp

function draw_facts(data, units) {
  const {report} = data;
  const parts = [area_facts(data, units), scan_facts(data, units), result_facts(data, units), cause_facts(data), station_facts(data),
                 next_station_facts(data, units), parameter_facts(report)];
  if (report.run) parts.push(run_facts(report.run));
  if (report.lacuna) parts.push(element("p", {class: "quiet"}, `Written by lacuna ${report.lacuna}.`));
  find("facts-body").replaceChildren(...parts.filter(Boolean));
}

function facts_part(title, ...children) {
  return element("section", {class: "part"}, element("h3", {}, title), ...children);
}

// A short name of a coordinate system; well-known text starts with KIND["name".
function crs_name(crs) {
  const match = /^[A-Z_0-9]+\s*\[\s*"([^"]*)"/i.exec(crs);
  return match ? match[1] : crs;
}

function scan_facts(data, units) {
  const {report} = data;
  const counts = report.counts || {};
  const inputs = report.inputs || [];
  const sample = report.sample || {};
  const rows = [["Points", format_count(counts.points)]];
  if (sample.of > 0 || data.points.count > 0) {
    const is_all = data.points.count + (report.strays || 0) >= sample.of;
    rows.push(["Drawn here", is_all ? "all" : `${format_count(data.points.count)}, spread evenly`]);
  }
  if (report.strays > 0) rows.push(["Far from all others, not drawn", format_count(report.strays)]);
  for (const [name, value] of left_out(counts)) rows.push([name, format_count(value)]);
  if (report.bounds) {
    const {min, max} = report.bounds;
    rows.push(["Extent", [0, 1, 2].map((k) => units.length(max[k] - min[k])).join(" × "), "wide"]);
    const decimals = place_decimals(report.median_distance);
    const corner = (values) => values.map((value) => format_place(value, decimals)).join("  ");
    rows.push(["Least x y z", corner(min), "wide"], ["Largest x y z", corner(max), "wide"]);
  } else {
    rows.push(["Extent", "none: no points"]);
  }
  if (report.median_distance > 0) rows.push(["Distance of neighbours", units.length(report.median_distance)]);
  rows.push(["Resolution", report.resolution > 0 ? units.length(report.resolution) : "not thinned"]);
  rows.push(["Unit", units.name || "not stated"]);
  const crs = report.crs ? crs_name(report.crs) : "not stated";
  rows.push(["CRS", crs, crs.length > 22 ? "wide" : null]);
  const made = facts_part("Scan", description(rows));
  if (report.crs && crs !== report.crs) {
    made.append(element("details", {}, element("summary", {}, "Well-known text"), element("pre", {}, report.crs)));
  }
  if (inputs.length > 0) made.append(file_list(inputs));
  return made;
}

// [name, count] of points that did not take part, without the zeros.
function left_out(counts) {
  const rows = [["Without coordinates", counts.dropped]];
  for (const [name, value] of Object.entries(counts.filtered_out || {})) rows.push([`Left out by ${name}`, value]);
  rows.push(["Thinned out", counts.thinned_out], ["Duplicates", counts.duplicates]);
  return rows.filter(([, value]) => value > 0);
}

function file_list(inputs) {
  const list = element("ul", {class: "files"});
  for (const {file, points} of inputs) {
    list.append(element("li", {}, element("span", {title: file}, element("bdi", {dir: "ltr"}, file)), element("span", {class: "number"}, format_count(points))));
  }
  return element("details", {open: inputs.length <= 4},
                 element("summary", {}, plural(inputs.length, "file", "files")), list);
}

function result_facts(data, units) {
  const {report, loops} = data;
  const counts = report.counts || {};
  // "Candidates" and "Coherent" are words of the paper: holes.json has them.
  const names = {holes: "Holes", outer: "Outer curves", loops: "Loops", boundary_points: "Boundary points"};
  const rows = Object.keys(names).filter((key) => is_number(counts[key])).map((key) => [names[key], format_count(counts[key])]);
  const {missing, openings} = hole_areas(report);
  const areas = [["Missing area", missing], ["Area of openings", openings]].filter(([, area]) => area > 0)
      .map(([name, area]) => [name, units.area(area, 4)]);
  if (report.surface_area > 0) {
    const share = 100 * missing / (missing + report.surface_area);
    areas.push(["Sampled surface, about", units.area(report.surface_area, 3)], ["Share that is missing", `${share.toPrecision(2)} %`]);
  }
  rows.splice(1, 0, ...areas);
  const made = facts_part("Result", description(rows));
  if (loops.count < loops.all) {
    made.append(element("p", {class: "quiet"},
        `This page holds the ${format_count(loops.count)} longest of ${format_count(loops.all)} loops; holes.json has all.`));
  }
  return made;
}

function parameter_text(value) {
  if (Array.isArray(value)) return value.length > 0 ? value.map(parameter_text).join(", ") : "none";
  if (value === null || value === "") return "none";
  if (typeof value === "number" && Number.isInteger(value)) return format_count(value);
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

function parameter_facts(report) {
  const changed = new Set(report.changed || []);
  const rows = [], others = [];
  for (const [section, values] of Object.entries(report.parameters || {})) {
    for (const [key, value] of Object.entries(values || {})) {
      const is_changed = changed.has(key) || changed.has(`${section}.${key}`);
      (is_changed ? rows : others).push([element("span", {}, key.replace(/_/g, " "), element("small", {}, section)),
                                         parameter_text(value), is_changed ? "changed" : null]);
    }
  }
  const made = facts_part("Method", description([["Method", report.method || kMissing], ...rows]));
  if (others.length > 0) {
    made.append(element("details", {},
        element("summary", {}, plural(others.length, "parameter", "parameters") + " at the default"), description(others)));
  }
  return made;
}

function run_facts(run) {
  const rows = [["Time", format_seconds(run.seconds)]];
  if (is_number(run.threads)) {
    rows.push(["Threads", format_count(run.threads) + (is_number(run.cores) ? ` of ${plural(run.cores, "core", "cores")}` : "")]);
  }
  if (is_number(run.peak_memory_bytes)) rows.push(["Peak memory", format_bytes(run.peak_memory_bytes)]);
  if (run.memory_limit_bytes > 0) rows.push(["Memory limit", format_bytes(run.memory_limit_bytes)]);
  const made = facts_part("Run", description(rows));
  const phases = (run.phases || []).filter(({seconds}) => is_number(seconds));
  if (phases.length > 0) made.append(description(phases.map(({name, seconds}) => [name, format_seconds(seconds)])));
  return made;
}

// How many holes each cause has, or loops each change; without stations, how to give them.
function cause_facts({loops}) {
  if (!loops.has_causes) {
    return facts_part("Causes of holes", element("p", {class: "quiet"},
        "Causes are not known, because no station is: --stations FILE gives stations (docs/stations.md)."));
  }
  const rows = cause_counts(loops, loops.cause.keys()).map(
      ([name, count]) => [element("span", {}, cause_swatch(name, "dot"), cause_title(name)), format_count(count)]);
  return facts_part(`${loops.cause_word}s of ${loops.has_changes ? "loops" : "holes"}`, rows.length > 0 ? description(rows) : element("p", {class: "quiet"}, "There are no holes."));
}

// `columns`: [title, text of a row, class or nothing].
function place_table(rows, columns, style = "places", caption = null) {
  return element("table", {class: style}, caption && element("caption", {}, caption),
      element("thead", {}, element("tr", {}, ...columns.map(([title, , own]) => element("th", {scope: "col", class: own}, title)))),
      element("tbody", {}, ...rows.map((row) => element("tr", {}, ...columns.map(([, text, own]) => element("td", {class: own}, text(row)))))));
}

// To about the distance of neighbours: enough for a tripod.
function station_place(place, {median_distance}) {
  return place.map((value) => format_place(value, Math.max(0, place_decimals(median_distance) - 1))).join("  ");
}

const kFewStations = 6;

function station_facts({stations, report}) {
  if (stations.length === 0) return null;
  const table = place_table(stations, [["Name", ({name}) => name], ["x  y  z", ({place}) => station_place(place, report)],
                                       ["Points", ({points}) => format_count(points)]]);
  const made = facts_part("Stations", stations.length <= kFewStations ? table
      : element("details", {}, element("summary", {}, plural(stations.length, "station", "stations")), table));
  const doubtful = stations.filter(({certainty}) => certainty < kLeastCertainty);
  if (doubtful.length > 0) {
    made.append(element("p", {class: "quiet"}, `${doubtful.map(({name}) => name).join(", ")}: too few of the points can have been ` +
        `measured from there, so ${doubtful.length === 1 ? "it does" : "they do"} not count.`));
  }
  return made;
}

function next_station_facts({next_stations, report}, units) {
  if (next_stations.length === 0) return null;
  return facts_part("Where to stand next", place_table(next_stations, [
    ["", ({rank}) => String(rank)], ["x  y  z", ({place}) => station_place(place, report)],
    ["Sees", ({area}) => units.area(area)], ["Of hidden", ({share}) => `${(100 * share).toPrecision(2)} %`]]));
}

// The check of an area: whether it is covered, a map of its voids, and the largest of them.

const kMapWidth = 300;  // pixels; the style stretches it
const kVoidRows = 10;

// The map has the area as a sheet, the squares of the table as lines, and voids by whether they count.
function area_map({polygons, voids, tiles, tile_edge}) {
  const to = map_scale(polygons, kMapWidth);
  const shape = (rings, style, title) => drawing("path", {d: to.path(rings), class: style, "fill-rule": "evenodd"},
                                                 ...(title ? [drawing("title", {}, title)] : []));
  return drawing("svg", {class: "area-map", viewBox: `-2 -2 ${(to.size[0] + 4).toFixed(1)} ${(to.size[1] + 4).toFixed(1)}`, role: "img",
                         "aria-label": "Map of the area and its voids"},
                 ...polygons.map(({outline, answer}) => shape(outline, "sheet", answer)),
                 ...voids.map((each) => shape(each.outline, each.counts ? "counts" : "excepted", `void ${each.id}, ${each.kind}`)),
                 ...tiles.map(({corner}) => shape(map_square(corner, tile_edge), "tile")));
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
