# SPDX-License-Identifier: Apache-2.0
"""Part C of docs/method.md, plainly and in memory, for the figures."""

import math
import struct
from dataclasses import dataclass, field

from common import add, dot, evaluate, frame, neighbourhoods, sub

FINE, COARSE = SCALES = 0, 1

# C.7
MAX_RADIUS, HOLE_RADIUS, MOST_RADIUS = 1.5, 0.85, 0.5
COARSE_BOUND, CLEAR_RADIUS, ADDED_LENGTH, MIN_CURVE = 2, 2.5, 4, 8


def hash_share(place):
    """A number in [0, 1) that looks random: the weights' share."""
    mixed = 0
    for coordinate in place:  # SplitMix64
        mixed ^= struct.unpack("<Q", struct.pack("<d", coordinate + 0.0))[0]
        mixed = (mixed + 0x9E3779B97F4A7C15) % 2**64
        mixed = (mixed ^ mixed >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        mixed = (mixed ^ mixed >> 27) * 0x94D049BB133111EB % 2**64
        mixed ^= mixed >> 31
    return (mixed >> 11) / 2**53


@dataclass
class Star:
    link: list = field(default_factory=list)  # neighbours in counterclockwise order
    inverted: list = field(default_factory=list)  # where each lies after the inversion
    radius: list = field(default_factory=list)  # circumradius of the triangle (p, link[i], link[i + 1])
    centre: list = field(default_factory=list)  # its circumcentre in the tangent plane
    seen: list = field(default_factory=list)  # all inverted neighbours: (x, y, q)
    distance: float = 0.0  # d_p
    median: float = 0.0  # M_p
    spread: float = 0.0  # S_p
    bounds: tuple = (0.0, 0.0)  # R_p, by scale
    sampling: tuple = (0.0, 0.0)  # sampling radius, by scale

    def circles(self):
        """The circumradii that do not lie in a hole, ascending."""
        return sorted(x for x in self.radius if x <= HOLE_RADIUS * self.distance)

    def triangles(self, scale=FINE):
        """Those within the bound: (index of the link edge, a, b)."""
        n = len(self.link)
        return [(i, self.link[i], self.link[(i + 1) % n]) for i in range(n) if self.radius[i] <= self.bounds[scale]]


@dataclass
class Wedge:
    point: int
    first: int  # the ends of its boundary edges
    last: int
    length: float  # of the curve at the point
    sampling: float  # the point's sampling radius
    distance: float  # d_p of the point
    clearness: float
    surface: float  # mean surface share of its neighbours


def hull(points):
    """Convex hull, counterclockwise (Andrew)."""
    points = sorted(points)

    def chain(ordered):
        result = []
        for p in ordered:
            while len(result) > 1 and turn(result[-2], result[-1], p) <= 0:
                result.pop()
            result.append(p)
        return result[:-1]
    return chain(points) + chain(points[::-1])


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def site(points, evaluations, p):
    e = evaluations[p]
    return add(points[p], e.normal, dot(e.normal, e.mean)), 1e-5 * hash_share(points[p]) * e.r**2


def star_of(points, evaluations, p, neighbours):
    position, weight = site(points, evaluations, p)
    u, v = frame(evaluations[p].normal)
    star = Star()
    star.distance = (len(neighbours) + 1) / sum(1 / evaluations[q].r for q in [p, *neighbours])
    for q in neighbours:
        other, other_weight = site(points, evaluations, q)
        d = sub(other, position)
        power = dot(d, d) + weight - other_weight
        if power > 0:
            star.seen.append((dot(d, u) / power, dot(d, v) / power, q))
    corners = hull(star.seen)
    if len(corners) < 3:
        return star
    for i, (x, y, q) in enumerate(corners):
        x2, y2, _ = corners[(i + 1) % len(corners)]
        length = math.hypot(x2 - x, y2 - y)
        height = (x * y2 - y * x2) / length
        largest = 8 * star.distance
        star.link.append(q)
        star.inverted.append((x, y))
        star.radius.append(min(1 / (2 * height), largest) if height > 0 else largest)
        centre = ((y2 - y) / (2 * height * length), (x - x2) / (2 * height * length)) if height > 0 else (0.0, 0.0)
        star.centre.append(centre)
    return star


def median(numbers):
    return sorted(numbers)[len(numbers) // 2]


def set_bounds(stars, around):
    """M_p, S_p, R_p and the sampling radii from the circumradii around."""
    circles = [star.circles() for star in stars]
    for p, star in enumerate(stars):
        most = MOST_RADIUS * star.distance
        known = [circles[q] for q in [p, *around[p]] if circles[q]]
        star.median = min(median([median(c) for c in known]), most) if known else most
        star.spread = min(median([median(c) - c[0] for c in known]), most) if known else most
        bound = MAX_RADIUS * star.median + star.spread
        star.bounds = (bound, COARSE_BOUND * bound)
        star.sampling = tuple(sampling_radius([x for c in known for x in c[:8]], bound) for bound in star.bounds)


def sampling_radius(circles, bound):
    """What nine in ten of the circles within the bound do not exceed, rounded up to a 64th of the bound."""
    steps = sorted(int(circle * 64 / bound) for circle in circles if circle * 64 / bound < 64)
    return (steps[len(steps) * 9 // 10] + 1) / 64 * bound if steps else bound


def first_way(curve, key):
    """The way to write a closed curve whose keys come first."""
    keys = [key(w) for w in curve]
    ways = [way[i:] + way[:i] for way in (list(zip(keys, curve)), list(zip(keys, curve))[::-1])
            for i, (own, _) in enumerate(way) if own == min(keys)]
    return [w for _, w in min(ways, key=lambda way: [own for own, _ in way])]


def normalised(curve):
    return first_way(curve, lambda w: w.point)


def points_of(curve):
    return [w.point for w in curve]


def simple_curves(curve, points):
    """Splits a curve where it passes a point twice."""
    path, parts = [], []
    for w in first_way(curve, lambda w: tuple(points[w.point])):
        passed = points_of(path)
        if w.point in passed:
            begin = passed.index(w.point)
            parts.append(normalised(path[begin:]))
            del path[begin:]
        path.append(w)
    return [*parts, normalised(path)]


def length(curve):
    return sum(w.length for w in curve)


def clearness(curve):
    """C.6"""
    clear = sum(w.clearness * w.length for w in curve)
    return clear / (length(curve) + ADDED_LENGTH * sum(w.sampling for w in curve) / len(curve))


class Surface:
    """Everything of a point set: evaluations, stars, active points; boundary wedges and curves, by scale."""

    def __init__(self, points, k=15, is_seed=lambda e: e.probability > 0.5, weights=(1, 1, 1), names=None):
        self.points = points
        self.names = names or range(len(points))  # ids in the input, ascending
        self.nearest, self.around = neighbourhoods(points, k)
        self.evaluations = [evaluate(points, p, self.around[p], weights) for p in range(len(points))]
        self.stars = [star_of(points, self.evaluations, p, self.around[p]) for p in range(len(points))]
        set_bounds(self.stars, self.around)
        self.kept = [[{frozenset((a, b)) for _, a, b in s.triangles(scale)} for s in self.stars] for scale in SCALES]
        self.seeds = {p for p, e in enumerate(self.evaluations) if is_seed(e)}
        self.active = self.grow()
        self.wedges = [[w for p in sorted(self.active) for w in self.wedges_of(p, scale)] for scale in SCALES]
        self.curves = [self.chain(scale) for scale in SCALES]

    def edges_of(self, p):
        link = self.stars[p].link
        return [(link[i], link[(i + 1) % len(link)]) for i in range(len(link))]

    def has(self, p, a, b, scale=FINE):
        """The triangle is in the star of p."""
        return frozenset((a, b)) in self.kept[scale][p]

    def is_consistent(self, p, a, b, active, scale=FINE):
        """The triangle is in the star of p and in those of its active vertices."""
        return (self.has(p, a, b, scale) and (a not in active or self.has(a, p, b, scale)) and
                (b not in active or self.has(b, p, a, scale)))

    def grow(self):
        """The least fixed point."""
        active = set(self.seeds)
        while True:
            more = {q for p in active for a, b in self.edges_of(p) if not self.is_consistent(p, a, b, active)
                    for q in (a, b)} - active
            if not more:
                return active
            active |= more

    def wedges_of(self, p, scale):
        edges, star = self.edges_of(p), self.stars[p]
        surface = sum(self.evaluations[q].surface_share for q in self.around[p]) / len(self.around[p])
        n = len(edges)
        good = [self.is_consistent(p, a, b, self.active, scale) for a, b in edges]
        result = []
        for i in range(n):
            if good[i] and not good[(i + 1) % n]:
                end, largest = (i + 1) % n, 0.0
                while not good[end]:
                    largest = max(largest, star.radius[end])
                    end = (end + 1) % n
                first, last, sampling = edges[i][1], edges[end][0], star.sampling[scale]
                way = math.dist(self.points[first], self.points[p]) + math.dist(self.points[p], self.points[last])
                clear = min(max((largest / sampling - 1) / (CLEAR_RADIUS - 1), 0), 1)
                result.append(Wedge(p, first, last, way / 2, sampling, star.distance, clear, surface))
        return result

    def chain(self, scale):
        """Closed curves of wedges that pass each point once, sorted."""
        at = {(w.point, end): w for w in self.wedges[scale] for end in (w.first, w.last)}
        done, curves = set(), []
        for start in self.wedges[scale]:
            curve, w, came = [], start, start.first
            while id(w) not in done:
                done.add(id(w))
                curve.append(w)
                came, leave = w.point, w.last if came == w.first else w.first
                w = at[leave, came]
            if len(curve) >= MIN_CURVE:
                curves += [c for c in simple_curves(curve, self.points) if len(c) >= MIN_CURVE]
        return sorted(curves, key=lambda c: (c[0].point, len(c), points_of(c)))
