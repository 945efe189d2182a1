#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Finds the holes of known scans, and fails where fewer than the floors are found, or more than the ceilings are false:
# bench/accuracy/floors.csv. A group that has run has to have the numbers of bench/accuracy/README.md and docs/results.md, too, and so have
# the rated loops of real scans. Takes an expression for GROUP/NAME of the sets. LACUNA_PROGRAM names the program.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=${LACUNA_SHARED:-$root/../shared}/data
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
status=0
"$root/tools/accuracy.sh" --lacuna "$LACUNA_PROGRAM" --bench "$LACUNA_BENCH_PROGRAM" --no-peers --work "$scratch" --csv "$scratch/rows.csv" \
  --data "$data" --only "$1" --floors "$root/bench/accuracy/floors.csv" | tee "$scratch/tables" || status=1

python3 - "$scratch/rows.csv" "$scratch/tables" "$root" <<'END' || status=1
import csv
import re
import sys
from collections import defaultdict
from pathlib import Path

RESULTS = {  # the beginning of a row, and its groups
    "25 synthetic surfaces": ["synth"], "15 synthetic surfaces": ["uneven"], "Stanford bunny": ["meshes"],
    "the same with half": ["half-meshes"], "5 meshes": ["uneven-meshes"], "9 scans with density": ["density", "density-meshes"],
    "3 real range maps": ["range"], "12 synthetic range maps": ["range-made"], "6 synthetic lidar": ["lidar"],
    "15 harder lidar": ["lidar-view", "lidar-noise", "lidar-rings", "lidar-crossing", "lidar-steps"], "4 synthetic aerial": ["aerial"]}
measured = defaultdict(lambda: [0, 0, 0, 0])
with open(sys.argv[1], encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        if row["method"] == "default":
            counts = (row["true"], row["found"], row["false"], int(row["joined"]) + int(row["parted"]))
            measured[row["group"]] = [sum(pair) for pair in zip(measured[row["group"]], map(int, counts))]
root = Path(sys.argv[3])
failed = []


def compare(page, begin, groups):
    if not set(groups) <= set(measured):
        return
    counts = [str(sum(values)) for values in zip(*(measured[group] for group in groups))][:4 if "(" in begin else 3]
    rows = re.findall(rf"^\| {re.escape(begin)}[^|]*\| (.*) \|$", (root / page).read_text(encoding="utf-8"), re.MULTILINE)
    said = [re.findall(r"\d+", begin.partition(" (")[2] + " " + row)[:len(counts)] for row in rows]
    if counts not in said:
        failed.append(f"{page}: {begin}: true, found, false, joined or parted are {counts}")


for begin, groups in RESULTS.items():
    compare("docs/results.md", begin, groups)
for group in list(measured):
    if group != "quick":
        compare("bench/accuracy/README.md", f"{group} ({measured[group][0]})", [group])
# Holes by width: the page has the first five columns, of the default method, and nothing where the table has "-". Sums are of all groups.
is_whole = all(set(groups) <= set(measured) for groups in RESULTS.values())
page = (root / "bench/accuracy/README.md").read_text(encoding="utf-8")
tables = Path(sys.argv[2]).read_text(encoding="utf-8")
for group, cells in re.findall(r"^\| ([a-z -]+?) +\|((?: +(?:-|\d+ of \d+) \|){5})", tables, re.MULTILINE):
    row = f"{group} | " + " | ".join(cell.strip(" -") for cell in cells.split("|")[:5]) + " |"
    if "of" in row and group != "quick" and (is_whole or group in measured) and row not in page:
        failed.append(f"bench/accuracy/README.md: has no row {row}")
sys.exit("\n".join(failed) or 0)
END

[[ $1 != ^quick/ && -d $data/real ]] || exit "$status"
python3 "$root/bench/accuracy/real.py" --lacuna "$LACUNA_PROGRAM" --bench "$LACUNA_BENCH_PROGRAM" --work "$scratch" --scans "$data/real" |
  grep '^| [a-z]' >"$scratch/rated"
while IFS= read -r row; do
  grep --quiet --fixed-strings --line-regexp -- "$row" "$root/bench/accuracy/README.md" || { echo "bench/accuracy/README.md: has no row $row"; status=1; }
done <"$scratch/rated"
exit "$status"
