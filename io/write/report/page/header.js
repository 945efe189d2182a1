// SPDX-License-Identifier: Apache-2.0
// The bar at the top: name and counts of the scan, help, theme.

// Areas of holes: openings are no missing surface. They are 0 where causes are not known.
function hole_areas({hole_area, opening_area}) {
  const openings = opening_area || 0;
  return {missing: (hole_area || 0) - openings, openings};
}

// These areas in words; nothing where there are none.
function missing_area(report, units) {
  const {missing, openings} = hole_areas(report);
  if (!(missing + openings > 0)) return "";
  const apart = openings > 0 ? `, ${units.area(openings, 3)} openings` : "";
  return `${units.area(missing, 3)} missing${apart}${report.unit ? "" : " (area; unit not stated)"}`;
}

function write_header({report}, units) {
  const counts = report.counts || {};
  const title = report.title || "Scan";
  document.title = `${title} – Lacuna`;
  find("title").textContent = title;
  find("title").title = title;
  const parts = [];
  if (is_number(counts.holes)) parts.push(plural(counts.holes, "hole", "holes"));
  const missing = missing_area(report, units);
  if (missing) parts.push(missing);
  if (is_number(counts.outer)) parts.push(plural(counts.outer, "outer curve", "outer curves"));
  if (is_number(counts.points)) parts.push(plural(counts.points, "point", "points"));
  if (report.compared) parts.push(`compared with ${report.compared}`);
  if (report.crs) parts.push(crs_name(report.crs));
  find("summary").replaceChildren(...parts.map((part) => element("span", {}, part)));
}

// `set_theme(name)`; `other_theme()`: the name of the one that is not shown.
function connect_header({set_theme, other_theme}) {
  let is_theme_chosen = false;
  find("help-open").addEventListener("click", () => find("help").showModal());
  find("help").addEventListener("click", (event) => { if (event.target === find("help")) find("help").close(); });
  find("theme").addEventListener("click", () => {
    is_theme_chosen = true;
    set_theme(other_theme());
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => {
    if (!is_theme_chosen) set_theme(event.matches ? "dark" : "light");
  });
}
