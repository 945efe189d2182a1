#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The pictures of the documentation are those that its script draws, and the numbers next to them are those that it prints. Those of
# real scans are left out where the scans are not there.
set -euo pipefail
: "${LACUNA_PROGRAM:?}" "${LACUNA_BENCH_PROGRAM:?}"
cd "$(dirname "${BASH_SOURCE[0]}")/../../docs/pictures"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp draw.sh "$scratch"
scans=${LACUNA_SHARED:-$PWD/../../../shared}/data
real=()
if [[ -d $scans ]]; then
  mkdir "$scratch/scans"
  ln -s "$scans"/{autzen_river.ply,dragon_30scans_793k.ply} "$scratch/scans"
  real=("$scratch/scans")
fi
"$scratch/draw.sh" "$LACUNA_PROGRAM" "$LACUNA_BENCH_PROGRAM" "${real[@]}" | tee "$scratch/numbers"
status=0
for picture in "$scratch"/*.png; do
  cmp "$picture" "$(basename "$picture")" || status=1
done

python3 - "$scratch/numbers" <<'END' || status=1
import re
import sys
from pathlib import Path

numbers = Path(sys.argv[1]).read_text(encoding="utf-8")
points = {name: int(count) for name, count in re.findall(r"^(\w+)\.ply: (\d+) points", numbers, re.MULTILINE)}
found = dict(re.findall(r"^(\S+): found (.*)$", numbers, re.MULTILINE))
choosing, first_run, readme = (Path(page).read_text(encoding="utf-8")
                               for page in ("../choosing.md", "../first-run.md", "../../README.md"))
failed = []

# In a table of choosing.md, the cell below a picture says what is found.
rows = [line.split("|") for line in choosing.splitlines()]
for pictures, below in zip(rows, rows[1:]):
    for picture, cell in zip(pictures, below):
        for name in re.findall(r"\(pictures/(.*)\.png\)", picture):
            said = re.match(r" (\d+ of \d+)(?: holes)?, (\d+ false)", cell)
            seen = re.match(r"(\d+ of \d+) holes.*, (\d+ false)", found[name])
            if not said or said.groups() != seen.groups():
                failed.append(f"choosing.md, {name}: says '{cell.strip()}', found {found[name]}")


def says(page, text, sentence):
    if sentence not in " ".join(text.split()):
        failed.append(f"{page}: does not say: {sentence}")


def size(count):
    return f"{count / 1e6:.1f} MB" if count >= 1e5 else f"{count / 1e3:.0f} kB"


says("choosing.md", choosing, f"Its {points['rough']:,} points have random positions")
of_room = [int(number) for number in re.findall(r"\d+", found["room"])]
says("README.md", readme, f"{points['room']:,} points of one scanner. Lacuna finds its {of_room[1] + of_room[3]} true loops, "
     f"and {of_room[4] or 'none'} that {'are' if of_room[4] > 1 else 'is'} false.")
if of_room[0] != of_room[1] or of_room[2] != of_room[3]:
    failed.append(f"README.md: not all true loops of the room are found: {found['room']}")
sizes = {name: int(count) for count, name in re.findall(r"(\d+) room[/.](\S+)", numbers)}
says("first-run.md", first_run, f"for the demo's scan of {size(sizes.pop('ply'))}")
for name, count in sizes.items():
    if not re.search(rf"^\| `{name}` \|.*\| {size(count)} \|$", first_run, re.MULTILINE):
        failed.append(f"first-run.md: {name}: has {size(count)}")
sys.exit("\n".join(failed) or 0)
END
exit "$status"
