#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Each result and the annotated scan, opened in a program that is not Lacuna: counts and values are those of holes.json.
# Skipped, with the names of what is missing, unless all of these programs are installed.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
bench=${LACUNA_BENCH_PROGRAM:?}
python=/usr/bin/python3  # Debian's own: python3-vtk9 is a package of it

missing=()
for command in CloudCompare:cloudcompare xvfb-run:xvfb pcl_ply2pcd:pcl-tools; do
  command -v "${command%:*}" >/dev/null || missing+=("${command#*:}")
done
"$python" -c 'import vtkmodules.vtkIOPLY' 2>/dev/null || missing+=(python3-vtk9)
if ((${#missing[@]} > 0)); then
  echo "skipped: not installed: ${missing[*]}"
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work XDG_RUNTIME_DIR=$work  # for what these programs keep of a user
chmod 700 "$work"
cd "$work"

# One scan near the origin, for programs of single precision, and the same one on Earth.
"$bench" synth surface near.ply --points 12000 --holes 4 --hole-radius 3 6 --order random >/dev/null
"$python" - <<'END'
import struct
content = open("near.ply", "rb").read()
head, rows = content.split(b"end_header\n", 1)
assert head.count(b"property float") == head.count(b"property") == 3
with open("earth.txt", "w") as text:
    print("x y z", file=text)
    for x, y, z in struct.iter_unpack("<3f", rows):
        print(repr(x + 500_000.1), repr(y + 5_400_000.1), repr(z), file=text)
END
for scan in near.ply earth.txt; do
  "$program" detect "$scan" --out "${scan%.*}" --lids --points --points-format ply --quiet
done

for name in loops boundary points; do
  xvfb-run -a CloudCompare -SILENT -NO_TIMESTAMP -O "near/$name.ply" -C_EXPORT_FMT ASC -ADD_HEADER -PREC 9 \
    -SAVE_CLOUDS FILE "$name.asc" >cloudcompare.log || { cat cloudcompare.log; exit 1; }
  pcl_ply2pcd "near/$name.ply" "$name.binary.pcd" >pcl.log 2>&1 || { cat pcl.log; exit 1; }
  pcl_convert_pcd_ascii_binary "$name.binary.pcd" "$name.pcd" 0 >pcl.log 2>&1 || { cat pcl.log; exit 1; }
done
"$program" detect near.ply --out text --points --points-format csv --quiet
xvfb-run -a CloudCompare -SILENT -O text/points.csv >cloudcompare.log || { cat cloudcompare.log; exit 1; }
grep --quiet "Found one cloud with $(($(wc --lines <text/points.csv) - 1)) points" cloudcompare.log
# PCL has points of floats, which take doubles for 0 0 0. Local coordinates keep their extent of 39.
awk 'BEGIN { for (i = 0; i < 1600; ++i) printf "%.2f %.2f 300\n", 500000.25 + i % 40, 5400000.25 + int(i / 40) }' >utm.xyz
"$program" detect utm.xyz --out local --points --points-format ply --local-coordinates --quiet
pcl_ply2pcd local/points.ply local.pcd >pcl.log 2>&1
pcl_demean_cloud local.pcd middle.pcd >pcl.log 2>&1
pcl_convert_pcd_ascii_binary middle.pcd local.pcd 0 >pcl.log 2>&1
sed '1,/^DATA/d' local.pcd | awk '$1 > 19.4 && $2 > 19.4 { found = 1 } END { exit !found }'

"$python" - <<'END'
import csv
import json
import math
from pathlib import Path

from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOPLY import vtkPLYReader

near, earth = (json.loads(Path(name, "holes.json").read_text(encoding="utf-8")) for name in ("near", "earth"))
assert len(near["loops"]) == len(earth["loops"]) == 5
points = [(*point, id, loop["id"], loop["kind"] == "outer")
          for loop in near["loops"] for point, id in zip(loop["coordinates"], loop["ids"], strict=True)]
COLOURS = {False: (230, 80, 30), True: (30, 130, 230)}


def equal(found, expected, tolerance):
    assert len(found) == len(expected), (len(found), len(expected))
    for one, other in zip(found, expected):
        assert len(one) == len(other), (one, other)
        assert all(math.isclose(a, b, rel_tol=0, abs_tol=tolerance) for a, b in zip(one, other)), (one, other)


def table(file, names, is_head):
    """The columns of these names of a text, and its rows."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    head = next(i for i, line in enumerate(lines) if is_head(line))
    columns = lines[head].removeprefix("//").removeprefix("FIELDS").split()
    assert all(name in columns for name in names), columns
    rows = [line.split() for line in lines[head + 1:] if line[0] in "-0123456789"]
    return [[float(row[columns.index(name)]) for name in names] for row in rows]


def read(reader, file):
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


# VTK
data = read(vtkPLYReader(), "near/loops.ply")
equal([data.GetPoint(i) for i in range(data.GetNumberOfPoints())], [point[:3] for point in points], 1e-7)
print("VTK reads loops.ply")
with open("near/holes.csv", encoding="utf-8") as file:
    lids = [row for row in csv.DictReader(file) if row["kind"] == "hole"]
assert len(lids) == 4
mesh = vtkMassProperties()
mesh.SetInputData(read(vtkPLYReader(), "near/lids.ply"))
assert mesh.GetInput().GetNumberOfPolys() == sum(int(lid["points"]) - 2 for lid in lids)
assert math.isclose(mesh.GetSurfaceArea(), sum(float(lid["lid_area"]) for lid in lids), rel_tol=1e-6)
print("VTK reads lids.ply")

# CloudCompare, of which the prefix "scalar_" goes
found = table("loops.asc", ["X", "Y", "Z", "id", "loop", "outer", "R", "G", "B"], lambda line: line.startswith("//"))
equal(found, [(*point, *COLOURS[point[5]]) for point in points], 1e-7)
cloud = table("boundary.asc", ["X", "Y", "Z", "id", "probability", "loop"], lambda line: line.startswith("//"))
assert len(cloud) == near["counts"]["boundary_points"]
assert all(0 < row[4] <= 1 for row in cloud)
annotated = table("points.asc", ["X", "Y", "Z", "probability", "angle", "halfdisc", "shape", "boundary", "coherent", "loop"],
                  lambda line: line.startswith("//"))
assert len(annotated) == near["counts"]["points"]
print("CloudCompare reads loops.ply, boundary.ply and points.ply")

# PCL
is_head = lambda line: line.startswith("FIELDS")
equal(table("loops.pcd", ["x", "y", "z", "scalar_id", "scalar_loop", "scalar_outer"], is_head), points, 1e-6)
equal(table("boundary.pcd", ["x", "y", "z", "scalar_id", "quality", "scalar_loop"], is_head), cloud, 1e-6)
equal(table("points.pcd", ["x", "y", "z", "scalar_probability"], is_head), [row[:4] for row in annotated], 1e-6)
print("PCL reads loops.ply, boundary.ply and points.ply")
END
