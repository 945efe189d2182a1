# SPDX-License-Identifier: Apache-2.0
"""The check of an area, cell by cell, as io/explain/area/check_area.hpp defines it.

area_reference.py CASE SCAN AREA EXCEPT    makes a case, and prints its size, its columns and its voids
area_reference.py --compare EXPECTED RESULT EXIT_CODE
"""
import csv
import json
import math
import random
import sys

CELLS = 8


# ---- cases

def jittered(draw, x0, x1, y0, y1, is_kept=lambda x, y: True):
    """A point near the middle of each unit square."""
    points = [(x + draw.uniform(.1, .9), y + draw.uniform(.1, .9)) for x in range(x0, x1) for y in range(y0, y1)]
    return [(round(x, 3), round(y, 3)) for x, y in points if is_kept(x, y)]


def square(x0, y0, x1, y1):
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def circle(x, y, radius, corners=40):
    return [[x + radius * math.cos(2 * math.pi * i / corners), y + radius * math.sin(2 * math.pi * i / corners)]
            for i in range(corners)]


def case_of(name):
    """Size of the least void, points, polygons of the area, exceptions. A polygon is a list of rings."""
    draw = random.Random(name)
    beyond = lambda x, y, radius: lambda px, py: math.hypot(px - x, py - y) >= radius
    if name == "swaths":  # three with gaps between them; the last gap is too narrow
        points = [p for x in (0, 28, 51) for p in jittered(draw, x, x + 20, 0, 60)]
        return 4, points, [[square(2, 2, 69, 58)]], []
    if name == "holes":  # one inside, one at the border, one in an exception, one half in it
        kept = [beyond(15, 15, 4), beyond(60, 30, 4), beyond(40, 45, 5), beyond(20, 45, 5)]
        points = jittered(draw, 0, 70, 0, 60, lambda x, y: all(keep(x, y) for keep in kept))
        return 4, points, [[square(1.3, 1.7, 60, 58)]], [[circle(40, 45, 6)], [square(10, 30, 20, 60)]]
    if name == "islands":  # an area of two parts, one with a hole in it
        points = jittered(draw, 0, 60, 0, 40, beyond(15, 20, 5))
        return 4, points, [[square(2, 2, 28, 38), square(10, 15, 14, 25)], [circle(45, 20, 12)]], []
    if name == "larger":  # than the scan
        return 4, jittered(draw, 0, 30, 0, 30, beyond(12, 12, 4)), [[square(-20.3, -15.1, 55, 42)]], []
    if name == "hull":  # a scan like an L, a gap along its diagonal edge
        return 4, jittered(draw, 0, 50, 0, 20) + jittered(draw, 0, 20, 20, 50), [[square(0, 0, 50, 50)]], []
    if name == "random":  # points by chance: many voids of nearly the least size
        points = [(round(draw.uniform(0, 50), 3), round(draw.uniform(0, 50), 3)) for _ in range(2500)]
        return 3, points, [[circle(25, 25, 23)]], []
    if name == "returns":  # second returns in a hole, which do not count
        points = jittered(draw, 0, 40, 0, 40, beyond(20, 20, 6))
        return 4, points, [[square(1, 1, 39, 39)]], []
    raise SystemExit(f"no case {name}")


def write_polygons(file, polygons):
    features = [{"type": "Feature", "properties": {},
                 "geometry": {"type": "Polygon", "coordinates": [ring + ring[:1] for ring in rings]}}
                for rings in polygons or [[square(1e4, 1e4, 1e4 + 1, 1e4 + 1)]]]
    json.dump({"type": "FeatureCollection", "features": features}, open(file, "w"))


# ---- the definition

def is_inside(rings, x, y):
    inside = False
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            if (ay <= y) != (by <= y) and ax + (y - ay) / (by - ay) * (bx - ax) > x:
                inside = not inside
    return inside


def hull_of(points):
    """By gift wrapping, counter-clockwise."""
    start = min(points)
    hull, at = [], start
    while True:
        hull.append(at)
        best = None
        for p in points:
            if p == at:
                continue
            turn = 0 if best is None else (best[0] - at[0]) * (p[1] - at[1]) - (best[1] - at[1]) * (p[0] - at[0])
            if best is None or turn < 0 or (turn == 0 and math.dist(at, p) > math.dist(at, best)):
                best = p
        at = best
        if at == start:
            return hull


