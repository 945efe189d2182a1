#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# pages_test.sh PATTERN...: pages run as they are, and print what they show. Each tutorial is pasted into a shell, as its reader
# does it, and has to show output by lines `#>`. Of other pages, the sections with such lines are pasted. All commands have to succeed.
# Each line `#>` has to be a part of what they print, in this order. Where real scans are absent, their sections are skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source_folder=$PWD
scans=${LACUNA_SHARED:-$PWD/../shared}/data
build_folder=$(dirname "${LACUNA_PROGRAM:?}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The package is built for the interpreter of the system.
export HOME=$work/home PATH=$build_folder:$(dirname "${LACUNA_BENCH_PROGRAM:?}"):/usr/bin:$PATH PYTHONPATH=$build_folder/python
failed=0
mkdir "$work/programs"
printf '#!/bin/sh\nexec lacuna detect "$1" --out "${2%%.txt}" --quiet\n' >"$work/programs/my-program"  # of docs/evaluate.md
chmod +x "$work/programs/my-program"
PATH=$PATH:$work/programs

# Says what a section needs and is not there.
missing() {  # COMMANDS
  case $(<"$1") in
    *"import lacuna"*) python3 -c 'import lacuna' 2>/dev/null || echo "the Python package" ;;
    *"COMPONENTS shared"*) [[ -e $build_folder/liblacuna.so ]] || echo "the shared library" ;;
    *autzen_* | *scans/*) [[ -d $scans ]] || echo "$scans" ;;
  esac
}

# Prints the first of the lines `#>` that does not follow the ones before it.
first_absent() {  # COMMANDS LOG
  awk 'FNR == NR { if (sub(/^#> /, "")) promised[++count] = $0; next }
       next_one < count && index($0, promised[next_one + 1]) { ++next_one }
       END { if (next_one < count) print promised[next_one + 1] }' "$1" "$2"
}

run_section() {  # PAGE COMMANDS
  local absent log=$2.log
  absent=$(missing "$2")
  [[ -z $absent ]] || { echo "$1: skipped: $absent is not there"; return; }
  bash -euo pipefail "$2" >"$log" 2>&1 || { echo "$1: fails:"; tail -n 20 "$log"; failed=1; return; }
  absent=$(first_absent "$2" "$log")
  [[ -n $absent ]] || return 0
  echo "$1: these commands do not print, or not in this order: $absent"
  cat "$2"
  echo "they print:"
  grep --extended-regexp "$(sed -E 's/[][(){}.*+?|^$\\]/./g; s/ ?[0-9][0-9.,]*/.{1,9}/g' <<<"$absent")" "$log" || tail -n 20 "$log"
  failed=1
}

for page in $*; do  # patterns become names here
  name=$(basename "$page" .md)
  heading='^#+ '
  [[ $page != docs/tutorials/* ]] || heading='^# '
  mkdir -p "$HOME" "$work/$name/scans"
  cd "$work/$name"
  ln -s "$build_folder" build
  ln -s "$scans/autzen_river.ply" .
  ln -s "$scans/dragon_30scans_793k.ply" scans/dragon.ply
  awk -v heading="$heading" -v to="$work/$name" '$0 ~ heading { ++part } sub(/^    /, "") { print > (to "." part ".sh") }' \
    "$source_folder/$page"
  mapfile -t sections < <(grep --files-with-matches '^#> ' "$work/$name".*.sh 2>/dev/null | sort --version-sort)
  ((${#sections[@]} > 0)) || [[ $page != docs/tutorials/* ]] || { echo "$page: shows no output by a line '#> '"; failed=1; }
  for section in "${sections[@]}"; do run_section "$page" "$section"; done
  cd "$source_folder"
  rm -rf "$HOME" "${work:?}/$name"
done
exit "$failed"
