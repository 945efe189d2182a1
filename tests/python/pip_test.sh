#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the package by pip into a new environment, as docs/python.md has it, and runs the tests against it. The clone
# has no build, so it takes minutes. A wheel of the checkout takes its engine from `build`, where that is the build of the
# tests.
set -euo pipefail
"${LACUNA_PYTHON:?}" -c 'import ensurepip, wheel' 2>/dev/null || {
  echo "pip_test.sh: python3-venv or python3-wheel is not installed: skipped"
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ $LACUNA_PACKAGE -ef ../../build/python ]]; then
  "$LACUNA_PYTHON" -m pip wheel --verbose --no-build-isolation --no-index --no-deps --wheel-dir "$work/wheel" ../.. >"$work/log" 2>&1
  grep --quiet "the engine in .* is used" "$work/log" || { cat "$work/log"; exit 1; }
fi
git clone --quiet ../.. "$work/lacuna"
"$LACUNA_PYTHON" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" install --quiet --no-build-isolation --no-index "$work/lacuna"
cd "$work"
"$work/venv/bin/python" -c '
import lacuna, pathlib
folder = pathlib.Path(lacuna.__file__).parent
assert str(folder).startswith("'"$work"'"), folder
names = {file.name for file in folder.iterdir()}
assert {"py.typed", "_core.pyi", "lacuna_gis.so"} <= names, names
print(lacuna.__version__)
'
cd "$OLDPWD"
PYTHONPATH='' LACUNA_PROGRAM=$LACUNA_PROGRAM LACUNA_BENCH_PROGRAM=$LACUNA_BENCH_PROGRAM "$work/venv/bin/python" -m unittest test_lacuna
