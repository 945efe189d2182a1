# SPDX-License-Identifier: Apache-2.0
"""Free-standing plates with openings over a floor: screens, frames, tables, windows with panes, and gates.

Openings whose outer curve is near them are lost where a coarse level joins both. Each plate is a grid, jittered by a
fifth of its spacing. True loops are the outer curve of each plate and the ring around each opening.
"""

import random

JITTER = 0.2  # spacings
# By kind: columns and rows of a plate, and its openings by columns and rows of their rings.
SHAPES = {
    "screens": lambda draw: plate(draw, 28, 40, lambda n, m: [(draw.randint(6, n // 4), draw.randint(6, m // 4))]),
    "frames": lambda draw: plate(draw, 20, 44, lambda n, m: [(draw.randint(4, 6), draw.randint(4, 6))]),
    "tables": lambda draw: plate(draw, 30, 50, lambda n, m: [(n // 3, m // 3)]),
    "panes": lambda draw: panes(draw.randint(36, 52), draw.randint(5, 7)),
    "gates": lambda draw: plate(draw, 40, 70, lambda n, m: [(draw.randint(8, n // 3), 5)]),
}


def plate(draw, low, high, margins_of):
    columns, rows = draw.randint(low, high), draw.randint(low, high)
    return columns, rows, [(a, columns - 1 - a, b, rows - 1 - b) for a, b in margins_of(columns, rows)]


def panes(side, bar):
    """Four openings between a border and a cross of bars."""
    middle, half = (side - 1) // 2, bar // 2
    spans = [(bar, middle - half), (middle + half, side - 1 - bar)]
    return side, side, [(*across, *up) for across in spans for up in spans]


def ring(low, high, bottom, top):
    """Cells along the border of a box, in order."""
    return ([(i, bottom) for i in range(low, high)] + [(high, j) for j in range(bottom, top)] +
            [(i, top) for i in range(high, low, -1)] + [(low, j) for j in range(top, bottom, -1)])


def screens(kind, spacing, seed):
    """Rows x y z and true loops of four plates over a floor."""
    draw = random.Random(seed)
    rows, loops = [], []

    def add(columns, lines, openings, place):
        def is_open(i, j):
            return any(a < i < b and c < j < d for a, b, c, d in openings)

        ids = {}
        for i in range(columns):
            for j in range(lines):
                if is_open(i, j):
                    continue
                ids[i, j] = len(rows)
                rows.append(place(*(spacing * (at + draw.uniform(-JITTER, JITTER)) for at in (i, j))))
        loops.extend([ids[cell] for cell in ring(*box)] for box in [(0, columns - 1, 0, lines - 1), *openings])

    shapes = [SHAPES[kind](draw) for _ in range(4)]
    step = 10 + max(columns for columns, _, _ in shapes)  # from plate to plate
    depth = 20 + max(lines for _, lines, _ in shapes)
    for number, shape in enumerate(shapes):
        left, height = spacing * step * number, spacing * draw.randint(8, 12)
        if kind == "tables":
            add(*shape, lambda u, v, left=left, height=height: (left + u, 10 * spacing + v, height))
        else:
            add(*shape, lambda u, v, left=left, height=height: (left + u, depth / 2 * spacing, height + v))
    add(4 * step, depth, [], lambda u, v: (u - 5 * spacing, v, 0))
    return rows, loops
