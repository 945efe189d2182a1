#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The report of a synthetic scan in headless Chromium: points and loops are drawn; rows, filters, section and keys work. The
# argument is the scan, `room` or `flat`.
set -euo pipefail
: "${LACUNA_PROGRAM:?}"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
case $1 in
  room) made=(scan --stations 1 --points 60000 --seed 2) ;;
  flat) made=(surface --points 40000 --holes 6 --hole-radius 5 12) ;;
esac
"$LACUNA_PROGRAM" synth "${made[@]}" "$scratch/scan.ply" > "$scratch/log"
"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/out" --quiet --report
/usr/bin/python3 report_page.py "$scratch/out/report.html" --size 1000x700
/usr/bin/python3 report_page.py "$scratch/out/report.html" --no-webgl
