#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# VTK 9.1: vtkFillHolesFilter and the side of its triangles.
# Guess: a patch has the side of the surface around it, since both share the edges of the hole.
# Seen: each triangle of the patch is turned against the surface. Shaded, the patch is black or not there,
# and areas or volumes by sign lose it. Neighbours walk a shared edge in the same direction, which no
# oriented surface does.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed.
apt-get install --simulate --no-install-recommends python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib
export LD_LIBRARY_PATH=$lib/x86_64-linux-gnu PYTHONPATH=$lib/python3/dist-packages

cat >fill.py <<'END'
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersModeling import vtkFillHolesFilter

# A plane of 30 x 30 squares, of which 10 x 10 are missing. All triangles are counter-clockwise from above.
points, triangles = vtkPoints(), vtkCellArray()
for y in range(31):
    for x in range(31):
        points.InsertNextPoint(x, y, 0)
for y in range(30):
    for x in range(30):
        if 10 <= x < 20 and 10 <= y < 20:
            continue
        a = 31 * y + x
        for corners in ((a, a + 1, a + 32), (a, a + 32, a + 31)):
            triangles.InsertNextCell(3, corners)
mesh = vtkPolyData()
mesh.SetPoints(points)
mesh.SetPolys(triangles)

fill = vtkFillHolesFilter()
fill.SetInputData(mesh)
fill.SetHoleSize(15)
fill.Update()
filled = fill.GetOutput()


def area(cell):  # positive where it is counter-clockwise from above
    (ax, ay, _), (bx, by, _), (cx, cy, _) = (cell.GetPoints().GetPoint(i) for i in range(3))
    return ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2


areas = [area(filled.GetCell(i)) for i in range(filled.GetNumberOfCells())]
surface, patch = areas[:1600], areas[1600:]
print("VTK", vtkVersion.GetVTKVersion())
print(f"surface: {sum(a > 0 for a in surface)} triangles up, {sum(a < 0 for a in surface)} down, area {sum(surface):.0f}")
print(f"patch: {sum(a > 0 for a in patch)} triangles up, {sum(a < 0 for a in patch)} down, area {sum(patch):.0f}")
END
/usr/bin/python3 fill.py | tee seen.txt

diff - seen.txt <<'END'
VTK 9.1.0
surface: 1600 triangles up, 0 down, area 800
patch: 0 triangles up, 38 down, area -100
END
echo "as before"
