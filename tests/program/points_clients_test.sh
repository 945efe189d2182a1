#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether other programs open the annotated scan: CloudCompare the PLY and the text, PCL the PLY. CloudCompare, pdal or
# lasinfo open the LAS. 77: none of them is there.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
bench=${LACUNA_BENCH_PROGRAM:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$PWD
cd "$work"
tried=0
has() { command -v "$1" >/dev/null; }

"$bench" synth surface torus.ply --kind torus --points 20000 --holes 3 >/dev/null
for format in ply csv; do
  "$program" detect torus.ply --out "$format" --points --points-format "$format" --quiet
done
python3 "$here/make_las.py" torus.ply torus.las 3
"$program" detect torus.las --out las --points --quiet
points=$(grep -a -m1 '^element vertex' ply/points.ply | cut -d' ' -f3)

# The names of its columns, as CloudCompare shows them.
cloudcompare() {
  local file=$1 asc=$2
  QT_QPA_PLATFORM=offscreen timeout 300 xvfb-run -a CloudCompare -SILENT -O "$file" -C_EXPORT_FMT ASC -PREC 9 \
    -ADD_HEADER -NO_TIMESTAMP -SAVE_CLOUDS FILE "$asc" >"$asc.log" 2>&1
  grep -q "Found one cloud with $points points" "$asc.log"
}
if has CloudCompare && has xvfb-run; then
  tried=1
  cloudcompare ply/points.ply "$work/ply.asc"
  [[ $(head -1 ply.asc) == "//X Y Z probability angle halfdisc shape boundary coherent loop"* ]]
  cloudcompare csv/points.csv "$work/csv.asc"
  # Only builds with this plugin open it; Debian's has it not.
  QT_QPA_PLATFORM=offscreen timeout 300 xvfb-run -a CloudCompare -SILENT -O las/points/torus.las >las.log 2>&1 || true
  grep -q "unhandled file extension" las.log || grep -q "Found one cloud with $points points" las.log
fi

if has pcl_ply2pcd && has pcl_convert_pcd_ascii_binary; then
  tried=1
  pcl_ply2pcd ply/points.ply points.pcd >pcl.log 2>&1
  pcl_convert_pcd_ascii_binary points.pcd ascii.pcd 0 >pcl.log 2>&1
  grep -q "^POINTS $points$" ascii.pcd
  grep -q "scalar_probability" ascii.pcd
  # This program has points of floats, which take doubles for 0 0 0. Local coordinates keep their extent of 39.
  awk 'BEGIN { for (i = 0; i < 1600; ++i) printf "%.2f %.2f 300\n", 500000.25 + i % 40, 5400000.25 + int(i / 40) }' >utm.xyz
  "$program" detect utm.xyz --out local --points --points-format ply --local-coordinates --quiet
  pcl_ply2pcd local/points.ply local.pcd >pcl.log 2>&1
  pcl_demean_cloud local.pcd middle.pcd >pcl.log 2>&1
  pcl_convert_pcd_ascii_binary middle.pcd ascii.pcd 0 >pcl.log 2>&1
  sed '1,/^DATA/d' ascii.pcd | awk '$1 > 19.4 && $2 > 19.4 { found = 1 } END { exit !found }'
fi

if has pdal; then
  tried=1
  pdal info --metadata las/points/torus.las | grep -q "\"count\": $points"
  pdal info --schema las/points/torus.las | grep -q probability
elif has lasinfo; then
  tried=1
  lasinfo las/points/torus.las | grep -q "$points"
fi
((tried)) || exit 77
