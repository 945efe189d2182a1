# SPDX-License-Identifier: Apache-2.0
"""What the examples share: points to try them with, and a line of text for a hole."""

import numpy as np


def plane_with_hole():
    """A square of 100 x 100 points, one unit apart and a little off their grid, without those within 12 of the
    middle."""
    y, x = np.divmod(np.arange(10_000.0), 100)
    xyz = np.column_stack([x + 0.2 * np.sin(7 * x + 3 * y), y + 0.2 * np.cos(5 * x - 2 * y), 0 * x])
    return xyz[np.linalg.norm(xyz - [50, 50, 0], axis=1) > 12]


def print_hole(hole, points):
    print(
        f"hole at {hole.centroid[0]:.1f} {hole.centroid[1]:.1f} {hole.centroid[2]:.1f}: {points} points, "
        f"perimeter {hole.perimeter:.1f}, diameter {hole.diameter:.1f}, confidence {hole.confidence:.2f}"
    )
