#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the pictures of README.md, first-run.md, choosing.md, confidence.md and examples.md into this folder. Prints the
# numbers of these pages: points, what `lacuna-bench evaluate` says of each synthetic scan, and sizes of files.
#
#     docs/pictures/draw.sh build/lacuna build/lacuna-bench [FOLDER]
#
# FOLDER has the real scans: autzen_river.ply, and dragon_30scans_793k.ply, 30 registered scans of Stanford's dragon.
# Without it, their pictures stay.
set -euo pipefail

lacuna=$(realpath "$1")
bench=$(realpath "$2")
scans=${3:+$(realpath "$3")}
pictures=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# detect RESULT SCAN OPTIONS...: and how many of the true loops it finds.
detect() {
  local result=$1 scan=$2
  shift 2
  "$lacuna" detect "$scan" --out "$result" --quiet "$@"
  local truth=${scan%.*}.loops.txt
  [[ ! -e $truth ]] || echo "$result: $("$bench" evaluate "$result" "$truth" | head -n 1)"
}

render() {
  local result=$1
  shift
  "$lacuna" render "$result" --out "$pictures/$result.png" --overwrite "$@" > log
}

small=(--view top --size 280x280)

"$bench" synth surface rough.ply --kind plane --points 16000 --holes 7 --hole-radius 3 8 --positions random \
  --noise 0.3 --seed 3
for k in 8 15 40; do
  detect "k-$k" rough.ply --k "$k"
  render "k-$k" "${small[@]}"
done
for size in 0.06 0.10 0.15; do
  detect "min-hole-$size" rough.ply --min-hole "$size"
  render "min-hole-$size" "${small[@]}"
done

"$bench" synth scan room.ply --stations 1 --field-of-view -60 15 --points 400000 --seed 2
detect room room.ply --stations room.stations.txt --report
wc --bytes room.ply room/*
render room --size 900x560

# The report as it opens, in Chromium.
page=$pictures/../../tests/program/report_page.py
if [[ -e $page ]]; then
  python3 "$page" room/report.html --screenshot "$pictures/report.png" --size 1400x860 --no-checks || (($? == 77))
fi

if [[ -n $scans ]]; then
  detect river "$scans/autzen_river.ply"
  render river --view top --size 560x490
  detect dragon "$scans/dragon_30scans_793k.ply"
  render dragon --size 760x520
fi
