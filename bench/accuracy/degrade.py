# SPDX-License-Identifier: Apache-2.0
"""Scans with what real ones suffer from: points that are missing, doubled or strewn about. Each function returns a
scan anew; `draw` is a random.Random."""

import math
from dataclasses import dataclass
from itertools import product

from mesh import read_mesh, write_ply


@dataclass
class Scan:
    points: list
    loops: list  # true ones, of places in `points`
    spacing: float


def read_scan(scan, truth, spacing):
    """The true loops are a text, or the boundary of the scan's own triangles."""
    mesh = read_mesh(scan)
    if truth == scan:
        return Scan(mesh.positions, mesh.boundary_loops(), spacing)
    with open(truth, encoding="utf-8") as lines:
        return Scan(mesh.positions, [list(map(int, line.split())) for line in lines if not line.startswith("#")], spacing)


def write_points(points, loops, out):
    """A PLY file of points, and their true loops next to it."""
    out.with_suffix(".loops.txt").write_text(
        f"# one boundary loop per line, 0-based point ids of {out.name}\n"
        + "".join(" ".join(map(str, loop)) + "\n" for loop in loops), encoding="utf-8")
    write_ply(out, points)


def box_of(points):
    """The lowest and the highest coordinate along each axis."""
    return [(min(axis), max(axis)) for axis in zip(*points)]


def part_of(scan, kept):
    """The kept points, and the ones that are left of each true loop, in its order."""
    place = {vertex: i for i, vertex in enumerate(kept)}
    left = [[place[vertex] for vertex in loop if vertex in place] for loop in scan.loops]
    return Scan([scan.points[vertex] for vertex in kept], [loop for loop in left if loop], scan.spacing)


def kept_with(scan, chance, draw):
    return part_of(scan, [vertex for vertex, point in enumerate(scan.points) if draw.random() < chance(point)])


def halved(scan, draw):
    """A random half of the points."""
    return kept_with(scan, lambda point: 0.5, draw)


def quartered(scan, draw):
    """A random one in four points: a surface is sampled as if each point knew of no other."""
    return kept_with(scan, lambda point: 0.25, draw)


def overlapping(scan, draw):
    """Two scans of one surface. The first has a random one in four points of the lower 60 % in x. The second has as many
    of the upper 60 %, 0.003 too high. A point that both have drawn belongs to the first."""
    low, high = box_of(scan.points)[0]
    share = [(x - low) / (high - low) for x, _, _ in scan.points]
    first, second = ([vertex for vertex in range(len(share)) if is_in(share[vertex]) and draw.random() < 0.25]
                     for is_in in (lambda s: s < 0.6, lambda s: s > 0.4))
    part = part_of(scan, first + sorted(set(second) - set(first)))
    raised = [(x, y, z + 0.003) for x, y, z in part.points[len(first):]]
    return Scan(part.points[:len(first)] + raised, part.loops, scan.spacing)


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
