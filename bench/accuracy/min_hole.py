#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which holes does `--min-hole 1` report? The rule behind it rests on this (docs/method.md, D).

A wavy surface has round holes of one diameter, four units apart. A hole is reported if a loop around its middle encloses
between half and twice its area. Prints one row for each sampling, noise and diameter."""

import argparse
import csv
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

COLUMNS, ROWS, PITCH = 10, 6, 4.0  # of the holes
WIDTH, HEIGHT = COLUMNS * PITCH, ROWS * PITCH
DIAMETERS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5)
NOISES = (0.0, 0.1, 0.2, 0.3)  # standard deviation along z, cells


def dense(cell, draw):
    """Eight points in a cell."""
    for _ in range(int(8 * WIDTH * HEIGHT / cell**2)):
        yield draw.uniform(0, WIDTH), draw.uniform(0, HEIGHT)


def sparse(cell, draw):
    """A point in every other cell, at random places."""
    for _ in range(int(0.5 * WIDTH * HEIGHT / cell**2)):
        yield draw.uniform(0, WIDTH), draw.uniform(0, HEIGHT)


def lines(cell, draw):
    """Sweeps of a scanner: eight points a cell along lines that are two thirds of a cell apart."""
    for line in range(int(HEIGHT / cell * 1.5)):
        y = (line + draw.uniform(-0.1, 0.1)) * cell / 1.5
        for i in range(int(8 * WIDTH / cell)):
            yield i * cell / 8, y


SAMPLINGS = {"dense": dense, "lines": lines, "sparse": sparse}


def middles():
    return [((i + 0.5) * PITCH + 0.3 * math.sin(i + j), (j + 0.5) * PITCH + 0.3 * math.cos(2 * i - j))
            for i in range(COLUMNS) for j in range(ROWS)]


def is_in_hole(x, y, holes, diameter):
    i, j = min(int(x / PITCH), COLUMNS - 1), min(int(y / PITCH), ROWS - 1)
    return math.dist((x, y), holes[i * ROWS + j]) < diameter / 2


def write_scan(file, sampling, cell, noise, diameter, seed):
    draw, holes = random.Random(seed), middles()
    points = []
    for x, y in SAMPLINGS[sampling](cell, draw):
        if is_in_hole(x, y, holes, diameter):
            continue
        z = 0.3 * math.sin(x / 2) * math.cos(y / 2) + draw.gauss(0, noise * cell)
        points.append((x, y, z))
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
              "property double x\nproperty double y\nproperty double z\nend_header\n")
    file.write_bytes(header.encode() + b"".join(struct.pack("<3d", *point) for point in points))
    return points


def area_of(loop):
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(loop, loop[1:] + loop[:1]))) / 2


def count_reported(points, report, diameter):
    """Holes that a loop is around, and loops around none. The outer edge counts for neither."""
    holes, reported, false = middles(), set(), 0
    for record in report["loops"]:
        loop = [points[i] for i in record["ids"]]
        x, y = (sum(p[axis] for p in loop) / len(loop) for axis in (0, 1))
        area = area_of(loop)
        if not (1 < x < WIDTH - 1 and 1 < y < HEIGHT - 1) or area > WIDTH * HEIGHT / 2:
            continue
        near = [i for i, hole in enumerate(holes) if math.dist((x, y), hole) < diameter / 4]
        if near and 0.5 <= area / (math.pi * diameter**2 / 4) <= 2:
            reported.update(near)
        else:
            false += 1
    return len(reported), false


def measure(arguments, sampling, noise, diameter):
    reported = false = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(arguments.seeds):
            scan, out = Path(folder) / "scan.ply", Path(folder) / f"out{seed}"
            points = write_scan(scan, sampling, arguments.cell, noise, diameter, seed)
            command = [arguments.lacuna, "detect", scan, "--out", out, "--quiet", "--min-hole", 1,
                       *arguments.detect_options]
            subprocess.run([str(word) for word in command], check=True)
            counts = count_reported(points, json.loads((out / "holes.json").read_text()), diameter)
            reported, false = reported + counts[0], false + counts[1]
    holes = arguments.seeds * len(middles())
    return {"sampling": sampling, "noise": noise, "diameter": diameter, "holes": holes, "reported": reported,
            "false": false}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lacuna", type=Path, default=Path("build/lacuna"))
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--cell", type=float, default=1 / 5, help="the resolution that --min-hole 1 sets")
    parser.add_argument("detect_options", nargs="*", help="further options of lacuna detect, after --")
    arguments = parser.parse_args()
    rows = csv.DictWriter(sys.stdout, ["sampling", "noise", "diameter", "holes", "reported", "false"])
    rows.writeheader()
    for sampling in SAMPLINGS:
        for noise in NOISES:
            for diameter in DIAMETERS:
                rows.writerow(measure(arguments, sampling, noise, diameter))


if __name__ == "__main__":
    main()
