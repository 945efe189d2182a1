#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The examples for users of PCL, VTK and Open3D print the hole that the first example prints. Skipped, with the names of
# what is missing, unless all of these libraries are installed.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
python=${LACUNA_PYTHON:?}
cd "$(dirname "${BASH_SOURCE[0]}")/../../docs/example"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$(dirname "$program")" --prefix "$work/prefix" >"$work/log"
cmake -S . -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

missing=()
targets=$(cmake --build "$work/build" --target help)
for example in pcl_cloud:libpcl-dev vtk_points:libvtk9-dev open3d_cloud:libopen3d-dev; do
  [[ $targets == *"${example%:*}"* ]] || missing+=("${example#*:}")
done
for module in vtkmodules:python3-vtk9 open3d:python3-open3d; do
  "$python" -c "import ${module%:*}" 2>/dev/null || missing+=("${module#*:}")
done
if ((${#missing[@]} > 0)); then
  echo "skipped: not installed: ${missing[*]}"
  exit 77
fi

cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
expected=$("$work/build/find_holes")
export PYTHONPATH=${LACUNA_PACKAGE:?} PYTHONDONTWRITEBYTECODE=1
for example in "$work"/build/{pcl_cloud,vtk_points,open3d_cloud} "$python "{vtk_points,open3d_cloud}.py; do
  found=$($example)
  [[ $found == "$expected" ]] || {
    echo "cloud_examples_test.sh: $example prints: $found, expected: $expected"
    exit 1
  }
done
