"""Figures of part D: scan lines and their resolution, and which holes `--min-hole` reports."""

import math
import random

from svg import BLUE, GREEN, INK, LINE, MUTED, ORANGE, RED, Page

STEP, LINES, DISTANCE = 0.3, 7, 2.1  # of points along lines, lines on each side of the middle, between lines


def scan_lines(seed=3):
    draw = random.Random(seed)
    return [((i + 0.4 * (draw.random() - 0.5)) * STEP, j * DISTANCE + 0.5 * (draw.random() - 0.5))
            for j in range(-LINES, LINES + 1) for i in range(-60, 61)]


def nearest_in_sectors(points, middle):
    """By sector, the nearest point."""
    nearest = {}
    for p in points:
        x, y = p[0] - middle[0], p[1] - middle[1]
        if x == y == 0:
            continue
        sector = int(math.floor(math.atan2(y, x) / math.tau * 6)) % 6
        if sector not in nearest or math.dist(p, middle) < math.dist(nearest[sector], middle):
            nearest[sector] = p
    return nearest


def representatives(points, edge):
    cells = {}
    for p in points:
        cells.setdefault((math.floor(p[0] / edge), math.floor(p[1] / edge)), []).append(p)
    for members in cells.values():
        mean = tuple(sum(axis) / len(members) for axis in zip(*members))
        yield min(members, key=lambda p: (math.dist(p, mean), p))


def lines(path):
    page = Page(820, 380, "Scan lines: the distance to the next line, and one representative in each cell")
    points = scan_lines()
    middle = min(points, key=lambda p: math.dist(p, (0, 0)))
    left = page.panel(20, 46, 380, 270, middle, 9)
    left.dots(points)
    for sector in range(6):
        a = math.tau * sector / 6
        left.lines([(middle, (middle[0] + 9 * math.cos(a), middle[1] + 9 * math.sin(a)))])
    nearest = nearest_in_sectors(points, middle)
    second = sorted(nearest.values(), key=lambda p: math.dist(p, middle))[-2]
    left.path([middle, second], RED, 2.5)
    left.dots(nearest.values(), ORANGE, 4.5)
    left.dots([middle], INK, 5)
    page.text(20, 30, "Six sectors around a point", weight="bold")
    page.legend(20, 342, [("dot", ORANGE, "nearest in its sector"), ("line", RED, "line distance")], 190)

    edge = math.dist(middle, second)
    right = page.panel(420, 46, 380, 270, middle, 13)
    for i in range(-10, 11):
        right.lines([((i * edge, -20), (i * edge, 20)), ((-20, i * edge), (20, i * edge))], LINE)
    right.dots(points)
    right.dots(representatives(points, edge), BLUE, 4.5)
    page.text(420, 30, "Cells of that size", weight="bold")
    page.legend(420, 342, [("dot", BLUE, "representative"), ("dot", MUTED, "represented")], 160)
    page.write(path)


# bench/accuracy/results/2026-11-23-min-hole.csv: holes of 960, of all noises.
DIAMETERS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5)
REPORTED = {
    "eight points in a cell": (BLUE, (0.0, 0.0, 0.0, 0.009, 0.24, 0.965, 0.998, 0.999, 0.999)),
    "scan lines, 2/3 of a cell apart": (GREEN, (0.0, 0.0, 0.0, 0.003, 0.255, 0.94, 0.999, 0.997, 1.0)),
    "a point in every other cell": (ORANGE, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.045, 0.556)),
}


def min_hole(path):
    page = Page(820, 380, "Which holes --min-hole reports, by their diameter")
    x0, y0, width, height = 70, 30, 430, 280

    def at(diameter, share):
        return x0 + (diameter - 0.4) / 1.1 * width, y0 + (1 - share) * height

    for share in (0, 0.25, 0.5, 0.75, 1):
        (left, y), (right, _) = at(0.4, share), at(1.5, share)
        page.parts.append(f'<line x1="{left:.1f}" y1="{y:.1f}" x2="{right:.1f}" y2="{y:.1f}" stroke="{LINE}"/>')
        page.text(left - 8, y + 5, f"{100 * share:.0f} %", MUTED, "end")
    for diameter in (0.4, 0.6, 0.8, 1.0, 1.2, 1.4):
        page.text(at(diameter, 0)[0], y0 + height + 20, f"{diameter}", MUTED, "middle")
    page.text(x0 + width / 2, y0 + height + 44, "diameter of the hole, in --min-hole", INK, "middle")
    for color, shares in REPORTED.values():
        d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in (at(*p) for p in zip(DIAMETERS, shares)))
        page.parts.append(f'<path d="{d}" fill="none" stroke="{color}" stroke-width="2.5"/>')
    page.text(520, 60, "Holes reported", weight="bold")
    page.legend(520, 88, [("line", color, words) for words, (color, _) in REPORTED.items()])
    page.write(path)


FIGURES = {"lines": lines, "min_hole": min_hole}