def voids_of(size, points, area, exceptions):
    edge = size / CELLS
    corners = [corner for rings in area for ring in rings for corner in ring]
    low = [math.floor(min(c[k] for c in corners) / edge) for k in (0, 1)]
    high = [math.ceil(max(c[k] for c in corners) / edge) for k in (0, 1)]
    middle = lambda cell: ((cell[0] + .5) * edge, (cell[1] + .5) * edge)
    inside = {(i, j) for i in range(low[0], high[0]) for j in range(low[1], high[1])
              if any(is_inside(rings, *middle((i, j))) for rings in area)}
    buckets = {}
    for x, y in points:
        buckets.setdefault((math.floor(x / size), math.floor(y / size)), []).append((x, y))

    def distance(x, y):
        i, j = math.floor(x / size), math.floor(y / size)
        near = (p for di in (-1, 0, 1) for dj in (-1, 0, 1) for p in buckets.get((i + di, j + dj), ()))
        return min((math.hypot(px - x, py - y) for px, py in near), default=math.inf)

    def has_empty(x, y, half):
        at = distance(x, y)
        if at >= size / 2 or half < edge / 100 or at + half * math.sqrt(2) < size / 2:
            return at >= size / 2
        return any(has_empty(x + dx, y + dy, half / 2) for dx in (-half / 2, half / 2) for dy in (-half / 2, half / 2))

    empty = {cell for cell in inside if distance(*middle(cell)) >= size / 2}
    beside = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    empty |= {cell for cell in inside if not any((cell[0] + i, cell[1] + j) in empty for i, j in beside)
              and has_empty(*middle(cell), edge / 2)}
    bounds = [(low[k] * edge, high[k] * edge) for k in (0, 1)]
    hull = [hull_of([p for p in points if all(bounds[k][0] <= p[k] < bounds[k][1] for k in (0, 1))])]
    in_hull = {cell for cell in inside if is_inside(hull, *middle(cell))}
    reach = CELLS // 2
    disc = [(di, dj) for di in range(-reach, reach + 1) for dj in range(-reach, reach + 1) if math.hypot(di, dj) <= reach]

    def grown(cells):
        return {(i + di, j + dj) for i, j in cells for di, dj in disc} & inside

    sides = ((-1, 0), (1, 0), (0, -1), (0, 1))
    values = {cell: "outside" for cell in grown(empty - in_hull)}
    values.update({cell: "inside" for cell in grown(empty & in_hull)})
    is_excepted = lambda cell: any(is_inside(rings, *middle(cell)) for rings in exceptions)
    voids, seen, missing = [], set(), set()
    for first in sorted(values):
        if first in seen:
            continue
        seen.add(first)
        part = [first]
        for i, j in part:  # which grows
            for di, dj in sides:
                cell = (i + di, j + dj)
                if values.get(cell) == values[first] and cell not in seen:
                    seen.add(cell)
                    part.append(cell)
        if len(part) < math.pi * reach * reach / 4:  # a sliver that the hull cuts off
            continue
        border = [(i + di, j + dj) for i, j in part for di, dj in sides] + part
        kind = values[first]
        if kind == "inside":
            kind = "hole" if all(cell in inside and cell in in_hull for cell in border) else "open"
        counts = any(cell in empty and not is_excepted(cell) for cell in part) if exceptions else True
        excepted = sum(map(is_excepted, part)) / len(part)
        missing |= {cell for cell in part if counts and not is_excepted(cell)}
        voids.append({"kind": kind, "counts": int(counts), "area": len(part) * edge * edge, "excepted": excepted})
    count = sum((math.floor(x / edge), math.floor(y / edge)) in inside for x, y in points)
    polygons = []
    for rings in area:
        cells = {cell for cell in inside if is_inside(rings, *middle(cell))}
        polygons.append([len(cells) * edge * edge, len(cells & missing) * edge * edge])
    return {"area": len(inside) * edge * edge, "points": count, "voids": voids, "polygons": polygons}


def compare(expected, result, code):
    expected = json.loads(open(expected).read().split("\n", 1)[1])
    found = json.load(open(result + "/voids.json"))
    rows = list(csv.DictReader(open(result + "/voids.csv")))
    key = lambda v: (v["kind"], int(v["counts"]), round(float(v["area"]), 6), round(float(v["excepted"]), 6))
    assert sorted(map(key, rows)) == sorted(map(key, expected["voids"])), (sorted(map(key, rows)), sorted(map(key, expected["voids"])))
    assert rows, "the case has no void"
    order = [(-int(v["counts"]), -float(v["area"])) for v in rows]
    assert order == sorted(order)
    assert abs(found["area"] - expected["area"]) < 1e-6 and found["points"] == expected["points"], found["points"]
    counting = sum(v["counts"] for v in expected["voids"])
    assert found["counting"] == counting and found["answer"] == ("voids" if counting else "covered")
    assert int(code) == (1 if counting else 0), code
    missing = sum(v["area"] * (1 - v["excepted"]) for v in expected["voids"] if v["counts"])
    assert abs(found["missing_area"] - missing) < 1e-6
    polygons = [(p["answer"], round(p["area"], 6), round(p["area"] * (1 - p["covered"]), 6)) for p in found["polygons"]]
    assert polygons == [("voids" if missing else "covered", round(area, 6), round(missing, 6))
                        for area, missing in expected["polygons"]], (polygons, expected["polygons"])
    largest = max((v["circle"] for v in found["voids"] if v["counts"]), default=0)
    assert max(p["circle"] for p in found["polygons"]) == largest
    tiles = found["tiles"]
    assert abs(sum(t["area"] for t in tiles) - found["area"]) < 1e-6
    assert abs(sum(t["area"] * (1 - t["covered"]) for t in tiles) - found["voids_area"]) < 1e-6
    assert sum(t["points"] for t in tiles) == found["points"] and sum(t["voids"] for t in tiles) == counting
    for void in found["voids"]:  # its largest circle lies in it
        assert void["circle"] >= .99 * found["void_size"] or void["kind"] != "hole", void["circle"]
        assert is_inside(void["outline"], *void["middle"])


def main():
    if sys.argv[1] == "--compare":
        return compare(*sys.argv[2:])
    name, scan, area_file, except_file = sys.argv[1:]
    size, points, area, exceptions = case_of(name)
    with open(scan, "w") as out:
        for x, y in points:
            print(x, y, round(math.sin(x / 20), 3), *([1] if name == "returns" else []), file=out)
        if name == "returns":
            for x, y in jittered(random.Random(9), 14, 26, 14, 26):
                print(x, y, 0, 2, file=out)
    write_polygons(area_file, area)
    write_polygons(except_file, exceptions)
    print(size, "x y z" + (" return_number" if name == "returns" else ""))
    print(json.dumps(voids_of(size, points, area, exceptions or [[square(1e4, 1e4, 1e4 + 1, 1e4 + 1)]])))


if __name__ == "__main__":
    main()
