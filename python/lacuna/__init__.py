# SPDX-License-Identifier: Apache-2.0
"""Lacuna finds holes in scanned surfaces, also in scans larger than memory.

    import lacuna
    holes = lacuna.find_holes(xyz)                # an array of n x 3
    holes = lacuna.detect(["a.laz", "b.e57"])     # files, out of core
    for loop in holes.loops: print(loop.kind, loop.diameter, loop.ids)

Lengths are in the units of the scan. The id of a point is its index in the input; over several files, ids
count on. Errors are `lacuna.Error`, with one line that says what is wrong and what is allowed.

docs/python.md has all of it with examples.
"""

from ._core import Error, version as __version__
from .files import compare, evaluate, load, render, stations, stream
from .holes import CAUSES, Holes, Loop, Loops, LacunaWarning
from .run import check, detect, find_holes, info, parameters

__all__ = [
    "CAUSES",
    "Error",
    "Holes",
    "LacunaWarning",
    "Loop",
    "Loops",
    "check",
    "compare",
    "detect",
    "evaluate",
    "find_holes",
    "info",
    "load",
    "parameters",
    "render",
    "stations",
    "stream",
]
