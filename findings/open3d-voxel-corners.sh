#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16: voxel_down_sample of tensor point clouds.
# Guess: the point of a voxel is the mean of its points, or one of them. The method of the same name of
# o3d.geometry.PointCloud returns the mean.
# Seen: it is a corner of the voxel. A tilted plane becomes stairs of whole numbers, up to 0.9 of a voxel
# from the plane. What fits planes or finds borders afterwards works on the stairs.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed.
apt-get install --simulate --no-install-recommends python3-open3d=0.16.1+ds-2+b4 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >sample.py <<'END'
import numpy as np
import open3d as o3d

# The plane z = 0.3 x, in steps of a quarter of a voxel's edge, which is 1.
x, y = np.meshgrid(np.arange(0.1, 12, 0.25), np.arange(0.1, 12, 0.25))
plane = np.column_stack([x.ravel(), y.ravel(), 0.3 * x.ravel()])


def describe(name, points):
    off = np.abs(points[:, 2] - 0.3 * points[:, 0]) / np.hypot(1, 0.3)
    nearest = np.sqrt(((points[:, None] - plane[None]) ** 2).sum(axis=2)).min(axis=1)
    whole = (points == np.round(points)).all(axis=1).sum()
    print(f"{name}: {len(points)} points, {whole} of whole numbers, from the plane up to {off.max():.2f}, "
          f"from its points up to {nearest.max():.2f}")


print("Open3D", o3d.__version__)
cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(plane))
describe("geometry.PointCloud", np.asarray(cloud.voxel_down_sample(1).points))
cloud = o3d.t.geometry.PointCloud(o3d.core.Tensor(plane))
describe("t.geometry.PointCloud", cloud.voxel_down_sample(1).point.positions.numpy())
END
/usr/bin/python3 sample.py | tee seen.txt

diff - seen.txt <<'END'
Open3D 0.16.1
geometry.PointCloud: 208 points, 0 of whole numbers, from the plane up to 0.00, from its points up to 0.18
t.geometry.PointCloud: 168 points, 168 of whole numbers, from the plane up to 0.86, from its points up to 0.87
END
echo "as before"
