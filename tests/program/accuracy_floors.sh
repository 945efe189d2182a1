#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Finds the holes of known scans, and fails where fewer than the floors are found, or more than the ceilings are false:
# bench/accuracy/floors.csv. Takes an expression for GROUP/NAME of the sets. LACUNA_PROGRAM names the program.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$root/tools/accuracy.sh" --lacuna "$LACUNA_PROGRAM" --bench "$LACUNA_BENCH_PROGRAM" --no-peers --work "$scratch" --csv "$scratch/rows.csv" \
  --data "${LACUNA_SHARED:-$root/../shared}/data" --only "$1" --floors "$root/bench/accuracy/floors.csv"
