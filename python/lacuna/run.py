# SPDX-License-Identifier: Apache-2.0
"""Runs of the engine: on arrays, and on files."""

from __future__ import annotations

import difflib
import json
import os
import tempfile
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _core
from .holes import Holes, LacunaWarning

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._parameters import CheckParameters, FileParameters, InfoParameters, RunParameters

Progress = Callable[[str, Optional[float], Optional[float], Optional[float], Optional[float]], Any]
Path = Union[str, "os.PathLike[str]"]


def parameters() -> list[dict[str, str]]:
    """All parameters of a run: section, key, default, what is allowed, and a sentence of help each."""
    return _core.parameters("run")


def find_holes(
    xyz: Any,
    normals: Any = None,
    *,
    points: bool = False,
    attributes: Optional[Mapping[str, Any]] = None,
    progress: Optional[Progress] = None,
    **params: Unpack[RunParameters],
) -> Holes:
    """Finds the holes of the surface that points sample.

    - xyz: array of n x 3, float32 or float64 at any stride, which is not copied. Other types are converted. An
      open3d PointCloud and laspy data do, too.
    - normals: array of n x 3, of any length; NaN or zero where one is not known.
    - points: whether results of all points are wanted, such as `Holes.probability`.
    - attributes: further columns of n values each, by name, for files that `Holes.save` writes. The report shows
      `red`, `green` and `blue`.
    - progress: is called as progress(step, share, seconds_left, run_share, run_seconds_left) some times a second,
      and at the end.
      The first share, from 0 to 1, and the first seconds belong to the current step, the others to the whole run.
      They are None where they are not known. The share of the run is rough. If it returns False, the run ends
      with an `Error`.
    - params: parameters by their keys, such as min_hole=0.5, k=20, memory_limit="4GiB", crs="EPSG:25832".
      `lacuna.parameters()` lists them.

    Non-finite points are dropped and counted. Cost: linear in n. Memory: the input, the results, and at most
    memory_limit, half of the machine's by default.
    """
    if isinstance(xyz, (str, bytes, os.PathLike)):
        raise TypeError(f"find_holes takes an array of points; lacuna.detect({os.fspath(xyz)!r}) reads a file")
    positions = _positions_of(xyz)
    columns = dict(zip("xyz", _columns(positions, "xyz")))
    if normals is not None:
        columns.update(zip(("nx", "ny", "nz"), _columns(np.asarray(normals), "normals")))
    for name, values in (attributes or {}).items():
        columns[name] = np.asarray(values)
    found = _core.find_in_arrays(columns, _checked({**params, "points": points}), progress)
    return _holes_of(found, xyz=positions)


def detect(
    files: Union[Path, Iterable[Path]],
    *,
    out: Optional[Path] = None,
    points: bool = False,
    progress: Optional[Progress] = None,
    **params: Unpack[FileParameters],
) -> Holes:
    """Finds the holes of scan files, which together are one registered scan and may be larger than memory.

    files: names of scans, of folders with scans, or "@list" of a list of names. LAS, LAZ, E57, PLY, PCD, PTX,
        OBJ and text are read.
    out: folder for the files that `lacuna detect` writes, with those of report=True, gpkg=True and so on; by
        default none are written, and `Holes.save` writes them later.
    Other arguments are those of `find_holes`.
    """
    folder = None if out is None else os.fspath(out)
    found = _core.find_in_files(_names(files), _checked({**params, "points": points}), progress, folder)
    return _holes_of(found)


def check(
    files: Union[Path, Iterable[Path]],
    area: Optional[Path] = None,
    *,
    out: Optional[Path] = None,
    progress: Optional[Progress] = None,
    **params: Unpack[CheckParameters],
) -> dict[str, Any]:
    """Checks whether scan files cover the polygons of `area`, as `lacuna check` does. Returns what voids.json has.

    area: file of polygons; None: the scan's own outline, seen from above.
    out: folder for voids.json, voids.csv and voids.gpkg; by default they are not kept.
    Other arguments are parameters of the input and of the area, memory_limit and threads; others are refused.
    """
    with tempfile.TemporaryDirectory(prefix="lacuna-") as kept:
        folder = os.path.join(kept, "voids") if out is None else os.fspath(out)
        if area is not None:
            if not os.fspath(area):
                raise _core.Error("area: is empty; allowed: a file of polygons, or None for the scan's own outline")
            params = {**params, "area": area}
        checked = _checked(params, "check")
        for warning in _core.check_files(_names(files), checked, folder, progress):
            warnings.warn(warning, LacunaWarning, stacklevel=2)
        with open(os.path.join(folder, "voids.json"), encoding="utf-8") as file:
            return json.load(file)


def info(files: Union[Path, Iterable[Path]], **params: Unpack[InfoParameters]) -> dict[str, Any]:
    """Says what scan files hold, and what a run on them would take, as `lacuna info --json` does.

    Its parameters are those of the input, min_hole, resolution, stations, memory_limit and threads."""
    content, warned = _core.info(_names(files), _checked(params, "info"))
    for warning in warned:
        warnings.warn(warning, LacunaWarning, stacklevel=2)
    return json.loads(content)


def _names(files: Union[Path, Iterable[Path]]) -> list[str]:
    return [os.fspath(name) for name in ([files] if isinstance(files, (str, os.PathLike)) else files)]


def _holes_of(found: _core.Found, xyz: Optional[np.ndarray] = None) -> Holes:
    for warning in found.warnings:
        warnings.warn(warning, LacunaWarning, stacklevel=3)
    return Holes(found.loops(), found.summary(), unit=found.unit, crs=found.crs, found=found, xyz=xyz)


def _positions_of(points: Any) -> np.ndarray:
    for name in ("xyz", "points"):  # laspy, open3d
        if not isinstance(points, np.ndarray) and hasattr(points, name):
            return np.asarray(getattr(points, name))
    return np.asarray(points)


def _columns(array: np.ndarray, name: str) -> list[np.ndarray]:
    if array.ndim != 2 or array.shape[1] != 3:
        raise _core.Error(f"{name}: has the shape {array.shape}; allowed: n x 3")
    if array.dtype not in (np.float32, np.float64) or not array.dtype.isnative:
        array = array.astype(np.float64)
    return [array[:, axis] for axis in range(3)]


def _checked(params: Mapping[str, Any], command: str = "run") -> dict[str, str]:
    keys = [p["key"] for p in _core.parameters(command)]
    for key in params:
        if key not in keys:
            near = difflib.get_close_matches(key, keys, 1)
            hint = f"; did you mean {near[0]}?" if near else "; lacuna.parameters() lists them"
            if command == "run" and key in {p["key"] for p in _core.parameters("check")}:
                hint = "; lacuna.check has it"
            of = {"run": "", "check": " of a check", "info": " of info"}[command]
            raise TypeError(f"{key} is no parameter{of}{hint}")
    return {key: _text(value) for key, value in params.items() if value is not None}


def _text(value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(_text(v) for v in value)
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return str(value)
