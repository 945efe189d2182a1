# SPDX-License-Identifier: Apache-2.0
"""Figures of part D: the loops of a hole at the levels of a scan, which holes `--min-hole` reports, and how small they are.
The last one has tiles, the halo of one, and the bound on the k-th neighbour's distance."""

import math
import random
import re
from pathlib import Path

from scans import find, scan_lines
from svg import BLUE, FILL, GREEN, INK, LINE, MUTED, ORANGE, RED, Page

HOLE = (15, 13, 5.5)


def levels(path):
    found = find(scan_lines((30, 26), HOLE))
    page = Page(820, 400, "The loops of a hole at three levels of a scan")
    for i, level in enumerate(found.levels):
        edge, x = level.edge, 20 + 265 * i
        panel = page.panel(x, 46, 250, 250, HOLE[:2], 17)
        if edge:
            ends = range(-40, 40)
            panel.lines([((j * edge, -40), (j * edge, 40)) for j in ends] + [((-40, j * edge), (40, j * edge)) for j in ends])
        panel.dots(level.places, MUTED, 1.6 + 0.5 * i)
        of_hole = [loop for loop in found.loops if loop.level == i and
                   all(math.dist(p[:2], HOLE[:2]) < HOLE[2] + 4 for p in loop.places)]
        loop = max(of_hole, key=lambda x: x.rank)
        panel.path(loop.places, RED if loop.stands else BLUE, 2.8, closed=True)
        page.text(x, 30, f"Cells of edge {edge:.0f}" if edge else "All points", weight="bold")
        page.text(x, 320, f"{len(level.points)} points, surface share {loop.surface:.2f},", MUTED)
        page.text(x, 341, f"clearness {loop.clearness:.2f}, confidence {loop.confidence:.2f}", MUTED)
    page.legend(20, 376, [("line", BLUE, "surest loop of the level"), ("line", RED, "the one that stands")], 230)
    page.write(path)


# Measured on 23 November 2026 (bench/accuracy/README.md): shares of 960 holes, of all noises.
DIAMETERS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5)
REPORTED = {
    "eight points in a cell": (BLUE, (0.0, 0.0, 0.0, 0.009, 0.24, 0.965, 0.998, 0.999, 0.999)),
    "scan lines, 2/3 of a cell apart": (GREEN, (0.0, 0.0, 0.0, 0.003, 0.255, 0.94, 0.999, 0.997, 1.0)),
    "a point in every other cell": (ORANGE, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.045, 0.556)),
}


def share_axes(page, x0, y0, width, height):
    """Draws the lines of 0 to 100 %."""
    for share in (0, 0.25, 0.5, 0.75, 1):
        y = y0 + (1 - share) * height
        page.parts.append(f'<line x1="{x0}" y1="{y:.1f}" x2="{x0 + width}" y2="{y:.1f}" stroke="{LINE}"/>')
        page.text(x0 - 8, y + 5, f"{100 * share:.0f} %", MUTED, "end")


def curve(page, color, places):
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
    page.parts.append(f'<path d="{d}" fill="none" stroke="{color}" stroke-width="2.5"/>')


def min_hole(path):
    page = Page(820, 380, "Which holes --min-hole reports, by their diameter")
    x0, y0, width, height = 70, 30, 430, 280

    def at(diameter, share):
        return x0 + (diameter - 0.4) / 1.1 * width, y0 + (1 - share) * height

    share_axes(page, x0, y0, width, height)
    for diameter in (0.4, 0.6, 0.8, 1.0, 1.2, 1.4):
        page.text(at(diameter, 0)[0], y0 + height + 20, f"{diameter}", MUTED, "middle")
    page.text(x0 + width / 2, y0 + height + 44, "diameter of the hole, in --min-hole", INK, "middle")
    for color, shares in REPORTED.values():
        curve(page, color, (at(*p) for p in zip(DIAMETERS, shares)))
    page.text(520, 60, "Holes reported", weight="bold")
    page.legend(520, 88, [("line", color, words) for words, (color, _) in REPORTED.items()])
    page.write(path)


MEASURED = Path(__file__).resolve().parents[2] / "bench/accuracy/README.md"
KINDS = {  # the groups of each
    "surfaces": (BLUE, "synth|uneven|half|density|doubled|outliers"),
    "meshes": (GREEN, "meshes|.*-meshes"),
    "range maps": (INK, "range|range-made"),
    "aerial": (ORANGE, "aerial"),
    "lidar": (RED, "lidar|lidar-.*"),
}


def found_by_width():
    """Returns the classes of width, and for each group of MEASURED a pair (found, true) per class."""
    table = MEASURED.read_text(encoding="utf-8").split("Lacuna, by group:")[1].split("\n## ")[0]
    title, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in table.strip().splitlines())
    counts = [[tuple(map(int, cell.split(" of "))) if cell else (0, 0) for cell in row[1:]] for row in rows]
    return title[1:], {row[0]: of_group for row, of_group in zip(rows, counts)}


def widths(path):
    page = Page(820, 380, "Found of the true holes, by their width")
    x0, y0, width, height = 70, 30, 430, 280
    classes, found = found_by_width()

    def at(place, share):
        return x0 + (place + 0.5) / len(classes) * width, y0 + (1 - share) * height

    share_axes(page, x0, y0, width, height)
    for place, words in enumerate(classes):
        page.text(at(place, 0)[0], y0 + height + 20, words, MUTED, "middle")
    page.text(x0 + width / 2, y0 + height + 44, "width of the hole, in local spacings", INK, "middle")
    for color, groups in KINDS.values():
        of_kind = [counts for name, counts in found.items() if re.fullmatch(groups, name)]
        sums = [[sum(numbers) for numbers in zip(*column)] for column in zip(*of_kind)]
        curve(page, color, (at(place, some / true) for place, (some, true) in enumerate(sums) if true > 0))
    page.text(520, 60, "Holes found", weight="bold")
    page.legend(520, 88, [("line", color, words) for words, (color, _) in KINDS.items()])
    page.write(path)


CELL = 2.0
K = 6
LIMIT = 60  # points per tile


def scan():
    """Denser to the left."""
    rng = random.Random(8)
    return [(22 * rng.random() ** 1.5, 18 * rng.random(), 0.0) for _ in range(620)]


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
    page.text(448, 215, "The halo has no fixed width. It\nholds the foreign points that\nare neighbours of the tile's\n"
                        "points, in either direction.", MUTED)
    page.write(path)


FIGURES = {"levels": levels, "min_hole": min_hole, "widths": widths, "tiles": tiles}
