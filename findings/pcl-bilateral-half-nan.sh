#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: pcl_fast_bilateral_filter and points that were not measured.
# Guess: a point of nan nan nan stays one, or is filled in whole.
# Seen: x and y stay nan, and z becomes a number, near the largest z of the scan. A test of z alone takes the
# point for a measured one. A range image from z shows a wall in place of the hole.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed.
apt-get install --simulate --no-install-recommends pcl-tools=1.13.0+dfsg-3 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib:$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PATH=$work/root/usr/bin:$PATH

# An organised scan of a slope, 40 x 30 points with z from 1.5 to 2.475, of which 10 x 10 are missing.
{
  printf '%s\n' "VERSION 0.7" "FIELDS x y z" "SIZE 4 4 4" "TYPE F F F" "COUNT 1 1 1" "WIDTH 40" "HEIGHT 30" \
    "VIEWPOINT 0 0 0 1 0 0 0" "POINTS 1200" "DATA ascii"
  awk 'BEGIN {
    for (j = 0; j < 30; ++j) for (i = 0; i < 40; ++i) {
      if (i >= 15 && i < 25 && j >= 10 && j < 20) print "nan nan nan"
      else print (i - 20) / 20, (j - 15) / 20, 2 + (i - 20) / 40
    }
  }'
} >scan.pcd
pcl_fast_bilateral_filter scan.pcd filtered.pcd -sigma_s 5 -sigma_r 0.05 >log.txt 2>&1
pcl_convert_pcd_ascii_binary filtered.pcd text.pcd 0 >log.txt 2>&1

count() {
  awk -v name="$1" 'is_data {
    kind = ($1 == "nan" ? "nan" : "number") " " ($2 == "nan" ? "nan" : "number") " " ($3 == "nan" ? "nan" : "number")
    ++points[kind]
    if ($1 == "nan" && $3 != "nan") { sum += $3; if (min == "" || $3 < min) min = $3 }
    if ($1 != "nan" && $3 > max) max = $3
  }
  $1 == "DATA" { is_data = 1 }
  END {
    for (kind in points) print name ": " points[kind] " points of " kind | "sort"
    close("sort")
    if (min != "") printf "%s: z of missing points from %.2f, of measured ones up to %.2f\n", name, min, max
  }' "$2"
}
{
  echo "PCL $(dpkg-deb -f pcl-tools_*.deb Version)"
  count before scan.pcd
  count after text.pcd
} | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0+dfsg-3
before: 100 points of nan nan nan
before: 1100 points of number number number
after: 100 points of nan nan number
after: 1100 points of number number number
after: z of missing points from 2.47, of measured ones up to 2.43
END
echo "as before"
