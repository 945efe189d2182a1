#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16: create_from_point_cloud_alpha_shape of a flat surface.
# Guess: the flatter a surface, the better its alpha shape.
# Seen: the flatter, the less of it is there. With a noise of a thousandth of the spacing, 33 of 4565 remain,
# the area of both sides. Triangles come from tetrahedra with a radius below alpha alone, and four points that
# are nearly in a plane have a huge one. An alpha shape also has triangles between two large tetrahedra.
# What helps: create_from_point_cloud_ball_pivoting with the same radius keeps all of the surface.
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

cat >shape.py <<'END'
import numpy as np
import open3d as o3d

# 50 x 50 points, moved by up to a fifth of the spacing in x and y, without 10 x 10 in the middle.
x, y = (axis.ravel() for axis in np.meshgrid(np.arange(50), np.arange(50)))
kept = (abs(x - 24.5) > 5) | (abs(y - 24.5) > 5)
random = np.random.default_rng(1)
place = np.column_stack([x, y])[kept] + random.uniform(-0.2, 0.2, (kept.sum(), 2))
noise = random.uniform(-1, 1, kept.sum())

print("Open3D", o3d.__version__)
for height in (0.3, 0.1, 0.01, 0.001):
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.column_stack([place, height * noise])))
    cloud.normals = o3d.utility.Vector3dVector(np.tile([0.0, 0.0, 1.0], (len(place), 1)))
    shape = o3d.geometry.TriangleMesh.create_from_point_cloud_alpha_shape(cloud, 1.5)
    balls = o3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(cloud, o3d.utility.DoubleVector([1.5]))
    print(f"noise {height}: alpha shape of area {shape.get_surface_area():.0f} with two sides, "
          f"ball pivoting {balls.get_surface_area():.0f} with one")
END
/usr/bin/python3 shape.py 2>&1 | tee seen.txt

diff - seen.txt <<'END'
Open3D 0.16.1
noise 0.3: alpha shape of area 3968 with two sides, ball pivoting 2414 with one
noise 0.1: alpha shape of area 2086 with two sides, ball pivoting 2298 with one
noise 0.01: alpha shape of area 225 with two sides, ball pivoting 2283 with one
noise 0.001: alpha shape of area 33 with two sides, ball pivoting 2283 with one
END
echo "as before"
