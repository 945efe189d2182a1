#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# polylabel 2.1 (npm): the pole of inaccessibility of an area in degrees.
# Guess: the pole is in the polygon. With the default precision of 1, it is a rough one.
# Seen: it is a corner of the bounding box, with the distance 0, if the width or the height is 1 or less.
# There is no search at all. The largest circle of a hole, and its label, are outside the hole.
# What helps: a precision of a thousandth of the size. The README says that 1 is too imprecise for degrees.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-fund --no-audit --prefix . polylabel@2.1.0 >/dev/null

cat >pole.mjs <<'END'
import { readFileSync } from "node:fs";
import polylabel from "polylabel";

// A round area of 64 corners, and a ring of it.
const circle = (radius) => Array.from({ length: 65 }, (_, i) => [
  radius * Math.cos(2 * Math.PI * i / 64), radius * Math.sin(2 * Math.PI * i / 64)]);

console.log("polylabel", JSON.parse(readFileSync("node_modules/polylabel/package.json")).version);
for (const radius of [0.4, 0.6, 400]) {
  const disc = [circle(radius)], ring = [circle(radius), circle(radius / 2).reverse()];
  for (const [name, polygon] of [["disc", disc], ["ring", ring]]) {
    for (const precision of [undefined, radius / 1000]) {
      const pole = polylabel(polygon, precision);
      const share = Math.hypot(...pole) / radius;
      console.log(`${name} of radius ${radius}, precision ${precision ?? "not given"}: ` +
                  `${share.toFixed(2)} radii from the middle, distance ${(pole.distance / radius).toFixed(3)} radii`);
    }
  }
}
END
node pole.mjs | tee seen.txt

diff - seen.txt <<'END'
polylabel 2.1.0
disc of radius 0.4, precision not given: 1.41 radii from the middle, distance 0.000 radii
disc of radius 0.4, precision 0.0004: 0.00 radii from the middle, distance 0.999 radii
ring of radius 0.4, precision not given: 1.41 radii from the middle, distance 0.000 radii
ring of radius 0.4, precision 0.0004: 0.75 radii from the middle, distance 0.250 radii
disc of radius 0.6, precision not given: 0.00 radii from the middle, distance 0.999 radii
disc of radius 0.6, precision 0.0006: 0.00 radii from the middle, distance 0.999 radii
ring of radius 0.6, precision not given: 1.00 radii from the middle, distance 0.000 radii
ring of radius 0.6, precision 0.0006: 0.75 radii from the middle, distance 0.250 radii
disc of radius 400, precision not given: 0.00 radii from the middle, distance 0.999 radii
disc of radius 400, precision 0.4: 0.00 radii from the middle, distance 0.999 radii
ring of radius 400, precision not given: 0.75 radii from the middle, distance 0.250 radii
ring of radius 400, precision 0.4: 0.75 radii from the middle, distance 0.250 radii
END
echo "as before"
