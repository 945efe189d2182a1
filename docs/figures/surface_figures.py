# SPDX-License-Identifier: Apache-2.0
"""Figures of parts B and C: graph and loop of method `paper`, stars, triangles, wedges of method `tangential`."""

import math

from scans import COARSE, FINE, SCALES, centres, find, has, inverted, nearest_to, patch, triangles, uneven
from svg import BLUE, FILL, GREEN, INK, LINE, MUTED, ORANGE, RED, Page

HOLE = (9.0, 8.0, 2.9)
LIGHT_ORANGE, LIGHT_GREEN = "#f5d7b0", "#cfe6d8"


def surface(noise=0.12, seed=4, jitter=0.45, threshold=0.5):
    found = find(patch(18, [HOLE], jitter, noise, seed), threshold=threshold)
    scan = found.levels[0]
    # The points of the fine loop around the hole.
    scan.curve = min((loop for loop in found.loops if (loop.level, loop.scale) == (0, FINE)),
                     key=lambda loop: max(math.dist(p[:2], HOLE[:2]) for p in loop.places)).points
    return scan


def corners(scan, *ids):
    return [scan.places[p] for p in ids]


def active_triangles(scan, consistent=True):
    """Triangles within the fine bound in the stars of active points."""
    return sorted({tuple(sorted((p, a, b))) for p in scan.active for i, a, b in triangles(scan.points[p])
                   if scan.points[p].consistent[i][FINE] == consistent})


def active(path):
    scan = surface(0.3, threshold=0.8)
    page = Page(700, 440, "Active points around a hole")
    panel = page.panel(20, 20, 410, 400, (9, 8), 11)
    for t in active_triangles(scan):
        panel.path(corners(scan, *t), "#a9c3da", 0.8, FILL, closed=True)
    for t in active_triangles(scan, consistent=False):
        panel.path(corners(scan, *t), RED, 1.2, closed=True, dash=True)
    panel.dots(scan.places, MUTED, 3)
    panel.dots(corners(scan, *sorted(scan.active - set(scan.seeds))), ORANGE, 5)
    panel.dots(corners(scan, *scan.seeds), RED, 5)
    page.legend(448, 50, [("dot", RED, "seed: \u03a0 > threshold, 0.8 here"), ("dot", ORANGE, "active, not a seed"),
                          ("dot", MUTED, "not active"), ("fill", FILL, "consistent triangle"),
                          ("dash", RED, "inconsistent, in bound")])
    page.text(448, 180, "Triangles over the bound are\ninconsistent, too; they fill the\nhole and are not drawn.", MUTED)
    page.text(448, 255, "Activity passes from an active\npoint to the vertices of the\ninconsistent triangles around it.", MUTED)
    page.write(path)


def star(path):
    scan = surface(0.0, jitter=0.3)
    p = nearest_to(scan.places, (4, 12))
    s, at = scan.points[p], scan.places[p]
    hull, outer = ([inverted(scan, p, q) for q in ids] for ids in (s.link, [q for q in s.around if q not in s.link]))
    cell = [(at[0] + x, at[1] + y) for x, y in centres(scan, p)]
    page = Page(700, 430, "Star of a point, and its dual")
    left = page.panel(20, 20, 320, 320, at, 4.6)
    link = corners(scan, *s.link)
    for i, q in enumerate(link):
        left.path([at, q, link[(i + 1) % len(link)]], BLUE, 1.3, FILL, closed=True)
    left.path(cell, ORANGE, 2.2, closed=True)
    left.dots(corners(scan, *s.around), MUTED, 4)
    left.dots(link, BLUE, 5)
    left.dots([at], INK, 6)
    left.label(at, "p", 9, 4, weight="bold")
    right = page.panel(360, 20, 320, 320, (0, 0), 2.3 * max(math.hypot(x, y) for x, y in hull))
    right.path(hull, BLUE, 1.6, FILL, closed=True)
    right.dots(outer, MUTED, 4)
    right.dots(hull, BLUE, 5)
    i = max(range(len(s.link)), key=lambda i: s.radius[i])
    (x, y), (x2, y2) = hull[i], hull[(i + 1) % len(hull)]
    t = -(x * (x2 - x) + y * (y2 - y)) / ((x2 - x) ** 2 + (y2 - y) ** 2)
    foot = (x + t * (x2 - x), y + t * (y2 - y))
    right.path([(0, 0), foot], RED, 2)
    right.label((foot[0] / 2, foot[1] / 2), "h", 6, -4, RED, weight="bold")
    left.path([at, cell[i]], RED, 2)
    right.dots([(0, 0)], INK, 6)
    right.label((0, 0), "p", -16, 4, weight="bold")
    page.text(20, 362, "In the tangent plane of p", weight="bold")
    page.text(360, 362, "Inverted: q at proj(d) / |d|\u00b2", weight="bold")
    page.legend(20, 388, [("fill", FILL, "triangles of the star"), ("line", ORANGE, "Voronoi cell of p")], 170)
    page.legend(20, 412, [("dot", BLUE, "link vertices"), ("dot", MUTED, "other neighbours")], 170)
    page.legend(360, 388, [("line", BLUE, "convex hull: its vertices are the link")])
    page.legend(360, 412, [("line", RED, "left: circumradius 1 / (2h); right: h")])
    page.write(path)


