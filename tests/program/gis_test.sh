#!/usr/bin/env bash
# The loops as GeoPackage, GeoJSON and Shapefile, read back by GDAL's programs: coordinates, measures and the coordinate
# reference system. The bytes are equal for every tiling. Other cases: what is replaced, and what is refused.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work/home
mkdir "$HOME"
cd "$work"
formats=(--gpkg --geojson --shp)

"$program" synth surface near.ply --points 12000 --holes 4 --hole-radius 3 6 --order random >/dev/null
# The scan in UTM, in millimetres, as LAS files with different coordinate reference systems.
python3 - <<'END'
import struct

rows = open("near.ply", "rb").read().split(b"end_header\n", 1)[1]
points = [(round(x * 100_000), round(y * 100_000), round(z * 100_000)) for x, y, z in struct.iter_unpack("<3f", rows)]


def write(name, record, data, version=2, encoding=0):
    header, vlr = (375 if version == 4 else 227), 54 + len(data)
    start = struct.pack("<4sHH16xBB32s32sHHHII", b"LASF", 0, encoding, 1, version, b"", b"", 1, 2026, header, header + vlr, 1)
    start += struct.pack("<BHI5I", 0, 20, len(points), len(points), 0, 0, 0, 0)
    start += struct.pack("<6d6d", .001, .001, .001, 500_000, 5_400_000, 100, 5e5 + 200, 5e5 - 200, 54e5 + 200, 54e5 - 200, 200, 0)
    if version == 4:
        start += struct.pack("<QQIQ15Q", 0, 0, 0, len(points), len(points), *[0] * 14)
    start += struct.pack("<H16sHH32s", 0, b"LASF_Projection", record, len(data), b"") + data
    with open(name, "wb") as file:
        file.write(start)
        for x, y, z in points:
            file.write(struct.pack("<3iHBBbBH", x, y, z, 0, 9, 0, 0, 0, 0))


def keys(*pairs):
    return struct.pack("<4H", 1, 1, 0, len(pairs)) + b"".join(struct.pack("<4H", key, 0, 1, code) for key, code in pairs)


write("utm.las", 34735, keys((1024, 1), (3072, 25832)))
write("heights.las", 34735, keys((1024, 1), (3072, 25832), (4096, 7837)))
write("nonsense.las", 2112, b'PROJCS["nonsense",', 4, 16)
with open("none.xyz", "w") as text:
    for x, y, z in points:
        print(f"{500_000 + x / 1000:.3f} {5_400_000 + y / 1000:.3f} {100 + z / 1000:.3f}", file=text)
END

"$program" detect utm.las --out utm "${formats[@]}" --quiet
"$program" detect utm.las --out tiled "${formats[@]}" --quiet --threads 3 --tile-points 900 --memory-limit 100MiB
for file in loops.{gpkg,geojson,shp,shx,dbf,prj,cpg}; do
  cmp "utm/$file" "tiled/$file"
done
cp -r utm again
"$program" detect heights.las --out heights "${formats[@]}" --quiet
"$program" detect none.xyz --out again "${formats[@]}" --quiet  # replaces own files
"$program" detect nonsense.las --out nonsense "${formats[@]}" --quiet 2>warnings.txt

for run in utm heights again nonsense; do
  for format in gpkg geojson shp; do
    ogr2ogr -f GeoJSON "$run.$format.json" "$run/loops.$format" -lco SIGNIFICANT_FIGURES=17
    ogrinfo -so -al "$run/loops.$format" >"$run.$format.txt"
  done
done
python3 - <<'END'
import json
import math
from pathlib import Path

MEASURES = {name: name for name in ("id", "kind", "points", "confidence", "perimeter", "area", "diameter", "planarity")}


def is_near(a, b):
    return a == b if isinstance(b, str) else math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-14)


for run in ("utm", "heights", "again", "nonsense"):
    loops = json.loads(Path(run, "holes.json").read_text(encoding="utf-8"))["loops"]
    assert len(loops) == 5 and loops[0]["coordinates"][0][1] > 5e6
    for format in ("gpkg", "geojson", "shp"):
        features = json.loads(Path(f"{run}.{format}.json").read_text(encoding="utf-8"))["features"]
        for feature, loop in zip(features, loops, strict=True):
            line = feature["geometry"]["coordinates"]
            assert feature["geometry"]["type"] == "LineString" and line[0] == line[-1]
            assert line[:-1] == loop["coordinates"], (run, format)
            names = MEASURES | {"mean_prob" if format == "shp" else "mean_probability": "mean_probability"}
            assert feature["properties"].keys() == names.keys(), feature["properties"]
            for name, key in names.items():
                assert is_near(feature["properties"][name], loop[key]), (run, format, name)
        info = Path(f"{run}.{format}.txt").read_text(encoding="utf-8")
        assert "3D Line String" in info
        has_crs = run in ("utm", "heights")
        assert ("UTM zone 32N" in info.replace("_", " ")) == has_crs, info
        if run == "heights" and format == "gpkg":
            assert 'ID["EPSG",25832]' in info and 'ID["EPSG",7837]' in info, info
        if format == "gpkg" and not has_crs:
            assert "Undefined Cartesian SRS" in info, info
warning = Path("warnings.txt").read_text(encoding="utf-8")
assert warning.count("\n") == 1 and "GDAL does not understand the coordinate reference system" in warning, warning
END
for run in again nonsense; do
  [[ ! -e $run/loops.prj ]] || { echo "$run: a .prj without a coordinate reference system"; exit 1; }
done

# Files of the same names that Lacuna did not write.
mkdir others
ogr2ogr -f GPKG others/loops.gpkg utm/loops.geojson -nln mine
ogr2ogr -f GeoJSON others/loops.geojson utm/loops.geojson -nln mine
ogr2ogr -f "ESRI Shapefile" others/loops.shp utm/loops.geojson -select id,area 2>/dev/null
cp -r others before
for format in gpkg geojson shp; do
  if "$program" detect utm.las --out others "--$format" --quiet 2>refused.txt; then exit 1; fi
  grep -q "loops.$format: exists, and this command did not write it" refused.txt
done
diff -r others before
"$program" detect utm.las --out others --quiet  # none of these is a result that an earlier run has left
for file in before/*; do
  cmp "$file" "others/${file#*/}"
done
# Own ones that this run does not want go.
"$program" detect utm.las --out again --quiet
[[ -z $(find again -name 'loops.*' ! -name loops.ply) ]]

# The library is found in the program's folder, or where it is installed.
mkdir -p bin lib/lacuna
cp "$program" bin/lacuna
if bin/lacuna detect utm.las --out out --gpkg --quiet 2>missing.txt; then exit 1; fi
grep -q "lacuna_gis.so: is neither in $work/bin nor in $work/lib/lacuna" missing.txt
[[ ! -e out ]]
bin/lacuna detect utm.las --out out --quiet
cp "$(dirname "$program")/lacuna_gis.so" lib/lacuna
bin/lacuna detect utm.las --out out --gpkg --quiet
cmp out/loops.gpkg utm/loops.gpkg

[[ -z $(ls -A "$HOME") ]] || { echo "something was written to the home folder"; exit 1; }
