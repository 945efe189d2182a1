# SPDX-License-Identifier: Apache-2.0
"""Part D of docs/method.md, plainly and in memory, for the figures: levels, tracks, confidence and choice."""

import math
from dataclasses import dataclass

from common import cross, dot, norm, sub
from tangential import SCALES, Surface, clearness, points_of

DISTANCE_OVER_SPACING = 1.7
FEWEST, WANTED_LEFT, MOST_LEFT = 200, 0.6, 0.9
SAME, NEAR, APART = 0.7, 0.5, 2  # shares of cells; levels


@dataclass
class Loop:
    points: list  # ids
    places: list
    level: int
    scale: int
    clearness: float
    surface: float
    spacing: float
    gap: float
    offsets: list  # from each point to the mean of its neighbours
    odds: float = 0.0  # their logarithm
    confidence: float = 0.0
    first: float = 0.0  # edges of the first and the last lattice of the track
    last: float = 0.0


# ---- D.1 Levels

def step_of(length):
    """The start of its step, of 64 steps an octave."""
    mantissa, power = math.frexp(length)
    return math.ldexp(math.floor(mantissa * 128) / 128, power)


def median(lengths):
    """As if the lengths within a step were spread evenly over it."""
    steps, half, before = [step_of(x) for x in lengths], len(lengths) / 2, 0
    for step in sorted(set(steps)):
        count = steps.count(step)
        if before + count >= half:
            _, power = math.frexp(step)
            return step + (half - before) / count * math.ldexp(1 / 128, power)
        before += count
    return 0.0


def power_above(length):
    """The first power of sqrt 2 above a length."""
    octave = math.ldexp(1.0, math.frexp(length)[1] - 1)
    return octave * math.sqrt(2) if octave * math.sqrt(2) > length else 2 * octave


def share_left(lengths, edge):
    return sum(1 / (1 + (edge * DISTANCE_OVER_SPACING / step_of(r)) ** 2 / 2.6) for r in lengths) / len(lengths)


def cell_of(p, edge):
    return tuple(0 if -0.25 <= x * (1 / edge) < 0 else math.floor(x * (1 / edge)) for x in p)


def representatives(points, edge):
    """The points nearest to the middle of their cell, by their numbers."""
    nearest = {}
    for i, p in enumerate(points):
        cell = cell_of(p, edge)
        rank = (sum((x * (1 / edge) - c - 0.5) ** 2 for x, c in zip(p, cell)), *p, i)
        nearest[cell] = min(nearest.get(cell, rank), rank)
    return sorted(rank[-1] for rank in nearest.values())


def level_above(surface, edge, **options):
    """The surface of the level above and its edge, or None."""
    lengths = [e.r for e in surface.evaluations]
    edge = power_above(max(edge * 1.0001, step_of(min(lengths)) / 4))
    while share_left(lengths, edge) > WANTED_LEFT:
        edge = power_above(edge * 1.0001)
    while True:
        kept = representatives(surface.points, edge)
        if len(kept) < FEWEST:
            return None
        if len(kept) <= MOST_LEFT * len(surface.points):
            return Surface([surface.points[i] for i in kept], names=[surface.names[i] for i in kept], **options), edge
        edge = power_above(edge * 1.0001)


def levels_of(points, **options):
    """Surfaces and their edges, from fine to coarse."""
    levels = [(Surface(points, **options), 0.0)]
    while above := level_above(*levels[-1], **options):
        levels.append(above)
    return levels


# ---- C.6 Evidence

def loops_of(surface, level=0):
    loops = []
    for scale in SCALES:
        for curve in surface.curves[scale]:
            n, sampling, distance = (len(curve), sum(w.sampling for w in curve), sum(w.distance for w in curve))
            loop = Loop([surface.names[p] for p in points_of(curve)], [surface.points[p] for p in points_of(curve)],
                        level, scale, clearness(curve), sum(w.surface for w in curve) / n,
                        distance / n / DISTANCE_OVER_SPACING, sampling / distance,
                        [surface.evaluations[p].mean for p in points_of(curve)])
            if loop.clearness >= 0.5 and loop.surface >= 0.3:
                loops.append(loop)
    return sorted(loops, key=lambda x: (x.points[0], len(x.points), x.points, x.scale))


