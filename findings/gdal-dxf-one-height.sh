#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# GDAL 3.6: heights of polygons in DXF.
# Guess: ogr2ogr keeps z of a polygon's corners, as it does for lines, or warns.
# Seen: a polygon becomes a hatch, which has one height. It is the middle of the lowest and the highest z, so
# that no corner need have it. There is no warning. With DXF_WRITE_HATCH=NO the corners keep their heights.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends gdal-bin=3.6.2+dfsg-1+b2 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack PATH=$work/root/usr/bin:$PATH
[[ ! -d root/usr/share/gdal ]] || export GDAL_DATA=$work/root/usr/share/gdal PROJ_DATA=$work/root/usr/share/proj

for kind in LineString Polygon; do
  line="[[0, 0, 10], [10, 0, 12], [10, 10, 20], [0, 10, 14], [0, 0, 10]]"
  [[ $kind == LineString ]] || line="[$line]"
  echo "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": {\"type\": \"$kind\", \"coordinates\": $line}}"
done | sed '1s/$/,/; 1s/^/{"type": "FeatureCollection", "features": [/; $s/$/]}/' >loops.geojson
convert() {
  ogr2ogr -f DXF "$1.dxf" loops.geojson "${@:2}"
  ogrinfo -q -al "$1.dxf" | grep -E "^ +(LINESTRING|POLYGON)"
}

{
  ogrinfo --version | cut -d, -f1
  echo "as it is:"
  convert plain
  echo "with DXF_WRITE_HATCH=NO:"
  convert lines --config DXF_WRITE_HATCH NO
} | tee seen.txt

diff - seen.txt <<'END'
GDAL 3.6.2
as it is:
  LINESTRING Z (0 0 10,10 0 12,10 10 20,0 10 14,0 0 10)
  POLYGON Z ((0 0 15,10 0 15,10 10 15,0 10 15,0 0 15))
with DXF_WRITE_HATCH=NO:
  LINESTRING Z (0 0 10,10 0 12,10 10 20,0 10 14,0 0 10)
  LINESTRING Z (0 0 10,10 0 12,10 10 20,0 10 14,0 0 10)
END
echo "as before"
