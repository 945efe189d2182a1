"""The method of docs/method.md, plainly and in memory, for the figures: a few hundred points, no library.

Names and section numbers are those of docs/method.md. Creases (A.2) are left out.
"""

import math
from dataclasses import dataclass, field


# ---- vectors

def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def add(a, b, scale=1.0):
    return (a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return tuple(x / norm(a) for x in a)


def frame(normal):
    """Two unit vectors that span the plane of the normal, right-handed with it."""
    axis = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.7 else (0.0, 1.0, 0.0)
    u = unit(add(axis, normal, -dot(axis, normal)))
    return u, cross(normal, u)


def eigen(matrix):
    """Eigenvalues, largest first, and eigenvectors of a symmetric 3 x 3 matrix (Jacobi)."""
    a = [list(row) for row in matrix]
    v = [[float(i == j) for j in range(3)] for i in range(3)]
    for _ in range(30):
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(a[p][q]) < 1e-30:
                continue
            angle = 0.5 * math.atan2(2 * a[p][q], a[q][q] - a[p][p])
            c, s = math.cos(angle), math.sin(angle)
            for m in (a, v):
                for row in m:
                    row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
            a[p], a[q] = ([c * x - s * y for x, y in zip(a[p], a[q])], [s * x + c * y for x, y in zip(a[p], a[q])])
    order = sorted(range(3), key=lambda i: -a[i][i])
    return [a[i][i] for i in order], [tuple(v[j][i] for j in range(3)) for i in order]


# ---- A. Common part

def neighbourhoods(points, k):
    """N_p: the k nearest, made symmetric; by (squared distance, id). Also the k nearest alone."""
    def key(p):
        return lambda q: (dot(sub(points[q], points[p]), sub(points[q], points[p])), q)
    everyone = range(len(points))
    nearest = [sorted((q for q in everyone if q != p), key=key(p))[:k] for p in everyone]
    symmetric = [set(n) for n in nearest]
    for p in everyone:
        for q in nearest[p]:
            symmetric[q].add(p)
    return nearest, [sorted(symmetric[p], key=key(p)) for p in everyone]


@dataclass
class Evaluation:
    r: float  # mean distance to the neighbours
    mean: tuple  # mu_p - p
    normal: tuple
    directions: list  # (angle in the tangent plane, neighbour), sorted
    gap: tuple  # the gap neighbours: the gap opens counterclockwise from the first to the second
    gap_angle: float
    shape: tuple  # Lambda_p
    angle: float
    halfdisc: float
    shape_probability: float
    probability: float


def evaluate(points, p, neighbours, weights=(1, 1, 1), cone=15.0):
    offsets = [sub(points[q], points[p]) for q in neighbours]
    r = sum(norm(d) for d in offsets) / len(offsets)
    w = [math.exp(-dot(d, d) / (r * r)) for d in offsets]
    mean = (0.0, 0.0, 0.0)
    for d, x in zip(offsets, w):
        mean = add(mean, d, x / sum(w))
    covariance = [[sum(x * (mean[i] - d[i]) * (mean[j] - d[j]) for d, x in zip(offsets, w)) for j in range(3)]
                  for i in range(3)]
    values, vectors = eigen(covariance)
    normal = vectors[2] if vectors[2][2] >= 0 else tuple(-x for x in vectors[2])
    u, v = frame(normal)

    used = [i for i, d in enumerate(offsets) if abs(dot(normal, d)) <= math.cos(math.radians(cone)) * norm(d)]
    directions = sorted((math.atan2(dot(offsets[i], v), dot(offsets[i], u)), neighbours[i]) for i in used)
    gaps = [((directions[(i + 1) % len(directions)][0] - a) % (2 * math.pi), q, directions[(i + 1) % len(directions)][1])
            for i, (a, q) in enumerate(directions)]
    gap_angle, first, second = max(gaps, key=lambda g: g[0])
    even = 2 * math.pi / len(directions)
    angle = min(max((gap_angle - even) / (math.pi - even), 0.0), 1.0)

    flat = add(mean, normal, -dot(mean, normal))
    halfdisc = min(norm(flat) / (4 * r / (3 * math.pi)), 1.0)

    total = sum(max(x, 0.0) for x in values)
    shape = tuple(max(x, 0.0) / total for x in values)
    scale = math.dist(shape, CENTROID) / 3
    kernels = [math.exp(-(math.dist(shape, c) / scale) ** 2) if scale > 0 else 0.0 for c in CHARACTERISTIC.values()]
    shape_probability = kernels[0] / sum(kernels) if sum(kernels) > 0 else 0.0

    probability = sum(x * y for x, y in zip(weights, (angle, halfdisc, shape_probability))) / sum(weights)
    probability = round(probability * 2**24) / 2**24
    return Evaluation(r, mean, normal, directions, (first, second), gap_angle, shape, angle, halfdisc,
                      shape_probability, probability)


CHARACTERISTIC = {"boundary": (2 / 3, 1 / 3, 0), "interior": (1 / 2, 1 / 2, 0), "corner": (1 / 3, 1 / 3, 1 / 3),
                  "line": (1, 0, 0)}
CENTROID = (11 / 18, 5 / 18, 1 / 9)


# ---- C. Method `tangential`

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
