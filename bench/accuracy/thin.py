# SPDX-License-Identifier: Apache-2.0
"""Uneven scans, thinned from a surface of `lacuna-bench synth surface`."""

import os
import random
import struct
from pathlib import Path

ROW = struct.Struct("<fff")


def thin(scan, truth, one_in, seed, out):
    """Writes a random one in so many points to `out`, and their true loops next to it."""
    draw = random.Random(seed)
    rows = read_rows(scan)
    write_part(rows, [vertex for vertex in range(len(rows)) if draw.random() < 1 / one_in], truth, out)


def overlap(scan, truth, one_in, seed, error, out):
    """Two scans of one surface as one file. The first has a random one in so many points of the lower 60 % in x. The
    second has as many of the upper 60 %, `error` higher in z than they should be."""
    draw = random.Random(seed)
    rows = read_rows(scan)
    low, high = min(row[0] for row in rows), max(row[0] for row in rows)
    share = [(row[0] - low) / (high - low) for row in rows]
    first = [vertex for vertex in range(len(rows)) if share[vertex] < 0.6 and draw.random() < 1 / one_in]
    second = [vertex for vertex in range(len(rows)) if share[vertex] > 0.4 and draw.random() < 1 / one_in]
    # A vertex that both have drawn belongs to the first.
    second = sorted(set(second) - set(first))
    for vertex in second:
        x, y, z = rows[vertex]
        rows[vertex] = (x, y, z + error)
    write_part(rows, first + second, truth, out)


def read_rows(scan):
    content = Path(scan).read_bytes()
    return list(ROW.iter_unpack(content[content.index(b"end_header\n") + len(b"end_header\n"):]))


def read_loops(truth):
    with open(truth, encoding="utf-8") as lines:
        return [list(map(int, line.split())) for line in lines if not line.startswith("#")]


def part_of(rows, loops, kept):
    """The kept rows and true loops: the points that are left of each loop, in its order."""
    place = {vertex: i for i, vertex in enumerate(kept)}
    left = [[place[vertex] for vertex in loop if vertex in place] for loop in loops]
    return [rows[vertex] for vertex in kept], [loop for loop in left if loop]


def write_part(rows, kept, truth, out):
    write_points(*part_of(rows, read_loops(truth), kept), out)


def write_points(rows, loops, out):
    """A PLY file of points, and their true loops next to it."""
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
              "property float x\nproperty float y\nproperty float z\nend_header\n")
    partial = Path(f"{out}.partial")
    partial.write_bytes(header.encode() + b"".join(ROW.pack(*row) for row in rows))
    out.with_suffix(".loops.txt").write_text(
        f"# one boundary loop per line, 0-based point ids of {out.name}\n"
        + "".join(" ".join(map(str, loop)) + "\n" for loop in loops), encoding="utf-8")
    os.replace(partial, out)
