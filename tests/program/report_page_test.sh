#!/usr/bin/env bash
# The report of a made scan in headless Chromium: points and loops are drawn, rows, filters and keys work.
set -euo pipefail
: "${LACUNA_PROGRAM:?}"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$LACUNA_PROGRAM" synth surface "$scratch/scan.ply" --points 40000 --holes 6 --hole-radius 5 12 > "$scratch/log"
"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/out" --quiet --report
/usr/bin/python3 report_page.py "$scratch/out/report.html"
