#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The loops as GeoPackage and GeoJSON, read back by GDAL's programs: coordinates, measures and the coordinate
# reference system. The bytes are equal for every tiling. Other cases: what is replaced, and what is refused. A GeoJSON is
# in longitude and latitude where the system is known: converted back, it has the coordinates of the scan.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
bench=${LACUNA_BENCH_PROGRAM:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work/home
mkdir "$HOME"
cd "$work"
formats=(--gpkg --geojson)

"$bench" synth surface near.ply --points 12000 --holes 4 --hole-radius 3 6 --order random >/dev/null
# The scan in UTM, in millimetres, as LAS files with different coordinate reference systems.
python3 - <<'END'
import struct
from pathlib import Path

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
# Without a code of EPSG, as NAD83(HARN) / Oregon GIC Lambert is in many files.
OWN = """PROJCS["own",GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_1989",
SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],
PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",10],
PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]"""
write("own.las", 2112, OWN.encode(), 4, 16)
Path("own.prj").write_text(OWN)
write("local.las", 2112, b'LOCAL_CS["site",UNIT["metre",1]]', 4, 16)
write("nonsense.las", 2112, b'PROJCS["nonsense",', 4, 16)
with open("none.xyz", "w") as text:
    for x, y, z in points:
        print(f"{500_000 + x / 1000:.3f} {5_400_000 + y / 1000:.3f} {100 + z / 1000:.3f}", file=text)
END

"$program" detect utm.las --out utm "${formats[@]}" --quiet
"$program" detect utm.las --out tiled "${formats[@]}" --quiet --threads 3 --tile-points 900 --memory-limit 128MiB
for file in loops.{gpkg,geojson}; do
  cmp "utm/$file" "tiled/$file"
done
cp -r utm again
"$program" detect heights.las --out heights "${formats[@]}" --quiet
"$program" detect none.xyz --out again "${formats[@]}" --quiet 2>again.txt  # replaces own files
"$program" detect nonsense.las --out nonsense "${formats[@]}" --quiet 2>nonsense.txt
"$program" detect local.las --out local "${formats[@]}" --quiet 2>local.txt
"$program" detect own.las --out own "${formats[@]}" --quiet
"$program" detect none.xyz --crs EPSG:25832 --out stated "${formats[@]}" --quiet

for run in utm heights own stated; do  # back to the scan's system
  srs=EPSG:25832
  [[ $run != own ]] || srs=own.prj
  ogr2ogr -f GeoJSON "$run.back.json" "$run/loops.geojson" -t_srs "$srs" -lco RFC7946=NO -lco SIGNIFICANT_FIGURES=17
done
for run in utm heights own stated again nonsense local; do
  for format in gpkg geojson; do
    ogr2ogr -f GeoJSON "$run.$format.json" "$run/loops.$format" -lco SIGNIFICANT_FIGURES=17
  done
  ogrinfo -so -al "$run/loops.gpkg" >"$run.gpkg.txt"
done
python3 - <<'END'
import json
import math
from pathlib import Path

MEASURES = ("id", "kind", "cause", "unit", "points", "confidence", "perimeter", "area", "diameter")


def is_near(a, b):
    if a is None or b is None or isinstance(b, str):
        return (a or "") == (b or "")
    return math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-14)


def distance(line, coordinates):
    return max(abs(a - b) for p, q in zip(line, coordinates, strict=True) for a, b in zip(p, q, strict=True))


