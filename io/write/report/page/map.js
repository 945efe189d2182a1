// SPDX-License-Identifier: Apache-2.0
// The map of an area in a page and in a sheet: places and outlines in pixels.

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
