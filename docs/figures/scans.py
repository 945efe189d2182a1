# SPDX-License-Identifier: Apache-2.0
"""Small synthetic scans: same seed, same points."""

import math
import random


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


def island(seed=193):
    """A ring-shaped hole that a bridge of points crosses. Its curve passes a point twice."""
    def is_kept(x, y):
        return not 2.5 < math.dist((x, y), (7.5, 7.5)) < 4.5 or (abs(y - 7.5) < 0.7 and x > 7.5)
    return [p for p in patch(16, seed=seed) if is_kept(*p[:2])]


def nearest_to(points, place):
    return min(range(len(points)), key=lambda p: math.dist(points[p][:2], place))