CONVERTED = ("utm", "heights", "own", "stated")
for run in (*CONVERTED, "again", "nonsense", "local"):
    result = json.loads(Path(run, "holes.json").read_text(encoding="utf-8"))
    loops = [{**loop, "unit": result["unit"]} for loop in result["loops"]]
    assert len(loops) == 5 and loops[0]["coordinates"][0][1] > 5e6
    assert '"crs"' not in Path(run, "loops.geojson").read_text(encoding="utf-8")
    if run in CONVERTED:
        features = json.loads(Path(f"{run}.back.json").read_text(encoding="utf-8"))["features"]
        for feature, loop in zip(features, loops, strict=True):
            assert distance(feature["geometry"]["coordinates"][:-1], loop["coordinates"]) < 1e-6, run
    for format in ("gpkg", "geojson"):
        features = json.loads(Path(f"{run}.{format}.json").read_text(encoding="utf-8"))["features"]
        for feature, loop in zip(features, loops, strict=True):
            line = feature["geometry"]["coordinates"]
            assert feature["geometry"]["type"] == "LineString" and line[0] == line[-1]
            if format == "geojson" and run in CONVERTED:
                longitude = 10 if run == "own" else 9
                assert all(abs(x - longitude) < 0.01 and abs(y - 48.75) < 0.01 for x, y, z in line), line
                assert [z for x, y, z in line[:-1]] == [z for x, y, z in loop["coordinates"]], run
            else:
                assert line[:-1] == loop["coordinates"], (run, format)
            assert feature["properties"].keys() == set(MEASURES), feature["properties"]
            for name in MEASURES:
                assert is_near(feature["properties"][name], loop[name]), (run, format, name)
    info = Path(f"{run}.gpkg.txt").read_text(encoding="utf-8")
    assert "3D Line String" in info
    assert ("UTM zone 32N" in info) == (run in ("utm", "heights", "stated")), info
    assert ('"own"' in info) == (run == "own") and ('"site"' in info) == (run == "local"), info
    assert ('ID["EPSG",25832]' in info and 'ID["EPSG",7837]' in info) == (run == "heights"), info
    assert ("Undefined Cartesian SRS" in info) == (run in ("again", "nonsense")), info
DEGREES = "GIS will read its coordinates, which are those of the scan, as degrees"
for name, reasons in {
    "again": ["loops.geojson: no coordinate reference system is known, and --crs can state it; " + DEGREES],
    "nonsense": ["GDAL does not understand the coordinate reference system", DEGREES,
                 "nonsense.las: nonsense: its unit is not known, as GDAL does not understand its system; --unit states it"],
    "local": ["loops.geojson: GDAL cannot convert its coordinate reference system", DEGREES],
}.items():
    warning = Path(f"{name}.txt").read_text(encoding="utf-8")
    assert all(reason in warning for reason in reasons), warning
    assert warning.count("\n") == (3 if name == "nonsense" else 1), warning
END

# Feet: z of a GeoJSON is in metres, as RFC 7946 demands. The other files have it in the unit of x and y.
python3 - <<'END'
for name, unit in (("feet", 1), ("mixed", 1200 / 3937)):
    with open(f"{name}.xyz", "w") as text:
        for line in open("none.xyz"):
            x, y, z = map(float, line.split())
            print(f"{5_500_000 + x:.3f} {y - 3_300_000:.3f} {z * unit:.6f}", file=text)
END
"$program" detect feet.xyz --crs EPSG:2227 --out feet "${formats[@]}" --quiet
"$program" detect mixed.xyz --crs EPSG:2227+5703 --out mixed "${formats[@]}" --quiet
"$program" detect feet.xyz --crs EPSG:2227+5703 --unit-z us-ft --out said "${formats[@]}" --quiet
for run in feet mixed said; do
  ogr2ogr -f GeoJSON "$run.gpkg.json" "$run/loops.gpkg" -lco SIGNIFICANT_FIGURES=17
done
python3 - <<'END'
import json
from pathlib import Path

FOOT = 1200 / 3937
for run in ("feet", "mixed", "said"):
    loops = json.loads(Path(run, "holes.json").read_text())["loops"]
    assert len(loops) == 5
    for file, unit in ((f"{run}/loops.geojson", FOOT), (f"{run}.gpkg.json", 1)):
        for feature, loop in zip(json.loads(Path(file).read_text())["features"], loops, strict=True):
            assert feature["properties"]["unit"] == "us-ft"
            found, expected = ([point[2] for point in line] for line in (feature["geometry"]["coordinates"][:-1], loop["coordinates"]))
            assert max(abs(a - unit * b) for a, b in zip(found, expected, strict=True)) < 1e-9, (run, file)
END

# A raster: points, spacing and holes.
"$program" detect utm.las --out raster --coverage 0.5 --quiet
"$program" detect utm.las --out raster2 --coverage 0.5 --quiet --threads 3 --tile-points 900
cmp raster/coverage.tif raster2/coverage.tif
"$program" detect utm.las --out raster2 --coverage 0.5 --quiet  # replaces its own file
gdalinfo -json -stats raster/coverage.tif >raster.json
gdal_translate -q -of XYZ -b 1 raster/coverage.tif points.xyz
gdal_translate -q -of XYZ -b 2 raster/coverage.tif spacing.xyz
gdal_translate -q -of XYZ -b 3 raster/coverage.tif holes.xyz
if "$program" detect utm.las --out fine --coverage 1e-6 --quiet 2>fine.txt; then exit 1; fi
grep -q "coverage: cells of 1e-06 make .* allowed: .* or more" fine.txt
[[ ! -e fine ]]
python3 - <<'END'
import json
import math
from pathlib import Path

