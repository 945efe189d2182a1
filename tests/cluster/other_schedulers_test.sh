#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The loop for GNU parallel and the Snakefile, taken from docs/cluster.md as they are: results have the bytes of those of
# one `lacuna detect`. Skipped where neither program is installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
page=$PWD/docs/cluster.md
program=${LACUNA_PROGRAM:-$PWD/build/lacuna}
bench=${LACUNA_BENCH_PROGRAM:-$PWD/build/lacuna-bench}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work XDG_CACHE_HOME=$work/cache  # for what these programs keep of a user
mkdir "$work/bin"
ln -s "$(realpath "$program")" "$work/bin/lacuna"
export PATH=$work/bin:$PATH

block_of() { sed --quiet "/^\`\`\`$1\$/,/^\`\`\`\$/p" "$page" | sed '1d;$d'; }
new_folder() {
  mkdir -p "$work/$1/survey"
  cd "$work/$1"
  "$bench" synth surface survey/scan.ply --truth truth.txt --points 200000 --holes 10 --positions random >/dev/null
  "$program" detect survey --out expected --quiet
}
is_as_expected() {
  diff --recursive --brief --exclude=run.json expected holes
  echo "$1: same bytes"
}

ran=0
if command -v parallel >/dev/null && parallel --version | grep --quiet GNU; then
  new_folder "GNU parallel"
  block_of bash >loop.sh
  bash -eu loop.sh >log 2>&1 || { cat log; exit 1; }
  is_as_expected "GNU parallel"
  ran=1
fi
if command -v snakemake >/dev/null; then
  new_folder Snakemake
  block_of python >Snakefile
  lacuna plan survey --workspace work --tasks 32 --tsv >plan.tsv
  snakemake --cores 2 >log 2>&1 || { cat log; exit 1; }
  is_as_expected Snakemake
  ran=1
fi
((ran)) || { echo "skipped: neither parallel nor snakemake is installed"; exit 77; }
