#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether LAS libraries that are not ours, copc.js and laz-perf, find in points.las and points.laz what they find in the
# inputs, and Lacuna's results.
# 77: Node.js or npm is missing, or npm cannot fetch the library.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
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

"$program" synth surface torus.ply --kind torus --points 12000 --holes 3 --hole-radius 3 6 >/dev/null
for format in 0 1 2 3 6 7 8; do
  python3 "$here/make_las.py" torus.ply "$format.las" "$format"
  for kind in las laz; do
    "$program" detect "$format.las" --out "$format.$kind.out" --points --points-format "$kind" --quiet
    check "$format.$kind.out" "$kind" "$format.las"
  done
  # What came as LAZ goes out as LAZ, with the same values again.
  "$program" detect "$format.laz.out/points.laz" --out "$format.again" --points --quiet
  cmp "$format.again/points.laz" "$format.laz.out/points.laz"
done
# Several chunks.
"$program" synth surface large.ply --kind torus --points 130000 --holes 3 --hole-radius 3 6 >/dev/null
for format in 3 7; do
  python3 "$here/make_las.py" large.ply large.las "$format"
  "$program" detect large.las --out "large.$format" --points --points-format laz --quiet
  check "large.$format" laz large.las
done
# A file without extra bytes and one with these become one; their coordinates are half a step apart.
python3 "$here/make_las.py" torus.ply first.las 1 0 5000
python3 "$here/make_las.py" torus.ply second.las 8 5000
for order in "first.las second.las" "second.las first.las"; do
  read -r -a files <<<"$order"
  for kind in las laz; do
    "$program" detect "${files[@]}" --out "${files[0]%.las}.$kind.out" --points --points-format "$kind" --quiet
    check "${files[0]%.las}.$kind.out" "$kind" "${files[@]}"
  done
done

for file in autzen_trim.las autzen_trim.laz simple.las simple.laz; do
  if [[ ! -e $shared/$file ]]; then
    echo "$shared/$file is not there"
    continue
  fi
  "$program" detect "$shared/$file" --out "${file/./_}" --points --quiet
  check "${file/./_}" "${file#*.}" "$shared/$file"
done
