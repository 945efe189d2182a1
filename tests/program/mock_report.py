#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes report.html of a synthetic scan, in the format that `lacuna detect --report` has, to work on the page without it.

    mock_report.py OUT.html [--points N] [--holes N] [--utm] [--colours] [--no-loops] [--empty] [--no-run] [--flat-loops N] [--stations N]
    mock_report.py OUT.html --ply SCAN.ply          # an ASCII or float PLY; loops of SCAN.ply.loops.txt if it is there

The scan is a bumpy sheet of 10 x 7 m with holes and its outer edge. Needs Debian's libjs-three and Python 3 alone.
"""

import argparse
import base64
import hashlib
import json
import math
import random
import re
import struct
from array import array
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "io" / "report" / "page"
THREE = Path("/usr/share/javascript/three")


def page_parts(kind):
    """The styles or scripts of the page, put together as CMake does."""
    names = re.search(rf"set\(page_{kind}s ([^)]*)\)", (PAGE / "page.cmake").read_text()).group(1).split()
    return "\n".join((PAGE / f"{name}.{'css' if kind == 'style' else 'js'}").read_text() for name in names)


WIDTH, DEPTH = 10.0, 7.0


class Frame:
    """The cube around the scan: 21 bits per axis."""

    def __init__(self, low, high):
        self.edge = max(max(h - l for l, h in zip(low, high)), 1e-9)
        self.origin = list(low)

    def pack(self, places):
        out = bytearray()
        for place in places:
            x, y, z = (min(2097151, max(0, int((value - origin) / self.edge * 2097152)))
                       for value, origin in zip(place, self.origin))
            out += struct.pack("<Q", x | y << 21 | z << 42)
        return bytes(out)


def octahedral(normal):
    x, y, z = normal
    size = abs(x) + abs(y) + abs(z) or 1.0
    x, y, z = x / size, y / size, z / size
    if z < 0:
        x, y = (1 - abs(y)) * math.copysign(1, x), (1 - abs(x)) * math.copysign(1, y)
    return round(127 * x), round(127 * y)


def measures(number, is_hole, vertices, confidence, planarity):
    """A loop as holes.json has it."""
    centre = [sum(v[k] for v in vertices) / len(vertices) for k in range(3)]
    normal, perimeter, diameter = [0.0, 0.0, 0.0], 0.0, 0.0
    for a, b in zip(vertices, vertices[1:] + vertices[:1]):
        u, v = [a[k] - centre[k] for k in range(3)], [b[k] - centre[k] for k in range(3)]
        normal = [normal[k] + (u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2]) / 2 for k in range(3)]
        perimeter += math.dist(a, b)
        diameter = max(diameter, 2 * math.dist(a, centre))
    area = math.hypot(*normal)
    return {"id": number, "kind": "hole" if is_hole else "outer", "parent": None, "points": len(vertices), "confidence": confidence,
            "prominence": short(confidence), "first_scale": 0, "last_scale": 0.5,
            "perimeter": short(perimeter), "area": short(area), "diameter": short(diameter), "planarity": planarity,
            "mean_probability": short(0.6 + 0.35 * confidence), "centroid": [round(value, 5) for value in centre],
            "normal": [short(value / (area or 1.0)) for value in normal], "vertices": vertices}


def short(value):
    return float(f"{value:.6g}")


CAUSES = ["hidden", "opening", "out_of_view", "no_return", "filtered"]


def stations_of(count, bounds):
    """As holes.json has them: over the diagonal of the scan, the first one with a long name."""
    low, high = bounds["min"], bounds["max"]
    names = ["a long name of a station, as in E57", *(f"station {i}" for i in range(1, count))]
    return [{"name": name, "place": [round(l + (h - l) * (i + 1) / (count + 1), 3) for l, h in zip(low[:2], high[:2])] + [high[2]],
             "points": 150000, "certainty": 0.6 if i == 2 else 0.999, "lowest_sine": -0.9, "highest_sine": 0.2, "turn": 1.0,
             "step": 0.003, "farthest": 12.0} for i, name in enumerate(names[:count])]


def add_causes(loops, stations, chance):
    """Each cause in turn, with a smaller second one; one hole of six has none. Outer curves have none."""
    holes = 0
    for loop in loops:
        loop.update({"cause": None, "hidden_by": None, "hidden_from": -1, "hidden_from_place": None, **{name: None for name in CAUSES}})
        if loop["kind"] == "outer" or not stations:
            continue
        main, holes = holes % 6, holes + 1
        if main == len(CAUSES):
            continue
        share = round(chance.uniform(0.6, 0.95), 3)
        loop.update({name: 0.0 for name in CAUSES}, cause=CAUSES[main])
        loop.update({CAUSES[main]: share, CAUSES[(main + 1) % 5]: round(0.995 - share, 3), CAUSES[(main + 2) % 5]: 0.005})
        if loop["hidden"] > 0.01:
            loop["hidden_from"] = (holes // 6) % len(stations)
            eye = loop["hidden_from_place"] = stations[loop["hidden_from"]]["place"]
            loop["hidden_by"] = [round(0.6 * c + 0.4 * e, 3) for c, e in zip(loop["centroid"], eye)]


def next_stations_of(stations):
    return [{"rank": i + 1, "place": [station["place"][0] + 1.5, station["place"][1] + 0.2, station["place"][2]],
             "area": round(0.4 / (i + 1), 4), "share": round(0.5 / (i + 1), 4)} for i, station in enumerate(stations[:3])]


class Sheet:
    """Points of z(x, y) outside of some wobbly discs, with the distance to the nearest edge as probability."""

    def __init__(self, count, holes, shift, chance):
        self.shift = shift
        self.holes = []
        while len(self.holes) < holes:
            x, y = chance.uniform(0.7, WIDTH - 0.7), chance.uniform(0.7, DEPTH - 0.7)
            hole = (x, y, 0.05 * 10 ** chance.uniform(0, 1), chance.uniform(0, 0.3), chance.randrange(2, 6))
            if all(math.hypot(x - h[0], y - h[1]) > 1.4 * (hole[2] + h[2]) for h in self.holes):
                self.holes.append(hole)
        self.points, self.normals, self.probabilities, self.colours = [], [], [], []
        self.spacing = math.sqrt(WIDTH * DEPTH / max(1, count))
        columns = max(1, round(WIDTH / self.spacing)) if count else 0
        rows = count // max(1, columns)
        for i in range(columns * rows):
            x = (i % columns + chance.random()) / columns * WIDTH
            y = (i // columns + chance.random()) / rows * DEPTH
            away = min(x, y, WIDTH - x, DEPTH - y)
            for hole in self.holes:
                dx, dy = x - hole[0], y - hole[1]
                if abs(dx) < 1 and abs(dy) < 1:
                    away = min(away, math.hypot(dx, dy) - self.radius(hole, math.atan2(dy, dx)))
            if away >= 0:
                self.add(x, y, away, chance)

    @staticmethod
    def radius(hole, angle):
        return hole[2] * (1 + hole[3] * math.sin(hole[4] * angle))

    @staticmethod
    def height(x, y):
        return (0.45 * math.sin(0.9 * x) * math.cos(0.8 * y) + 0.12 * math.sin(3.1 * x + 1.7 * y) +
                0.9 * math.exp(-((x - 6.5) ** 2 + (y - 4) ** 2) / 1.5))

    def place(self, x, y):
        return (x + self.shift[0], y + self.shift[1], self.height(x, y) + self.shift[2])

    def add(self, x, y, away, chance):
        step = 1e-3
        slope_x = (self.height(x + step, y) - self.height(x - step, y)) / (2 * step)
        slope_y = (self.height(x, y + step) - self.height(x, y - step)) / (2 * step)
        place = self.place(x, y)
        self.points.append((place[0], place[1], place[2] + chance.gauss(0, 0.1 * self.spacing)))
        self.normals.append(octahedral((-slope_x, -slope_y, 1)))
        near = max(0.0, 1 - away / (2.2 * self.spacing))
        self.probabilities.append(min(255, int(255 * min(1, chance.betavariate(2, 9) + 0.85 * near))))
        stripe = 30 if int(x * 2) % 2 == int(y * 2) % 2 else 0
        self.colours.append((120 + stripe, int(105 + 12 * y) + stripe // 2, 80 + stripe))

    def loops(self, chance):
        edge = [(WIDTH * t / 200, 0) for t in range(200)] + [(WIDTH, DEPTH * t / 140) for t in range(140)]
        edge += [(WIDTH - x, DEPTH - y) for x, y in edge]
        yield False, [self.place(x, y) for x, y in edge], 0.98, 0.71
        for hole in self.holes:
            count = max(12, round(6.3 * hole[2] / self.spacing))
            angles = [2 * math.pi * t / count for t in range(count)]
            radii = [self.radius(hole, angle) * (1 + chance.uniform(-0.02, 0.02)) for angle in angles]
            yield (True, [self.place(hole[0] + r * math.cos(a), hole[1] + r * math.sin(a)) for a, r in zip(angles, radii)],
                   round(chance.betavariate(6, 2), 4), round(1 - chance.betavariate(1, 12), 4))


def read_ply(path):
    """Vertices of an ASCII or binary little-endian PLY whose vertex properties are all scalars."""
    raw = path.read_bytes()
    end = raw.index(b"end_header\n") + len(b"end_header\n")
    header = raw[:end].decode().split("\n")
    names, count, element = [], 0, ""
    for words in (line.split() for line in header):
        if words[:1] == ["element"]:
            element, count = words[1], int(words[2]) if words[1] == "vertex" else count
        if words[:1] == ["property"] and element == "vertex":
            names.append((words[2], {"float": "f", "float32": "f", "double": "d", "float64": "d", "uchar": "B",
                                     "uint8": "B", "int": "i", "ushort": "H"}[words[1]]))
    at = [[name for name, _ in names].index(axis) for axis in "xyz"]
    if any("ascii" in line for line in header[:3]):
        rows = [[float(word) for word in line.split()] for line in raw[end:].decode().split("\n")[:count]]
    else:
        row = struct.Struct("<" + "".join(kind for _, kind in names))
        rows = list(row.iter_unpack(raw[end:end + count * row.size]))
    return [tuple(float(row[k]) for k in at) for row in rows]


def make(arguments):
    chance = random.Random(7)
    shift = (473251.4, 5428119.7, 312.5) if arguments.utm else (0.0, 0.0, 0.0)
    if arguments.ply:
        points = read_ply(arguments.ply)
        loop_file = arguments.ply.with_suffix(".ply.loops.txt") if not Path(f"{arguments.ply.with_suffix('')}.loops.txt").exists() \
            else Path(f"{arguments.ply.with_suffix('')}.loops.txt")
        loops = []
        if loop_file.exists():
            for line in loop_file.read_text().splitlines():
                ids = [int(word) for word in line.split() if word.isdigit()]
                if len(ids) > 2:
                    loops.append((len(loops) > 0, [points[i] for i in ids], chance.random(), chance.random()))
        sheet = None
        spacing = math.dist(*[[f(p[k] for p in points) for k in range(3)] for f in (min, max)]) / math.sqrt(len(points))
        probabilities, normals, colours = [chance.randrange(60) for _ in points], [], []
    else:
        sheet = Sheet(0 if arguments.empty else arguments.points, 0 if arguments.empty else arguments.holes, shift, chance)
        points, spacing, loops = sheet.points, sheet.spacing, []
        probabilities, normals, colours = sheet.probabilities, sheet.normals, sheet.colours
        if not arguments.no_loops and not arguments.empty:
            loops = list(sheet.loops(chance))
        for _ in range(arguments.flat_loops):
            x, y, r = chance.uniform(0, WIDTH), chance.uniform(0, DEPTH), 0.004 * 10 ** chance.uniform(0, 1)
            loops.append((True, [sheet.place(x + r * math.cos(a / 4), y + r * math.sin(a / 4)) for a in range(25)],
                          chance.random(), chance.random()))
    return assemble(arguments, points, spacing, probabilities, normals, colours, loops)


def assemble(arguments, points, spacing, probabilities, normals, colours, raw_loops):
    loops = [measures(number, *loop) for number, loop in enumerate(raw_loops)]
    loops.sort(key=lambda loop: -loop["perimeter"])
    stations = stations_of(arguments.stations, {"min": [min(p[k] for p in points) for k in range(3)],
                                                "max": [max(p[k] for p in points) for k in range(3)]}) if points else []
    add_causes(loops, stations, random.Random(3))
    everything = points + [v for loop in loops for v in loop["vertices"]]
    bounds = {"min": [min(p[k] for p in points) for k in range(3)],
              "max": [max(p[k] for p in points) for k in range(3)]} if points else None
    frame = Frame([min(p[k] for p in everything) for k in range(3)], [max(p[k] for p in everything) for k in range(3)]) \
        if everything else Frame([0, 0, 0], [1, 1, 1])
    first = [0]
    for loop in loops:
        first.append(first[-1] + len(loop["vertices"]))
    histogram = [0] * 20
    for value in probabilities:
        histogram[min(19, value * 20 // 256)] += 1
    has_colours = bool(arguments.colours and colours)
    columns = ["id", "kind", "parent", "points", "confidence", "prominence", "first_scale", "last_scale", "perimeter", "area", "diameter", "planarity", "mean_probability",
               "centroid", "normal", "cause", "hidden_by", "hidden_from", "hidden_from_place", *CAUSES]
    holes = sum(loop["kind"] == "hole" for loop in loops)
    report = {
        "lacuna": "0.1.0", "title": arguments.ply.name if arguments.ply else "scan.laz",
        "crs": "EPSG:25832" if arguments.utm else None, "unit": "" if arguments.ply else "m",
        "inputs": [{"file": str(arguments.ply or "scans/court/scan.laz"), "points": len(points) + 1810}],
        "counts": {"points": len(points), "dropped": 0, "filtered_out": {"origin": 0, "bounds": 1700, "leave_out": 0, "withheld": 0, "noise": 0, "where": 0},
                   "thinned_out": 0, "duplicates": 110, "candidates": len(points) // 40, "coherent": len(points) // 60,
                   "boundary_points": first[-1], "boundary_edges": first[-1], "holes": holes,
                   "outer": len(loops) - holes, "loops": len(loops)},
        "bounds": bounds, "resolution": 0, "strays": 0, "median_distance": 1.7 * spacing if points else 0, "surface_area": len(points) * spacing ** 2,
        "hole_area": sum(loop["area"] for loop in loops if loop["kind"] == "hole"),
        "opening_area": sum(loop["area"] for loop in loops if loop["cause"] == "opening") if stations else None, "method": "tangential",
        "stations": stations, "next_stations": next_stations_of(stations) or None,
        "parameters": {"neighbours": {"k": 24, "radius": 0}, "criteria": {"angle": True, "halfdisc": True},
                       "loops": {"min_hole": 0.1, "min_confidence": 0, "holes_only": False},
                       "output": {"report": True, "sample_points": 300000}},
        "changed": ["k", "min_hole"],
        "run": None if arguments.no_run else {
            "threads": 2, "memory_limit_bytes": 2 << 30, "peak_memory_bytes": 187 << 20, "cores": 2,
            "phases": [{"name": "survey", "seconds": 0.11}, {"name": "tiles", "seconds": 0.52},
                       {"name": "probability", "seconds": 3.61}, {"name": "coherence", "seconds": 0.34},
                       {"name": "loops", "seconds": 0.082}], "seconds": 4.69},
        "probability": histogram if points else None,
        "frame": {"origin": frame.origin, "edge": frame.edge},
        "sample": {"points": len(points), "spacing": spacing if points else 0, "of": len(points) * (4 if len(points) > 200000 else 1),
                   "has_normals": bool(normals), "has_colours": has_colours},
        "loops": {"shown": len(loops), "all": len(loops), **{name: [loop[name] for loop in loops] for name in columns},
                  "first": first},
    }
    elements = [("positions", frame.pack(points)), ("probabilities", bytes(probabilities)),
                ("normals", array("b", [value for normal in normals for value in normal]).tobytes())]
    if has_colours:
        elements.append(("colours", bytes(value for colour in colours for value in colour)))
    elements.append(("loop_vertices", frame.pack(v for loop in loops for v in loop["vertices"])))
    data = '<script type="application/json" id="report">' + json.dumps(report).replace("<", "\\u003c") + "</script>"
    for name, content in elements:
        data += f'\n<script type="application/base64" id="{name}">{base64.b64encode(content).decode()}</script>'
    three = (THREE / "three.min.js").read_text() + "\n" + (THREE / "examples/js/controls/OrbitControls.js").read_text()
    parts = {"/*{style}*/": page_parts("style"), "/*{three}*/": three, "<!--{data}-->": data,
             "/*{script}*/": page_parts("script")}
    lines = (PAGE / "page.html").read_text().split("\n")
    page = "\n".join(parts.get(line, line) for line in lines)
    return page.replace("{scripts}", hashes(page, "script"), 1).replace("{styles}", hashes(page, "style"), 1)


def hashes(page, name):
    """Sources of the page's security policy: elements without attributes."""
    texts = re.findall(rf"<{name}>(.*?)</{name}>", page, re.DOTALL)
    return " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in texts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--points", type=int, default=300000)
    parser.add_argument("--holes", type=int, default=12)
    parser.add_argument("--utm", action="store_true", help="coordinates as in UTM, with a CRS")
    parser.add_argument("--colours", action="store_true")
    parser.add_argument("--no-loops", action="store_true")
    parser.add_argument("--empty", action="store_true", help="no points and no loops")
    parser.add_argument("--no-run", action="store_true")
    parser.add_argument("--flat-loops", type=int, default=0, help="this many small loops more")
    parser.add_argument("--stations", type=int, default=3, help="this many, with causes of holes and places to stand next")
    parser.add_argument("--ply", type=Path)
    arguments = parser.parse_args()
    arguments.out.write_text(make(arguments))


if __name__ == "__main__":
    main()
