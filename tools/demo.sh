#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 to the holes of a scan; the text below has the steps. Packages of this version in this folder or next to it
# take the place of the build. So does what is installed, where there is no build. A build folder that exists keeps its options.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/packages.sh

version=$(sed -n 's/^project(lacuna VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
are_installed() {
  [[ $(lacuna --version 2>&1) == "lacuna $version" && $(lacuna-bench --version 2>&1) == "lacuna-bench $version" ]]
}
packages=()
for folder in .. .; do
  files=("$folder"/lacuna*_"${version}_$(dpkg --print-architecture)".deb)  # lacuna, lacuna-bench, lacuna-gis
  [[ ${files[*]} != *"/lacuna_"* || ${files[*]} != *"/lacuna-bench_"* ]] || packages=("${files[@]}")
done

programs=build/  # where they are; nothing: in PATH
if ((${#packages[@]} > 0)) || { [[ ! -f build/CMakeCache.txt ]] && are_installed; }; then
  programs=
  cat <<END
This takes lacuna and lacuna-bench $version from ${packages[*]:-PATH}, makes a scan of 400,000 points
in demo/, finds its holes, and compares them with the true ones. It takes seconds, and builds nothing.

END
  are_installed || install_packages "${packages[@]}"
  are_installed || { echo "demo.sh: lacuna $version is not the first one in PATH: $(type -aP lacuna lacuna-bench | xargs)" >&2; exit 1; }
else
  cat <<'END'
This installs what the build needs, builds the programs lacuna and lacuna-bench without their tests, makes a scan of
400,000 points in demo/, finds its holes, and compares them with the true ones. On two cores the build takes three
to five minutes, the packages and all else about two.

END
  tools/install.sh
  [[ -f build/CMakeCache.txt ]] || cmake -G Ninja -S . -B build -DCMAKE_BUILD_TYPE=Release
  cmake --build build --target lacuna lacuna-bench --parallel "$(nproc)"
fi

run() {
  printf '\n$ %s\n' "$*"
  "$@"
}

mkdir -p demo
run "${programs}lacuna-bench" synth scan demo/scan.ply --stations 1 --field-of-view -60 15 --points 400000 --seed 2
run "${programs}lacuna" detect demo/scan.ply --out demo/holes --stations demo/scan.stations.txt --points --report
run "${programs}lacuna-bench" evaluate demo/holes demo/scan.loops.txt

cat <<END

The scan is synthetic: one scanner in a room with two windows and a door, a table with a screen, a sofa, a cupboard, a
column and a ball. It looks up by 15 degrees, so the walls end below the ceiling. Every place that the scanner could not
sample is known, and the table above compares. With another --seed the scanner is elsewhere, and some shadows that touch
each other are found as one: docs/evaluate.md has the numbers.

Open it in a browser, by a double click:
  $PWD/demo/holes/report.html   the scan and its holes in 3D
or in CloudCompare or MeshLab:
  $PWD/demo/holes/points/scan.ply  every point, with its boundary probability
  $PWD/demo/holes/boundary.ply  the boundary points
  $PWD/demo/holes/loops.ply     the loops around the holes
and at $PWD/demo/holes/holes.csv for their measures; "loop 3" above has the id 3 there.
On a scan of your own:
  ${programs:+$PWD/$programs}lacuna detect SCAN.ply --out DIR --report
END
