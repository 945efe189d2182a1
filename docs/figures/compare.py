#!/usr/bin/env python3
"""Compares the loops of the program, and their confidence, with those of the plain method in this folder, on made
scans, for both methods. So what docs/method.md states, what the figures show and what the program does are the same.

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
from scans import patch
from tangential import Surface

# size, holes, jitter, noise, seed; weights; threshold
SCANS = [((24, [(8, 9, 3), (16, 15, 2.5)], 0.25, 0.0, 1), (1, 1, 1), 0.5),
         ((24, [(8, 9, 3), (16, 15, 2.5)], 0.5, 0.3, 2), (1, 1, 1), 0.5),
         ((26, [(8, 9, 3), (14, 12, 2.5)], 0.5, 0.4, 5), (1, 1, 1), 0.7),
         ((26, [(8, 9, 3), (14, 14, 2.5)], 0.5, 0.4, 7), (0.2, 0.2, 0.6), 0.6)]


def write_scan(points, path):
    rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
    path.write_text("ply\nformat ascii 1.0\nelement vertex " + str(len(points)) + "\nproperty double x\n"
                    "property double y\nproperty double z\nend_header\n" + rows, encoding="ascii")


def found_by(program, folder, method, weights, threshold):
    options = ["--out", folder / method, "--quiet", "--crease-threshold", 1, "--method", method, "--threshold", threshold]
    for name, weight in zip(("angle", "halfdisc", "shape"), weights):
        options += [f"--weight-{name}", weight]
    if method == "tangential":
        options += ["--min-confidence", 0]
    subprocess.run([str(word) for word in [program, "detect", folder / "scan.ply", *options]], check=True)
    report = json.loads((folder / method / "holes.json").read_text(encoding="utf-8"))
    return sorted((sorted(loop["points"]), round(loop["confidence"], 5)) for loop in report["loops"])


def confidence(curve):
    """C.6"""
    return round(sum(min(excess / 3.5, 1) for _, excess in curve) / (len(curve) + 5), 5)


def expected(scan):
    curves = [(sorted(p for p, _ in curve), confidence(curve)) for curve in scan.curves if len(curve) >= 8]
    e = round(2 * math.sqrt(math.pi * sum(map(len, scan.around)) / len(scan.points)))
    graph = spanning_graph(len(scan.points), eligible_edges(scan.points, scan.around, scan.evaluations), e)
    return {"tangential": sorted(curves), "paper": sorted((sorted(loop), 1) for loop in paper_loops(graph))}


def main():
    if len(sys.argv) != 2:
        raise SystemExit("usage: compare.py LACUNA")
    different = 0
    for i, (scan, weights, threshold) in enumerate(SCANS):
        points = patch(*scan)
        plain = expected(Surface(points, is_seed=lambda e: e.probability > threshold, weights=weights))
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write_scan(points, folder / "scan.ply")
            for method, loops in plain.items():
                if found_by(sys.argv[1], folder, method, weights, threshold) != loops:
                    print(f"scan {i}: the loops of method {method} differ")
                    different += 1
    raise SystemExit(1 if different else 0)


if __name__ == "__main__":
    main()
