#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Turf 7.4 (npm): booleanValid() of areas with holes.
# Guess: it refuses what the OGC Simple Feature Specification forbids, which its page names.
# Seen: an outline that crosses itself is valid, and so are a hole outside, holes that overlap and a hole in a hole.
# Only a hole across the outline is refused. Folded loops and holes that count twice pass this check.
# What helps: GEOS, as by ST_IsValid of GDAL's SQLite dialect, refuses all five.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . @turf/boolean-valid@7.4.0 @turf/helpers@7.4.0 >/dev/null

cat >valid.mjs <<'END'
import { readFileSync } from "node:fs";
import { booleanValid } from "@turf/boolean-valid";
import { polygon } from "@turf/helpers";

const square = (x, y, size) => [[x, y], [x + size, y], [x + size, y + size], [x, y + size], [x, y]];
const hole = (x, y, size) => square(x, y, size).reverse();
const outline = square(0, 0, 10);
console.log("Turf", JSON.parse(readFileSync("node_modules/@turf/boolean-valid/package.json")).version);
for (const [name, rings] of [["one hole", [outline, hole(3, 3, 4)]],
                             ["hole across the outline", [outline, hole(8, 3, 4)]],
                             ["hole outside", [outline, hole(20, 3, 4)]],
                             ["holes that overlap", [outline, hole(2, 2, 3), hole(4, 4, 4)]],
                             ["hole in a hole", [outline, hole(2, 2, 6), hole(4, 4, 2)]],
                             ["outline that crosses itself", [[[0, 0], [10, 10], [10, 0], [0, 10], [0, 0]]]]]) {
  console.log(`${name}: ${booleanValid(polygon(rings)) ? "valid" : "not valid"}`);
}
END
node valid.mjs | tee seen.txt

diff - seen.txt <<'END'
Turf 7.4.0
one hole: valid
hole across the outline: not valid
hole outside: valid
holes that overlap: valid
hole in a hole: valid
outline that crosses itself: valid
END
echo "as before"
