#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Counts the instructions of `lacuna detect`, which do not depend on the load of the machine. Runs the program in build/
# under callgrind on 400,000 random positions, with one thread. Fails where a part of the run takes 10 % more instructions
# than bench/instructions.csv has, or where a part was not found. With --update it writes that file anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/packages.sh
[[ $* == "" || $* == --update ]] || { echo "usage: tools/instructions.sh [--update]" >&2; exit 2; }

install_packages valgrind
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Valgrind has no rdtscp where the processor of a virtual machine does not offer it, and libhwy starts with it.
if ! grep --quiet --word-regexp rdtscp /proc/cpuinfo; then
  echo "instructions: not counted, since valgrind cannot run the program on this processor (no rdtscp)"
  exit 0
fi
build/lacuna-bench synth surface "$work/scan.ply" --kind waves --density-factor 4 --points 400000 --positions random \
  --holes 41 >/dev/null
valgrind --quiet --tool=callgrind --callgrind-out-file="$work/calls" \
  build/lacuna detect "$work/scan.ply" --out "$work/out" --quiet --threads 1
callgrind_annotate --inclusive=yes --threshold=100 --show-percs=no "$work/calls" >"$work/functions"
python3 bench/instructions.py "$work/functions" bench/instructions.csv "$@"