def bound(path):
    scan = surface()

    def kinds(s):
        return [sum(x > b for b in s.bounds) for x in s.radius]
    curve = [p for p in scan.curve if {0, 1, 2} <= set(kinds(scan.points[p]))]
    p = min(curve, key=lambda q: (math.dist(scan.places[q][:2], (HOLE[0], HOLE[1] + HOLE[2])), q))
    s, at, circles = scan.points[p], scan.places[p], list(centres(scan, p))
    most = s.distance / 2
    radii = [sorted(x for x in star.radius if x <= 0.85 * star.distance) for star in (scan.points[q] for q in [p, *s.around])]
    middle, spread = (min(sorted(x)[len(x) // 2], most) for x in zip(*((r[len(r) // 2], r[len(r) // 2] - r[0]) for r in radii if r)))
    page = Page(700, 400, "Circumradii of a star and their bounds")
    panel = page.panel(20, 20, 410, 360, (at[0] + 0.1, at[1] - 0.7), 7.7)
    panel.dots(scan.places, LINE, 3.4)
    n = len(s.link)
    for i, kind in sorted(enumerate(kinds(s)), key=lambda entry: -entry[1]):
        color, fill = ((BLUE, FILL), (ORANGE, LIGHT_ORANGE), (RED, "none"))[kind]
        panel.path(corners(scan, p, s.link[i], s.link[(i + 1) % n]), color, 1.3, fill, closed=True, dash=kind == 2)
        panel.circle((at[0] + circles[i][0], at[1] + circles[i][1]), s.radius[i], color, 0.9, dash=kind == 2)
    panel.dots(corners(scan, *s.link), BLUE, 4.5)
    panel.dots([at], INK, 6)
    page.legend(448, 50, [("dot", INK, "a point at a hole"), ("dot", BLUE, "its link vertices"),
                          ("fill", FILL, "within the fine bound"), ("fill", LIGHT_ORANGE, "within the coarse bound"),
                          ("dash", RED, "beyond both, with circle")])
    page.text(448, 172, f"Median radius M = {middle:.2f},\nradius spread S = {spread:.2f}:\n"
                        f"fine bound 1.5 M + S = {s.bounds[FINE]:.2f},\ncoarse bound 2 times that: {s.bounds[COARSE]:.2f}.", INK)
    page.text(448, 262, "Circumradii of the star:", MUTED)
    for i, (radius, kind) in enumerate(sorted(zip(s.radius, kinds(s)))):
        page.text(448 + 50 * (i % 4), 284 + 20 * (i // 4), f"{radius:.2f}", (BLUE, ORANGE, RED)[kind])
    page.write(path)


def consistency(path):
    scan = surface(0.4, 9)
    # An active pair near the hole, of which one star has a triangle within the bound that the other lacks.
    found = [(math.dist(scan.places[p][:2], HOLE[:2]), p, a, b) for p in sorted(scan.active)
             for _, a, b in triangles(scan.points[p]) if a in scan.active and not has(scan.points[a], p, b)]
    _, p, a, b = min(found)
    page = Page(700, 420, "A consistent and an inconsistent triangle")
    shared = sorted(c for _, x, y in triangles(scan.points[p]) for c in (x, y)
                    if a in (x, y) and c != a and has(scan.points[a], p, c))
    centre = [(scan.places[p][i] + scan.places[a][i]) / 2 for i in range(2)]
    for i, (q, name) in enumerate(((p, "p"), (a, "q"))):
        panel = page.panel(20 + 340 * i, 20, 320, 320, centre, 5.0)
        panel.dots(scan.places, LINE, 3.4)
        for _, x, y in triangles(scan.points[q]):
            kind = {q, x, y}
            fill = LIGHT_GREEN if shared and kind == {p, a, shared[0]} else LIGHT_ORANGE if kind == {p, a, b} else FILL
            panel.path(corners(scan, q, x, y), BLUE, 1.3, fill, closed=True)
        panel.path(corners(scan, p, a, b), ORANGE, 2.4, closed=True, dash=i == 1)
        if shared:
            panel.path(corners(scan, p, a, shared[0]), GREEN, 2.4, closed=True)
        panel.dots(corners(scan, *scan.points[q].link), BLUE, 4)
        panel.dots(corners(scan, p, a), INK, 6)
        panel.label(scan.places[p], "p", -18, 5, weight="bold")
        panel.label(scan.places[a], "q", 10, 5, weight="bold")
        page.text(20 + 340 * i, 364, f"The star of {name}, within the bound", weight="bold")
    page.legend(20, 394, [("fill", LIGHT_GREEN, "consistent: in both stars"),
                          ("fill", LIGHT_ORANGE, "inconsistent: in the star of p only")], 250)
    page.write(path)


def wedges(path):
    scan = surface()
    # The wedge of a curve's point ends at the points before and behind it.
    curve, n = scan.curve, len(scan.curve)
    chained = [(p, first, last) for i, p in enumerate(curve) for at, first, last in scan.wedges
               if at == p and {first, last} == {curve[i - 1], curve[(i + 1) % n]}]
    page = Page(700, 440, "Boundary wedges chained to a curve")
    panel = page.panel(20, 20, 410, 400, HOLE[:2], 10)
    for t in active_triangles(scan):
        panel.path(corners(scan, *t), "#a9c3da", 0.8, FILL, closed=True)
    for wedge in chained:
        at, first, last = corners(scan, *wedge)
        start = math.atan2(first[1] - at[1], first[0] - at[0])
        angle = (math.atan2(last[1] - at[1], last[0] - at[0]) - start) % (2 * math.pi)
        arc = [(at[0] + 0.42 * math.cos(start + angle * j / 16), at[1] + 0.42 * math.sin(start + angle * j / 16)) for j in range(17)]
        panel.path([at, *arc], ORANGE, 1, LIGHT_ORANGE, closed=True)
    panel.path(corners(scan, *curve), RED, 2.8, closed=True)
    panel.dots(scan.places, MUTED, 3)
    panel.dots(corners(scan, *curve), INK, 4.5)
    page.legend(448, 50, [("fill", FILL, "consistent triangle"), ("fill", LIGHT_ORANGE, "boundary wedge"),
                          ("line", RED, "boundary curve"), ("dot", INK, "its points")])
    page.text(448, 160, "A wedge ends at two boundary\nedges. Each edge ends one wedge\nat either of its points, so the\n"
                        f"wedges chain to a closed curve:\nhere {n} points.", MUTED)
    page.write(path)


def scales(path):
    hole = (12, 12, 4.6)
    found = find(uneven(hole))
    scan = found.levels[0]
    surer = max((loop for loop in found.loops if (loop.level, loop.scale) == (0, COARSE)), key=lambda loop: loop.odds)
    other = max((loop for loop in found.loops if (loop.level, loop.scale) == (0, FINE)),
                key=lambda loop: len(set(loop.points) & set(surer.points)))
    fine, coarse = ({min((p, a, b), (a, b, p), (b, p, a)) for p, s in enumerate(scan.points)
                     for i, a, b in triangles(s, scale) if s.consistent[i][scale]} for scale in SCALES)
    page = Page(700, 440, "A hole of an uneven scan, within both bounds")
    panel = page.panel(20, 20, 410, 400, (12.6, 12), 17.6)
    for surface_of, fill in ((fine, FILL), (coarse - fine, LIGHT_ORANGE)):
        panel.triangles([corners(scan, *t) for t in sorted(surface_of)], "#a9c3da", 0.5, fill)
    panel.dots(scan.places, MUTED, 2)
    panel.path(other.places, BLUE, 5, closed=True)
    panel.path(surer.places, RED, 2.2, closed=True)
    panel.circle(hole[:2], hole[2], INK, 1.2, dash=True)
    page.legend(448, 50, [("fill", FILL, "within the fine bound"),
                          ("fill", LIGHT_ORANGE, "within the coarse bound only"),
                          ("line", BLUE, "fine loop"),
                          ("line", RED, "coarse loop"), ("dash", INK, "the hole, as made")])
    page.text(448, 172, f"Clearness {other.clearness:.2f} and {surer.clearness:.2f},\n"
                        f"surface share {other.surface:.2f} and {surer.surface:.2f}:\n"
                        f"confidence {other.confidence:.2f} and {surer.confidence:.2f}.\nThe coarse loop is surer.", MUTED)
    page.text(448, 262, "White places around are gaps of\nthe sampling. Their curves have\nfewer than 8 points, or little\n"
                        "clearness.", MUTED)
    page.write(path)


def msg(path):
    found = find(patch(18, [HOLE], 0.3, 0.0, 4))
    scan, graph = found.levels[0], found.graph
    loop = min(found.paper, key=lambda l: max(math.dist(scan.places[p][:2], HOLE[:2]) for p in l))
    page = Page(700, 440, "Minimum spanning graph and its loop")
    panel = page.panel(20, 20, 410, 400, HOLE[:2], 10)
    panel.lines([corners(scan, *edge) for edge in found.eligible], LINE, 1)
    panel.lines([corners(scan, p, q) for p, row in enumerate(graph) for q in sorted(row or []) if p < q], BLUE, 1.8)
    panel.path(corners(scan, *loop), RED, 3, closed=True)
    panel.dots(scan.places, MUTED, 3)
    panel.dots(corners(scan, *scan.seeds), ORANGE, 4.5)
    panel.dots(corners(scan, loop[0]), INK, 6)
    page.legend(448, 50, [("dot", ORANGE, "candidate: \u03a0 > threshold"), ("line", LINE, "eligible edge"),
                          ("line", BLUE, "edge of the spanning graph"), ("line", RED, f"loop of {len(loop)} edges"),
                          ("dot", INK, "origin of the search")])
    page.text(448, 180, f"An edge that closes a loop needs\nmore than e = {found.e} edges on it.", MUTED)
    page.write(path)


FIGURES = {"msg": msg, "active": active, "star": star, "bound": bound, "consistency": consistency, "wedges": wedges,
           "scales": scales}
