#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16: estimate_normals of a scan in map coordinates.
# Guess: points are doubles, so that normals are as good as near the origin. Only floats would suffer.
# Seen: at UTM coordinates and a spacing of 5 cm, 46 % of them are off by more than 30 degrees. At 20 cm, 12 % are
# off by more than one degree. There is no warning, and borders that are found by such normals are noise.
# A covariance is computed as a mean of squares less a square of means, of which UTM leaves few digits.
# What helps: a shift to the origin first, or the method of the same name of o3d.t.geometry.PointCloud.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends python3-open3d=0.16.1+ds-2+b4 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >normals.py <<'END'
import numpy as np
import open3d as o3d

# 100 x 100 points of a saddle, moved by up to a fifth of the spacing.
x, y = (axis.ravel() for axis in np.meshgrid(np.arange(100), np.arange(100)))
move = np.random.default_rng(1).uniform(-0.2, 0.2, (2, 10000))
surface = np.column_stack([x + move[0], y + move[1], (x - 50) * (y - 50) / 500])


def legacy(points):
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamKNN(12))
    return np.asarray(cloud.normals)


def tensor(points):
    cloud = o3d.t.geometry.PointCloud(o3d.core.Tensor(points))
    cloud.estimate_normals(12)
    return cloud.point.normals.numpy()


print("Open3D", o3d.__version__)
for name, normals in (("geometry.PointCloud", legacy), ("t.geometry.PointCloud", tensor)):
    for spacing in (1, 0.2, 0.05):
        near, far = normals(spacing * surface), normals(spacing * surface + (500000, 5400000, 0))
        turned = np.degrees(np.arccos(np.clip(np.abs((near * far).sum(axis=1)), 0, 1)))
        print(f"{name}, spacing {spacing}: {100 * (turned > 1).mean():.0f} % turned by more than 1 degree in UTM, "
              f"{100 * (turned > 30).mean():.0f} % by more than 30")
END
/usr/bin/python3 normals.py | tee seen.txt

diff - seen.txt <<'END'
Open3D 0.16.1
geometry.PointCloud, spacing 1: 0 % turned by more than 1 degree in UTM, 0 % by more than 30
geometry.PointCloud, spacing 0.2: 12 % turned by more than 1 degree in UTM, 0 % by more than 30
geometry.PointCloud, spacing 0.05: 84 % turned by more than 1 degree in UTM, 46 % by more than 30
t.geometry.PointCloud, spacing 1: 0 % turned by more than 1 degree in UTM, 0 % by more than 30
t.geometry.PointCloud, spacing 0.2: 0 % turned by more than 1 degree in UTM, 0 % by more than 30
t.geometry.PointCloud, spacing 0.05: 0 % turned by more than 1 degree in UTM, 0 % by more than 30
END
echo "as before"
