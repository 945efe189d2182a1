#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Turf 7.4 (npm): booleanContains() and booleanWithin() of an area with a hole.
# Guess: a surface does not contain a square over its hole, nor the hole itself.
# Seen: both say that it does. They look at corners and not at what is between them, so that a hole counts only
# if a corner falls into it. A tile that is mostly hole passes as covered.
# What helps: the area of the tile that difference() leaves.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . @turf/area@7.4.0 \
  @turf/boolean-contains@7.4.0 @turf/boolean-within@7.4.0 @turf/difference@7.4.0 @turf/helpers@7.4.0 >/dev/null

cat >covered.mjs <<'END'
import { readFileSync } from "node:fs";
import { area } from "@turf/area";
import { booleanContains } from "@turf/boolean-contains";
import { booleanWithin } from "@turf/boolean-within";
import { difference } from "@turf/difference";
import { featureCollection, polygon } from "@turf/helpers";

const square = (half) => [[-half, -half], [half, -half], [half, half], [-half, half], [-half, -half]];
const surface = polygon([square(10), square(4).reverse()]);

console.log("Turf", JSON.parse(readFileSync("node_modules/@turf/boolean-contains/package.json")).version);
console.log("surface: square of 20 x 20 without a hole of 8 x 8 in its middle");
for (const half of [3, 4, 4.1, 9, 11]) {
  const tile = polygon([square(half)]), left = difference(featureCollection([tile, surface]));
  const outside = left ? area(left) : 0;
  console.log(`square of ${2 * half} x ${2 * half} in the middle: contained ${booleanContains(surface, tile)}, ` +
              `within ${booleanWithin(tile, surface)}, ${(100 * outside / area(tile)).toFixed(0)} % outside it`);
}
END
node covered.mjs | tee seen.txt

diff - seen.txt <<'END'
Turf 7.4.0
surface: square of 20 x 20 without a hole of 8 x 8 in its middle
square of 6 x 6 in the middle: contained false, within false, 100 % outside it
square of 8 x 8 in the middle: contained true, within true, 100 % outside it
square of 8.2 x 8.2 in the middle: contained true, within true, 95 % outside it
square of 18 x 18 in the middle: contained true, within true, 20 % outside it
square of 22 x 22 in the middle: contained false, within false, 31 % outside it
END
echo "as before"
