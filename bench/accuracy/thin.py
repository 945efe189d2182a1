"""Uneven scans: a random part of the points of a surface that `lacuna synth surface` has made."""

import os
import random
from pathlib import Path

ROW_BYTES = 12  # x y z, float


def thin(scan, truth, one_in, seed, out):
    """Writes a random one in so many points to `out` and their true loops beside it: the points that are left of
    each loop, in its order."""
    content = Path(scan).read_bytes()
    body = content.index(b"end_header\n") + len(b"end_header\n")
    count = (len(content) - body) // ROW_BYTES
    draw = random.Random(seed)
    kept = [vertex for vertex in range(count) if draw.random() < 1 / one_in]
    place = {vertex: i for i, vertex in enumerate(kept)}
    rows = b"".join(content[body + ROW_BYTES * vertex:body + ROW_BYTES * (vertex + 1)] for vertex in kept)
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(kept)}\n"
              "property float x\nproperty float y\nproperty float z\nend_header\n")
    with open(truth, encoding="utf-8") as lines:
        loops = [[place[vertex] for vertex in map(int, line.split()) if vertex in place]
                 for line in lines if not line.startswith("#")]
    partial = Path(f"{out}.partial")
    partial.write_bytes(header.encode() + rows)
    out.with_suffix(".loops.txt").write_text(
        f"# one boundary loop per line, 0-based point ids of {out.name}\n"
        + "".join(" ".join(map(str, loop)) + "\n" for loop in loops if loop), encoding="utf-8")
    os.replace(partial, out)