result = json.loads(Path("utm/holes.json").read_text(encoding="utf-8"))
loops = result["loops"]


def area(line):  # seen from above; positive where it is counter-clockwise
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(line, line[1:])) / 2


def local(line):
    return [[x - 5e5, y - 54e5] for x, y, *_ in line]


flat = [abs(area(local(loop["coordinates"] + loop["coordinates"][:1]))) for loop in loops]
info = json.loads(Path("raster.json").read_text(encoding="utf-8"))
assert [band["description"] for band in info["bands"]] == ["points", "spacing", "holes"]
assert "UTM zone 32N" in info["coordinateSystem"]["wkt"]
bands = {name: [[float(v) for v in line.split()] for line in Path(f"{name}.xyz").read_text().splitlines()]
         for name in ("points", "spacing", "holes")}
assert sum(v for _, _, v in bands["points"]) == result["counts"]["points"]
for (_, _, count), (_, _, spacing) in zip(bands["points"], bands["spacing"], strict=True):
    assert math.isnan(spacing) if count == 0 else math.isclose(spacing, 0.5 / math.sqrt(count), rel_tol=1e-6)
covered = 0.5 ** 2 * sum(v for _, _, v in bands["holes"])
expected = sum(a for a, loop in zip(flat, loops) if loop["kind"] == "hole")
assert math.isclose(covered, expected, rel_tol=0.02), (covered, expected)
for loop in loops:  # the place is right, too: the middle of each hole is void
    if loop["kind"] != "hole":
        continue
    x, y, _ = loop["centroid"]
    near = min(bands["holes"], key=lambda cell: math.hypot(cell[0] - x, cell[1] - y))
    assert near[2] > 0.9, (loop["centroid"], near)
END

# Polygons: a second layer of the GeoPackage, in place of lines in the others. An island in a hole, and a hole in the
# island: no result counts the island as hole.
python3 - <<'END'
import math
import random

draw = random.Random(4)
with open("island.xyz", "w") as text:
    for i in range(80):
        for j in range(80):
            x, y = i + draw.uniform(-0.2, 0.2), j + draw.uniform(-0.2, 0.2)
            r = math.hypot(x - 40, y - 40)
            if 5 < r < 14 or r > 24:
                print(f"{500_000 + x:.3f} {5_400_000 + y:.3f} {100 + 0.1 * x:.3f}", file=text)
END
"$program" detect island.xyz --crs EPSG:25832 --out island "${formats[@]}" --polygons --coverage 0.5 --quiet
# Islands that are not reported are open, too.
"$program" detect island.xyz --crs EPSG:25832 --out only "${formats[@]}" --polygons --coverage 0.5 --holes-only --quiet
cmp island/coverage.tif only/coverage.tif
ogrinfo -so -al island/loops.gpkg lacuna_loops | grep -q "Geometry: 3D Line String"
ogr2ogr -f GeoJSON only.json only/loops.gpkg lacuna_areas -lco SIGNIFICANT_FIGURES=17
ogr2ogr -f GeoJSON island.gpkg.json island/loops.gpkg lacuna_areas -lco SIGNIFICANT_FIGURES=17
ogr2ogr -f GeoJSON island.geojson.json island/loops.geojson -t_srs EPSG:25832 -lco RFC7946=NO -lco SIGNIFICANT_FIGURES=17
gdal_translate -q -of XYZ -b 3 island/coverage.tif island.holes.xyz
python3 - <<'END'
import json
import math
from pathlib import Path

loops = json.loads(Path("island/holes.json").read_text(encoding="utf-8"))["loops"]
outline, hole, island, inner = sorted(loops, key=lambda loop: -loop["perimeter"])


def area(line):  # in the plan
    flat = [[x - 5e5, y - 54e5] for x, y, *_ in line]
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(flat, flat[1:] + flat[:1]))) / 2


whole = {loop["id"]: area(loop["coordinates"]) for loop in loops}
ring = whole[hole["id"]] - whole[island["id"]]
for format in ("gpkg", "geojson"):
    features = json.loads(Path(f"island.{format}.json").read_text(encoding="utf-8"))["features"]
    for feature, loop in zip(features, loops, strict=True):
        assert feature["geometry"]["type"] == "Polygon" and feature["properties"]["unit"] == "m", (format, feature["properties"])
        rings = [area(ring) for ring in feature["geometry"]["coordinates"]]
        expected = [whole[loop["id"]]] + [whole[other["id"]] for other in loops if other["parent"] == loop["id"]]
        assert all(math.isclose(a, b, rel_tol=1e-6) for a, b in zip(rings, expected, strict=True)), (format, rings)
