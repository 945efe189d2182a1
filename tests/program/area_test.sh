#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The check of an area against area_reference.py, which follows its definition cell by cell. Other cases: what does not
# change it, polygons in other systems and formats, and what is refused.
set -euo pipefail
program=${LACUNA_PROGRAM:?}
here=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# ---- the definition
for name in swaths holes islands larger hull random returns; do
  python3 "$here/area_reference.py" "$name" "$name.xyz" "$name.geojson" "$name.except.geojson" >"$name.expected"
  read -r size columns < <(head -n 1 "$name.expected")
  options=(--area "$name.geojson" --except "$name.except.geojson" --void-rule "$size" --area-tile 20)
  code=0
  "$program" check "$name.xyz" --columns "$columns" "${options[@]}" --out "$name" --quiet 2>"$name.err" || code=$?
  python3 "$here/area_reference.py" --compare "$name.expected" "$name" "$code"
done

# ---- what does not change it
python3 - <<'END'
import random
rows = open("holes.xyz").read().splitlines()
random.Random(1).shuffle(rows)
open("mixed.xyz", "w").write("\n".join(rows[:1000]) + "\n")
open("mixed2.xyz", "w").write("\n".join(rows[1000:]) + "\n")
END
options=(--area holes.geojson --except holes.except.geojson --void-rule 4 --area-tile 20 --quiet)
for other in "--threads 1" "--threads 3 --memory-limit 112MiB"; do
  # shellcheck disable=SC2086
  "$program" check mixed.xyz mixed2.xyz --columns "x y z" "${options[@]}" $other --out other 2>other.err || true
  for file in voids.csv voids.json voids.gpkg; do cmp "holes/$file" "other/$file"; done
done

# ---- the files
ogrinfo -q -al -so holes/voids.gpkg >layers.txt
grep -q lacuna_voids layers.txt
grep -q lacuna_area_tiles layers.txt
python3 - <<'END'
import csv, json, subprocess
voids = json.load(open("holes/voids.json"))["voids"]
rows = list(csv.DictReader(open("holes/voids.csv")))
subprocess.run(["ogr2ogr", "-f", "GeoJSON", "read.geojson", "holes/voids.gpkg", "lacuna_voids"], check=True)
features = json.load(open("read.geojson"))["features"]
assert len(voids) == len(rows) == len(features) > 2
for void, row, feature in zip(voids, rows, features):
    values = feature["properties"]
    assert values["kind"] == row["kind"] == void["kind"]
    assert float(row["area"]) == void["area"] == values["area"]
    assert float(row["circle"]) == void["circle"] == values["circle"]
    rings = [[tuple(corner) for corner in ring[:-1]] for ring in feature["geometry"]["coordinates"]]
    outline = [[tuple(corner) for corner in ring] for ring in void["outline"]]
    assert sorted(map(sorted, rings)) == sorted(map(sorted, outline))
END

# ---- polygons in other systems and formats
python3 - <<'END'
rows = [list(map(float, line.split())) for line in open("holes.xyz")]
with open("utm.xyz", "w") as out:
    for x, y, z in rows:
        print(f"{500_000 + x:.3f} {5_400_000 + y:.3f} {z:.3f}", file=out)
import json
for name in ("holes", "holes.except"):
    area = json.load(open(name + ".geojson"))
    for feature in area["features"]:
        feature["geometry"]["coordinates"] = [[[500_000 + x, 5_400_000 + y] for x, y in ring]
                                              for ring in feature["geometry"]["coordinates"]]
    json.dump(area, open("utm." + name + ".json", "w"))
END
ogr2ogr -f GPKG -a_srs EPSG:25832 utm.gpkg utm.holes.json
ogr2ogr -f GeoJSON -s_srs EPSG:25832 -t_srs EPSG:4326 degrees.geojson utm.gpkg
ogr2ogr -f "ESRI Shapefile" -t_srs EPSG:3857 mercator.shp utm.gpkg
ogr2ogr -f GPKG -a_srs EPSG:25832 water.gpkg utm.holes.except.json
for area in utm.gpkg degrees.geojson mercator.shp; do
  "$program" check utm.xyz --columns "x y z" --crs EPSG:25832 --area "$area" --except water.gpkg --void-rule 4 --out "in_$area" \
    --quiet 2>area.err || true
  python3 - "in_$area" <<'END'
