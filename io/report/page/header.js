// SPDX-License-Identifier: Apache-2.0
// The bar at the top: name and counts of the scan, help, theme.

// The area of all holes in words; nothing where there are none.
function missing_area({hole_area, unit}, units) {
  if (!(hole_area > 0)) return "";
  return `${units.area(hole_area, 3)} missing${unit ? "" : " (unit not stated: --unit)"}`;
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
