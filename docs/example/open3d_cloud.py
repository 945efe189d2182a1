# SPDX-License-Identifier: Apache-2.0
"""A cloud of Open3D in, the holes out as a set of lines."""

import open3d
from plane_with_hole import plane_with_hole, print_hole

import lacuna

cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(plane_with_hole()))

holes = lacuna.find_holes(cloud, min_hole=10, holes_only=True)
coloured, lines = holes.to_open3d()  # also: open3d.visualization.draw_geometries([coloured, lines])
print_hole(holes.loops[0], len(lines.lines))
