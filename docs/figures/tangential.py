"""Part C of docs/method.md, plainly and in memory, for the figures."""

import math
from dataclasses import dataclass, field

from common import add, dot, evaluate, frame, neighbourhoods, sub


def hash_share(identity):
    """A number in [0, 1) that looks random: the weights' share."""
    mixed = (identity + 1) * 0x9E3779B97F4A7C15 % 2**64
    mixed ^= mixed >> 29
    mixed = mixed * 0xBF58476D1CE4E5B9 % 2**64
    return (mixed >> 40) / 2**24


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
    bound: float = 0.0  # R_p

    def excess(self, i):
        return (self.radius[i] - self.bound) / (self.spread + 0.1 * self.median)

    def triangles(self):
        """Those within the bound: (index of the link edge, a, b)."""
        n = len(self.link)
        return [(i, self.link[i], self.link[(i + 1) % n]) for i in range(n) if self.radius[i] <= self.bound]


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
    return add(points[p], e.normal, dot(e.normal, e.mean)), 1e-4 * hash_share(p) * e.r**2


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
    """M_p, S_p and R_p from the circumradii around."""
    medians, spreads = {}, {}
    for p, star in enumerate(stars):
        radii = [x for x in star.radius if x <= 0.85 * star.distance]
        if radii:
            medians[p] = median(radii)
            spreads[p] = medians[p] - min(radii)
    for p, star in enumerate(stars):
        most = star.distance / 2
        known = [q for q in [p, *around[p]] if q in medians]
        star.median = min(median([medians[q] for q in known]), most) if known else most
        star.spread = min(median([spreads[q] for q in known]), most) if known else most
        star.bound = 1.5 * star.median + star.spread


class Surface:
    """Everything of a point set: evaluations, stars, active points, boundary wedges and curves."""

    def __init__(self, points, k=15, is_seed=lambda e: e.probability > 0.5, weights=(1, 1, 1)):
        self.points = points
        self.nearest, self.around = neighbourhoods(points, k)
        self.evaluations = [evaluate(points, p, self.around[p], weights) for p in range(len(points))]
        self.stars = [star_of(points, self.evaluations, p, self.around[p]) for p in range(len(points))]
        set_bounds(self.stars, self.around)
        self.kept = [{frozenset((a, b)) for _, a, b in star.triangles()} for star in self.stars]
        self.seeds = {p for p, e in enumerate(self.evaluations) if is_seed(e)}
        self.active = self.grow()
        self.wedges = [w for p in sorted(self.active) for w in self.wedges_of(p)]
        self.curves = self.chain()

    def edges_of(self, p):
        link = self.stars[p].link
        return [(link[i], link[(i + 1) % len(link)]) for i in range(len(link))]

    def is_consistent(self, p, a, b, active):
        """The triangle is in the star of p and in those of its active vertices."""
        return (frozenset((a, b)) in self.kept[p] and (a not in active or frozenset((p, b)) in self.kept[a]) and
                (b not in active or frozenset((p, a)) in self.kept[b]))

    def grow(self):
        """The least fixed point."""
        active = set(self.seeds)
        while True:
            more = {q for p in active for a, b in self.edges_of(p) if not self.is_consistent(p, a, b, active)
                    for q in (a, b)} - active
            if not more:
                return active
            active |= more

    def wedges_of(self, p):
        """(p, from, to, largest excess radius)"""
        edges = self.edges_of(p)
        n = len(edges)
        good = [self.is_consistent(p, a, b, self.active) for a, b in edges]
        result = []
        for i in range(n):
            if good[i] and not good[(i + 1) % n]:
                end, excess = (i + 1) % n, 0.0
                while not good[end]:
                    excess = max(excess, self.stars[p].excess(end))
                    end = (end + 1) % n
                result.append((p, edges[i][1], edges[end][0], excess))
        return result

    def chain(self):
        """Closed curves of wedges: lists of (point, excess radius)."""
        at = {}
        for w, (p, a, b, _) in enumerate(self.wedges):
            at[p, a] = at[p, b] = w
        done, curves = set(), []
        for start in range(len(self.wedges)):
            if start in done:
                continue
            curve, w, came = [], start, self.wedges[start][1]
            while w not in done:
                p, a, b, excess = self.wedges[w]
                done.add(w)
                curve.append((p, excess))
                came, leave = p, b if a == came else a
                w = at[leave, came]
            curves.append(curve)
        return curves