import csv, sys
found = list(csv.DictReader(open(sys.argv[1] + "/voids.csv")))
expected = list(csv.DictReader(open("holes/voids.csv")))
assert len(found) == len(expected), (len(found), len(expected))
for a, b in zip(found, expected):
    assert a["kind"] == b["kind"] and a["counts"] == b["counts"], (a, b)
    assert abs(float(a["area"]) - float(b["area"])) < .05 * float(b["area"]) + 1, (a, b)
END
done
"$program" check utm.xyz --columns "x y z" --crs EPSG:25832 --area degrees.geojson --void-rule 4 >converted.txt 2>converted.err || true
grep -q "degrees.geojson: is converted from WGS 84" converted.err

# ---- rules for voids
for rule in anps:1 spacing2:2; do
  "$program" check holes.xyz --columns "x y z" --area holes.geojson --except holes.except.geojson --area-tile 20 --void-rule $rule \
    --out ruled >ruled.txt 2>ruled.err || true
  cmp holes/voids.csv ruled/voids.csv
  grep -q "^  voids .* circles of 4 or more without points, by the rule $rule$" ruled.txt
done

"$program" check holes.xyz --columns "x y z" --unit m --area holes.geojson --except holes.except.geojson --area-tile 20 \
  --void-rule anps:100cm --out ruled >ruled.txt 2>ruled.err || true
cmp holes/voids.csv ruled/voids.csv
"$program" check holes.xyz --columns "x y z" --unit ft --area holes.geojson --void-rule anps:1 --quiet >ruled.txt 2>ruled.err || true
grep -q "warning: void_rule = anps:1: the spacing is taken in ft, so that voids have 1.22 m; standards are in metres" ruled.err

# ---- edges that are straight in degrees
python3 - <<'END'
import json
corners = [[9, 60], [9.4, 60], [9.2, 60.1]]
json.dump({"type": "Polygon", "coordinates": [corners + corners[:1]]}, open("few.json", "w"))
edge = lambda a, b: [[a[k] + (b[k] - a[k]) * i / 100 for k in (0, 1)] for i in range(100)]
ring = [place for a, b in zip(corners, corners[1:] + corners[:1]) for place in edge(a, b)]
json.dump({"type": "Polygon", "coordinates": [ring + ring[:1]]}, open("many.json", "w"))
END
echo "500000 6650000 0" >one.txt
for name in few many; do
  "$program" check one.txt --columns "x y z" --crs EPSG:25832 --area $name.json --void-rule 100 --out $name >few.txt 2>few.err || true
done
python3 - <<'END'
import json
few, many = (json.load(open(name + "/voids.json"))["area"] for name in ("few", "many"))
assert abs(few / many - 1) < 2e-5, (few, many)
END

# ---- a conversion that is known to metres only
if [[ ! -e /usr/share/proj/uk_os_OSTN15_NTv2_OSGBtoETRS.tif ]]; then
  python3 - <<'END'
import json
corners = [[-1.2, 52.7], [-1.1996, 52.7], [-1.1996, 52.7003], [-1.2, 52.7003]]
json.dump({"type": "Polygon", "coordinates": [corners + corners[:1]]}, open("britain.json", "w"))
END
  code=0
  "$program" check one.txt --columns "x y z" --crs EPSG:27700 --area britain.json --void-rule 3 --quiet 2>britain.err || code=$?
  [[ $code == 3 ]]
  grep -q "britain.json: the conversion from WGS 84 holds to 2 m only; PROJ does not find the grid uk_os_OSTN15" britain.err
  grep -q "its polygons may lie off by 2.00 m, more than half of the void size" britain.err
  "$program" check one.txt --columns "x y z" --crs EPSG:27700 --area britain.json --void-rule 30 --quiet 2>britain.err || true
  [[ $(grep -c "may lie off" britain.err) == 0 ]]
fi
# Datums that all programs take for one are no reason.
"$program" check utm.xyz --columns "x y z" --crs EPSG:25832 --area degrees.geojson --void-rule 1.6 --quiet 2>null.err || true
grep -q "the conversion from WGS 84 holds to 1 m only" null.err
[[ $(grep -c "may lie off" null.err) == 0 ]]

