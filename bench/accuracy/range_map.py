# SPDX-License-Identifier: Apache-2.0
"""Range maps for the accuracy sets: a scene sampled from one place along a grid of rays, and the mesh of that grid. The
boundary of the mesh is known. Plain Python, no packages.

A shape is a function of a ray, its origin and unit direction. It returns how far along the ray the first hit is, and
the cosine between the ray and the normal there."""

import math
import random
from statistics import median

from mesh import Mesh, border_ends

MISS = (math.inf, 0.0)
EYE = 3.0  # above the scene, which lies about the origin; rays go down
WIDTH = 2.2  # of the view at the origin
DROPOUTS = 0.004  # share of single rays that are lost
PATCHES = [(12, 3.0, 8.0), (16, 1.2, 3.0)]  # dark patches and small blobs: how many, radii from and to, in rays
LONG = 0.4  # share of these that are three times as long as wide
GRAZING = 0.12  # cosine below which rays are lost, the more the lower it is
LONGEST_EDGE = 5  # median steps


# ---- shapes

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def from_to(a, b):
    return b[0] - a[0], b[1] - a[1], b[2] - a[2]


def sphere(centre, radius):
    def meet(origin, way):
        start = from_to(centre, origin)
        along = dot(start, way)
        square = along * along - dot(start, start) + radius * radius
        if square <= 0:
            return MISS
        return -along - math.sqrt(square), math.sqrt(square) / radius

    return meet


def slab(start, way, half):
    """Where a ray enters and leaves the places within `half` of 0, along one axis."""
    if way == 0:
        return (-math.inf, math.inf) if abs(start) <= half else (math.inf, -math.inf)
    return (-start - math.copysign(half, way)) / way, (-start + math.copysign(half, way)) / way


def box(centre, half):
    def meet(origin, way):
        start = from_to(centre, origin)
        enter, leave, cosine = 0.0, math.inf, 0.0
        for side in range(3):
            near, far = slab(start[side], way[side], half[side])
            if near > enter:
                enter, cosine = near, abs(way[side])
            leave = min(leave, far)
        return (enter, cosine) if 0 < enter <= leave else MISS

    return meet


def cylinder(centre, axis, radius, half):
    """With lids. Rays along the axis miss it."""
    axis = tuple(value / math.hypot(*axis) for value in axis)

    def meet(origin, way):
        start = from_to(centre, origin)
        start_along, way_along = dot(start, axis), dot(way, axis)
        a = 1 - way_along * way_along
        b = dot(start, way) - start_along * way_along
        square = b * b - a * (dot(start, start) - start_along * start_along - radius * radius)
        if square <= 0 or a <= 0:
            return MISS
        root = math.sqrt(square)
        enter, leave = slab(start_along, way_along, half)
        cosine = abs(way_along)
        if (-b - root) / a > enter:
            enter, cosine = (-b - root) / a, root / radius
        return (enter, cosine) if 0 < enter <= min(leave, (-b + root) / a) else MISS

    return meet


def traced(clearance, origin, way, near, far, shortest):
    """Where along the ray, between `near` and `far`, `clearance` first becomes negative. It changes by at most twice
    the length of a step; what the ray is inside of for less than `shortest` may be missed."""
    def at(t):
        return clearance(origin[0] + t * way[0], origin[1] + t * way[1], origin[2] + t * way[2])

    before, t = near, near
    above = value = at(t)
    while value > 0:
        before, above = t, value
        t += max(value / 2, shortest)
        if t > far:
            return MISS
        value = at(t)
    for _ in range(3):  # the chord's zero: the stretch is short, and so nearly straight
        if above == value:
            break
        before, above, t = t, value, t - value * (t - before) / (value - above)
        value = at(t)
    x, y, z = (o + t * w for o, w in zip(origin, way))
    step = 1e-6
    normal = (clearance(x + step, y, z) - value, clearance(x, y + step, z) - value, clearance(x, y, z + step) - value)
    return t, abs(dot(normal, way)) / math.hypot(*normal)


