#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Each tutorial is pasted into a shell, as its reader does it: all of its commands have to succeed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source_folder=$PWD
build_folder=$(dirname "${LACUNA_PROGRAM:?}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The package is built for the interpreter of the system.
export HOME=$work/home PATH=$build_folder:$(dirname "${LACUNA_BENCH_PROGRAM:?}"):/usr/bin:$PATH PYTHONPATH=$build_folder/python
failed=0

# What runs where; what is missing is said.
has() {
  case $1 in
    python) python3 -c 'import lacuna' 2>/dev/null ;;
    cpp) [[ -e $build_folder/liblacuna.so ]] ;;
    *) true ;;
  esac
}

for page in docs/tutorials/*.md; do
  name=$(basename "$page" .md)
  has "$name" || { echo "$name: skipped: its library is not built"; continue; }
  mkdir -p "$HOME" "$work/$name"
  ln -sfn "$build_folder" "$work/$name/build"
  sed -n 's/^    //p' "$page" >"$work/$name.sh"
  (cd "$work/$name" && bash -euo pipefail "$work/$name.sh") >"$work/$name.log" 2>&1 || {
    echo "$page: fails:"
    tail -n 20 "$work/$name.log"
    failed=1
  }
  rm -rf "$HOME"
done
cd "$source_folder"

# They show what they promise.
expect() {
  grep -q "$2" "$work/$1.log" || { echo "$1: does not print: $2"; failed=1; }
}
while IFS= read -r line; do
  grep -q --fixed-strings "$line" "$work/surveyor.log" || { echo "surveyor: does not print: $line"; failed=1; }
done < <(sed -n 's/^    #> //p' docs/tutorials/surveyor.md)
expect gis "Description = points"
expect cluster "the same bytes"
! has python || expect python "centre \[40. 60.  0.\]"
! has cpp || expect cpp "diameter 2[0-9]"
exit "$failed"
