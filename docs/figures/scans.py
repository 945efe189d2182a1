# SPDX-License-Identifier: Apache-2.0
"""Small synthetic scans, and what the plain method finds in them: tests/support/reference.cpp, with which the tests compare
the engine. LACUNA_FIGURE_DATA names the program that prints it, tests/figure_data.cpp; build/tests has it, too.
"""

import json
import math
import os
import random
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


# Scans: same seed, same points.

def patch(size, holes=(), jitter=0.3, noise=0.0, seed=1, height=lambda x, y: 0.0):
    """A square of size x size points, one unit apart, without those in the holes (x, y, radius)."""
    rng = random.Random(seed)
    points = []
    for j in range(size):
        for i in range(size):
            x, y = i + rng.uniform(-jitter, jitter), j + rng.uniform(-jitter, jitter)
            z = height(x, y) + (rng.gauss(0, noise) if noise else 0.0)
            if all(math.hypot(x - hx, y - hy) > radius for hx, hy, radius in holes):
                points.append((x, y, z))
    return points


def density_step(seed=3):
    """Points half a unit apart on the left, one and a half on the right."""
    rng = random.Random(seed)
    points = []
    for step, first, last in ((0.5, -5.0, 0.0), (1.5, 0.6, 7.5)):
        x = first
        while x < last:
            y = -5.0
            while y < 5.0:
                points.append((x + rng.uniform(-0.2, 0.2) * step, y + rng.uniform(-0.2, 0.2) * step, 0.0))
                y += step
            x += step
    return points


def uneven(hole, size=24, seed=15):
    """Clusters of up to five points, the farther apart the lower, without those in the hole (x, y, radius)."""
    rng = random.Random(seed)
    points = []
    y = 0.0
    while y < size:
        step = 1.6 - 0.7 * y / size
        x = 0.0
        while x < size:
            cluster = (x + rng.uniform(-0.4, 0.4) * step, y + rng.uniform(-0.4, 0.4) * step)
            for _ in range(rng.randint(1, 5)):
                p = tuple(c + rng.uniform(-0.3, 0.3) * step for c in cluster)
                if math.dist(p, hole[:2]) > hole[2]:
                    points.append((*p, 0.0))
            x += step
        y += step
    return points


def scan_lines(size, hole, distance=1.6, step=0.25, seed=3):
    """Lines of points along x, without those in the hole (x, y, radius)."""
    rng = random.Random(seed)
    width, height = size
    points = []
    for j in range(math.ceil(height / distance)):
        for i in range(math.ceil(width / step)):
            p = ((i + rng.uniform(-0.3, 0.3)) * step, j * distance + rng.uniform(-0.2, 0.2))
            if math.dist(p, hole[:2]) > hole[2]:
                points.append((*p, 0.0))
    return points


def nearest_to(points, place):
    return min(range(len(points)), key=lambda p: math.dist(points[p][:2], place))
