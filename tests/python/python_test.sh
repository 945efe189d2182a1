#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The tests of the Python package, in the build folder. LACUNA_PYTHON names the interpreter that it is built for.
set -euo pipefail
export PYTHONPATH=${LACUNA_PACKAGE:?}
"${LACUNA_PYTHON:?}" -W error::SyntaxWarning -m unittest -v test_lacuna