# ---- D.2 The same hole

def drawn(loop, edge):
    """The cells that the loop passes through."""
    cells = set()
    for a, b in zip(loop.places, loop.places[1:] + loop.places[:1]):
        steps = min(math.ceil(math.dist(a, b) / edge), 16)
        for i in range(1, steps + 1):
            p = b if i == steps else tuple(x + (y - x) * (i / steps) for x, y in zip(a, b))
            cells.add(tuple(math.floor(x / edge) for x in p))
    return cells


def share_near(cells, others):
    steps = (-1, 0, 1)
    wide = {(x + i, y + j, z + k) for x, y, z in others for i in steps for j in steps for k in steps}
    return len(cells & wide) / len(cells)


def shares_of(loops, cell_edges):
    """By pair of loops: the share of the first one's cells near the second one."""
    near = {}
    has_chance = [loop.odds + 2 * (0.7 if shape_of(loop)[3] else 1.1) > -4 for loop in loops]
    for a, x in enumerate(loops):
        for b, y in enumerate(loops):
            if a != b and abs(x.level - y.level) <= APART and has_chance[a] and has_chance[b]:
                edge = cell_edges[max(x.level, y.level)]
                near[a, b] = share_near(drawn(x, edge), drawn(y, edge))
    return near


def is_same(near, a, b):
    return near[a, b] >= SAME and near[b, a] >= SAME


# ---- D.3 Confidence

def shape_of(loop):
    """The centroid, the area vector (Newell), the perimeter, and whether the loop is a hole."""
    places, count = loop.places, len(loop.places)
    centroid = tuple(sum(p[i] for p in places) / count for i in range(3))
    area, length = (0.0, 0.0, 0.0), 0.0
    for p, q in zip(places, places[1:] + places[:1]):
        area = tuple(s + x / 2 for s, x in zip(area, cross(sub(p, centroid), sub(q, centroid))))
        length += math.dist(p, q)
    size, growth, most = norm(area), 0.0, 0.0
    for i, offset in enumerate(loop.offsets):
        along = sub(places[(i + 1) % count], places[i - 1])
        growth += dot(offset, cross(along, area)) / (size or 1)
        most += norm(offset) * norm(along)
    return centroid, area, length, not growth < -0.1 * most


def is_within(polygon, x, y):
    crossed = 0
    for (ax, ay), (bx, by) in zip(polygon[-1:] + polygon[:-1], polygon):
        if min(ay, by) <= y < max(ay, by):
            crossed += x < ax + (y - ay) / (by - ay) * (bx - ax)
    return crossed % 2 == 1


def nearest(pixel, marked):
    """The squared distance to the nearest of the marked pixels, and that pixel."""
    return min(((pixel[0] - row) ** 2 + (pixel[1] - column) ** 2, (row, column)) for row, column in marked)


def prominence(loop, centroid, area, length, points):
    size = norm(area)
    width = 2 * size / length
    normal = tuple(x / size for x in area)
    least = min(range(3), key=lambda i: abs(normal[i]))
    u = cross(normal, tuple(float(i == least) for i in range(3)))
    u = tuple(x / norm(u) for x in u)
    axes = (u, cross(normal, u), normal)
    rim = [tuple(dot(axis, sub(p, centroid)) for axis in axes) for p in loop.places]
    lows, highs = ([extreme(p[i] for p in rim) + grow for i in range(2)] for extreme, grow in ((min, -width), (max, width)))
    side = max(high - low for low, high in zip(lows, highs))
    edge = min(max(loop.spacing / 2, side / 255), side / 24)
    counts = [int((high - low) / edge) + 1 for low, high in zip(lows, highs)]
    corner = [(low + high - edge * count) / 2 for low, high, count in zip(lows, highs, counts)]

    def pixel_of(place):
        return tuple(math.floor((place[i] - corner[i]) / edge) for i in (1, 0))

    heights = {pixel_of(p): p[2] for p in rim}
    sampled = set()
    for p in points:
        place = tuple(dot(axis, sub(p, centroid)) for axis in axes)
        row, column = pixel_of(place)
        if 0 <= row < counts[1] and 0 <= column < counts[0]:
            if abs(place[2] - heights[nearest((row, column), heights)[1]]) <= width:
                sampled.add((row, column))
    deepest, around = 0, []
    for row in range(counts[1]):
        for column in range(counts[0]):
            x, y = (corner[i] + edge * (at + 0.5) for i, at in enumerate((column, row)))
            if is_within([p[:2] for p in rim], x, y):
                deepest = max(deepest, nearest((row, column), sampled)[0])
            elif nearest((row, column), heights)[0] <= (width / edge) ** 2:
                around.append(nearest((row, column), sampled)[0])
    gap = sorted(around)[int(0.9 * len(around))]
    return (math.sqrt(deepest) + 0.5) / (math.sqrt(gap) + 0.5)


