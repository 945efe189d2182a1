#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# d3-polygon 3.0 (npm): polygonCentroid() of a small ring in map coordinates.
# Guess: a ring has its centroid inside, since doubles resolve a nanometre at UTM coordinates.
# Seen: it is 6 m off for a ring of 10 m radius, and 567 m off for one of 1 m. The area is nearly right.
# The sum has products of three coordinates, of which most digits cancel. The label of a hole is elsewhere.
# What helps: coordinates relative to a corner of the ring.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . d3-polygon@3.0.2 >/dev/null

cat >centroid.mjs <<'END'
import { readFileSync } from "node:fs";
import { polygonArea, polygonCentroid } from "d3-polygon";

// Rings of 32 corners, in steps of 1/64, which are exact at either place.
const exact = (value) => Math.round(64 * value) / 64;
const ring = (radius, east, north) => Array.from({ length: 32 }, (_, i) => [
  east + exact(radius * Math.cos(Math.PI * i / 16)), north + exact(radius * Math.sin(Math.PI * i / 16))]);

console.log("d3-polygon", JSON.parse(readFileSync("node_modules/d3-polygon/package.json")).version);
for (const radius of [100, 10, 1]) {
  for (const [east, north] of [[0, 0], [500000, 5400000]]) {
    const [x, y] = polygonCentroid(ring(radius, east, north));
    const ratio = polygonArea(ring(radius, east, north)) / polygonArea(ring(radius, 0, 0));
    const off = Math.hypot(x - east, y - north);
    console.log(`radius ${radius} m around ${east} ${north}: centroid ${off.toFixed(2)} m off, ` +
                `area ${ratio.toFixed(5)} of the true one`);
  }
}
END
node centroid.mjs | tee seen.txt

diff - seen.txt <<'END'
d3-polygon 3.0.2
radius 100 m around 0 0: centroid 0.00 m off, area 1.00000 of the true one
radius 100 m around 500000 5400000: centroid 0.00 m off, area 1.00000 of the true one
radius 10 m around 0 0: centroid 0.00 m off, area 1.00000 of the true one
radius 10 m around 500000 5400000: centroid 5.65 m off, area 1.00000 of the true one
radius 1 m around 0 0: centroid 0.00 m off, area 1.00000 of the true one
radius 1 m around 500000 5400000: centroid 567.03 m off, area 0.99969 of the true one
END
echo "as before"
