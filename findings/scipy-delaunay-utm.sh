#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# SciPy 1.10: Delaunay triangulation of a scan in map coordinates.
# Guess: doubles resolve a nanometre at UTM coordinates, so a scan has the triangles that it has near the origin.
# Seen: at a spacing of 5 cm, 76 of 10,000 points are used, and at 20 cm, 905. There is no warning. The others
# count as coplanar. Qhull lifts points by their squares, which leave no digits for the distance of neighbours.
# Long triangles look like holes, and heights of LinearNDInterpolator and griddata are off by more than a metre.
# What helps: a shift to the origin first, and a look at the length of `coplanar`.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends python3-scipy=1.10.1-2 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu:$lib/x86_64-linux-gnu/blas:$lib/x86_64-linux-gnu/lapack
export PYTHONPATH=$lib/python3/dist-packages

cat >triangulate.py <<'END'
import numpy as np
import scipy
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

# 100 x 100 points, moved by up to a fifth of the spacing, and a wave of 1 m in their heights.
x, y = (axis.ravel() for axis in np.meshgrid(np.arange(100), np.arange(100)))
random = np.random.default_rng(1)
grid = np.column_stack([x, y]) + random.uniform(-0.2, 0.2, (10000, 2))
height = np.sin(x / 5) * np.cos(y / 7)
inner = (abs(x - 50) < 40) & (abs(y - 50) < 40)

print("SciPy", scipy.__version__)
for spacing in (1, 0.2, 0.05):
    for east, north in ((0, 0), (500000, 5400000)):
        points = spacing * grid + (east, north)
        triangulation = Delaunay(points)
        used = np.unique(triangulation.simplices).size
        back = LinearNDInterpolator(points, height)(points[inner])
        print(f"spacing {spacing}, from {east} {north}: {used} of {len(points)} points used, "
              f"{len(triangulation.coplanar)} coplanar, heights off by up to {np.abs(back - height[inner]).max():.1f}")
END
/usr/bin/python3 triangulate.py | tee seen.txt

diff - seen.txt <<'END'
SciPy 1.10.1
spacing 1, from 0 0: 10000 of 10000 points used, 0 coplanar, heights off by up to 0.0
spacing 1, from 500000 5400000: 10000 of 10000 points used, 0 coplanar, heights off by up to 0.0
spacing 0.2, from 0 0: 10000 of 10000 points used, 0 coplanar, heights off by up to 0.0
spacing 0.2, from 500000 5400000: 905 of 10000 points used, 9095 coplanar, heights off by up to 0.2
spacing 0.05, from 0 0: 10000 of 10000 points used, 0 coplanar, heights off by up to 0.0
spacing 0.05, from 500000 5400000: 76 of 10000 points used, 9924 coplanar, heights off by up to 1.3
END
echo "as before"
