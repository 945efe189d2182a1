# SPDX-License-Identifier: Apache-2.0
"""Pictures by matplotlib."""

from __future__ import annotations

import base64
import io
from typing import Any

import numpy as np

from ._optional import require

HOLE, OUTER = "#d95f02", "#1f6fb4"  # as in the report


def plot_holes(holes: Any, ax: Any, axes: str, points: int) -> Any:
    pyplot = require("matplotlib.pyplot", "plot")
    right, up = ("xyz".index(letter) for letter in axes)
    if ax is None:
        ax = pyplot.figure(layout="constrained").add_subplot()
    _draw(holes, ax, right, up, points)
    unit = f" [{holes.unit}]" if holes.unit else ""
    ax.set(xlabel=axes[0] + unit, ylabel=axes[1] + unit)
    return ax


def picture_of(holes: Any) -> str:
    """Returns an <img> element with the plot from above; nothing where matplotlib is not installed."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    figure = Figure(figsize=(6, 4), layout="constrained")
    _draw(holes, figure.add_subplot(), 0, 1, 30_000)
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=100)
    return f'<img alt="points and loops from above" src="data:image/png;base64,{base64.b64encode(png.getvalue()).decode()}">'


def _draw(holes: Any, ax: Any, right: int, up: int, points: int) -> None:
    xyz, _ = holes._drawn_points()
    step = max(1, -(-len(xyz) // max(points, 1)))
    ax.scatter(xyz[::step, right], xyz[::step, up], s=1, c="0.65", linewidths=0, rasterized=True)
    for loop in holes.loops:
        closed = np.vstack([loop.xyz, loop.xyz[:1]])
        ax.plot(closed[:, right], closed[:, up], color=OUTER if loop.kind == "outer" else HOLE, linewidth=1.2)
    ax.set_aspect("equal")
