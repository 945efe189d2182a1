#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether LAS libraries that are not ours, copc.js and laz-perf, read annotated LAS and LAZ files. They must find what is
# in the inputs, and Lacuna's results.
# 77: Node.js or npm is missing, or npm cannot fetch the library.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
bench=${LACUNA_BENCH_PROGRAM:?}
here=$PWD
shared=${LACUNA_SHARED:-$here/../../../shared}/data/las

missing=()
for command in node:nodejs npm:npm; do
  command -v "${command%:*}" >/dev/null || missing+=("${command#*:}")
done
if ((${#missing[@]} > 0)); then
  echo "skipped: not installed: ${missing[*]}"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir npm
if ! npm install --prefix npm --cache "$work/cache" --ignore-scripts --no-audit --no-fund --fetch-retries 1 \
  --fetch-retry-mintimeout 1000 --fetch-timeout 60000 copc@0.0.8 laz-perf@0.0.7 >npm.log 2>&1; then
  echo "skipped: npm cannot fetch copc@0.0.8:"
  tail -5 npm.log
  exit 77
fi
check() {
  echo "$@"
  node "$here/las_clients.cjs" "$work/npm" "$@"
}

"$bench" synth surface torus.ply --kind torus --points 12000 --holes 3 --hole-radius 3 6 >/dev/null
for format in 0 1 2 3 6 7 8; do
  python3 "$here/make_las.py" torus.ply "$format.las" "$format"
  "$program" detect "$format.las" --out "$format.out" --points --keep-withheld --keep-noise --quiet
  check "$format.out" las "$format.las"
done

for file in autzen_trim.las autzen_trim.laz simple.las simple.laz; do
  if [[ ! -e $shared/$file ]]; then
    echo "$shared/$file is not there"
    continue
  fi
  "$program" detect "$shared/$file" --out "${file/./_}" --points --quiet
  check "${file/./_}" "${file#*.}" "$shared/$file"
  # What came as LAZ goes out as LAZ, with the same values again.
  "$program" detect "${file/./_}/points/$file" --out again --points --quiet
  cmp "again/points/$file" "${file/./_}/points/$file"
done