only = json.loads(Path("only.json").read_text(encoding="utf-8"))["features"]
assert sorted(len(feature["geometry"]["coordinates"]) for feature in only) == [1, 2]
cells = sum(float(line.split()[2]) for line in Path("island.holes.xyz").read_text().splitlines())
assert math.isclose(0.25 * cells, ring + whole[inner["id"]], rel_tol=0.01), cells
END

# Walls seen from above: polygons that cross themselves are mended, and those without an area are counted.
python3 - <<'END'
import random

draw = random.Random(7)
with open("walls.xyz", "w") as text:
    for x, rough in ((0, 0.05), (50, 0)):
        for i in range(60):
            for j in range(40):
                if not (20 <= i < 40 and 15 <= j < 28):
                    print(x + draw.uniform(-rough, rough), i + draw.uniform(-0.2, 0.2), j + draw.uniform(-0.2, 0.2), file=text)
END
"$program" detect walls.xyz --out walls "${formats[@]}" --polygons --quiet 2>walls.txt
grep -qx "lacuna: warning: walls/loops.gpkg: loops that have no valid polygon seen from above: 2 of 4" walls.txt
[[ $(wc -l <walls.txt) == 3 ]]
for layer in "walls/loops.gpkg lacuna_areas" "walls/loops.geojson lacuna_loops"; do
  read -r file name <<<"$layer"
  ogrinfo -al -geom=NO -dialect SQLite "$file" -sql "SELECT ST_IsValid($([[ $name == *areas ]] && echo geom || echo geometry)) AS v FROM $name" \
    >valid.txt 2>&1
  if grep -qi "warning" valid.txt; then exit 1; fi
  [[ $(grep -c "v (.*) = 1" valid.txt) == 2 && $(grep -c "v (.*) = -1" valid.txt) == 2 ]]  # -1: none
done
ogrinfo -so walls/loops.gpkg lacuna_areas | grep -q "Geometry: 3D Multi Polygon"

# At the antimeridian, shapes in degrees are cut (RFC 7946, 3.1.9).
python3 - <<'END'
with open("date.xyz", "w") as text:
    for line in open("none.xyz"):
        x, y, z = map(float, line.split())
        print(f"{x + 319_450:.3f} {y + 2_718_000:.3f} {z:.3f}", file=text)
END
for options in "" "--polygons"; do
  "$program" detect date.xyz --crs EPSG:32760 --out date --geojson --quiet $options
  mv date/loops.geojson "date$options.json"
done
python3 - <<'END'
import json
from pathlib import Path

for file, type in (("date.json", "LineString"), ("date--polygons.json", "Polygon")):
    shapes = [feature["geometry"] for feature in json.loads(Path(file).read_text())["features"]]
    assert "Multi" + type in {shape["type"] for shape in shapes} <= {type, "Multi" + type}, file
    for shape in shapes:
        parts = shape["coordinates"] if shape["type"].startswith("Multi") else [shape["coordinates"]]
        for part in parts:
            for line in part if type == "Polygon" else [part]:
                longitudes = [point[0] for point in line]
                assert min(abs(x) for x in longitudes) > 179.9 and max(longitudes) - min(longitudes) < 0.1, longitudes
                assert type != "Polygon" or line[0] == line[-1]
END

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
# A stated code stays one without the library, and a line says so.
bin/lacuna detect none.xyz --crs EPSG:25832 --out coded --quiet 2>coded.txt
grep -q -- "--crs EPSG:25832: is not checked, since lacuna_gis.so is missing; results have the code alone" coded.txt
grep -q '"crs": "EPSG:25832"' coded/holes.json
grep -q '"unit": "m"' coded/holes.json
bin/lacuna detect own.las --out bare --quiet 2>bare.txt
grep -qx "lacuna: warning: own.las: own: its unit is not known, as lacuna_gis.so is missing; --unit states it" bare.txt
cp "$(dirname "$program")/lacuna_gis.so" lib/lacuna
bin/lacuna detect utm.las --out out --gpkg --quiet
cmp out/loops.gpkg utm/loops.gpkg

[[ -z $(ls -A "$HOME") ]] || { echo "something was written to the home folder"; exit 1; }
