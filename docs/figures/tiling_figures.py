# SPDX-License-Identifier: Apache-2.0
"""Figure of part D: tiles, the halo of one, and the bound on the k-th neighbour's distance."""

import math
import random

from reference import find
from svg import BLUE, FILL, MUTED, ORANGE, RED, Page

CELL = 2.0
K = 6
LIMIT = 60  # points per tile


def scan():
    """Denser to the left."""
    rng = random.Random(8)
    points = []
    for _ in range(620):
        points.append((22 * rng.random() ** 1.5, 18 * rng.random(), 0.0))
    return points


def split(cells, limit):
    """Halves the cells along the longest side, at the median of the counts."""
    if sum(len(ids) for ids in cells.values()) <= limit or len(cells) == 1:
        return [cells]
    sides = [max(c[i] for c in cells) - min(c[i] for c in cells) for i in range(2)]
    axis = 0 if sides[0] >= sides[1] else 1
    ordered = sorted(cells, key=lambda c: (c[axis], c[1 - axis]))
    total = sum(len(cells[c]) for c in ordered)
    planes = sorted({c[axis] for c in ordered})[1:]
    best = min(planes, key=lambda at: abs(total / 2 - sum(len(cells[c]) for c in ordered if c[axis] < at)))
    return (split({c: cells[c] for c in ordered if c[axis] < best}, limit) +
            split({c: cells[c] for c in ordered if c[axis] >= best}, limit))


def farthest(a, b):
    """Between any two places of two cells."""
    return CELL * math.hypot(abs(a[0] - b[0]) + 1, abs(a[1] - b[1]) + 1)


def bound(cells, cell):
    count = 0
    for other in sorted(cells, key=lambda c: (farthest(cell, c), c)):
        count += len(cells[other])
        if count > K:
            return farthest(cell, other)
    return math.inf


def tiles(path):
    points = scan()
    cells = {}
    for p, (x, y, _) in enumerate(points):
        cells.setdefault((int(x // CELL), int(y // CELL)), []).append(p)
    parts = split(cells, LIMIT)
    tile_of = {p: t for t, part in enumerate(parts) for ids in part.values() for p in ids}
    around = [p.around for p in find(points, K).levels[0].points]
    middle = min(range(len(parts)), key=lambda t: math.dist(
        [sum(c[i] * CELL for c in parts[t]) / len(parts[t]) for i in range(2)], (10, 9)))
    own = [p for p in range(len(points)) if tile_of[p] == middle]
    crossing = [(p, q) for p in own for q in around[p] if tile_of[q] != middle]
    halo = sorted({q for _, q in crossing})

    page = Page(700, 440, "Tiles, halo, and the bound of a cell")
    panel = page.panel(20, 20, 410, 400, (11, 9), 23)
    panel.lines([((i * CELL, 0), (i * CELL, 18)) for i in range(12)] + [((0, j * CELL), (22, j * CELL)) for j in range(10)],
                "#e4e7ea", 0.8)
    for t, part in enumerate(parts):
        for i, j in part:
            if t == middle:
                x, y = i * CELL, j * CELL
                panel.path([(x, y), (x + CELL, y), (x + CELL, y + CELL), (x, y + CELL)], "none", 0, FILL, closed=True)
        low = [min(c[i] for c in part) * CELL for i in range(2)]
        high = [(max(c[i] for c in part) + 1) * CELL for i in range(2)]
        panel.path([low, (high[0], low[1]), high, (low[0], high[1])], MUTED, 2.2, closed=True)
    panel.lines([(points[p], points[q]) for p, q in crossing], ORANGE, 1)
    panel.dots(points, MUTED, 2.2)
    panel.dots([points[p] for p in own], BLUE, 3)
    panel.dots([points[q] for q in halo], ORANGE, 3.6)
    # A cell of the tile, and a rounded box around it.
    cell = sorted(parts[middle])[len(parts[middle]) // 2]
    reach, (x, y) = bound(cells, cell), (cell[0] * CELL, cell[1] * CELL)
    panel.path([(x, y), (x + CELL, y), (x + CELL, y + CELL), (x, y + CELL)], RED, 2.2, closed=True)
    around_box = [(cx + reach * math.cos(a), cy + reach * math.sin(a))
                  for (cx, cy), start in (((x + CELL, y + CELL), 0), ((x, y + CELL), 90), ((x, y), 180), ((x + CELL, y), 270))
                  for a in (math.radians(start + 90 * j / 12) for j in range(13))]
    panel.path(around_box, RED, 1.8, closed=True, dash=True)
    page.legend(448, 50, [("line", MUTED, "border of a tile"), ("dot", BLUE, f"the tile's {len(own)} points"),
                          ("dot", ORANGE, f"its halo: {len(halo)} points"),
                          ("line", ORANGE, "neighbours across borders"),
                          ("line", RED, "a cell of the tile"), ("dash", RED, "within its bound: the"), ])
    page.text(473, 176, f"{K} nearest of its points")
    page.text(448, 215, "The halo has no fixed width. It", MUTED)
    page.text(448, 235, "holds the foreign points that", MUTED)
    page.text(448, 255, "are neighbours of the tile's", MUTED)
    page.text(448, 275, "points, in either direction.", MUTED)
    page.write(path)


FIGURES = {"tiles": tiles}
