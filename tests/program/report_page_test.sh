#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The report of a synthetic scan in headless Chromium, with stations and without. Points and loops are drawn; rows,
# filters, section, keys, marks, links, print and tools work. Marks go into the report of another run. The argument is
# the scan, `room` or `flat`.
set -euo pipefail
: "${LACUNA_PROGRAM:?}" "${LACUNA_BENCH_PROGRAM:?}"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
stations=()
case $1 in
  room) made=(scan --stations 1 --points 60000 --seed 2) mock_size=400x800 stations=(--stations "$scratch/scan.stations.txt") ;;
  flat) made=(surface --points 40000 --holes 6 --hole-radius 5 12) mock_size=1280x800 ;;
esac
"$LACUNA_BENCH_PROGRAM" synth "${made[@]}" "$scratch/scan.ply" > "$scratch/log"
"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/out" --quiet --report "${stations[@]}"
if [ "$1" = room ]; then
  "$LACUNA_PROGRAM" stations "$scratch/out" > "$scratch/log"
  "$LACUNA_PROGRAM" report "$scratch/out" > "$scratch/log"
  /usr/bin/python3 report_page.py "$scratch/out/report.html" --size 1280x800 --dark --causes
fi
# All causes, and so many stations that their names would overlap.
/usr/bin/python3 mock_report.py "$scratch/mock.html" --points 30000 --stations 9
/usr/bin/python3 report_page.py "$scratch/mock.html" --size "$mock_size" --causes
/usr/bin/python3 report_page.py "$scratch/out/report.html" --size 1280x800 --save-marks "$scratch/marks.json"
/usr/bin/python3 report_page.py "$scratch/out/report.html" --no-webgl

"$LACUNA_PROGRAM" detect "$scratch/scan.ply" --out "$scratch/other" --quiet --k 30
/usr/bin/python3 mock_report.py "$scratch/without.html" --points 5000 --stations 0
/usr/bin/python3 report_page.py "$scratch/without.html" --causes
"$LACUNA_PROGRAM" report "$scratch/other" --marks "$scratch/marks.json" > "$scratch/log"
cat "$scratch/log"
grep --quiet '^marks: 1 of 2 found their loops' "$scratch/log"  # the checks leave one far away from the scan
grep --quiet '^no loop fits: ' "$scratch/log"
/usr/bin/python3 report_page.py "$scratch/other/report.html" --no-checks --has-marks "$scratch/marks.json"

# Marks of all loops, with the ids of others: the program and the page find the same loops.
/usr/bin/python3 - "$scratch/out/holes.json" > "$scratch/all.json" <<'END'
import json, sys
loops = json.load(open(sys.argv[1], encoding="utf-8"))["loops"]
names = ["real", "ignore", "scan again", "done", "none"]
marks = [{"id": loops[i - 1]["id"], **{key: loop[key] for key in ("kind", "centroid", "diameter")}, "mark": names[i % 5], "note": f"loop {i}"}
         for i, loop in enumerate(loops)]
print(json.dumps({"schema": "marks 1", "marks": marks}))
END
"$LACUNA_PROGRAM" report "$scratch/other" > "$scratch/log"
/usr/bin/python3 report_page.py "$scratch/other/report.html" --no-checks --load-marks "$scratch/all.json" --save-marks "$scratch/by-page.json"
"$LACUNA_PROGRAM" report "$scratch/other" --marks "$scratch/all.json"
/usr/bin/python3 report_page.py "$scratch/other/report.html" --no-checks --save-marks "$scratch/by-program.json"
cmp "$scratch/by-page.json" "$scratch/by-program.json"
