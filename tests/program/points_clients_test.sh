#!/usr/bin/env bash
# Whether other programs open the annotated scan: CloudCompare the PLY and the text, PCL the PCD, and CloudCompare, pdal,
# lasinfo or LASzip's library the LAS. 77: none of them is there.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
tried=0
has() { command -v "$1" >/dev/null; }

"$program" synth surface torus.ply --kind torus --points 20000 --holes 3 >/dev/null
for format in ply las pcd csv; do
  "$program" detect torus.ply --out "$format" --points --points-format "$format" --quiet
done
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
  for format in las pcd; do  # only builds with these plugins open them; Debian's has neither
    QT_QPA_PLATFORM=offscreen timeout 300 xvfb-run -a CloudCompare -SILENT -O "$format/points.$format" >"$format.log" 2>&1 || true
    grep -q "unhandled file extension" "$format.log" || grep -q "Found one cloud with $points points" "$format.log"
  done
fi

if has pcl_convert_pcd_ascii_binary; then
  tried=1
  pcl_convert_pcd_ascii_binary pcd/points.pcd ascii.pcd 0 >pcl.log 2>&1
  grep -q "^POINTS $points$" ascii.pcd
  grep -q "scalar_probability" ascii.pcd
  # The same values by PCL and by this project.
  "$program" detect ascii.pcd --out pcl --points --points-format csv --quiet
  cmp <(cut -d, -f1-3 pcl/points.csv) <(cut -d, -f1-3 csv/points.csv) || echo "PCL rounds text to seven digits"
fi

if has pdal; then
  tried=1
  pdal info --metadata las/points.las | grep -q "\"count\": $points"
  pdal info --schema las/points.las | grep -q probability
elif has lasinfo; then
  tried=1
  lasinfo las/points.las | grep -q "$points"
fi
if has g++ && [[ -e /usr/include/laszip/laszip_api.h ]]; then
  tried=1
  cat >read.cpp <<'END'
#include <laszip/laszip_api.h>
#include <cstdio>
#include <cstring>
int main(int, char** words) {
  laszip_POINTER reader;
  laszip_BOOL is_compressed;
  laszip_header* header;
  laszip_point* point;
  laszip_create(&reader);
  if (laszip_open_reader(reader, words[1], &is_compressed)) return 1;
  laszip_get_header_pointer(reader, &header);
  laszip_get_point_pointer(reader, &point);
  const auto count = header->extended_number_of_point_records;
  float probability = 0;
  double x = 0;
  for (laszip_U64 i = 0; i < count; ++i) {
    if (laszip_read_point(reader)) return 1;
    std::memcpy(&probability, point->extra_bytes, sizeof probability);
    x = point->X * header->x_scale_factor + header->x_offset;
  }
  std::printf("%llu %d %s %.6f %.5g\n", count, point->num_extra_bytes, header->generating_software, x, probability);
}
END
  g++ -o read read.cpp -llaszip_api 2>/dev/null || g++ -o read read.cpp -llaszip_api3 2>/dev/null || g++ -o read read.cpp -llaszip
  last=$(tail -1 csv/points.csv)
  expected=$(awk -F, -v n="$points" '{ printf "%s 22 %.6f %.5g", n, $1, $4 }' <<<"$last")
  [[ $(./read las/points.las | sed 's/Lacuna [0-9.]* //') == "$expected" ]]
fi

((tried)) || exit 77
