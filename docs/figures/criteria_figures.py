# SPDX-License-Identifier: Apache-2.0
"""Figures of part A: neighbourhood, angle, halfdisc, shape."""

import math

from scans import density_step, find, nearest_to, patch
from svg import BLUE, GREEN, INK, LINE, MUTED, ORANGE, RED, Page

HOLE = (8.0, 8.0, 3.2)
CHARACTERISTIC = {"boundary": (2 / 3, 1 / 3, 0), "interior": (1 / 2, 1 / 2, 0), "corner": (1 / 3, 1 / 3, 1 / 3),
                  "line": (1, 0, 0)}
CENTROID = (11 / 18, 5 / 18, 1 / 9)


def kernel_width(characteristic):
    return math.dist(characteristic, CENTROID) / 3


def neighbourhood(path):
    points = density_step()
    p = nearest_to(points, (-0.45, 0.1))
    around = find(points).levels[0].points[p].around
    nearest = around[:15]
    page = Page(700, 400, "Symmetric neighbourhood at a density step")
    panel = page.panel(20, 20, 410, 360, (0.3, 0.0), 8.2)
    added = around[15:]
    panel.dots(points, LINE, 3.4)
    panel.lines([(points[p], points[q]) for q in nearest], BLUE, 1.4)
    panel.lines([(points[p], points[q]) for q in added], ORANGE, 1.4)
    panel.circle(points[p], math.dist(points[p], points[nearest[-1]]), BLUE, 1.2, dash=True)
    panel.dots([points[q] for q in nearest], BLUE, 4.5)
    panel.dots([points[q] for q in added], ORANGE, 4.5)
    panel.dots([points[p]], INK, 6)
    panel.label(points[p], "p", -16, 5, weight="bold")
    page.legend(448, 50, [("dot", INK, "the point p"), ("dot", BLUE, "its 15 nearest points"),
                          ("dot", ORANGE, "points that count p"), ])
    page.text(473, 111, "among their 15 nearest")
    page.text(448, 150, "Neighbourhood of p:")
    page.text(448, 170, f"{len(around)} points, blue and orange.", weight="bold")
    page.text(448, 205, "The 15 nearest alone reach\nhardly beyond the density step:\np would look like a boundary.", MUTED)
    page.write(path)


def two_points():
    """A scan with a hole, an interior point and a boundary point."""
    points = patch(17, [HOLE], 0.3, seed=5)
    found = find(points).levels[0].points
    places = {"interior point": (3.4, 3.2), "boundary point": (4.6, 8.1)}
    return points, {name: found[nearest_to(points, place)] for name, place in places.items()}


def angle(path):
    points, found = two_points()
    page = Page(700, 424, "Angle criterion: the largest gap")
    for i, (name, p) in enumerate(found.items()):
        at = p.place
        directions = sorted((math.atan2(points[q][1] - at[1], points[q][0] - at[0]), q) for q in p.around)
        gaps = [((b - a) % (2 * math.pi), a, (q, r)) for (a, q), (b, r) in zip(directions, directions[1:] + directions[:1])]
        gap, start, ends = max(gaps)
        panel = page.panel(20 + 340 * i, 20, 320, 300, at, 6.6)
        panel.dots(points, LINE, 3.4)
        # the gap, counterclockwise from its first neighbour
        sector = [at] + [(at[0] + 2.6 * math.cos(start + gap * j / 40), at[1] + 2.6 * math.sin(start + gap * j / 40))
                         for j in range(41)]
        panel.path(sector, "none", 0, ORANGE, closed=True, opacity=0.3)
        panel.lines([(at, points[q]) for _, q in directions], BLUE, 1.3)
        panel.dots([points[q] for q in p.around], BLUE, 4)
        panel.dots([points[q] for q in ends], ORANGE, 5.5)
        panel.dots([at], INK, 6)
        page.text(20 + 340 * i, 345, name[0].upper() + name[1:], weight="bold")
        words = f"{len(directions)} directions, gap {math.degrees(gap):.0f}\u00b0, criterion {p.angle:.2f}"
        page.text(20 + 340 * i, 366, words)
    page.legend(20, 402, [("fill", "#f5d7b0", "largest gap"), ("dot", ORANGE, "gap neighbours"),
                          ("dot", BLUE, "other neighbours"), ("dot", INK, "point p")], 170)
    page.write(path)


