#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the files of a release in build-package/, for the Debian that it runs on, and prints their names. They are the packages
# lacuna, lacuna-bench, lacuna-gis, liblacuna0.1, liblacuna-dev and python3-lacuna, and a wheel. Takes further arguments for CMake.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/packages.sh

tools/install.sh
install_packages help2man python3-pip python3-setuptools python3-wheel
build="build-package"
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DLACUNA_TESTS=OFF \
  -DLACUNA_PYTHON_DIR=lib/python3/dist-packages -DPython3_EXECUTABLE=/usr/bin/python3 "$@" >&2
cmake --build "$build" --parallel "$(nproc)" >&2
make_manual() {
  help2man --no-info --help-option=--help-all --name="$2" "$build/$1" | gzip -9n >"$build/$1.1.gz"
}
make_manual lacuna "find holes in scanned surfaces"
make_manual lacuna-bench "benchmark for programs that find holes in scanned surfaces"
rm -f "$build"/*.deb "$build"/*.whl
(cd "$build" && cpack -G DEB) >&2
# Its engine is the one of the packages, so nothing is compiled again.
LACUNA_BUILD=$build /usr/bin/python3 -m pip wheel --no-build-isolation --no-index --no-deps --wheel-dir "$build" . >&2
ls "$build"/*.deb "$build"/*.whl
