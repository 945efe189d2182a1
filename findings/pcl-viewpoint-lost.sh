#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: where the scanner stood, after pcl_pcd2ply.
# Guess: VIEWPOINT of the PCD file becomes the camera of the PLY file, as the option -use_camera, which
# is on by default, suggests.
# Seen: the camera is at 0 0 0 and looks along z, whatever VIEWPOINT says. It looks like a measured place.
# Normals that are turned to this camera have the wrong side.
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

cat >scan.pcd <<'END'
# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT 10 20 30 0 0 0 1
POINTS 2
DATA ascii
1 2 3
4 5 6
END
pcl_pcd2ply -format 0 scan.pcd scan.ply >log.txt 2>&1
pcl_ply2pcd -format 0 scan.ply back.pcd >log.txt 2>&1

{
  echo "PCL $(dpkg-deb -f pcl-tools_*.deb Version)"
  grep VIEWPOINT scan.pcd
  grep -E "^(element camera|property float view)" scan.ply
  tail -n 1 scan.ply
  echo "and back: $(grep VIEWPOINT back.pcd)"
} | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0+dfsg-3
VIEWPOINT 10 20 30 0 0 0 1
element camera 1
property float view_px
property float view_py
property float view_pz
0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 0 0 2 1 0 0
and back: VIEWPOINT 0 0 0 1 0 0 0
END
echo "as before"
