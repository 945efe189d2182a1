#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: pcl_crop_to_hull, and CropHull in it, by a concave hull with a hole.
# Guess: the hull has two polygons, the outline and the hole. Points in the hole go as those outside do.
# Seen: all points in the hole stay. A point passes if it is in any polygon, and the hole is one of them.
# Filled or simulated points in a hole then count as measured area.
# What helps: CropHull once more, by the polygon of the hole alone and with setCropOutside(false).
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends pcl-tools=1.13.0+dfsg-3 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib:$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PATH=$work/root/usr/bin:$PATH

# NAME FROM TO HOLE: points of a square in z = 0, moved by up to a fifth of a step, without a hole.
points() {
  awk -v from="$2" -v to="$3" -v hole="$4" '
    function move() {r = r * 16807 % 2147483647; return 0.4 * r / 2147483647 - 0.2}
    BEGIN {r = 1; for (y = from; y <= to; ++y) for (x = from; x <= to; ++x)
      if (!hole || x < 20 || x >= 30 || y < 20 || y >= 30) printf "%.4f %.4f 0\n", x + move(), y + move()}' >points.txt
  {
    printf '%s\n' "VERSION 0.7" "FIELDS x y z" "SIZE 4 4 4" "TYPE F F F" "COUNT 1 1 1" \
      "WIDTH $(wc -l <points.txt)" "HEIGHT 1" "VIEWPOINT 0 0 0 1 0 0 0" "POINTS $(wc -l <points.txt)" "DATA ascii"
    cat points.txt
  } >"$1.pcd"
}
points scan 0 49 1
points around -5 54 0

count() {
  pcl_convert_pcd_ascii_binary "$1.pcd" text.pcd 0 >log.txt 2>&1
  awk -v name="$2" 'data {++all; if ($1 > 20.3 && $1 < 28.7 && $2 > 20.3 && $2 < 28.7) ++hole
      if ($1 < -0.5 || $1 > 49.5 || $2 < -0.5 || $2 > 49.5) ++outside}
    $1 == "DATA" {data = 1}
    END {print name ": " all " points, in the hole " hole + 0 ", outside the scan " outside + 0}' text.pcd
}
{
  echo "PCL $(dpkg-deb -f pcl-tools_*.deb Version 2>/dev/null || dpkg-query -W -f '${Version}' pcl-tools)"
  pcl_compute_hull scan.pcd hull.vtk -alpha 1.5 >log.txt 2>&1
  echo "polygons of the concave hull: $(awk '$1 == "POLYGONS" {print $2}' hull.vtk)"
  count scan "scan"
  count around "points around and in the scan"
  pcl_crop_to_hull scan.pcd around.pcd cropped.pcd -alpha 1.5 >log.txt 2>&1
  count cropped "cropped to the hull"
} | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0+dfsg-3
polygons of the concave hull: 2
scan: 2400 points, in the hole 0, outside the scan 0
points around and in the scan: 3600 points, in the hole 64, outside the scan 1100
cropped to the hull: 2398 points, in the hole 64, outside the scan 0
END
echo "as before"
