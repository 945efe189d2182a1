# SPDX-License-Identifier: Apache-2.0
"""Points of VTK in, the holes out as closed polylines on the same points."""

from plane_with_hole import plane_with_hole, print_hole
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import lacuna


def polylines_of(holes, points):
    lines = vtkCellArray()
    for loop in holes.loops:
        lines.InsertNextCell(len(loop) + 1, [*loop.ids, loop.ids[0]])
    polylines = vtkPolyData()
    polylines.SetPoints(points)
    polylines.SetLines(lines)
    return polylines


points = vtkPoints()
points.SetData(numpy_to_vtk(plane_with_hole(), deep=True))

holes = lacuna.find_holes(vtk_to_numpy(points.GetData()), min_hole=10, holes_only=True)
polylines = polylines_of(holes, points)
for loop in holes.loops:
    print_hole(loop, polylines.GetCell(loop.id).GetNumberOfPoints() - 1)
