# SPDX-License-Identifier: Apache-2.0
"""Part A of docs/method.md, plainly and in memory, for the figures: a few hundred points, no library.

Names are those of docs/method.md. Creases (A.2) are left out.
"""

import math
from dataclasses import dataclass


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
    surface_share: float
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
    kernels = [math.exp(-(math.dist(shape, c) / kernel_width(c)) ** 2) for c in CHARACTERISTIC.values()]
    shape_probability = kernels[0] / sum(kernels) if sum(kernels) > 0 else 0.0
    surface_share = (kernels[0] + kernels[1]) / sum(kernels) if sum(kernels) > 0 else 0.0

    probability = sum(x * y for x, y in zip(weights, (angle, halfdisc, shape_probability))) / sum(weights)
    probability = round(probability * 2**24) / 2**24
    return Evaluation(r, mean, normal, directions, (first, second), gap_angle, shape, angle, halfdisc,
                      shape_probability, surface_share, probability)


CHARACTERISTIC = {"boundary": (2 / 3, 1 / 3, 0), "interior": (1 / 2, 1 / 2, 0), "corner": (1 / 3, 1 / 3, 1 / 3),
                  "line": (1, 0, 0)}
CENTROID = (11 / 18, 5 / 18, 1 / 9)


def kernel_width(characteristic):
    return math.dist(characteristic, CENTROID) / 3
