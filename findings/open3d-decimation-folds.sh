#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16: simplify_quadric_decimation of a plane with a hole.
# Guess: a plane is the easiest case; its triangles become larger and stay in it side by side.
# Seen: they fold. All errors are 0, so that any edge may go. Triangles lie on each other, and some are turned
# over. A tenth to a half of the area lies twice; the area by sign stays exact. With a slight curvature of the
# surface, no triangle folds.
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

cat >decimate.py <<'END'
import numpy as np
import open3d as o3d

# A plane of 60 x 60 squares, of which 20 x 20 in the middle are missing.
x, y = (axis.ravel() for axis in np.meshgrid(np.arange(61), np.arange(61)))
squares = [61 * j + i for j in range(60) for i in range(60) if not (20 <= i < 40 and 20 <= j < 40)]
triangles = np.array([t for a in squares for t in ((a, a + 1, a + 62), (a, a + 62, a + 61))])


def describe(name, z, target):
    mesh = o3d.geometry.TriangleMesh(o3d.utility.Vector3dVector(np.column_stack([x, y, z]).astype(float)),
                                     o3d.utility.Vector3iVector(triangles))
    mesh = mesh.simplify_quadric_decimation(target)
    a, b, c = (np.asarray(mesh.vertices)[np.asarray(mesh.triangles)[:, k], :2] for k in range(3))

    area = ((b - a)[:, 0] * (c - a)[:, 1] - (c - a)[:, 0] * (b - a)[:, 1]) / 2
    print(f"{name}, {len(triangles)} to {len(area)} triangles: {(area < 0).sum()} turned over, "
          f"area by sign {area.sum():.0f}, without sign {np.abs(area).sum():.0f}")


print("Open3D", o3d.__version__)
describe("exact plane", 0 * x, 1600)
describe("exact plane", 0 * x, 800)
describe("curved surface", (x * x + y * y) / 600, 1600)
describe("curved surface", (x * x + y * y) / 600, 800)
END
/usr/bin/python3 decimate.py | tee seen.txt

diff - seen.txt <<'END'
Open3D 0.16.1
exact plane, 6400 to 1599 triangles: 55 turned over, area by sign 3200, without sign 3574
exact plane, 6400 to 800 triangles: 65 turned over, area by sign 3200, without sign 4874
curved surface, 6400 to 1600 triangles: 0 turned over, area by sign 3200, without sign 3200
curved surface, 6400 to 799 triangles: 0 turned over, area by sign 3201, without sign 3201
END
echo "as before"
