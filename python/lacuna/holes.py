# SPDX-License-Identifier: Apache-2.0
"""What a run has found: loops around holes, and results of points."""

from __future__ import annotations

import html
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union, overload

import numpy as np

from . import _core
from ._optional import require

# One number for each loop, in the order of tables.
MEASURES = (
    "confidence",
    "points",
    "perimeter",
    "area",
    "diameter",
    "planarity",
    "mean_probability",
    "prominence",
    "first_scale",
    "last_scale",
)
# Why no scanner sampled the inside of a hole, in the order of `cause_shares`.
CAUSES = ("hidden", "opening", "out_of_view", "no_return", "filtered")
# Those that are no counts.
NUMBERS = tuple(name for name in MEASURES if name != "points")


def _counted(count: int, noun: str) -> str:
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


class LacunaWarning(UserWarning):
    """Something of a scan is odd: not wrong, but hardly meant."""


@dataclass(frozen=True)
class Loop:
    """A closed loop of points around a hole, or along the outer edge of an open surface.

    Lengths are in the units of the scan. `ids` are indices of points of the input, of m points; the first one
    is not repeated. `xyz` are their positions, m x 3.
    """

    id: int  # its index among the loops of the result
    kind: str  # "hole" or "outer"
    parent: Optional[int]  # the loop that it is an inner ring of: of an island its hole, of a hole the outer curve
    ids: np.ndarray
    xyz: np.ndarray
    confidence: float  # probability that it is one, from 0 to 1
    perimeter: float
    area: float  # seen along its normal; of a hole without its islands
    diameter: float  # largest distance between two of its points
    centroid: np.ndarray
    normal: np.ndarray  # unit; its largest component is positive; 0 where the loop encloses nothing
    planarity: float  # 1: in one plane
    mean_probability: float
    prominence: float  # of a hole over the gaps of the sampling around it; 0: not measured
    first_scale: float
    last_scale: float
    cause_shares: np.ndarray  # of its area, in the order of `lacuna.CAUSES`; NaN where no station is known
    hidden_by: np.ndarray  # a point that hides it; NaN where nothing does

    @property
    def cause(self) -> Optional[str]:
        """The cause with the largest share; None where no station is known."""
        return None if np.isnan(self.cause_shares[0]) else CAUSES[int(np.argmax(self.cause_shares))]

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return (
            f"Loop({self.id}, {self.kind}, {_counted(len(self), 'point')}, diameter {self.diameter:.3g}, "
            f"confidence {self.confidence:.2f})"
        )


class Loops(Sequence):
    """The loops in order of (first id, length, ids).

    Arrays of all loops have the names of what a `Loop` has: `loops.area`, `loops.centroid`. Points of all loops
    lie one after the other in `loops.xyz` and `loops.ids`; those of loop i from `loops.offsets[i]` on.
    """

    def __init__(self, arrays: Mapping[str, np.ndarray]):
        self._arrays = dict(arrays)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name not in self._arrays:
            raise AttributeError(name)
        return self._arrays[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._arrays]

    def __len__(self) -> int:
        return len(self._arrays["confidence"])

    @overload
    def __getitem__(self, i: int) -> Loop: ...
    @overload
    def __getitem__(self, i: slice) -> list[Loop]: ...
    def __getitem__(self, i):
        if isinstance(i, slice):
            return [self[j] for j in range(*i.indices(len(self)))]
        i = range(len(self))[i]
        a = self._arrays
        of_loop = slice(a["offsets"][i], a["offsets"][i + 1])
        scalars = {name: a[name][i].item() for name in NUMBERS}
        return Loop(
            id=i,
            kind="outer" if a["is_outer"][i] else "hole",
            parent=None if a["parent"][i] < 0 else int(a["parent"][i]),
            ids=a["ids"][of_loop],
            xyz=a["xyz"][of_loop],
            centroid=a["centroid"][i],
            normal=a["normal"][i],
            cause_shares=a["cause_shares"][i],
            hidden_by=a["hidden_by"][i],
            **scalars,
        )

    def __iter__(self) -> Iterator[Loop]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        outer = int(np.count_nonzero(self.is_outer))
        return f"Loops({_counted(len(self) - outer, 'hole')}, {outer} outer)"


