#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the notebook of docs/example. Skipped where Jupyter, pandas or matplotlib is not installed.
set -euo pipefail
export PYTHONPATH=${LACUNA_PACKAGE:?}
for module in nbconvert ipykernel pandas matplotlib; do
  "${LACUNA_PYTHON:?}" -c "import $module" 2>/dev/null || {
    echo "notebook_test.sh: $module is not installed: skipped"
    exit 77
  }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$LACUNA_PYTHON" -m nbconvert --to html --execute ../../docs/example/holes.ipynb --output-dir "$work" --output holes
grep --quiet 'data:image/png' "$work/holes.html"
grep --quiet 'Holes(3 holes and 1 outer' "$work/holes.html"
