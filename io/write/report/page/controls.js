// SPDX-License-Identifier: Apache-2.0
// What stands around the view: the bar at the top, the tabs of narrow screens, the settings of the view, and keys. Last
// the address of the page: with #hole=ID it opens at the loop with this id in holes.json, a hole or an outer curve.

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

// `set_theme(name)`: the page has the colours of the system, light or dark.
function connect_header(set_theme) {
  find("help-open").addEventListener("click", () => find("help").showModal());
  find("help").addEventListener("click", (event) => { if (event.target === find("help")) find("help").close(); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => set_theme(event.matches ? "dark" : "light"));
}

// `name`: the data-tab of one of them.
function choose_tab(name) {
  document.body.dataset.tab = name;
  for (const tab of document.querySelectorAll("[role=tab]")) {
    tab.setAttribute("aria-selected", String(tab.dataset.tab === name));
    tab.tabIndex = tab.dataset.tab === name ? 0 : -1;
  }
}

function connect_tabs() {
  const tabs = Array.from(document.querySelectorAll("[role=tab]"));
  const choose = (tab, is_focused) => {
    choose_tab(tab.dataset.tab);
    if (is_focused) tab.focus();
  };
  for (const [at, tab] of tabs.entries()) {
    tab.addEventListener("click", () => choose(tab, false));
    tab.addEventListener("keydown", (event) => {
      const move = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (move) choose(tabs[(at + move + tabs.length) % tabs.length], true);
    });
  }
  choose(tabs[0], false);
}

function connect_settings() {
  find("view-more").addEventListener("click", () => {
    const is_open = find("view-settings").hidden;
    find("view-settings").hidden = !is_open;
    find("view-more").setAttribute("aria-expanded", String(is_open));
  });
}

function connect_shown(scenes) {
  const shown = () => scenes.set_shown(find("show-points").checked, find("show-loops").checked);
  find("show-points").addEventListener("change", shown);
  find("show-loops").addEventListener("change", shown);
  find("through").addEventListener("change", () => scenes.set_through(find("through").checked));
}

// Keys of the page. Arrow keys, WASD, + and - act as long as they are down; fields keep the keys they need.

// `navigation`: null without a view; `press`: {key: function}
function connect_keys({navigation, press}) {
  const turn = 1.4, move = 0.7, zoom = 1.6;  // radians, parts of the picture and powers of e per second
  const held = navigation ? {
    arrowleft: (s) => navigation.nudge(-turn * s, 0, 0, 0), arrowright: (s) => navigation.nudge(turn * s, 0, 0, 0),
    arrowup: (s) => navigation.nudge(0, -turn * s, 0, 0), arrowdown: (s) => navigation.nudge(0, turn * s, 0, 0),
    a: (s) => navigation.nudge(0, 0, -move * s, 0), d: (s) => navigation.nudge(0, 0, move * s, 0),
    w: (s) => navigation.nudge(0, 0, 0, move * s), s: (s) => navigation.nudge(0, 0, 0, -move * s),
    "+": (s) => navigation.zoom(Math.exp(-zoom * s)), "=": (s) => navigation.zoom(Math.exp(-zoom * s)),
    "-": (s) => navigation.zoom(Math.exp(zoom * s)), "_": (s) => navigation.zoom(Math.exp(zoom * s)),
  } : {};
  const is_typing = (target) => target.matches("input[inputmode=decimal], textarea, select");
  const needs_arrows = (target) => target.matches("input, [role=tab]") || target.closest(".rows, .side");
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const key = event.key.toLowerCase();
    if (key === "escape" && event.target.matches("textarea")) {
      event.target.blur();
      return;
    }
    if (is_typing(event.target) && key !== "escape") return;
    if (key in press) {
      press[key]();
      event.preventDefault();
    } else if (key in held && !(key.startsWith("arrow") && needs_arrows(event.target))) {
      navigation.hold(event.code, held[key]);
      event.preventDefault();
    }
  });
  document.addEventListener("keyup", (event) => { if (navigation) navigation.release(event.code); });
  window.addEventListener("blur", () => { if (navigation) navigation.release(); });
}

// The id of a part of an address such as "#hole=12"; null without one.
function linked_id(hash) {
  const match = /^#hole=(\d{1,15})$/.exec(hash);
  return match ? Number(match[1]) : null;
}

// Gives the address the id of a loop, or none for null. The history gets no entry, so Back leaves the page.
function set_link(id) {
  const hash = id === null ? "" : `#hole=${id}`;
  if (location.hash === hash) return;
  try {
    history.replaceState(null, "", location.pathname + location.search + hash);
  } catch (error) {
    // A page without an address of its own, such as one in a frame of others: nothing to link to.
  }
}
