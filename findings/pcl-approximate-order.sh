#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PCL 1.13: ApproximateVoxelGrid and the order of points, by Debian's python3-pcl.
# Guess: "approximate" costs a few points more than voxels, whatever the order.
# Seen: row by row, it leaves as many points as there are voxels. In random order it leaves 13 to 56 times as many.
# The density of a thinned scan, and what looks like a hole in it, then depend on the order of its points.
# Its table has 512 entries. A voxel that comes to the entry of another one writes its mean and starts anew.
# What helps: VoxelGrid, which leaves the same number in any order.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends python3-pcl=0.3.0~rc1+dfsg-14+b2 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib:$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >thin.py <<'END'
import re
import numpy as np
import pcl

# 200 x 200 points in z = 0, row by row, and the same in random order.
x, y = np.meshgrid(np.arange(200), np.arange(200))
rows = np.column_stack([x.ravel() + 0.5, y.ravel() + 0.5, 0 * x.ravel()]).astype(np.float32)
order = np.random.RandomState(1).permutation(len(rows))
print("PCL", re.search(r"libpcl_filters\.so\.([\d.]+)", open("/proc/self/maps").read())[1])
for name, points in (("row by row", rows), ("random order", rows[order])):
    for size in (4, 10):
        cloud = pcl.PointCloud(points)
        filters = cloud.make_ApproximateVoxelGrid(), cloud.make_voxel_grid_filter()
        for filter in filters:
            filter.set_leaf_size(size, size, size)
        approximate, exact = (filter.filter().size for filter in filters)
        print(f"{name}, voxels of {size}: ApproximateVoxelGrid {approximate} points, VoxelGrid {exact}")
END
/usr/bin/python3 thin.py | tee seen.txt

diff - seen.txt <<'END'
PCL 1.13.0
row by row, voxels of 4: ApproximateVoxelGrid 2500 points, VoxelGrid 2500
row by row, voxels of 10: ApproximateVoxelGrid 400 points, VoxelGrid 400
random order, voxels of 4: ApproximateVoxelGrid 32748 points, VoxelGrid 2500
random order, voxels of 10: ApproximateVoxelGrid 22303 points, VoxelGrid 400
END
echo "as before"
