#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16 of Debian 12: rays of RaycastingScene.
# Guess: a ray to a wall hits it, and a signed distance inside a closed box is negative.
# Seen: no ray hits anything, and all of a box is outside it. Distances without sign are right, and there is no
# warning. Where rays decide what a scanner saw through a hole, the whole scan is transparent.
# Open3D sends its rays with the mask 0. Embree ignores masks as it is by default, but Debian's build has them.
# What helps: one ray to a known wall first. If it misses, take another library for rays.
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

cat >rays.py <<'END'
import numpy as np
import open3d as o3d

# A box from 0 0 0 to 2 2 2, closed.
box = o3d.geometry.TriangleMesh.create_box(2, 2, 2)
scene = o3d.t.geometry.RaycastingScene()
scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(box))
ray = o3d.core.Tensor([[0.9, 0.8, 5, 0, 0, -1]], o3d.core.float32)
places = o3d.core.Tensor([[0.9, 0.8, 1.5], [0.9, 0.8, 5]], o3d.core.float32)

print("Open3D", o3d.__version__, "watertight", box.is_watertight())
print("ray from z = 5 down to the lid at z = 2: t_hit", scene.cast_rays(ray)["t_hit"].numpy(),
      "intersections", scene.count_intersections(ray).numpy(), "occluded", scene.test_occlusions(ray).numpy())
print("inside and outside: distance", scene.compute_distance(places).numpy(),
      "signed", scene.compute_signed_distance(places).numpy(), "occupancy", scene.compute_occupancy(places).numpy())
END
/usr/bin/python3 rays.py | tee seen.txt

diff - seen.txt <<'END'
Open3D 0.16.1 watertight True
ray from z = 5 down to the lid at z = 2: t_hit [inf] intersections [0] occluded [False]
inside and outside: distance [0.5 3. ] signed [0.5 3. ] occupancy [0. 0.]
END
echo "as before"
