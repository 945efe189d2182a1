#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Turf 7.4 (npm): mask() of an area with a hole.
# Guess: the mask covers all that is not area, and so the hole.
# Seen: the hole is not covered. The mask leaves out what is in the outline, and no inner ring comes back into it.
# On a map, a hole looks like surveyed area.
# What helps: difference() of the world and the area.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . \
  @turf/mask@7.4.0 @turf/difference@7.4.0 @turf/boolean-point-in-polygon@7.4.0 @turf/helpers@7.4.0 >/dev/null

cat >mask.mjs <<'END'
import { readFileSync } from "node:fs";
import { booleanPointInPolygon } from "@turf/boolean-point-in-polygon";
import { difference } from "@turf/difference";
import { featureCollection, polygon } from "@turf/helpers";
import { mask } from "@turf/mask";

const square = (half) => [[-half, -half], [half, -half], [half, half], [-half, half], [-half, -half]];
const world = polygon([[[-180, -90], [180, -90], [180, 90], [-180, 90], [-180, -90]]]);
const area = polygon([square(10), square(4).reverse()]);

console.log("Turf", JSON.parse(readFileSync("node_modules/@turf/mask/package.json")).version);
for (const [name, cover] of [["mask", mask(area)], ["difference", difference(featureCollection([world, area]))]]) {
  const places = [["outside", [20, 0]], ["in the area", [7, 0]], ["in its hole", [0, 0]]];
  const state = (place) => booleanPointInPolygon(place, cover) ? "covered" : "open";
  console.log(`${name}:`, places.map(([what, place]) => `${what} ${state(place)}`).join(", "));
}
END
node mask.mjs | tee seen.txt

diff - seen.txt <<'END'
Turf 7.4.0
mask: outside covered, in the area open, in its hole open
difference: outside covered, in the area open, in its hole covered
END
echo "as before"
