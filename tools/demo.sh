#!/usr/bin/env bash
# From a fresh Debian 12 to the holes of a scan: installs, builds, makes a scan of about 200,000 points in
# demo/, finds its holes, and compares them with the true ones.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/build.sh -DLACUNA_TESTS=OFF

mkdir -p demo
build/lacuna synth scan demo/scan.ply --points 200000 --stations 3 --seed 1
build/lacuna detect demo/scan.ply --out demo/holes --points

echo
build/lacuna evaluate demo/holes demo/scan.loops.txt | awk 'NF == 0 { ++tables } tables < 2'
printf '\n  true loop  what it is\n'
sed -n '1d; s/^# //p' demo/scan.loops.txt | awk '{ printf "  %-9d  %s\n", NR - 1, $0 }'

cat <<END

Look at it in CloudCompare or MeshLab:
  $PWD/demo/holes/points.ply    every point, with its boundary probability
  $PWD/demo/holes/boundary.ply  the boundary points
  $PWD/demo/holes/loops.ply     the loops around the holes
and at $PWD/demo/holes/holes.json for their measures.
On a scan of your own:
  $PWD/build/lacuna detect SCAN.ply --out DIR
END