# ---- what lies in voids, by a map
python3 - <<'END'
import json
def write(name, *squares):
    rings = [[[x, y], [x + e, y], [x + e, y + e], [x, y + e], [x, y]] for x, y, e in squares]
    json.dump({"type": "MultiPolygon", "coordinates": [[ring] for ring in rings]}, open(name, "w"))
write("buildings.geojson", (5, 5, 20))   # over the hole at 15 15
write("water.geojson", (10, 45, 20), (200, 200, 5))  # over the northern half of the one at 20 45
END
"$program" check holes.xyz --columns "x y z" --area holes.geojson --void-rule 4 --classes buildings.geojson \
  --classes water.geojson --out classes >classes.txt 2>classes.err || true
ogr2ogr -f CSV layer.csv classes/voids.gpkg lacuna_voids
python3 - <<'END'
import csv, json
from math import fsum
found = json.load(open("classes/voids.json"))
rows, layer = (list(csv.DictReader(open(name))) for name in ("classes/voids.csv", "layer.csv"))
is_near = lambda void, x, y: abs(void["middle"][0] - x) + abs(void["middle"][1] - y) < 2
seen = 0
for void, row, feature in zip(found["voids"], rows, layer):
    shares = void["classes"]
    for name, share in shares.items():
        assert float(row["in_" + name]) == share and abs(float(feature["in_" + name]) - share) < 1e-9, (row, feature)
    if is_near(void, 15, 15):
        assert shares == {"buildings": 1, "water": 0}, shares
    elif is_near(void, 20, 45):
        assert .45 < shares["water"] < .55 and shares["buildings"] == 0, shares
    else:
        assert shares == {"buildings": 0, "water": 0}, shares
        continue
    seen += 1
assert seen == 2
for sum in found["classes"]:
    area = [void["area"] * void["classes"][sum["name"]] for void in found["voids"]]
    assert abs(sum["voids_area"] - fsum(area)) < 1e-6 and sum["voids_area"] > 30
END
grep -q "^  of the voids that count, .* lie in buildings$" classes.txt

# ---- an area that is covered
"$program" check holes.xyz --columns "x y z" --area holes.geojson --void-rule 30 >covered.txt
head -n 1 covered.txt | grep -qx covered

# ---- without an area: the outline of the scan, whatever the void rule is
python3 - <<'END'
import math, random
draw = random.Random(3)
grid = [(i / 2 + draw.uniform(-.1, .1), j / 2 + draw.uniform(-.1, .1)) for i in range(160) for j in range(120)]
def write(name, keeps):
    with open(name, "w") as out:
        print("x y z", file=out)
        for x, y in grid:
            u, v = x * math.cos(.4) - y * math.sin(.4), x * math.sin(.4) + y * math.cos(.4)  # no edge is along cells
            if keeps(x, y): print(f"{u:.3f} {v:.3f} {300 + math.sin(x / 9):.3f}", file=out)
