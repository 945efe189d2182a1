#!/usr/bin/env python3
"""Draws a scan with its loops as a PNG: points grey, holes red, outer boundaries blue.

    lacuna detect scan.ply --out holes --points --normals --orient-normals
    tools/picture.py holes picture.png --azimuth 30 --elevation 40

The folder is that of a run with --points, --normals and --orient-normals. Needs Python 3 and no package. The README's picture:

    lacuna synth surface torus.ply --kind torus --points 120000 --holes 24 --hole-radius 8 22 --noise 0.1 --seed 4
    lacuna detect torus.ply --out torus --points --normals --orient-normals
    tools/picture.py torus docs/picture.png
"""

import argparse
import json
import math
import struct
import zlib
from pathlib import Path

BACKGROUND = (251, 250, 247)
SURFACE, INSIDE = (178, 188, 198), (108, 118, 130)  # in full light: the near side, and what is seen from behind
HOLE, OUTER = (206, 44, 40), (28, 96, 176)
TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}


def read_points(path):
    """Positions and normals of points.ply (binary, little-endian, as lacuna writes it)."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = [line.split() for line in data[:end].decode("ascii").splitlines()]
    if ["format", "binary_little_endian", "1.0"] not in header:
        raise SystemExit(f"picture.py: {path}: not a binary little-endian PLY file")
    count = next(int(words[2]) for words in header if words[:2] == ["element", "vertex"])
    properties = [words for words in header if words[0] == "property"]
    names = [words[2] for words in properties]
    missing = {"x", "y", "z", "nx", "ny", "nz"} - set(names)
    if missing:
        raise SystemExit(f"picture.py: {path}: no {', '.join(sorted(missing))}; run detect with --points --normals --orient-normals")
    layout = struct.Struct("<" + "".join(TYPES[words[1]] for words in properties))
    columns = [names.index(name) for name in ("x", "y", "z", "nx", "ny", "nz")]
    rows = layout.iter_unpack(data[end:end + count * layout.size])
    return [tuple(row[c] for c in columns) for row in rows]


class View:
    """Orthographic: across, up and towards the eye."""

    def __init__(self, azimuth, elevation):
        a, e = math.radians(azimuth), math.radians(elevation)
        self.right = (-math.sin(a), math.cos(a), 0.0)
        self.up = (-math.sin(e) * math.cos(a), -math.sin(e) * math.sin(a), math.cos(e))
        self.eye = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))

    def turn(self, v):
        return tuple(v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2] for axis in (self.right, self.up, self.eye))


class Canvas:
    """A grid of colours with depths; drawn at twice the size and averaged."""

    def __init__(self, width, height):
        self.width, self.height = 2 * width, 2 * height
        self.depth = [-math.inf] * (self.width * self.height)
        self.color = [BACKGROUND] * (self.width * self.height)

    def disc(self, x, y, radius, depth, color):
        r2 = radius * radius
        for row in range(max(0, math.ceil(y - radius)), min(self.height - 1, math.floor(y + radius)) + 1):
            half = math.sqrt(max(0.0, r2 - (row - y) ** 2))
            first, last = max(0, math.ceil(x - half)), min(self.width - 1, math.floor(x + half))
            for at in range(row * self.width + first, row * self.width + last + 1):
                if depth > self.depth[at]:
                    self.depth[at] = depth
                    self.color[at] = color

    def write(self, path):
        rows = bytearray()
        for y in range(0, self.height, 2):
            rows.append(0)
            for x in range(0, self.width, 2):
                at = y * self.width + x
                four = (self.color[at], self.color[at + 1], self.color[at + self.width], self.color[at + self.width + 1])
                for channel in range(3):
                    # Few distinct values compress better, and nobody sees the difference.
                    rows.append((sum(c[channel] for c in four) // 4) & 0xFC)
        size = struct.pack(">IIBBBBB", self.width // 2, self.height // 2, 8, 2, 0, 0, 0)

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) +
                         chunk(b"IEND", b""))


def shade(color, light):
    return tuple(round(c * light) for c in color)


def draw(points, loops, view, width, height, spacing):
    turned = [view.turn(p) for p in points]
    low = [min(t[i] for t in turned) for i in range(2)]
    high = [max(t[i] for t in turned) for i in range(2)]
    canvas = Canvas(width, height)
    scale = min((canvas.width - 60) / (high[0] - low[0]), (canvas.height - 60) / (high[1] - low[1]))
    middle = [(low[i] + high[i]) / 2 for i in range(2)]

    def place(t):
        return (canvas.width / 2 + (t[0] - middle[0]) * scale, canvas.height / 2 - (t[1] - middle[1]) * scale)

    radius = 0.85 * spacing * scale
    normals = [view.turn(p[3:6]) for p in points]
    known = [i for i, n in enumerate(normals) if all(map(math.isfinite, n))]
    nearest = max(known, key=lambda i: turned[i][2])
    outside = 1 if normals[nearest][2] > 0 else -1
    for i in known:
        n = [outside * x for x in normals[i]]
        is_near_side = n[2] > 0
        light = 0.4 + 0.6 * abs(-0.35 * n[0] + 0.45 * n[1] + 0.82 * n[2])
        x, y = place(turned[i])
        canvas.disc(x, y, radius, turned[i][2], shade(SURFACE if is_near_side else INSIDE, min(light, 1.0)))
    for kind, ids in loops:
        color = HOLE if kind == "hole" else OUTER
        for a, b in zip(ids, ids[1:] + ids[:1]):
            (x, y), (x2, y2) = place(turned[a]), place(turned[b])
            steps = max(1, math.ceil(math.hypot(x2 - x, y2 - y)))
            for i in range(steps + 1):
                s = i / steps
                depth = turned[a][2] + s * (turned[b][2] - turned[a][2]) + 1.5 * spacing
                canvas.disc(x + s * (x2 - x), y + s * (y2 - y), 4.2, depth, color)
    return canvas


def main():
    parser = argparse.ArgumentParser(description="Draws a scan with its loops as a PNG.")
    parser.add_argument("folder", type=Path, help="of `lacuna detect --points --normals --orient-normals`")
    parser.add_argument("picture", type=Path, help="the PNG file to write")
    parser.add_argument("--azimuth", type=float, default=30.0, help="degrees about the z axis")
    parser.add_argument("--elevation", type=float, default=38.0, help="degrees above the x y plane")
    parser.add_argument("--width", type=int, default=1000, help="pixels")
    parser.add_argument("--height", type=int, default=460, help="pixels")
    arguments = parser.parse_args()
    points = read_points(arguments.folder / "points.ply")
    report = json.loads((arguments.folder / "holes.json").read_text(encoding="utf-8"))
    loops = [(loop["kind"], loop["ids"]) for loop in report["loops"]]
    lengths = sorted(loop["perimeter"] / loop["points"] for loop in report["loops"])
    spacing = lengths[len(lengths) // 2] if lengths else 0.01
    canvas = draw(points, loops, View(arguments.azimuth, arguments.elevation), arguments.width, arguments.height, spacing)
    canvas.write(arguments.picture)


if __name__ == "__main__":
    main()
