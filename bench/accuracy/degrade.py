# SPDX-License-Identifier: Apache-2.0
"""Scans with what real ones suffer from: points that are missing, doubled or strewn about. Each function returns a
scan anew; `draw` is a random.Random."""

import math
from dataclasses import dataclass
from itertools import product

from mesh import read_mesh
from thin import part_of, read_loops


@dataclass
class Scan:
    points: list
    loops: list  # true ones, of places in `points`
    spacing: float


def read_scan(scan, truth, spacing):
    """The true loops are a text, or the boundary of the scan's own triangles."""
    mesh = read_mesh(scan)
    return Scan(mesh.positions, mesh.boundary_loops() if truth == scan else read_loops(truth), spacing)


def box_of(points):
    """The lowest and the highest coordinate along each axis."""
    return [(min(axis), max(axis)) for axis in zip(*points)]


def kept_with(scan, chance, draw):
    kept = [vertex for vertex, point in enumerate(scan.points) if draw.random() < chance(point)]
    points, loops = part_of(scan.points, scan.loops, kept)
    return Scan(points, loops, scan.spacing)


def halved(scan, draw):
    """A random half of the points."""
    return kept_with(scan, lambda point: 0.5, draw)


def falling_by_ten(scan, draw):
    """All points at one end of the longest axis, one in ten at the other, a random one in 10^t where t is between."""
    box = box_of(scan.points)
    axis = max(range(3), key=lambda i: box[i][1] - box[i][0])
    low, high = box[axis]
    return kept_with(scan, lambda point: 10 ** -((point[axis] - low) / (high - low)), draw)


def doubled(scan, draw):
    """A second point for every one, a third of a spacing off, towards a random point within two spacings. The second
    points follow the first, and are in no true loop."""
    cells = {}
    for point in scan.points:
        cells.setdefault(cell_of(point, 2 * scan.spacing), []).append(point)
    return Scan(scan.points + [twin(point, cells, scan.spacing, draw) for point in scan.points], scan.loops, scan.spacing)


def cell_of(point, edge):
    return tuple(math.floor(value / edge) for value in point)


def twin(point, cells, spacing, draw):
    middle = cell_of(point, 2 * spacing)
    near = [other for offset in product((-1, 0, 1), repeat=3)
            for other in cells.get(tuple(map(sum, zip(middle, offset))), ())
            if 0 < math.dist(point, other) <= 2 * spacing]
    if not near:  # a stray: any direction
        near = [tuple(value + draw.gauss(0, spacing) for value in point)]
    other = near[int(draw.random() * len(near))]
    share = spacing / 3 / math.dist(point, other)
    return tuple(a + share * (b - a) for a, b in zip(point, other))


def with_outliers(scan, draw):
    """One more point in a hundred, anywhere in the box of the scan. The box is enlarged on each side by a twentieth
    of its longest edge. They follow the others."""
    box = box_of(scan.points)
    farther = max(high - low for low, high in box) / 20
    strewn = [tuple(draw.uniform(low - farther, high + farther) for low, high in box)
              for _ in range(round(len(scan.points) / 100))]
    return Scan(scan.points + strewn, scan.loops, scan.spacing)