def is_land(x, y): return abs(x - 40 - 6 * math.sin(y / 12)) > 6
write("whole.txt", lambda x, y: True)
write("river.txt", lambda x, y: abs(x - 40) > 6)
write("gap.txt", lambda x, y: is_land(x, y) or y > 50)
write("corner.txt", lambda x, y: x < 60 or y < 45)
write("arms.txt", lambda x, y: x < 30 or y < 25)
write("notch.txt", lambda x, y: abs(x - 40) > 3 or y > 30)
write("thin.txt", lambda x, y: x < 40 or round(2 * x) % 5 == 0 and round(2 * y) % 5 == 0)
write("pond.xyz", lambda x, y: math.hypot(x - 40, y - 30) > 4)
END
{ head -n 1 gap.txt; tail -n +2 gap.txt | sort -k 2; } >sorted.txt
{ cat gap.txt; tail -n +2 gap.txt | awk '{ $1 += 42000; $2 += 42000; print }'; } >patches.txt
outline() {  # EXIT_CODE NAME VOID_RULE REASONS_OR_KINDS AREA LEFT_OUT
  local code=0
  "$program" check "$2" --void-rule "$3" --out outline >outline.txt 2>outline.err || code=$?
  [[ $code == "$1" ]] || { echo "exit code $code of: $2"; cat outline.txt outline.err; exit 1; }
  python3 - "${@:4}" <<'END'
import json, sys
found = json.load(open("outline/voids.json"))
kinds = [void["kind"] for void in found["voids"]]
assert ", ".join(found["undecided"] or kinds) == sys.argv[1] and found["file"] is None, (found["undecided"], kinds)
for name, expected in zip(("area", "left_out"), map(float, sys.argv[2:])):
    assert abs(found[name] - expected) < .03 * max(expected, 2000), (name, found[name])
END
}
for rule in 2 3 9; do
  outline 0 whole.txt $rule "" 4731 0  # 79.5 x 59.5
  head -n 1 outline.txt | grep -qx "covered within its own outline"
  grep -q "^  area *the scan's own outline, 1 polygon in cells of 0\.5, without .* of its convex hull$" outline.txt
  outline 3 river.txt $rule "several parts" 3999 720
  outline 3 gap.txt $rule "bay" 4124 592
  cp outline/voids.json gap.json
  grep -q "^lacuna: outline of the scan: not decided: the outline of the scan leaves out a bay .*; --area states" outline.err
  outline 3 sorted.txt $rule "bay" 4124 592
  cmp gap.json outline/voids.json
  outline 3 arms.txt $rule "bay" 2999 878
  outline 3 patches.txt $rule "several parts, bay" 8248
done
outline 3 corner.txt 3 "bay" 4441 143
outline 0 corner.txt 12 "" 4441 143
outline 3 thin.txt 8 "several parts" 2350 0
grep -q "^not decided: the scan has 1 large part and many small ones, and its outline leaves out" outline.txt
outline 1 notch.txt 3 open 4731 0
outline 1 pond.xyz 3 hole 4731 0
# Parts are checked one by one, and squares of the table that both have are one.
awk 'BEGIN { print "x y z"; for (i = 0; i < 160; i++) for (j = 0; j < 80; j++) if (i < 60 || i > 70) print i / 2, j / 2, 0 }' >halves.txt
"$program" check halves.txt --void-rule 3 --area-tile 20 --out halves --quiet 2>halves.err || [[ $? == 3 ]]
python3 - <<'END'
import json
found = json.load(open("halves/voids.json"))
tiles = found["tiles"]
assert found["undecided"] == ["several parts"] and abs(found["spacing"] - .5) < .02, found["spacing"]
assert len({tuple(tile["corner"]) for tile in tiles}) == len(tiles) == 8, len(tiles)
assert sum(tile["points"] for tile in tiles) == found["points"] and len(found["polygons"]) == 2
for name in ("tiles", "polygons"):
    assert abs(sum(each["area"] for each in found[name]) - found["area"]) < 1e-6, name
END

