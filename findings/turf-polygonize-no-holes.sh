#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Turf 7.4 (npm): polygonize() of a ring within a ring.
# Guess: an outline and the hole in it become a polygon with an inner ring, and the disc in it. The
# polygonizer of GEOS, which Turf names as its source, makes these.
# Seen: the outer polygon has no inner ring, so that it covers the hole. The disc comes twice. The areas add up
# to more than the outline encloses.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . @turf/polygonize@7.4.0 @turf/helpers@7.4.0 >/dev/null

cat >polygonize.mjs <<'END'
import { readFileSync } from "node:fs";
import { featureCollection, lineString } from "@turf/helpers";
import { polygonize } from "@turf/polygonize";

const square = (half) => lineString([[-half, -half], [half, -half], [half, half], [-half, half], [-half, -half]]);
const area = (ring) => Math.abs(ring.slice(1).reduce((sum, [x, y], i) => sum + ring[i][0] * y - x * ring[i][1], 0)) / 2;

console.log("Turf", JSON.parse(readFileSync("node_modules/@turf/polygonize/package.json")).version);
console.log("lines: a square of area 400, and one of area 64 in it");
for (const { geometry } of polygonize(featureCollection([square(10), square(4)])).features) {
  const [outline, ...inner] = geometry.coordinates;
  console.log(`polygon: outline of area ${area(outline)}, inner rings ${inner.length}`);
}
END
node polygonize.mjs | tee seen.txt

diff - seen.txt <<'END'
Turf 7.4.0
lines: a square of area 400, and one of area 64 in it
polygon: outline of area 400, inner rings 0
polygon: outline of area 64, inner rings 0
polygon: outline of area 64, inner rings 0
END
echo "as before"
