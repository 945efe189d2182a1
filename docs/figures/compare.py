#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the loops of the program, their confidence and their scales, with those of the plain method in this folder. It takes
synthetic scans and both methods. So what docs/method.md states, what the figures show and what the program does are the same.

    docs/figures/compare.py build/lacuna

The crease turn (A.2) is off, since the plain method leaves it out. Exits with 1 where loops differ.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from paper import eligible_edges, paper_loops, spanning_graph
from scans import island, patch, uneven
from tracking import levels_of, track

FIELDS = "confidence", "first_scale", "last_scale"
# points; weights; threshold
SCANS = [(patch(24, [(8, 9, 3), (16, 15, 2.5)], 0.25, 0.0, 1), (1, 1, 1), 0.5),
         (patch(24, [(8, 9, 3), (16, 15, 2.5)], 0.5, 0.3, 2), (1, 1, 1), 0.5),
         (patch(26, [(8, 9, 3), (14, 12, 2.5)], 0.5, 0.4, 5), (1, 1, 1), 0.7),
         (patch(26, [(8, 9, 3), (14, 14, 2.5)], 0.5, 0.4, 7), (0.2, 0.2, 0.6), 0.6),
         (uneven((12, 12, 4.6)), (1, 1, 1), 0.5), (island(), (1, 1, 1), 0.5)]


def write_scan(points, path):
    rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
    path.write_text("ply\nformat ascii 1.0\nelement vertex " + str(len(points)) + "\nproperty double x\n"
                    "property double y\nproperty double z\nend_header\n" + rows, encoding="ascii")


def found_by(program, folder, run, weights, threshold):
    method, min_confidence, levels = run
    options = ["--out", folder / method, "--quiet", "--crease-threshold", 1]
    options += ["--method", method, "--threshold", threshold]
    for name, weight in zip(("angle", "halfdisc", "shape"), weights):
        options += [f"--weight-{name}", weight]
    if method == "tangential":
        options += ["--min-confidence", min_confidence, *(["--every-point"] if levels == 1 else [])]
    subprocess.run([str(word) for word in [program, "detect", folder / "scan.ply", *options]], check=True)
    report = json.loads((folder / method / "holes.json").read_text(encoding="utf-8"))
    return [(loop["ids"], [loop[key] for key in FIELDS]) for loop in report["loops"]]


def expected(levels):
    """Loops and what is known of each, by method, least confidence and levels."""
    result = {}
    for count in sorted({1, len(levels)}):
        tracked = track(levels[:count])
        for least in (0, 0.5):
            result["tangential", least, count] = [(x.points, [x.confidence, x.first, x.last])
                                                  for x in tracked if x.confidence >= least]
    scan, _ = levels[0]
    e = round(2 * math.sqrt(math.pi * sum(map(len, scan.around)) / len(scan.points)))
    graph = spanning_graph(len(scan.points), eligible_edges(scan.points, scan.around, scan.evaluations), e)
    return result | {("paper", 0.5, 1): [(loop, [1, 0, 0, 0]) for loop in paper_loops(graph)]}


def differ(some, others):
    some, others = (sorted((sorted(points), x) for points, x in loops) for loops in (some, others))
    return len(some) != len(others) or any(
        p != q or any(abs(a - b) > 1e-5 for a, b in zip(x, y)) for (p, x), (q, y) in zip(some, others))


def main():
    if len(sys.argv) != 2:
        raise SystemExit("usage: compare.py LACUNA")
    different = 0
    for i, (points, weights, threshold) in enumerate(SCANS):
        plain = expected(levels_of(points, is_seed=lambda e: e.probability > threshold, weights=weights))
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write_scan(points, folder / "scan.ply")
            for run, loops in plain.items():
                if differ(found_by(sys.argv[1], folder, run, weights, threshold), loops):
                    print(f"scan {i}: the loops of method {run[0]} at {run[2]} levels differ")
                    different += 1
    raise SystemExit(1 if different else 0)


if __name__ == "__main__":
    main()
