// SPDX-License-Identifier: Apache-2.0
// Facts of the scan and of its result: sources, counts, areas, causes, stations.

const kLeastCertainty = 0.98;  // of a station that counts, as in io/explain/stations/station_views.hpp

function draw_facts(data, units) {
  const {report} = data;
  const parts = [scan_facts(data, units), result_facts(data, units), cause_facts(data), station_facts(data),
                 next_station_facts(data, units)];
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
