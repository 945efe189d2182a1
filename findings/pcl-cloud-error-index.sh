#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: pcl_compute_cloud_error of a scan and the same scan in another order.
# Guess: the error is 0, since each point is in the other cloud, too.
# Seen: it is as large as the scan. Points with the same number are compared, as the help says by "default: index".
# Clouds of different sizes have no error at all, with exit code 0. So a scan that was thinned, filled or sorted
# cannot be compared with the scan before.
# What helps: -correspondence nn, which compares with the nearest point.
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

awk 'BEGIN {for (y = 0; y < 50; ++y) for (x = 0; x < 50; ++x) print x / 100, y / 100, 0}' | tee lines.txt | cloud scan
tac lines.txt | cloud reversed
grep -v ' 0 0$' lines.txt | cloud thinned

{
  echo "PCL $(dpkg-deb -f pcl-tools_*.deb Version 2>/dev/null || dpkg-query -W -f '${Version}' pcl-tools)"
  for other in reversed thinned; do
    for pairs in "" "-correspondence nn"; do
      pcl_compute_cloud_error scan.pcd $other.pcd error.pcd $pairs >log.txt 2>&1
      echo "$other, ${pairs:-no option}: $(grep -oE "RMSE Error.*|not have the same number" log.txt)"
    done
  done
} | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0+dfsg-3
reversed, no option: RMSE Error: 0.408167
reversed, -correspondence nn: RMSE Error: 0.000000
thinned, no option: not have the same number
thinned, -correspondence nn: RMSE Error: 0.001414
END
echo "as before"