class Holes:
    """The result of a run.

    loops: a sequence of `Loop`.
    summary: counts, bounds, spacing, areas, levels, times; a dict.
    unit, crs: of the scan; empty where it states none.

    Its length is the number of loops. A pickled copy has all but the files: `save`, `report` and `lids` are of
    the original.
    """

    def __init__(
        self,
        loops: Mapping[str, np.ndarray],
        summary: dict[str, Any],
        *,
        unit: str = "",
        crs: str = "",
        found: Optional[_core.Found] = None,
        folder: Optional[Path] = None,
        read_sample: Optional[Callable[[], dict[str, np.ndarray]]] = None,
        xyz: Optional[np.ndarray] = None,
    ):
        self.loops = Loops(loops)
        self.summary = summary
        self.unit = unit
        self.crs = crs
        self._found = found  # of a run in this process
        self._folder = folder  # of loaded results
        self._read_sample = found.sample if found is not None else read_sample
        self._xyz = xyz
        self._points: Optional[dict[str, np.ndarray]] = None
        self._sample: Optional[dict[str, np.ndarray]] = None

    def __len__(self) -> int:
        return len(self.loops)

    def __getstate__(self) -> dict[str, Any]:
        has_points = self._points is not None or (self._found is not None and self._found.has_points)
        if has_points:
            self._of_points("probability")  # brings all of them
        if self._folder is None or (self._folder / "sample.ply").exists():
            self._sample = self.sample
        state = {**self.__dict__, "_found": None, "_folder": None, "_read_sample": None}
        return state if has_points else {**state, "_xyz": None}

    def _kept_folder(self) -> str:
        """The folder of loaded results."""
        if self._folder is None:
            raise _core.Error("a pickled result has no files; save the original, and load its folder")
        return os.fspath(self._folder)

    # ---- results of points, in the order of the input

    def _of_points(self, name: str) -> np.ndarray:
        if self._points is None:
            if self._found is None:
                raise _core.Error("results of points are not loaded; lacuna.find_holes or detect with points=True has them")
            self._points = self._found.points()
        return self._points[name]

    @property
    def probability(self) -> np.ndarray:
        """Probability of each point that it lies on a boundary; NaN of a dropped one. float32, n."""
        return self._of_points("probability")

    @property
    def criteria(self) -> np.ndarray:
        """Its parts: angle, halfdisc and shape. float32, n x 3."""
        return self._of_points("criteria")

    @property
    def boundary(self) -> np.ndarray:
        """Whether each point is on a loop, or a candidate next to one. bool, n."""
        return self._of_points("boundary")

    @property
    def loop_of_point(self) -> np.ndarray:
        """Index of the first loop through each point; -1: none. int32, n."""
        return self._of_points("loop")

    @property
    def normals(self) -> np.ndarray:
        """Unit normals, of the input or estimated; NaN where undefined. float32, n x 3."""
        return self._of_points("normal")

    @property
    def sample(self) -> dict[str, np.ndarray]:
        """Points spread evenly over the surface: id, xyz, probability, normal."""
        if self._sample is None:
            if self._read_sample is None:
                raise _core.Error("the pickled result had no sample.ply")
            self._sample = self._read_sample()
        return self._sample

    # ---- to other libraries

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each loop."""
        pandas = require("pandas", "to_frame")
        loops = self.loops
        frame = pandas.DataFrame({"kind": np.where(loops.is_outer, "outer", "hole")})
        for name in MEASURES:
            frame[name] = getattr(loops, name)
        frame["cause"] = [loop.cause for loop in loops]
        for vector in ("centroid", "normal"):
            for axis, letter in enumerate("xyz"):
                frame[f"{vector}_{letter}"] = getattr(loops, vector)[:, axis]
        frame.index.name = "loop"
        return frame

    def to_geo(self, polygons: bool = True) -> Any:
        """A geopandas.GeoDataFrame: each loop as a polygon seen from above, with its inner rings, or as a closed
        3D line."""
        geopandas, shapely = require("geopandas", "to_geo"), require("shapely.geometry", "to_geo")
        lines = [np.vstack([loop.xyz, loop.xyz[:1]]) for loop in self.loops]
        inner: list[list[np.ndarray]] = [[] for _ in lines]
        for line, parent in zip(lines, self.loops.parent):
            if parent >= 0:
                inner[parent].append(line)
        if polygons:
            geometry = [shapely.Polygon(line, rings) for line, rings in zip(lines, inner)]
        else:
            geometry = [shapely.LineString(line) for line in lines]
        return geopandas.GeoDataFrame(self.to_frame(), geometry=geometry, crs=self.crs or None)

    def to_open3d(self) -> tuple[Any, Any]:
        """An open3d PointCloud, coloured by probability, and a LineSet of the loops. Points are those of the
        input where their results are here, else the sample."""
        o3d = require("open3d", "to_open3d")
        xyz, probability = self._drawn_points()
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.asarray(xyz, np.float64)))
        share = np.nan_to_num(probability)[:, None]
        cloud.colors = o3d.utility.Vector3dVector(0.75 * (1 - share) + share * np.array([0.85, 0.35, 0.05]))
        loops = self.loops
        lines = [
            np.column_stack([ids := np.arange(a, b), np.roll(ids, -1)])
            for a, b in zip(loops.offsets[:-1], loops.offsets[1:])
        ]
        line_set = o3d.geometry.LineSet()
        line_set.points = o3d.utility.Vector3dVector(loops.xyz)
        if lines:
            line_set.lines = o3d.utility.Vector2iVector(np.concatenate(lines).astype(np.int32))
        return cloud, line_set

    def to_laspy(self, las: Any) -> Any:
        """Adds the results of points to laspy data of the same points, as extra dimensions. Returns it."""
        laspy = require("laspy", "to_laspy")
        if len(las.points) != len(self.probability):
            raise _core.Error(f"the LAS data has {len(las.points)} points, the results {len(self.probability)}")
        for name, values in (("probability", self.probability), ("loop", self.loop_of_point)):
            if name not in las.point_format.extra_dimension_names:
                las.add_extra_dim(laspy.ExtraBytesParams(name=name, type=values.dtype))
            las[name] = values
        return las

    # ---- files

    def save(self, folder: Union[str, os.PathLike], **params: Any) -> list[Path]:
        """Writes the files of `lacuna detect --out` to a folder: a new one, or one of earlier results. Returns their names.

        params: parameters of the section `output`, such as report=True, gpkg=True, points_format="ply".
        """
        from .run import _checked

        if self._found is not None:
            return list(self._found.save(os.fspath(folder), _checked(params)))
        source = self._kept_folder()
        if params:
            raise _core.Error("loaded results are copied as they are; save the result of a run to have other files")
        return list(_core.copy_results(source, os.fspath(folder)))

    def lids(self) -> dict[int, tuple[np.ndarray, np.ndarray]]:
        """Triangulated lids, by the id of their hole: vertices, m x 3, and triangles, t x 3 indices of vertices.

        A hole that cannot be closed has none. Loaded results have lids where the run wrote lids.ply."""
        if self._found is None:
            return _read_lids(Path(self._kept_folder(), "lids.ply"))
        with tempfile.TemporaryDirectory(prefix="lacuna-") as folder:
            self.save(folder, lids=True)
            return _read_lids(Path(folder, "lids.ply"))

    def report(self, file: Union[str, os.PathLike]) -> Path:
        """Writes the scan and its holes in 3D as one HTML file, for a browser. Returns its name.

        It replaces an earlier report, and no other file."""
        if self._found is None:
            _core.write_report(self._kept_folder(), os.fspath(file))
        else:
            with tempfile.TemporaryDirectory(prefix="lacuna-") as folder:
                self.save(folder)
                _core.write_report(folder, os.fspath(file))
        return Path(file)

    # ---- pictures

    def plot(self, ax: Any = None, *, axes: str = "xy", points: int = 100_000) -> Any:
        """Draws points and loops along an axis, by matplotlib. axes: those of the picture, right and up.
        points: so many at most. Returns matplotlib's axes."""
        from .plot import plot_holes

        return plot_holes(self, ax, axes, points)

    def _drawn_points(self) -> tuple[np.ndarray, np.ndarray]:
        if self._xyz is not None and self._points is not None:
            return self._xyz, self.probability
        return self.sample["xyz"], self.sample["probability"]

    def __repr__(self) -> str:
        outer = int(np.count_nonzero(self.loops.is_outer))
        holes, curves = _counted(len(self.loops) - outer, "hole"), _counted(outer, "outer curve")
        return f"Holes({holes} and {curves} of {_counted(self.summary['points'], 'point')})"

    def _repr_html_(self) -> str:
        from .plot import picture_of

        unit = f" {html.escape(self.unit)}" if self.unit else ""
        largest = sorted(self.loops, key=lambda loop: -loop.diameter)[:10]
        rows = "".join(
            f"<tr><td>{loop.id}</td><td>{loop.kind}</td><td>{loop.confidence:.2f}</td><td>{len(loop)}</td>"
            f"<td>{loop.diameter:.4g}{unit}</td><td>{loop.perimeter:.4g}{unit}</td></tr>"
            for loop in largest
        )
        more = "" if len(largest) == len(self.loops) else f"<p>The largest 10 of {len(self.loops)} loops.</p>"
        head = "".join(f"<th>{name}</th>" for name in ("loop", "kind", "confidence", "points", "diameter", "perimeter"))
        return f"<p>{html.escape(repr(self))}</p>{picture_of(self)}<table><tr>{head}</tr>{rows}</table>{more}"


def _read_lids(file: Path) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    try:
        head, _, body = file.read_bytes().partition(b"end_header\n")
    except OSError as error:
        raise _core.Error(f"{file}: cannot be read: {error.strerror}; a run with lids=True writes it") from error
    lines = head.decode().splitlines()
    vertices, faces = (int(line.split()[2]) for line in lines if line.startswith("element"))
    coordinate = "<f8" if "property double x" in lines else "<f4"
    offset = next(([float(word) for word in line.split()[3:]] for line in lines if line.startswith("comment lacuna offset")), 0.0)
    rows = np.frombuffer(body, np.dtype([("xyz", coordinate, 3), ("hole", "<i4")]), vertices)
    triangles = np.frombuffer(body, np.dtype([("size", "u1"), ("corners", "<i4", 3)]), faces, rows.nbytes)["corners"]
    holes = rows["hole"][triangles[:, 0]]
    return {
        int(hole): (rows["xyz"][rows["hole"] == hole].astype(np.float64) + offset, triangles[holes == hole].astype(np.int64) - first)
        for hole, first in zip(*np.unique(rows["hole"], return_index=True))
    }
