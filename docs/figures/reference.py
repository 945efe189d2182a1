# SPDX-License-Identifier: Apache-2.0
"""What the plain method finds in a small scan: tests/support/reference.cpp, with which the tests compare the engine.

LACUNA_FIGURE_DATA names the program that prints it, tests/figure_data.cpp. It is in build/tests where it is not set.
"""

import json
import math
import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

PROGRAM = os.environ.get("LACUNA_FIGURE_DATA", Path(__file__).resolve().parents[2] / "build/tests/figure_data")
FINE, COARSE = SCALES = 0, 1


def named(names, row):
    return SimpleNamespace(**dict(zip(names.split(), row, strict=True)))


def find(points, k=15, threshold=0.5):
    """Levels with their points, stars and wedges; loops of all levels; edges, graph and loops of method `paper`."""
    rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
    printed = subprocess.run([PROGRAM, str(k), str(threshold)], input=rows, capture_output=True, text=True, check=True).stdout
    found = named("levels loops e eligible graph paper", json.loads(printed))
    found.levels = [named("edge points active wedges", row) for row in found.levels]
    found.loops = [named("points level scale clearness surface odds rank stands", row) for row in found.loops or []]
    for level in found.levels:
        level.points = [named("place around r mean normal angle halfdisc shape probability link radius consistent distance bounds",
                              row) for row in level.points]
        level.places = [tuple(p.place) for p in level.points]
        level.seeds = [i for i, p in enumerate(level.points) if p.probability > threshold]
        level.active = set(level.active)
        for p in level.points:
            if p.normal[2] < 0:  # all normals point up, so that links and wedges are counterclockwise
                p.normal = [-x for x in p.normal]
                p.link = p.link[::-1]
                p.radius, p.consistent = ([*x[-2::-1], x[-1]] for x in (p.radius, p.consistent))
                level.wedges = [[at, last, first] if level.points[at] is p else [at, first, last]
                                for at, first, last in level.wedges]
    for loop in found.loops:
        loop.places = [found.levels[0].places[p] for p in loop.points]
        loop.confidence = 1 / (1 + math.exp(-loop.odds))
    return found


def triangles(star, scale=FINE):
    """Those of the star within the bound: (index of the link edge, a, b)."""
    n = len(star.link)
    return [(i, star.link[i], star.link[(i + 1) % n]) for i in range(n) if star.radius[i] <= star.bounds[scale]]


def has(star, a, b):
    return any({a, b} == {x, y} for _, x, y in triangles(star))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def inverted(level, p, q):
    """Where q lies after the inversion at p, in the tangent plane of p; without the weights of sites, which are small."""
    a, b = ([x + n * dot(s.normal, s.mean) for x, n in zip(s.place, s.normal)] for s in (level.points[p], level.points[q]))
    d = [y - x for x, y in zip(a, b)]
    nx, ny, nz = level.points[p].normal
    u = [x / math.hypot(ny, nz) for x in (1 - nx * nx, -nx * ny, -nx * nz)]
    v = (ny * u[2] - nz * u[1], nz * u[0] - nx * u[2], nx * u[1] - ny * u[0])
    return dot(d, u) / dot(d, d), dot(d, v) / dot(d, d)


def centres(level, p):
    """The circumcentre of each triangle of the star of p, from p."""
    corners = [inverted(level, p, q) for q in level.points[p].link]
    for (x, y), (x2, y2) in zip(corners, corners[1:] + corners[:1]):
        twice = 2 * (x * y2 - y * x2)
        yield ((y2 - y) / twice, (x - x2) / twice) if twice > 0 else (0.0, 0.0)
