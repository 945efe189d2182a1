#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The report of a synthetic scan in headless Chromium, with stations and without. Points and loops are drawn; rows,
# filters, section, keys, marks, links, print and tools work. The report of another run loads marks. The argument is
# the scan, `room` or `flat`.
set -euo pipefail
: "${LACUNA_PROGRAM:?}" "${LACUNA_BENCH_PROGRAM:?}"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
check() { /usr/bin/python3 report_page.py "$scratch/$1" "${@:2}"; }
stations=()
case $1 in
  room) made=(scan --stations 1 --points 60000 --seed 2) mock_size=400x800 stations=(--stations "$scratch/scan.stations.txt") ;;
  flat) made=(surface --points 40000 --holes 6 --hole-radius 5 12) mock_size=1280x800 ;;
esac
"$LACUNA_BENCH_PROGRAM" synth "${made[@]}" "$scratch/scan.ply" > "$scratch/log"
"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/out" --quiet --report "${stations[@]}"
check out/report.html --size 1280x800 --save-marks "$scratch/marks.json"
# All causes, and so many stations that their names would overlap.
/usr/bin/python3 mock_report.py "$scratch/out/report.html" "$scratch/mock.html" --stations 9
check mock.html --size "$mock_size" --causes

if [ "$1" = flat ]; then
  /usr/bin/python3 mock_report.py "$scratch/out/report.html" "$scratch/small.html" --small
  for size in 1200x760 390x844; do check small.html --size "$size" --small; done
  # A hole is scanned, and the outer curve is as it was.
  "$LACUNA_BENCH_PROGRAM" synth surface --points 40000 --holes 5 --hole-radius 5 12 "$scratch/later.ply" > "$scratch/log"
  "$LACUNA_PROGRAM" detect "$scratch/later.ply" --out "$scratch/later" --quiet
  "$LACUNA_PROGRAM" compare "$scratch/out" "$scratch/later" --report > "$scratch/log"
  check later/changes.html --size 1280x800 --changes
  exit
fi
check out/report.html --no-webgl
"$LACUNA_PROGRAM" stations "$scratch/out" > "$scratch/log"
"$LACUNA_PROGRAM" report "$scratch/out" > "$scratch/log"
check out/report.html --size 1280x800 --dark --causes
# The report of another run, without stations.
"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/other" --quiet --k 30 --report
check other/report.html --causes
check other/report.html --no-checks --load-marks "$scratch/marks.json" > "$scratch/log"
cat "$scratch/log"
grep --quiet '1 of 2 marks found their loops' "$scratch/log"  # the checks leave one far away from the scan
