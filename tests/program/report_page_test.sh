#!/usr/bin/env bash
# Reports of made scans in headless Chromium: points and loops are drawn; rows, filters, section and keys work.
set -euo pipefail
: "${LACUNA_PROGRAM:?}"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$LACUNA_PROGRAM" synth surface "$scratch/flat.ply" --points 40000 --holes 6 --hole-radius 5 12 > "$scratch/log"
"$LACUNA_PROGRAM" synth scan "$scratch/room.ply" --stations 1 --points 60000 --seed 2 > "$scratch/log"
for scan in flat room; do
  "$LACUNA_PROGRAM" detect "$scratch/$scan.ply" --out "$scratch/$scan" --quiet --report
  /usr/bin/python3 report_page.py "$scratch/$scan/report.html"
done
/usr/bin/python3 report_page.py "$scratch/flat/report.html" --no-webgl