def halfdisc(path):
    points, found = two_points()
    page = Page(700, 420, "Halfdisc criterion: the mean of the neighbours")
    for i, (name, p) in enumerate(found.items()):
        at = p.place
        panel = page.panel(20 + 340 * i, 20, 320, 300, at, 5.6)
        panel.dots(points, LINE, 3.4)
        panel.circle(at, p.r, MUTED, 1.2, dash=True)
        panel.circle(at, 4 * p.r / (3 * math.pi), GREEN, 1.6, dash=True)
        for q in p.around:
            weight = math.exp(-(math.dist(points[q], at) / p.r) ** 2)
            panel.dots([points[q]], BLUE, round(2 + 6 * weight, 1))
        mean = (at[0] + p.mean[0], at[1] + p.mean[1])
        panel.path([at, mean], RED, 3)
        panel.dots([at], INK, 5)
        panel.dots([mean], RED, 5)
        page.text(20 + 340 * i, 345, name[0].upper() + name[1:], weight="bold")
        page.text(20 + 340 * i, 366, f"mean moved by {math.hypot(*p.mean[:2]) / p.r:.2f} r, halfdisc {p.halfdisc:.2f}")
    page.legend(20, 400, [("dash", MUTED, "radius r"), ("dash", GREEN, "4r / 3\u03c0"), ("dot", BLUE, "size: weight"),
                          ("dot", RED, "weighted mean"), ("dot", INK, "point p")], 138)
    page.write(path)


def shape(path):
    points = patch(34, [(11.0, 11.0, 4.2), (22.0, 20.0, 3.4)], 0.5, 0.2, seed=2)

    def is_boundary(p):
        x, y, _ = p
        edge = min(x, y, 33 - x, 33 - y)
        return edge < 0.5 or math.hypot(x - 11, y - 11) < 4.7 or math.hypot(x - 22, y - 20) < 3.9

    # In the plane where the three eigenvalues have the sum 1.
    def place(shape):
        return (shape[0] - shape[1]) / math.sqrt(2), (2 * shape[2] - shape[0] - shape[1]) / math.sqrt(6)

    page = Page(700, 400, "Shape criterion: normalised eigenvalues")
    panel = page.panel(20, 20, 410, 360, (0.345, -0.19), 1.04)
    corners = [CHARACTERISTIC[name] for name in ("corner", "interior", "line")]
    panel.path([place(c) for c in corners], MUTED, 1.4, closed=True)
    for name, color in (("boundary", ORANGE), ("interior", BLUE), ("corner", MUTED), ("line", MUTED)):
        center = CHARACTERISTIC[name]
        panel.circle(place(center), kernel_width(center), color, 1.2, color, dash=True, opacity=0.10)
    shapes = [(is_boundary(p.place), place(p.shape)) for p in find(points).levels[0].points]
    panel.dots([s for boundary, s in shapes if not boundary], BLUE, 1.7)
    panel.dots([s for boundary, s in shapes if boundary], ORANGE, 1.9)
    for name, dx, dy, words in (("boundary", -36, 36, "boundary"), ("interior", -8, 24, "interior"),
                                ("corner", 12, -2, "corner, noise"), ("line", -20, 24, "line")):
        panel.dots([place(CHARACTERISTIC[name])], INK, 4.5)
        panel.label(place(CHARACTERISTIC[name]), words, dx, dy, weight="bold")
    panel.dots([place(CENTROID)], INK, 3)
    panel.label(place(CENTROID), "c", 8, 4)
    page.legend(448, 50, [("dot", BLUE, "interior points of a scan"), ("dot", ORANGE, "its boundary points"),
                          ("dot", INK, "characteristic points")])
    page.text(448, 130, "Circles: widths of the kernels,\na third of the distance to c.", MUTED)
    page.text(448, 185, "The triangle holds all possible\nshapes. Its lower side holds flat\n"
                        "ones: the smallest eigenvalue is 0.", MUTED)
    page.write(path)


FIGURES = {"neighbourhood": neighbourhood, "angle": angle, "halfdisc": halfdisc, "shape": shape}