# ---- the sheet of a check, and the colours of its layers
"$program" check pond.xyz --void-rule anps:0.75 --unit m --out sheet --report --quiet 2>sheet.err || true
grep -q '<script type="application/json" id="area">{"lacuna":.*"title":"pond.xyz"}</script>' sheet/report.html
if command -v chromium >/dev/null; then
chromium --headless=new --no-sandbox --dump-dom "file://$work/sheet/report.html" >sheet.html 2>/dev/null
python3 - <<'END'
from html.parser import HTMLParser
class Sheet(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags, self.text, self.paths = [], "", {}
    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag == "path": self.paths.setdefault(dict(attributes)["class"], []).append(dict(attributes)["d"])
    def handle_data(self, data):
        self.text += data + "\n"
sheet = Sheet()
sheet.feed(open("sheet.html").read())
for text in ("voids: 1 of 3 m or more", "anps:0.75", "U.S. Geological Survey, Lidar Base Specification", "Covered", "Project",
             "Client", "Checked on", "This check does not show", "the scan's own outline", "pond.xyz", "Largest circle"):
    assert text in sheet.text, text
assert sheet.tags.count("input") == 6 and len(sheet.paths["counts"]) == 1 and len(sheet.paths["tile"]) > 100, sheet.paths.keys()
END
fi
ogrinfo -q sheet/voids.gpkg -sql "SELECT f_table_name, f_geometry_column, useAsDefault, styleQML FROM layer_styles" >styles.txt
for layer in lacuna_voids lacuna_area lacuna_area_tiles; do grep -q "f_table_name .* = $layer$" styles.txt; done
grep -q 'renderer-v2 type="singleSymbol"' styles.txt
"$program" check pond.xyz --area sheet/voids.gpkg --void-rule 3 --quiet 2>again.err || true  # a table without geometries is none
grep -q "voids.gpkg: voids: " again.err

# ---- points that cover nothing, and points that are there twice
python3 - <<'END'
import random
draw = random.Random(1)
places = [(i / 2 + draw.uniform(-.1, .1), j / 2 + draw.uniform(-.1, .1)) for i in range(80) for j in range(80)]
def write(name, rows):
    with open(name, "w") as out:
        print("x y z return_number synthetic gps_time", file=out)
        for x, y, *more in rows:
            print(f"{x:.3f} {y:.3f} 0", *more, file=out)
def is_filled(x, y):
    return max(abs(x - 20), abs(y - 20)) < 3
write("filled.txt", [(x, y, 1, int(is_filled(x, y)), i) for i, (x, y) in enumerate(places)])
write("synthetic.txt", [(x, y, 1, 1, i) for i, (x, y) in enumerate(places)])
write("later.txt", [(x, y, 2, 0, i) for i, (x, y) in enumerate(places)])
write("mixed.txt", [(x, y, 1 + i % 2, 0, i) for i, (x, y) in enumerate(places)])
write("west.txt", [(x, y, 1, 0, i) for i, (x, y) in enumerate(places) if x < 25])
write("east.txt", [(x, y, 1, 0, i) for i, (x, y) in enumerate(places) if x > 15])
write("strip.txt", [(x, y, 1, 0, i + 1e5) for i, (x, y) in enumerate(places) if x > 15])
with open("swaths.txt", "w") as out:
    print("x y z point_source_id", file=out)
    for i, (x, y) in enumerate(places):
        print(f"{x:.3f} {y:.3f} 0", 3 + i % 2, file=out)
    print("39.9 39.9 0 9", file=out)
with open("earth.txt", "w") as out:
    for x, y in places:
        print(4264423 + x, 690634 + y, 4678943, file=out)
with open("many.txt", "w") as out:
    print("x y z", file=out)
    for i in range(700):
        for j in range(700):
            print(2 + i * .05, 2 + j * .05, 0, file=out)
END
echo '{"type":"Polygon","coordinates":[[[2,2],[38,2],[38,38],[2,38],[2,2]]]}' >some.geojson
on=(--area some.geojson --void-rule 2.4)
check() {  # EXIT_CODE ARGUMENT...
  local code=0
  "$program" check "${@:2}" "${on[@]}" >checked.txt 2>checked.err || code=$?
  [[ $code == "$1" ]] || { echo "exit code $code of: ${*:2}"; cat checked.txt checked.err; exit 1; }
}
check 1 filled.txt
grep -q "^voids: 1 of 2.40 or more (1 hole)" checked.txt
grep -q "^lacuna: some.geojson: voids: 1 of" checked.err  # an answer, and no error
grep -q "; 14[0-9] synthetic points take no part" checked.txt
"$program" detect filled.txt --out filled >filled.out 2>filled.err
grep -q "; 14[0-9] flagged as synthetic, which were not measured" filled.out
check 0 mixed.txt
grep -q "; 2,[0-9]* later returns take no part" checked.txt
grep -q "^  returns *first ones alone$" checked.txt
grep -q "^  point classes *all: no file states them$" checked.txt
grep -q "^  swaths *all: no file states them$" checked.txt
check 0 swaths.txt
grep -q "^  returns *all: no file states them$" checked.txt
grep -q "^  swaths *2 values of point_source_id" checked.txt  # the third is out of the area
grep -q "^  area *some.geojson, 1 polygon$" checked.txt
grep -q "^  a point *covers what is nearer than 1.2; spacing 0.[45]" checked.txt
check 0 mixed.txt --where "return_number == 1"
grep -q "^  point classes *.*, where return_number == 1$" checked.txt
check 0 swaths.txt mixed.txt
grep -q "^  returns *first ones alone; all points of 1 file, which state none$" checked.txt
check 0 west.txt east.txt --area-tile 20 --out tiles
python3 -c 'import json
found = json.load(open("tiles/voids.json"))
assert dict(found["basis"])["returns"] == "first ones alone" and "narrower" in found["not_shown"][0]'
grep -q "; 1,[0-9]* points that are there again count once" checked.txt
check 0 west.txt strip.txt --area-tile 20 --out strips
python3 - <<'END'
import json
once, twice = ([tile["density"] for tile in json.load(open(name + "/voids.json"))["tiles"]] for name in ("tiles", "strips"))
assert all(3.8 < density < 4.2 for density in once), once
assert all(4.8 < density < 5.3 for density in twice), twice
END
# Tiles that were written anew, with other decimals and another offset.
python3 - <<'END'
rows = [line.split() for line in open("east.txt").read().splitlines()[1:]]
with open("anew.txt", "w") as out:
    print("x y z return_number synthetic gps_time", file=out)
    for x, y, *more in rows:
        print(*(f"{round((float(v) - .005) * 100) / 100 + .005:.3f}" for v in (x, y)), *more, file=out)
END
check 1 east.txt anew.txt
grep -q "; 3,[0-9]* points that are there again count once" checked.txt
for name in east anew; do cut -d " " -f 1-3 $name.txt >$name.places.txt; done
check 1 {east,anew}.places.txt
grep -q "warning: about 3,[0-9]* points without a time have another within a 25th of the spacing" checked.err
# Too many to hold: a sample of them counts, and each as often as it is there.
check 1 many.txt many.txt --memory-limit 112MiB
grep -q "warning: about 4[789][0-9],... points in the area are there twice" checked.err

# ---- points whose heights lie apart
python3 - <<'END'
import math
rows = [line.split() for line in open("filled.txt").read().splitlines()[1:]]
def write(name, height):
    with open(name, "w") as out:
        print("x y z", file=out)
        for i, (x, y, _, _, synthetic, _) in enumerate(rows):
            z = height(i) if synthetic == "1" else 300 + 2 * math.sin(float(x))
            print(x, y, z, file=out)
write("no_data.txt", lambda i: -9999)
END
check 3 no_data.txt --quiet --out apart
grep -q "warning: 14[0-9] points in the bounds of the area at heights of .*, cover nothing" checked.err
grep -q "some.geojson: not decided: its voids are covered if 14[0-9] points count" checked.err
python3 -c 'import json; found = json.load(open("apart/voids.json"))
assert found["undecided"] == ["heights apart"] and len(found["voids"]) == 1 and 36 < found["voids"][0]["area"] < 49, found'
check 1 no_data.txt --bounds 0,0,0,40,40,1000  # the user states heights
grep -q "^voids: 1 of 2.40 or more (1 hole)" checked.txt
check 0 no_data.txt --bounds 0,0,-10000,40,40,1000
# A void that is there in any case decides.
awk 'NR == 1 || !($1 > 8 && $1 < 14 && $2 > 8 && $2 < 14)' no_data.txt >hollow.txt
check 1 hollow.txt
grep -q "^voids: 2 of 2.40 or more (2 holes)" checked.txt

# ---- what is not decided
python3 - <<'END'
import struct, subprocess
def write(name, x0, system):
    wkt = subprocess.run(["gdalsrsinfo", "-o", "wkt1", system], check=True, capture_output=True).stdout.strip() + b"\0"
    places = [(x0 + i * 500, j * 500, 0) for i in range(80) for j in range(80)]
    bounds = [(x0 + 39_500) / 1000, x0 / 1000, 39.5, 0, 0, 0]
    head = struct.pack("<4sHH16sBB32s32sHHHIIBHI5I3d3d6dQQIQ15Q", b"LASF", 0, 16, b"", 1, 4, b"", b"", 1, 2026, 375,
                       375 + 54 + len(wkt), 1, 6, 30, 0, *[0] * 5, *[.001] * 3, *[0] * 3, *bounds, 0, 0, 0,
                       len(places), len(places), *[0] * 14)
    head += struct.pack("<H16sHH32s", 0, b"LASF_Projection", 2112, len(wkt), b"") + wkt
    points = (struct.pack("<iiiHBBBBhHd", *place, 0, 17, 0, 2, 0, 0, 0, 0) for place in places)
    open(name, "wb").write(head + b"".join(points))
write("utm32.las", 0, "EPSG:25832")
write("utm33.las", 20_000, "EPSG:25833")
with open("sparse.txt", "w") as out:
    print("x y z", file=out)
    for i in range(21):
        for j in range(21):
            print(2 * i, 2 * j, 0, file=out)
END
undecided() {  # REASON TEXT ARGUMENT...
  check 3 "${@:3}" --out undecided
  grep -q "^lacuna: some[.a-z]*: not decided: $2" checked.err || { echo "not '$2' but:"; cat checked.err; exit 1; }
  grep -q "^not decided: $2" checked.txt
  [[ $(grep -c "of it covered" checked.txt) == 0 ]]
  python3 -c 'import json, sys
found = json.load(open("undecided/voids.json"))
assert found["answer"] == "not decided" and found["undecided"] == [sys.argv[1]], found["undecided"]' "$1"
  ogrinfo -q -al undecided/voids.gpkg lacuna_area >layer.txt
  grep -q "answer (String) = not decided" layer.txt
}
undecided "synthetic points alone" "all 5,[0-9]* points in it are flagged as synthetic" synthetic.txt
undecided "no first return" "no first returns that were measured are in it, but 5,[0-9]* later returns, which" later.txt
undecided "no point" "no point of the scan is in its bounds" utm.xyz --columns "x y z"
undecided "few points" "too few points: their spacing is 2.00, and voids of 2.40 need 1.70 or less" sparse.txt
ogr2ogr -f GPKG -a_srs EPSG:25832 some.gpkg some.geojson
on=(--area some.gpkg --void-rule 2.4)
check 0 utm32.las
undecided "different systems" "files of the scan have different coordinate" utm32.las utm33.las
on=(--area some.geojson --void-rule 2.4)

# ---- what is refused
refuse() {
  local expected=$1
  shift
  local code=0
  "$program" "$@" >refused.txt 2>refused.err || code=$?
  [[ $code == 1 || $code == 2 ]] || { echo "exit code $code of: $*"; exit 1; }
  grep -q -- "$expected" refused.err || { echo "not '$expected' but:"; cat refused.err; exit 1; }
  [[ $(wc -l <refused.err) -le 3 ]]
}
some=(holes.xyz --columns "x y z" --out refused)
refuse "--void-rule is required for an area; allowed: a length above 0, or" check "${some[@]}" --area holes.geojson
refuse "nothing.gpkg: cannot be opened: No such file" check "${some[@]}" --area nothing.gpkg --void-rule 4
refuse "holes.xyz: cannot be read as GeoPackage" check "${some[@]}" --area holes.xyz --void-rule 4
refuse "void_rule = 1e-6: the area has .* cells of an eighth of this size, more than .* allowed: a size of .* or more" check "${some[@]}" \
  --area holes.geojson --void-rule 1e-6
refuse "void_rule = \"anps:QL9\"; allowed: a length above 0, or" check "${some[@]}" --area holes.geojson --void-rule anps:QL9
refuse "void_rule = 4m is a length in m, and the scan states no unit" check "${some[@]}" --area holes.geojson --void-rule 4m
refuse "area_tile is less than the void size, 4.0" check "${some[@]}" --area holes.geojson --void-rule 4 --area-tile 3
mkfifo pipe.geojson
for options in "--area pipe.geojson" "--area holes.geojson --except pipe.geojson" "--area holes.geojson --classes pipe.geojson"; do
  refuse "pipe.geojson: is not a regular file; a file of polygons is needed" check "${some[@]}" --void-rule 4 $options
done
# A view may have no end.
cp some.gpkg view.gpkg
python3 - <<'END'
import sqlite3
with sqlite3.connect("view.gpkg") as file:
    file.execute("CREATE VIEW endless AS WITH n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
                 "SELECT n.i AS fid, some.geom AS geom FROM n, some WHERE n.i < 0")
    file.execute("INSERT INTO gpkg_contents SELECT 'endless', data_type, 'endless', '', last_change, NULL, NULL, NULL, NULL, "
                 "srs_id FROM gpkg_contents WHERE table_name = 'some'")
    file.execute("INSERT INTO gpkg_geometry_columns SELECT 'endless', 'geom', geometry_type_name, srs_id, z, m "
                 "FROM gpkg_geometry_columns WHERE table_name = 'some'")
END
refuse "view.gpkg: layer endless is no table, but a view, which may have no end; .ogr2ogr" check "${some[@]}" \
  --area view.gpkg --void-rule 4
# A polygon of a table or of a Shapefile that does not fit in memory is refused (memory_test: of GeoJSON).
python3 - <<'END'
import json, math
corners = 600_000
ring = [[50 + (30 + i % 2) * f(2 * math.pi * i / corners) for f in (math.cos, math.sin)] for i in range(corners)]
json.dump({"type": "Polygon", "coordinates": [ring + ring[:1]]}, open("coast.geojson", "w"))
END
ogr2ogr -f GPKG -a_srs EPSG:25832 coast.gpkg coast.geojson
ogr2ogr -f "ESRI Shapefile" -a_srs EPSG:25832 coast.shp coast.geojson
for file in coast.gpkg coast.shp; do
  refuse "$file: .* corners of polygons, .* of them in one, take more than the 42 MiB that the memory limit leaves .* allowed: 550502 in one" \
    check "${some[@]}" --area $file --void-rule 4 --memory-limit 112MiB
done
refuse "water.geojson: a file of --classes before it has this name, too: water" check "${some[@]}" --area holes.geojson \
  --void-rule 4 --classes water.gpkg,water.geojson
refuse "2: no such file; --classes takes files of polygons, and --where 'Classification == 2'" check "${some[@]}" \
  --area holes.geojson --void-rule 4 --classes 2
echo '{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}]}' >point.geojson
refuse "point.geojson: has no polygon" check "${some[@]}" --area point.geojson --void-rule 4
python3 - <<'END'
import random
draw = random.Random(1)
with open("wide.xyz", "w") as out:
    for i in range(90_000):
        print(draw.uniform(0, 300), draw.uniform(0, 300), 0, file=out)
END
echo '{"type":"Polygon","coordinates":[[[0,0],[299,0],[299,299],[0,299],[0,0]]]}' >wide.geojson
refuse "points are so far apart that outlines of voids have .* edges" check wide.xyz --columns "x y z" --area wide.geojson \
  --void-rule 1.5 --memory-limit 112MiB
refuse "area_tile = 0.5: the area has 360000 squares with this edge, more than .* allowed: an edge of 1.3.* or more" check wide.xyz \
  --columns "x y z" --area wide.geojson --void-rule 0.5 --area-tile 0.5 --memory-limit 112MiB
refuse "--void-rule is required for an area" check "${some[@]}"
echo '{"type":"Polygon","coordinates":[[[0,0],[1e308,0],[1,1],[0,0]]]}' >beyond.geojson
awk 'NR < 3' whole.txt >one.xyz
awk 'NR % 120 == 1' whole.txt >row.xyz
refuse "corner beyond 1e30" check "${some[@]}" --area holes.geojson --void-rule 4 --except beyond.geojson
refuse "corner beyond 1e30" check "${some[@]}" --area holes.geojson --void-rule 4 --classes beyond.geojson
refuse "the points cover no area, so that the scan has no outline; --area states one" check one.xyz --void-rule 3
refuse "the points cover no area, so that the scan has no outline; --area states one" check row.xyz --void-rule 3
refuse "earth.txt: its places are geocentric, as of EPSG:4978, and --area needs a plan; .*EPSG:32632" check earth.txt \
  --columns "x y z" "${on[@]}"
refuse "is geocentric, and --area needs a plan; .*EPSG:32632" check earth.txt --columns "x y z" --crs EPSG:4936 "${on[@]}"
refuse "is geocentric, and --coverage needs a plan" detect earth.txt --columns "x y z" --crs EPSG:4978 --coverage 1 --out refused
refuse "utm.holes.json: its coordinates, such as 5.*, are read as degrees by RFC 7946, .*a GeoPackage" check utm.xyz \
  --columns "x y z" --crs EPSG:25832 --area utm.holes.json --void-rule 4
refuse "memory_limit = 64MiB is too little for files for GIS" check west.txt "${on[@]}" --memory-limit 64MiB
mkdir -p refused
echo mine >refused/voids.csv
refuse "refused/voids.csv: " check "${some[@]}" --area holes.geojson --void-rule 4
[[ $(cat refused/voids.csv) == mine ]]
