#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# CloudCompare 2.11: spatial subsampling with the distance that a grid has already.
# Guess: a minimal distance of 1 keeps all points of a grid of spacing 1.
# Seen: half of them go, in the pattern of a chessboard. Points at exactly the distance count as too near.
# So a hole of two spacings looks like any other place afterwards. With 0.99, all points stay.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed.
apt-get install --simulate --no-install-recommends cloudcompare=2.11.3-7.1 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$lib:$lib/cloudcompare QT_PLUGIN_PATH=$lib/qt5/plugins QT_QPA_PLATFORM=offscreen
export PATH=$work/root/usr/bin:$PATH HOME=$work XDG_RUNTIME_DIR=$work

for ((y = 0; y < 100; ++y)); do
  for ((x = 0; x < 100; ++x)); do echo "$x $y 0"; done
done >grid.xyz

{
  echo "CloudCompare $(dpkg-deb -f cloudcompare_*.deb Version)"
  for distance in 0.99 1; do
    CloudCompare -SILENT -NO_TIMESTAMP -O grid.xyz -C_EXPORT_FMT ASC -SS SPATIAL "$distance" >log.txt
    echo "distance $distance: $(wc -l <grid_SPATIAL_SUBSAMPLED.asc) of $(wc -l <grid.xyz) points"
  done
  awk '$2 == 0 && $1 < 6 {print "first row: " $1 + 0}' grid_SPATIAL_SUBSAMPLED.asc
} | tee seen.txt

diff - seen.txt <<'END'
CloudCompare 2.11.3-7.1
distance 0.99: 10000 of 10000 points
distance 1: 5000 of 10000 points
first row: 0
first row: 2
first row: 4
END
echo "as before"
