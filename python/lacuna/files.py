# SPDX-License-Identifier: Apache-2.0
"""Results in folders: loading, evaluating, comparing; and results of points as a stream."""

from __future__ import annotations

import glob
import json
import os
import queue
import tempfile
import threading
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _core
from .holes import CAUSES, NUMBERS, Holes, LacunaWarning

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._parameters import FileParameters

Result = Union[Holes, str, "os.PathLike[str]"]


def load(folder: Union[str, os.PathLike]) -> Holes:
    """Loads the results in an output folder of `lacuna detect`, or of `Holes.save`."""
    folder = Path(folder)
    file = folder / "holes.json"
    try:
        with open(file, encoding="utf-8") as stream:
            content = json.load(stream)
        loops = _arrays_of(content["loops"])
        summary = {**content["counts"], **{key: content[key] for key in _SUMMARY}}
    except OSError as error:
        raise _core.Error(f"{file}: cannot be read: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise _core.Error(f"{file}: is no result of lacuna detect: {error}") from error
    offset = content["offset"] or [0, 0, 0]
    return Holes(
        loops,
        summary,
        unit=content["unit"] or "",
        crs=content["crs"] or "",
        folder=folder,
        read_sample=lambda: _read_sample(folder / "sample.ply", offset),
    )


def evaluate(
    holes: Result,
    truth: Union[str, os.PathLike],
    *,
    scans: Iterable[Union[str, os.PathLike]] = (),
    tolerance: float = 2.0,
    min_vertices: int = 8,
) -> dict[str, Any]:
    """Compares loops with true ones, as `lacuna-bench evaluate` does: a PLY mesh, or loops as text. Returns its
    JSON. tolerance: in spacings of the scan."""
    with _folder_of(holes) as folder:
        names = [os.fspath(scan) for scan in scans]
        return json.loads(_core.evaluate(folder, os.fspath(truth), names, tolerance, min_vertices))


def compare(before: Result, after: Result, *, tolerance: float = 0.0) -> dict[str, Any]:
    """Says which holes of two results are closed, opened, changed or the same, as `lacuna compare` does. Returns
    its JSON. tolerance: how far apart curves of one hole may be; 0: twice the larger spacing."""
    with _folder_of(before) as first, _folder_of(after) as second:
        compared, lines = _core.compare(first, second, tolerance)
    for line in lines:
        warnings.warn(line, LacunaWarning, stacklevel=2)
    return json.loads(compared)


def render(
    holes: Result,
    file: Union[str, os.PathLike],
    *,
    view: Union[str, int] = "oblique",
    size: tuple[int, int] = (1600, 1000),
    hide_above: Optional[float] = None,
    as_it_came: bool = False,
    ids: bool = True,
    overwrite: bool = False,
) -> Path:
    """Draws the scan and its holes as a PNG, as `lacuna render` does. Returns its name.

    - view: oblique, top, front, side, or the id of a loop.
    - hide_above: nothing above this height is drawn, such as a ceiling.
    - as_it_came: colours or intensities of the scan, where it has them, not probabilities.
    - ids: whether loops have their ids on the picture.
    - overwrite: whether a file that Lacuna did not write is replaced, too.
    """
    options = {"out": os.fspath(file), "view": view, "size": "{}x{}".format(*size), "hide_above": hide_above}
    with _folder_of(holes) as folder:
        _run("render", folder, options, as_it_came=as_it_came, no_ids=not ids, overwrite=overwrite)
    return Path(file)


def stations(
    holes: Result,
    *,
    count: int = 5,
    height: Optional[float] = None,
    range: Optional[float] = None,
    places: Union[str, os.PathLike, None] = None,
    incidence: Optional[float] = None,
    grid: Optional[float] = None,
) -> dict[str, Any]:
    """Says where a scanner should stand next, as `lacuna stations` does. Returns what next_stations.geojson has.

    - count: how many places at most.
    - height: of the scanner over the floor. range: how far it measures. grid: distance of the places that are
      tried. These are lengths in the unit of the scan; None chooses them.
    - places: a file with the places to try, instead of those over the floor.
    - incidence: degrees between a ray and a surface, at least.

    Where the results are in a folder, the file is written there, and the report shows the places.
    """
    options = {
        "count": count,
        "height": height,
        "range": range,
        "places": places,
        "incidence": incidence,
        "grid": grid,
    }
    with _folder_of(holes) as folder:
        _run("stations", folder, options)
        return json.loads(Path(folder, "next_stations.geojson").read_text(encoding="utf-8"))


def _run(command: str, folder: str, options: dict[str, Any], **flags: bool) -> None:
    """Runs a command of the program. Options that are None are left out."""
    words = [command]
    words += [f"--{name.replace('_', '-')}={value}" for name, value in options.items() if value is not None]
    words += [f"--{name.replace('_', '-')}" for name, is_set in flags.items() if is_set]
    for warning in _core.run_command([*words, "--", folder]):
        warnings.warn(warning, LacunaWarning, stacklevel=3)


def stream(
    files: Union[str, os.PathLike, Iterable[Union[str, os.PathLike]]], **params: Unpack[FileParameters]
) -> Iterator[dict[str, Any]]:
    """Finds the holes of files, and yields the results of their points in blocks, in the order of the input.

    files: as for `detect`, or patterns such as "big/*.laz". Parameters are those of `detect`.
    A block has `first_id`, and the arrays probability, criteria, boundary, coherent, loop and normal.
    Memory: a few blocks, and that of the run.
    """
    from .run import detect

    names = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    matched = [found for name in map(os.fspath, names) for found in (sorted(glob.glob(name)) or [name])]
    found = detect(matched, **{**params, "points": True})._found
    return _blocks(found)


class _Ended(Exception):
    pass


# The engine calls a function for each block. So it runs on a thread of its own, two blocks ahead.
def _blocks(found: _core.Found) -> Iterator[dict[str, Any]]:
    blocks: queue.Queue = queue.Queue(maxsize=2)
    is_ended = threading.Event()

    def put(item: Any) -> None:
        while not is_ended.is_set():
            try:
                return blocks.put(item, timeout=0.1)
            except queue.Full:
                continue
        raise _Ended

    def work() -> None:
        try:
            found.for_each_block(put)
            put(None)
        except _Ended:
            pass
        except BaseException as error:
            put(error)

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    try:
        while (block := blocks.get()) is not None:
            if isinstance(block, BaseException):
                raise block
            yield block
    finally:
        is_ended.set()
        thread.join()


@contextmanager
def _folder_of(holes: Result) -> Iterator[str]:
    if not isinstance(holes, Holes):
        yield os.fspath(holes)
    elif holes._folder is not None:
        yield os.fspath(holes._folder)
    else:
        with tempfile.TemporaryDirectory(prefix="lacuna-") as folder:
            holes.save(folder)
            yield folder


def _arrays_of(loops: list[dict[str, Any]]) -> dict[str, np.ndarray]:
    def numbers(name: str, type: Any = np.float64) -> np.ndarray:
        return np.array([np.nan if loop[name] is None else loop[name] for loop in loops], type)

    def vectors(name: str) -> np.ndarray:
        return np.array([loop[name] for loop in loops], np.float64).reshape(-1, 3)

    counts = [len(loop["ids"]) for loop in loops]
    xyz = [np.array(loop.get("coordinates", []), np.float64).reshape(-1, 3) for loop in loops]
    return {
        "is_outer": np.array([loop["kind"] == "outer" for loop in loops], bool),
        "parent": np.array([-1 if loop.get("parent") is None else loop["parent"] for loop in loops], np.int64),
        "points": np.array(counts, np.int64),
        **{name: numbers(name) for name in NUMBERS},
        **{name: vectors(name) for name in ("centroid", "normal")},
        **_causes_of([loop.get("cause") for loop in loops]),
        "offsets": np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        "ids": np.array([i for loop in loops for i in loop["ids"]], np.int64),
        "xyz": np.concatenate(xyz) if xyz else np.empty((0, 3)),
    }


def _causes_of(causes: list[Any]) -> dict[str, np.ndarray]:
    shares = np.full((len(causes), len(CAUSES)), np.nan)
    hidden_by = np.full((len(causes), 3), np.nan)
    for i, cause in enumerate(causes):
        if cause is not None:
            shares[i] = [cause["shares"][name] for name in CAUSES]
            if cause["hidden_by"] is not None:
                hidden_by[i] = cause["hidden_by"]["place"]
    return {"cause_shares": shares, "hidden_by": hidden_by}


_SUMMARY = ("bounds", "levels", "mean_neighbours", "mean_edge_length", "median_distance", "surface_area", "hole_area", "opening_area")

_PLY_TYPES = {"float": "<f4", "double": "<f8", "uint": "<u4", "int": "<i4", "uchar": "u1", "ushort": "<u2"}


def _read_sample(file: Path, offset: list[float]) -> dict[str, np.ndarray]:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise _core.Error(f"{file}: cannot be read: {error.strerror}") from error
    head, _, body = content.partition(b"end_header\n")
    words = [line.split() for line in head.decode().splitlines()]
    count = next(int(w[2]) for w in words if w[:2] == ["element", "vertex"])
    rows = np.frombuffer(body, np.dtype([(w[2], _PLY_TYPES[w[1]]) for w in words if w[0] == "property"]), count)
    return {
        "id": rows["scalar_id"].astype(np.int64),
        "xyz": np.column_stack([rows[axis].astype(np.float64) for axis in "xyz"]) + offset,
        "probability": rows["scalar_probability"],
        "normal": np.column_stack([rows[name] for name in ("nx", "ny", "nz")]),
    }
