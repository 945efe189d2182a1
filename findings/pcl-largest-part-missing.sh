#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: pcl_cluster_extraction of a scan in two parts.
# Guess: each part becomes a file. Only parts that are too small are left out.
# Seen: the small part is there, and the largest is missing without a word. It has more than 25,000 points, which
# is the default of -max. Of a surface and the island in its hole, the island remains.
# What helps: -max with more points than the scan has. EuclideanClusterExtraction itself has no such default.
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

cloud() {  # NAME, with the points from the input
  cat >points.txt
  {
    printf '%s\n' "VERSION 0.7" "FIELDS x y z" "SIZE 4 4 4" "TYPE F F F" "COUNT 1 1 1" \
      "WIDTH $(wc -l <points.txt)" "HEIGHT 1" "VIEWPOINT 0 0 0 1 0 0 0" "POINTS $(wc -l <points.txt)" "DATA ascii"
    cat points.txt
  } >"$1.pcd"
}

# A plane of 200 x 200 points, and an island of 15 x 14 points apart from it.
awk 'BEGIN {for (y = 0; y < 200; ++y) for (x = 0; x < 200; ++x) print x / 100, y / 100, 0
  for (y = 0; y < 14; ++y) for (x = 0; x < 15; ++x) print 5 + x / 100, 5 + y / 100, 0}' | cloud scan

{
  echo "PCL $(dpkg-deb -f pcl-tools_*.deb Version 2>/dev/null || dpkg-query -W -f '${Version}' pcl-tools)"
  for limit in "" "-max 100000"; do
    rm -f part*.pcd
    pcl_cluster_extraction scan.pcd part.pcd -tolerance 0.015 $limit >log.txt 2>&1
    for part in part*.pcd; do
      pcl_convert_pcd_ascii_binary "$part" text.pcd 0 >log.txt 2>&1
      grep "^POINTS" text.pcd
    done | sort -k2n | tr '\n' ' ' | sed "s/^/${limit:-no option}: /; s/ $/\n/"
  done
} | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0+dfsg-3
no option: POINTS 210
-max 100000: POINTS 210 POINTS 40000
END
echo "as before"
