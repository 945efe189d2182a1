#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether holes.json is as docs/holes.schema.json says, by a validator that is not ours.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${LACUNA_PROGRAM:?}
bench=${LACUNA_BENCH_PROGRAM:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$bench" synth surface "$work/torus.ply" --kind torus --points 20000 --holes 3 >/dev/null
printf '0 0 0\n1 0 0\nnan 0 0\n' >"$work/few.xyz"
printf '%s\n' "$work/torus.ply" "$work/few.xyz pose=5 0 0 0 0 0 1" >"$work/list"
"$program" detect "$work/torus.ply" --out "$work/one" --quiet
"$program" detect "@$work/list" --out "$work/two" --quiet --no-coordinates
"$program" detect "$work/few.xyz" --out "$work/none" --quiet 2>/dev/null
"$program" detect "$work/torus.ply" --out "$work/local" --quiet --local-coordinates

"$bench" synth scan "$work/room.ply" --points 60000 >/dev/null
"$program" detect "$work/room.ply" --out "$work/room" --quiet --stations "$work/room.stations.txt"

# Debian's own python3, since python3-jsonschema is a package of it.
/usr/bin/python3 - docs/holes.schema.json "$work"/{one,two,none,local,room}/holes.json <<'END'
import csv, json, sys
from pathlib import Path
import jsonschema

schema = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
reports = [json.loads(Path(name).read_text(encoding="utf-8")) for name in sys.argv[2:]]
for report in reports:
    validator.validate(report)
one, two, none, local, room = reports
assert [station["name"] for station in room["stations"]] == ["station_0", "station_1"]
assert any(loop["cause"] and loop["cause"]["hidden_by"] for loop in room["loops"])
assert len(one["loops"]) == 3 and not none["loops"]
assert all(len(loop["ids"]) == len(loop["coordinates"]) == loop["points"] for loop in one["loops"])
assert [loop["ids"] for loop in two["loops"]] == [loop["ids"] for loop in one["loops"]]
assert two["inputs"][1]["first_id"] == one["counts"]["points"]
assert two["inputs"][1]["points"] == 3 and two["inputs"][1]["pose"][3] == 5
assert all(report["offset"] is None for report in (one, two, none))
bounds = local["strays"]["rest"]
assert all(abs(2 * at - low - high) <= 1 for at, low, high in zip(local["offset"], bounds["min"], bounds["max"]))
assert local["loops"] == one["loops"]
with open(Path(sys.argv[2]).parent / "holes.csv", encoding="utf-8", newline="") as table:
    rows = list(csv.DictReader(table))
assert sorted(int(row["id"]) for row in rows) == [loop["id"] for loop in one["loops"]]
assert all(abs(float(row["area"]) - one["loops"][int(row["id"])]["area"]) <= 1e-6 * float(row["area"]) for row in rows)
holes = [float(row["area"]) for row in rows if row["kind"] == "hole"]
assert rows[0]["kind"] == "hole" and holes == sorted(holes, reverse=True)

for break_it in (lambda r: r.pop("schema"), lambda r: r.pop("offset"), lambda r: r.update(offset=[0.5, 0, 0]),
                 lambda r: r.update(offset=[0, 0]), lambda r: r["loops"][0].update(kind="rim"), lambda r: r.update(tiles=4)):
    broken = json.loads(json.dumps(one))
    break_it(broken)
    assert not validator.is_valid(broken)
END