def octaves(ratio):
    mantissa, power = math.frexp(ratio)
    return power - 1 + 2 * mantissa - 1


def octaves_within(ratio, least, most):
    return octaves(min(max(ratio, least), most))


def own_log_odds(loop, points):
    """Without the persistence. `points`: of the loop's level."""
    centroid, area, length, is_hole = shape_of(loop)
    width = 2 * norm(area) / length / loop.spacing
    wide, gap = octaves_within(width, 0.5, 5.0), octaves_within(loop.gap, 0.25, 1.0)
    compact = octaves_within(width / len(loop.places), 1 / 16, 1.0)
    if not is_hole:
        return 3.6 * loop.surface + 1.9 * wide + 0.7 * compact - 3.2 * gap - 6.4
    rest = 9.3 * loop.surface + 3.1 * wide + 1.4 * compact - 7.4 * gap - 16.4
    if rest + 1.4 * 5 + 0.7 * 2 <= 0 or norm(area) == 0:  # no prominence could make it probable
        return rest
    return rest + 1.4 * octaves_within(prominence(loop, centroid, area, length, points), 1.0, 32.0)


def rated(levels):
    """All loops of all levels, each with its confidence, first and last scale; their pairs and ranks."""
    loops = []
    for i, (surface, _) in enumerate(levels):
        of_level = loops_of(surface, i)
        for loop in of_level:
            loop.odds = own_log_odds(loop, surface.points)
        loops += of_level
    edges = [edge for _, edge in levels]
    first = median([e.r for e in levels[0][0].evaluations]) / DISTANCE_OVER_SPACING
    near = shares_of(loops, [edges[0] or first, *edges[1:]])
    lasts, firsts = [x.level for x in loops], [x.level for x in loops]
    links = [(a, b) for a, b in near if loops[a].level < loops[b].level and is_same(near, a, b)]
    for a, b in sorted(links, reverse=True):
        lasts[a] = max(lasts[a], lasts[b])
    for a, b in sorted(links, key=lambda link: link[::-1]):
        firsts[b] = min(firsts[b], firsts[a])
    for i, loop in enumerate(loops):
        loop.first, loop.last = edges[firsts[i]], edges[lasts[i]]
        persistence = octaves(loop.last / loop.spacing) if loop.last > loop.spacing else 0.0
        loop.odds += (0.7 if shape_of(loop)[3] else 1.1) * min(persistence, 2)
        loop.confidence = 1 / (1 + math.exp(-loop.odds))
    return loops, near, [min(x.odds, 4) - 0.8 * (x.level + 0.5 * x.scale) for x in loops]


# ---- D.4 The choice

def choose(loops, near, ranks):
    """The loops that stand."""
    neighbours = [[] for _ in loops]
    for (a, b), share in near.items():
        if share >= NEAR or near[b, a] >= NEAR:
            neighbours[a].append(b)
    standing, covered = [], set()
    for i in sorted(range(len(loops)), key=lambda i: (-ranks[i], i)):
        if i in covered:
            continue
        standing.append(i)
        place, ahead = set(), [i]
        while ahead:
            at = ahead.pop()
            around = set(neighbours[at]) - place - set(standing)
            place |= around
            ahead += [j for j in around if is_same(near, at, j)]
        covered |= place
    return [loops[i] for i in sorted(standing)]


def track(levels):
    return choose(*rated(levels))
