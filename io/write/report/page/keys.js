// SPDX-License-Identifier: Apache-2.0
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