def torus(radius, tube):
    """About the z axis."""
    def clearance(x, y, z):
        return math.hypot(math.hypot(x, y) - radius, z) - tube

    around = sphere((0, 0, 0), radius + tube)

    def meet(origin, way):
        near, _ = around(origin, way)
        return traced(clearance, origin, way, near, near + 2 * (radius + tube), 0.004) if near < math.inf else MISS

    return meet


def height_field(height, bottom, top):
    """z = height(x, y), which lies between `bottom` and `top` and is no steeper than 60 degrees."""
    def clearance(x, y, z):
        return z - height(x, y)

    def meet(origin, way):
        if way[2] >= 0:
            return MISS
        return traced(clearance, origin, way, (top - origin[2]) / way[2], (bottom - origin[2]) / way[2], 0.01)

    return meet


def nearest(*shapes):
    return lambda origin, way: min(shape(origin, way) for shape in shapes)


def tilted(degrees, *shapes):
    """These shapes turned about the x axis, from z towards -y."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    inside = nearest(*shapes)

    def turned(v):
        return v[0], c * v[1] + s * v[2], c * v[2] - s * v[1]

    return lambda origin, way: inside(turned(origin), turned(way))


def bumps(x, y):
    return (0.09 * math.sin(6 * x + 1) * math.sin(4 * y) + 0.05 * math.sin(7.7 * x + 9 * y)
            + 0.15 * math.exp(-8 * (x * x + y * y)))


# Each with the number of rays along a side that gives about 40,000 points.
SCENES = {
    "wall": (200, nearest(
        height_field(lambda x, y: -1 + 0.06 * math.sin(5 * x) * math.cos(4 * y), -1.06, -0.94),
        sphere((-0.4, 0.3, 0), 0.45), cylinder((0.5, -0.1, -0.2), (0.25, 0.95, 0.18), 0.22, 0.8),
        box((-0.45, -0.6, -0.3), (0.3, 0.22, 0.3)))),
    "torus": (280, nearest(tilted(35, torus(0.7, 0.28)), sphere((0.05, 0, -0.3), 0.25))),
    "bumps": (220, tilted(50, height_field(bumps, -0.15, 0.3))),
    "table": (230, tilted(35, box((0, 0, -0.4), (1.3, 1.3, 0.1)), box((-0.5, 0.4, 0), (0.2, 0.25, 0.35)),
                          box((0.35, 0.1, -0.1), (0.3, 0.2, 0.25)), box((-0.2, -0.5, -0.15), (0.35, 0.15, 0.2)),
                          cylinder((0.5, -0.6, 0), (0, 0, 1), 0.18, 0.3))),
    "figure": (340, nearest(sphere((0, 0.1, 0), 0.55), sphere((0.3, 0.62, 0.05), 0.3), sphere((-0.35, -0.5, 0.1), 0.4),
                            sphere((0.45, -0.45, 0.25), 0.28),
                            cylinder((-0.2, 0.75, 0.1), (-0.3, 0.9, 0.3), 0.07, 0.3))),
    "pipes": (300, nearest(cylinder((-0.35, 0, 0), (0.15, 0.5, 0.85), 0.4, 0.9),
                           cylinder((0.55, 0.1, -0.3), (-0.1, 1, 0.1), 0.25, 1.1), sphere((0.5, -0.5, 0.5), 0.2))),
}


# ---- the scanner

def lost_rays(rays, draw):
    """One byte for each ray: not 0 if it sees nothing, alone or in a patch."""
    lost = bytearray(draw.random() < DROPOUTS for _ in range(rays * rays))
    for count, least, most in PATCHES:
        for _ in range(count):
            column, row, radius = draw.uniform(0, rays), draw.uniform(0, rays), draw.uniform(least, most)
            length = radius * (3 if draw.random() < LONG else 1)
            angle = draw.uniform(0, math.pi)
            c, s = math.cos(angle), math.sin(angle)
            for y in range(max(0, int(row - length)), min(rays, int(row + length) + 2)):
                for x in range(max(0, int(column - length)), min(rays, int(column + length) + 2)):
                    u, v = c * (x - column) + s * (y - row), c * (y - row) - s * (x - column)
                    if math.hypot(u / length, v / radius) < 1:
                        lost[y * rays + x] = 1
    return lost


def scan(shape, perspective, rays, noise, draw):
    """Row by row the point in which each ray hits the shape; None where it is lost."""
    lost = lost_rays(rays, draw)
    step = WIDTH / rays
    seen = []
    for ray in range(rays * rays):
        x, y = (ray % rays + 0.5) * step - WIDTH / 2, (ray // rays + 0.5) * step - WIDTH / 2
        luck, error = draw.random(), draw.gauss(0, noise * step)
        if lost[ray]:
            seen.append(None)
            continue
        if perspective:
            far = math.hypot(x, y, EYE)
            origin, way = (0.0, 0.0, EYE), (x / far, y / far, -EYE / far)
        else:
            origin, way = (x, y, EYE), (0.0, 0.0, -1.0)
        t, cosine = shape(origin, way)
        if t == math.inf or luck > cosine / GRAZING:
            seen.append(None)
        else:
            t += error
            seen.append((origin[0] + t * way[0], origin[1] + t * way[1], origin[2] + t * way[2]))
    return seen


# ---- its mesh

def median_step(seen, rays):
    pairs = [(ray, ray + 1) for ray in range(rays * rays) if (ray + 1) % rays]
    pairs += [(ray, ray + rays) for ray in range(rays * (rays - 1))]
    return median(math.dist(seen[a], seen[b]) for a, b in pairs if seen[a] and seen[b])


def grid_triangles(seen, rays):
    """Two triangles for each square of neighbouring rays, along the shorter diagonal; or one where a ray is lost, but
    none with a long edge."""
    limit = LONGEST_EDGE * median_step(seen, rays)
    triangles = []
    for corner in range(rays * (rays - 1)):
        if (corner + 1) % rays == 0:
            continue
        square = [ray for ray in (corner, corner + 1, corner + rays + 1, corner + rays) if seen[ray]]
        if len(square) == 4:
            a, b, c, d = square
            if math.dist(seen[a], seen[c]) <= math.dist(seen[b], seen[d]):
                candidates = [(a, b, c), (a, c, d)]
            else:
                candidates = [(a, b, d), (b, c, d)]
        else:
            candidates = [tuple(square)] if len(square) == 3 else []
        triangles += [t for t in candidates if all(math.dist(seen[t[i - 1]], seen[t[i]]) < limit for i in range(3))]
    return triangles


def touched_twice(triangles):
    """The rays where the boundary touches itself."""
    return [ray for ray, ends in border_ends(triangles).items() if len(ends) > 1]


def range_map(scene, perspective, noise, strays, seed):
    """What a scanner samples of one of the SCENES, with noise along its rays, in steps of the grid. With `strays`, the
    points that no triangle uses are there too. Loops do not touch: points where they would are lost as well."""
    rays, shape = SCENES[scene]
    seen = scan(shape, perspective, rays, noise, random.Random(seed))
    triangles = grid_triangles(seen, rays)
    while touched := touched_twice(triangles):
        for ray in touched:
            seen[ray] = None
        triangles = grid_triangles(seen, rays)
    points = [ray for ray in range(rays * rays) if seen[ray]]
    place = {ray: i for i, ray in enumerate(points)}
    mesh = Mesh([seen[ray] for ray in points],
                [tuple(place[ray] for ray in triangle) for triangle in triangles])
    return mesh if strays else mesh.without(set())
