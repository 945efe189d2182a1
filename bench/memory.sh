#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws how much memory a run of `lacuna detect` holds, over time, next to its limit. Needs gnuplot.
#
#     bench/memory.sh LACUNA SCAN LIMIT IMAGE.svg [DETECT_OPTIONS]     # LIMIT as for --memory-limit, such as 1GiB
set -euo pipefail
lacuna=$1 scan=$2 limit=$3 image=$4
work=$(mktemp -d "$(dirname "$image")/memory.XXXXXX")
trap 'rm -rf "$work"' EXIT

"$lacuna" detect "$scan" --out "$work/out" --quiet --memory-limit "$limit" "${@:5}" &
begin=${EPOCHREALTIME/./}
# A process that has ended has no VmRSS.
while resident=$(sed -n 's/^VmRSS:[^0-9]*\([0-9]*\) kB/\1/p' "/proc/$!/status") && [[ -n $resident ]]; do
  echo "$((${EPOCHREALTIME/./} - begin)) $resident"
  sleep 0.05
done >"$work/samples" 2>/dev/null
wait $!

bytes=$(sed -n 's/.*"memory_limit_bytes": *\([0-9]*\).*/\1/p' "$work/out/run.json")
gnuplot -c /dev/stdin "$work/samples" "$bytes" "$image" <<'END_OF_PLOT'
set terminal svg size 900,400 font "sans,14" background "white"
set output ARG3
set xlabel "seconds"
set ylabel "resident memory, MiB"
set yrange [0:*]
set grid
set key below
plot ARG1 using ($1 / 1e6):($2 / 1024) with lines linewidth 2 title "lacuna detect", \
     real(ARG2) / 2**20 with lines dashtype 2 title "--memory-limit"
END_OF_PLOT
