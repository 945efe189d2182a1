#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a wheel of a clone by pip, as docs/python.md has it, installs it into a new environment, and runs the tests against it. The
# clone is gone by then. It has no build, so the wheel takes minutes. A wheel of the checkout takes its engine from `build`, where that
# is the build of the tests.
set -euo pipefail
"${LACUNA_PYTHON:?}" -c 'import ensurepip, wheel' 2>/dev/null || {
  echo "pip_test.sh: python3-venv or python3-wheel is not installed: skipped"
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
wheel() {  # FOLDER
  "$LACUNA_PYTHON" -m pip wheel --verbose --no-build-isolation --no-index --no-deps --wheel-dir "$work/wheels" "$1" >"$work/log" 2>&1 ||
    { tail -n 50 "$work/log"; exit 1; }
}
if [[ $LACUNA_PACKAGE -ef ../../build/python ]]; then
  wheel ../..
  grep --quiet "the engine in .* is used" "$work/log" || { cat "$work/log"; exit 1; }
fi
git clone --quiet ../.. "$work/lacuna"
wheel "$work/lacuna"
rm -rf "$work/lacuna"
"$LACUNA_PYTHON" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" install --quiet --no-index "$work"/wheels/lacuna-*.whl
cd "$work"
"$work/venv/bin/python" -c '
import lacuna, pathlib
folder = pathlib.Path(lacuna.__file__).parent
assert str(folder).startswith("'"$work/venv"'"), folder
names = {file.name for file in folder.iterdir()}
assert {"py.typed", "_core.pyi", "lacuna_gis.so"} <= names, names
print(lacuna.__version__)
'
cd "$OLDPWD"
PYTHONPATH='' LACUNA_PROGRAM=$LACUNA_PROGRAM LACUNA_BENCH_PROGRAM=$LACUNA_BENCH_PROGRAM "$work/venv/bin/python" -m unittest test_lacuna
