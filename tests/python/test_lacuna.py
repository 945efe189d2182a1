# SPDX-License-Identifier: Apache-2.0
"""The Python package against the program, and against itself. Run by tests/python/python_test.sh."""

import inspect
import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured

import lacuna

PROGRAM = os.environ["LACUNA_PROGRAM"]
BENCH_PROGRAM = os.environ["LACUNA_BENCH_PROGRAM"]


def plane(n, holes=(), seed=1):
    """A jittered grid of n x n points at distances of 1, without the points in circles (x, y, radius)."""
    random = np.random.default_rng(seed)
    xy = np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1).reshape(-1, 2) + random.uniform(-0.3, 0.3, (n * n, 2))
    xyz = np.column_stack([xy, random.normal(0, 0.02, n * n)])
    for x, y, radius in holes:
        xyz = xyz[np.hypot(xyz[:, 0] - x, xyz[:, 1] - y) > radius]
    return xyz


SHEET = plane(60, [(18, 17, 6), (41, 40, 8)])


def same_loops(a, b):
    return np.array_equal(a.loops.ids, b.loops.ids) and np.array_equal(a.loops.offsets, b.loops.offsets)


class Folder(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def synth(self, kind, name, *options):
        subprocess.run([BENCH_PROGRAM, "synth", kind, self.folder / name, *options], check=True, stdout=subprocess.DEVNULL)
        return self.folder / name

    def room(self):
        """A scan and its stations."""
        return self.synth("scan", "room.ply", "--points", "60000"), self.folder / "room.stations.txt"


class FindHoles(Folder):
    def test_a_hole_is_a_closed_loop_of_points_of_the_input(self):
        holes = lacuna.find_holes(SHEET)
        self.assertEqual([loop.kind for loop in holes.loops].count("hole"), 2)
        small, large = sorted((loop for loop in holes.loops if loop.kind == "hole"), key=lambda loop: loop.area)
        for loop, (centre, radius) in ((small, ((18, 17), 6)), (large, ((41, 40), 8))):
            np.testing.assert_array_equal(loop.xyz, SHEET[loop.ids])
            np.testing.assert_allclose(loop.centroid[:2], centre, atol=0.7)
            self.assertAlmostEqual(loop.diameter, 2 * radius, delta=2)
            self.assertGreater(loop.confidence, 0.5)
            self.assertAlmostEqual(abs(loop.normal[2]), 1, places=2)
            self.assertEqual(len(loop), len(loop.ids))
        self.assertEqual(holes.summary["points"], len(SHEET))
        self.assertEqual(repr(holes.loops), "Loops(2 holes, 1 outer)")
        self.assertEqual(holes.loops[-1].id, len(holes) - 1)
        self.assertEqual([loop.id for loop in holes.loops[:2]], [0, 1])
        with self.assertRaises(IndexError):
            holes.loops[len(holes.loops)]

    def test_any_stride_and_type_gives_the_same(self):
        single = SHEET.astype(np.float32)
        expected = lacuna.find_holes(single.astype(np.float64))
        records = np.zeros(len(single), [("intensity", "u2"), ("z", "f4"), ("y", "f4"), ("x", "f4")])
        for axis, name in enumerate("xyz"):
            records[name] = single[:, axis]
        wide = np.full((2 * len(single), 5), 7, np.float32)
        wide[::2, 4:1:-1] = single
        np.save(self.folder / "a.npy", np.column_stack([single, single]))
        for xyz in (
            single,
            np.asfortranarray(single),
            wide[::2, 4:1:-1],
            structured_to_unstructured(records[["x", "y", "z"]]),
            np.load(self.folder / "a.npy", mmap_mode="r")[:, :3],
            single.astype(np.float64)[::-1][::-1],
            single.astype(">f8"),
        ):
            self.assertTrue(same_loops(lacuna.find_holes(xyz), expected))
        self.assertTrue(same_loops(lacuna.find_holes(np.round(single * 1000).astype(np.int64)), lacuna.find_holes(np.round(single * 1000))))

        class Las:  # as laspy has it
            xyz = single

        self.assertTrue(same_loops(lacuna.find_holes(Las()), expected))

    def test_results_are_those_of_the_program(self):
        scan = self.folder / "sheet.xyz"
        np.savetxt(scan, SHEET, fmt="%.17g")
        subprocess.run([PROGRAM, "detect", scan, "--out", self.folder / "out", "--quiet", "--min-hole", "10"], check=True)
        program = json.loads((self.folder / "out/holes.json").read_text())["loops"]
        self.assertEqual(len(program), 3)
        for holes in (lacuna.find_holes(SHEET, min_hole=10), lacuna.detect(scan, min_hole=10), lacuna.load(self.folder / "out")):
            self.assertEqual([loop.ids.tolist() for loop in holes.loops], [loop["ids"] for loop in program])
            for loop, expected in zip(holes.loops, program):
                self.assertEqual(loop.xyz.tolist(), expected["coordinates"])
                for name in ("kind", "parent", "confidence", "area", "diameter", "perimeter", "planarity", "mean_probability", "last_scale"):
                    self.assertEqual(getattr(loop, name), expected[name])
            self.assertEqual(holes.summary["points"], len(SHEET))
            self.assertGreater(len(holes.sample["xyz"]), 500)  # of the first level
        self.assertEqual(set(lacuna.load(self.folder / "out").summary["bounds"]), set(holes.summary["bounds"]))

    def test_each_point_has_its_result(self):
        xyz = np.vstack([SHEET, [np.nan, 0, 0]])
        holes = lacuna.find_holes(xyz, points=True)
        self.assertEqual(holes.probability.shape, (len(xyz),))
        self.assertEqual(holes.criteria.shape, (len(xyz), 3))
        self.assertEqual(holes.normals.shape, (len(xyz), 3))
        self.assertTrue(np.isnan(holes.probability[-1]))
        self.assertEqual(holes.summary["dropped"], 1)
        loop = holes.loops[0]
        self.assertTrue((holes.loop_of_point[loop.ids] == 0).all())
        self.assertTrue(holes.boundary[loop.ids].all())
        np.testing.assert_array_equal(np.nonzero(holes.loop_of_point >= 0)[0], np.unique(holes.loops.ids))
        np.testing.assert_allclose(holes.criteria[:-1].mean(axis=1), holes.probability[:-1], atol=1e-6)
        with self.assertRaisesRegex(lacuna.Error, "points=True"):
            lacuna.find_holes(SHEET).probability

    def test_normals_count(self):
        up = np.tile(np.float32([0, 0, 2]), (len(SHEET), 1))
        np.testing.assert_array_equal(lacuna.find_holes(SHEET, up, points=True).normals, np.float32([[0, 0, 1]]).repeat(len(SHEET), 0))
        with self.assertRaisesRegex(lacuna.Error, "nx: has 5 values for"):
            lacuna.find_holes(SHEET, up[:5])

    def test_nothing_has_no_holes(self):
        holes = lacuna.find_holes(np.empty((0, 3)), points=True)
        self.assertEqual((len(holes.loops), len(holes.probability), holes.summary["bounds"]), (0, 0, None))

    def test_wrong_input_is_one_line(self):
        for xyz in (SHEET[:, :2], SHEET[0]):
            with self.assertRaisesRegex(lacuna.Error, "^xyz: has the shape .*; allowed: n x 3$"):
                lacuna.find_holes(xyz)
        with self.assertRaisesRegex(TypeError, "min_holes is no parameter; did you mean min_hole?"):
            lacuna.find_holes(SHEET, min_holes=1)
        with self.assertRaisesRegex(TypeError, "area is no parameter; lacuna.check has it"):
            lacuna.detect("a.laz", area="a.gpkg")
        with self.assertRaisesRegex(lacuna.Error, "k.*a whole number from 1 to 1000"):
            lacuna.find_holes(SHEET, k=0)
        with self.assertRaisesRegex(lacuna.Error, "no_such.laz"):
            lacuna.detect(self.folder / "no_such.laz")
        with self.assertRaisesRegex(lacuna.Error, "eps_fraction"):
            lacuna.find_holes(SHEET, eps=1, eps_fraction=0.1)
        with self.assertRaisesRegex(lacuna.Error, "label: has values of type"):
            lacuna.find_holes(SHEET, attributes={"label": np.array(["a"] * len(SHEET))})
        self.assertNotIn("\n", str(lacuna.Error("x")))

    def test_parameters_have_python_s_types(self):
        boxed = lacuna.find_holes(SHEET, bounds=[0, 0, 30, 30], threads=1, memory_limit="1GiB", every_point=True, holes_only=np.bool_(True))
        self.assertEqual({loop.kind for loop in boxed.loops}, {"hole"})
        self.assertEqual(boxed.summary["threads"], 1)
        self.assertIn("min_hole", [p["key"] for p in lacuna.parameters()])

    def test_warnings_and_errors_are_python_s(self):
        far = np.vstack([SHEET, [1e6, 0, 0]])
        with self.assertWarnsRegex(lacuna.LacunaWarning, "far.* bounds=") as caught:
            lacuna.find_holes(far)
        self.assertNotIn("--", str(caught.warning))
        np.savetxt(self.folder / "s.xyz", SHEET)
        with self.assertRaisesRegex(lacuna.Error, "^void_rule is required"):
            lacuna.check(self.folder / "s.xyz")
        with self.assertRaisesRegex(lacuna.Error, "^count: 0 is not possible; allowed: a whole number from 1 to 1000$"):
            lacuna.stations(lacuna.find_holes(SHEET), count=0)


BIG = plane(1000, [(500, 500, 20)])


class Running(Folder):
    def test_progress_of_a_step_and_of_the_run_goes_from_0_to_1(self):
        calls = []
        lacuna.find_holes(BIG, progress=lambda *call: calls.append(call))
        self.assertGreater(len(calls), 2)
        for step in {step for step, *_ in calls}:
            self.assertIsInstance(step, str)
            shares = [share for name, share, *_ in calls if name == step and share is not None]
            self.assertEqual(shares, sorted(shares))
            self.assertTrue(all(0 <= share <= 1 for share in shares))
        self.assertTrue(any(left is not None and left >= 0 for _, _, left, _, _ in calls))
        run = [share for *_, share, _ in calls]
        self.assertEqual(run, sorted(run))
        self.assertTrue(0 <= run[0] < run[-1] <= 1)
        self.assertTrue(any(left is not None and left >= 0 for *_, left in calls))

    def test_progress_of_a_short_run_is_its_end(self):
        calls = []
        lacuna.find_holes(SHEET, progress=lambda *call: calls.append(call))
        self.assertEqual(calls[-1][:2], ("collect", 1))

    def test_progress_can_cancel(self):
        for xyz in (BIG, SHEET):
            with self.assertRaisesRegex(lacuna.Error, "cancelled"):
                lacuna.find_holes(xyz, progress=lambda *_: False)

        def fail(*_):
            raise ValueError("mine")

        with self.assertRaisesRegex(ValueError, "mine"):
            lacuna.find_holes(BIG, progress=fail)
        self.assertEqual(len(lacuna.find_holes(SHEET).loops), 3)  # and the next run works

    def test_ctrl_c_ends_a_run(self):
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                lacuna.find_holes(BIG)

    def test_other_threads_go_on(self):
        ticks = []
        with ThreadPoolExecutor(1) as pool:
            run = pool.submit(lacuna.find_holes, BIG)
            while not run.done():
                ticks.append(time.monotonic())
                time.sleep(0.01)
        self.assertLess(max(b - a for a, b in zip(ticks, ticks[1:])), 0.3)

    def test_two_runs_at_once_have_the_same_results(self):
        expected = lacuna.find_holes(BIG)
        with ThreadPoolExecutor(2) as pool:
            self.assertTrue(all(same_loops(result, expected) for result in pool.map(lacuna.find_holes, [BIG, BIG])))

    def test_a_missing_folder_for_temporary_files_is_an_error(self):
        code = "import lacuna, numpy as np; lacuna.find_holes(np.random.default_rng(1).uniform(0, 30, (2000, 3)))"
        environment = {**os.environ, "TMPDIR": "/nonexistent"}
        run = subprocess.run([sys.executable, "-c", code], env=environment, stderr=subprocess.PIPE, text=True)
        self.assertRegex(run.stderr, "lacuna.*Error: TMPDIR names no folder for temporary files")


class Files(Folder):
    def test_results_are_saved_and_loaded(self):
        holes = lacuna.find_holes(SHEET, points=True, attributes={"red": np.arange(len(SHEET), dtype=np.uint8)})
        written = holes.save(self.folder / "out", lids=True, points=True)
        self.assertIn("lids.ply", [file.name for file in written])
        self.assertIn(b"property uchar red", (self.folder / "out/points/arrays.ply").read_bytes()[:2000])
        loaded = lacuna.load(self.folder / "out")
        self.assertTrue(same_loops(loaded, holes))
        for name in ("xyz", "area", "centroid", "is_outer", "parent", "points", "confidence"):
            np.testing.assert_array_equal(getattr(loaded.loops, name), getattr(holes.loops, name))
        for name in ("id", "xyz", "probability", "normal"):
            np.testing.assert_array_equal(loaded.sample[name], holes.sample[name])
        self.assertEqual({f.name for f in loaded.save(self.folder / "copy")}, {f.name for f in written})

        report = holes.report(self.folder / "x.html").read_text()
        self.assertTrue(report.startswith("<!doctype html>\n<!-- Lacuna report"))
        self.assertEqual(loaded.report(self.folder / "y.html").read_text().split("<body")[0], report.split("<body")[0])

    def test_detect_writes_what_the_program_writes(self):
        scan = self.synth("surface", "s.ply", "--points", "20000", "--holes", "3")
        subprocess.run([PROGRAM, "detect", scan, "--out", self.folder / "program", "--gpkg", "--quiet"], check=True)
        holes = lacuna.detect(scan, out=self.folder / "ours", gpkg=True)
        names = sorted(os.listdir(self.folder / "program"))
        self.assertEqual(sorted(os.listdir(self.folder / "ours")), names)
        for name in ("holes.json", "holes.csv", "loops.ply"):
            self.assertEqual((self.folder / "ours" / name).read_bytes(), (self.folder / "program" / name).read_bytes())
        self.assertEqual(len(holes), 4)
        (self.folder / "ours/mine.txt").write_text("mine")
        with self.assertRaisesRegex(lacuna.Error, "mine.txt"):
            lacuna.detect(scan, out=self.folder / "ours")

    def test_a_pickled_result_has_all_but_the_files(self):
        scan = self.synth("surface", "s.ply", "--points", "20000", "--holes", "3")
        found = lacuna.detect(scan, out=self.folder / "out", points=True)
        for holes in (found, lacuna.load(self.folder / "out")):
            copy = pickle.loads(pickle.dumps(holes))
            self.assertTrue(same_loops(copy, holes))
            self.assertEqual((len(copy), copy.summary, copy.unit), (4, holes.summary, holes.unit))
            np.testing.assert_array_equal(copy.sample["xyz"], holes.sample["xyz"])
            for use in (copy.save, copy.report, lambda _: copy.lids(), lambda _: lacuna.stations(copy)):
                with self.assertRaisesRegex(lacuna.Error, "a pickled result has no files; save the original"):
                    use(self.folder / "copy")
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(found)).probability, found.probability)

    def test_files_of_others_stay(self):
        (self.folder / "holes.csv").write_text("mine")
        holes = lacuna.find_holes(SHEET)
        with self.assertRaisesRegex(lacuna.Error, "holes.csv"):
            holes.save(self.folder)
        self.assertEqual(os.listdir(self.folder), ["holes.csv"])
        holes.save(self.folder / "out")
        loaded = lacuna.load(self.folder / "out")
        for write in (loaded.save, loaded.report, holes.report):
            (self.folder / "mine").mkdir(exist_ok=True)
            target = self.folder / "mine" / "holes.csv"
            target.write_text("mine")
            with self.assertRaisesRegex(lacuna.Error, "holes.csv"):
                write(target.parent if write == loaded.save else target)
            self.assertEqual(target.read_text(), "mine")
        with self.assertRaisesRegex(lacuna.Error, "holes.json: cannot be read"):
            lacuna.load(self.folder / "nothing")
        (self.folder / "holes.json").write_text("{}")
        with self.assertRaisesRegex(lacuna.Error, "is no result"):
            lacuna.load(self.folder)

    def test_causes_of_holes_where_stations_are_known(self):
        scan, stations = self.room()
        holes = lacuna.detect(scan, stations=stations)
        causes = [loop.cause for loop in holes.loops]
        self.assertTrue({"hidden", "opening"} <= set(causes))
        for loop in holes.loops:
            self.assertEqual(loop.cause is None, bool(np.isnan(loop.cause_shares).all()))
            self.assertEqual(np.isfinite(loop.hidden_by).all(), bool(loop.cause_shares[0] > 0))
        holes.save(self.folder / "out")
        loaded = lacuna.load(self.folder / "out")
        np.testing.assert_array_equal(loaded.loops.cause_shares, holes.loops.cause_shares)
        np.testing.assert_array_equal(loaded.loops.hidden_by, holes.loops.hidden_by)
        self.assertEqual({loop.cause for loop in lacuna.detect(scan).loops}, {None})

    def test_results_are_compared_with_the_truth_and_with_others(self):
        holes = lacuna.detect(self.synth("surface", "s.ply", "--points", "20000", "--holes", "3"))
        score = lacuna.evaluate(holes, self.folder / "s.loops.txt")
        self.assertEqual((score["found"], score["true"], score["false"]), (4, 4, 0))
        fewer = lacuna.detect(self.folder / "s.ply", holes_only=True)
        changes = [c["change"] for c in lacuna.compare(holes, fewer)["changes"]]
        self.assertEqual((changes.count("not found now"), changes.count("same")), (1, len(fewer.loops)))
        holes.save(self.folder / "out")
        same = lacuna.compare(self.folder / "out", lacuna.load(self.folder / "out"))["changes"]
        self.assertEqual([c["change"] for c in same], ["same"] * len(holes.loops))

    def test_an_area_is_checked_as_the_program_checks_it(self):
        np.savetxt(self.folder / "s.xyz", SHEET, fmt="%.17g")
        area = self.folder / "area.geojson"
        square = [[[5, 5], [55, 5], [55, 55], [5, 55], [5, 5]]]
        area.write_text(json.dumps({"type": "Polygon", "coordinates": square}))
        program = [PROGRAM, "check", self.folder / "s.xyz", "--area", area, "--out", self.folder / "out", "--void-rule", "9"]
        subprocess.run(program, check=False, capture_output=True)
        checked = lacuna.check(self.folder / "s.xyz", area, out=self.folder / "ours", void_rule=9)
        self.assertEqual(len(checked["voids"]), 2)
        for name in ("voids.json", "voids.csv"):
            self.assertEqual((self.folder / "ours" / name).read_bytes(), (self.folder / "out" / name).read_bytes())
        self.assertEqual(lacuna.check(self.folder / "s.xyz", area, void_rule=9), checked)
        with self.assertRaisesRegex(lacuna.Error, "area"):
            lacuna.check(self.folder / "s.xyz", "")
        outline = lacuna.check(self.folder / "s.xyz", void_rule=9)
        self.assertIsNone(outline["file"])
        self.assertIn("the scan's own outline", dict(outline["basis"])["area"])
        with self.assertRaisesRegex(TypeError, "min_confidence is no parameter of a check"):
            lacuna.check(self.folder / "s.xyz", area, void_rule=9, min_confidence=0.9)

    def test_a_file_of_points_is_read_by_detect(self):
        for name in ("room.ply", b"room.ply", Path("room.ply")):
            with self.assertRaisesRegex(TypeError, r"lacuna.detect\(b?'room.ply'\) reads a file"):
                lacuna.find_holes(name)

    def test_a_picture_is_the_program_s(self):
        holes = lacuna.find_holes(SHEET)
        holes.save(self.folder / "out")
        command = [PROGRAM, "render", self.folder / "out", "--out", self.folder / "p.png", "--view", "1", "--size", "200x100"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        for result in (holes, self.folder / "out"):
            picture = lacuna.render(result, self.folder / "ours.png", view=1, size=(200, 100))
            self.assertEqual(picture.read_bytes(), (self.folder / "p.png").read_bytes())
        with self.assertRaisesRegex(lacuna.Error, "view 'below'"):
            lacuna.render(holes, self.folder / "ours.png", view="below")
        (self.folder / "mine.png").write_text("mine")
        with self.assertRaisesRegex(lacuna.Error, "mine.png"):
            lacuna.render(holes, self.folder / "mine.png")

    def test_next_stations_are_the_program_s(self):
        scan, stations = self.room()
        holes = lacuna.detect(scan, stations=stations)
        holes.save(self.folder / "out")
        subprocess.run([PROGRAM, "stations", self.folder / "out", "--count", "2"], check=True, stdout=subprocess.DEVNULL)
        program = json.loads((self.folder / "out/next_stations.geojson").read_text())
        self.assertEqual(len(program["features"]), 2)
        self.assertEqual(lacuna.stations(holes, count=2), program)
        with self.assertWarnsRegex(lacuna.LacunaWarning, "no next station: .*all is farther"):
            self.assertEqual(lacuna.stations(holes, range=0.01)["features"], [])

    def test_info_is_the_program_s(self):
        np.savetxt(self.folder / "s.xyz", SHEET, fmt="%.17g")
        command = [PROGRAM, "info", "--json", self.folder / "s.xyz", "--min-hole", "10"]
        program = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        self.assertEqual(lacuna.info(self.folder / "s.xyz", min_hole=10), program)
        with self.assertRaisesRegex(TypeError, "k is no parameter of info"):
            lacuna.info(self.folder / "s.xyz", k=3)

    def test_lids_close_their_holes(self):
        holes = lacuna.find_holes(SHEET)
        lids = holes.lids()
        self.assertEqual(sorted(lids), [loop.id for loop in holes.loops if loop.kind == "hole"])
        for hole, (vertices, triangles) in lids.items():
            self.assertEqual((triangles.min(), triangles.max()), (0, len(vertices) - 1))
            a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
            area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
            self.assertAlmostEqual(area / holes.loops[hole].area, 1, delta=0.05)
        holes.save(self.folder / "with", lids=True)
        np.testing.assert_array_equal(lacuna.load(self.folder / "with").lids()[hole][0], vertices)
        holes.save(self.folder / "without")
        with self.assertRaisesRegex(lacuna.Error, "lids.ply: cannot be read.*lids=True"):
            lacuna.load(self.folder / "without").lids()

    def test_one_hole_is_no_holes(self):
        holes = lacuna.find_holes(plane(40, [(18, 17, 6)]))
        self.assertRegex(repr(holes), r"^Holes\(1 hole and 1 outer curve of 1,[0-9]+ points\)$")

    def test_a_stream_has_all_points_in_order(self):
        for i, part in enumerate(np.array_split(BIG, 3)):
            np.savetxt(self.folder / f"part{i}.xyz", part, fmt="%.17g")
        blocks = list(lacuna.stream(self.folder / "part*.xyz", sample_points=0))
        self.assertGreater(len(blocks), 1)
        self.assertEqual([b["first_id"] for b in blocks], np.cumsum([0] + [len(b["probability"]) for b in blocks])[:-1].tolist())
        expected = lacuna.find_holes(BIG, points=True)
        np.testing.assert_array_equal(np.concatenate([b["probability"] for b in blocks]), expected.probability)
        np.testing.assert_array_equal(np.concatenate([b["loop"] for b in blocks]), expected.loop_of_point)
        before = threading.active_count()
        for _ in lacuna.stream(self.folder / "part*.xyz"):
            break
        self.assertEqual(threading.active_count(), before)


class OtherLibraries(Folder):
    def need(self, module):
        try:
            return __import__(module)
        except ImportError:
            self.skipTest(f"{module} is not installed")

    def test_pandas(self):
        self.need("pandas")
        frame = lacuna.find_holes(SHEET).to_frame()
        self.assertEqual(len(frame), 3)
        self.assertEqual(sorted(frame["kind"]), ["hole", "hole", "outer"])
        self.assertIn("centroid_x", frame.columns)

    def test_geopandas(self):
        self.need("geopandas")
        holes = lacuna.find_holes(SHEET, crs="EPSG:25832", unit="m")
        self.assertEqual(holes.unit, "m")
        geo = holes.to_geo()
        self.assertEqual(geo.crs.to_epsg(), 25832)
        np.testing.assert_allclose(geo.geometry.area, holes.loops.area, rtol=0.01)
        self.assertEqual(set(holes.to_geo(polygons=False).geom_type), {"LineString"})

    def test_open3d(self):
        self.need("open3d")
        cloud, lines = lacuna.find_holes(SHEET, points=True).to_open3d()
        self.assertEqual(len(cloud.points), len(SHEET))
        self.assertEqual(len(lines.lines), len(lines.points))

    def test_matplotlib(self):
        matplotlib = self.need("matplotlib")
        matplotlib.use("Agg")
        holes = lacuna.find_holes(SHEET)
        ax = holes.plot(axes="xz")
        self.assertEqual(len(ax.lines), 3)
        self.assertIn("data:image/png", holes._repr_html_())

    def test_absent_libraries_are_named(self):
        from lacuna._optional import require

        with self.assertRaisesRegex(ImportError, "to_frame needs no_such_library: pip install no_such_library"):
            require("no_such_library", "to_frame")


class Documentation(unittest.TestCase):
    def test_editors_know_all_parameters(self):
        from lacuna import _core, _parameters

        for name, command, own in (("RunParameters", "run", {"points", "normals"}), ("CheckParameters", "check", {"area"}), ("InfoParameters", "info", set())):
            self.assertEqual(set(getattr(_parameters, name).__annotations__), {p["key"] for p in _core.parameters(command)} - own)
        self.assertEqual(set(_parameters.FileParameters.__annotations__), {p["key"] for p in lacuna.parameters()} - {"points"})
        for function, name in ((lacuna.find_holes, "Run"), (lacuna.detect, "File"), (lacuna.stream, "File"), (lacuna.check, "Check"), (lacuna.info, "Info")):
            self.assertEqual(inspect.signature(function).parameters["params"].annotation, f"Unpack[{name}Parameters]")

    def test_public_functions_say_what_they_do(self):
        for name in lacuna.__all__:
            self.assertTrue(inspect.getdoc(getattr(lacuna, name)), name)
        for name, member in inspect.getmembers(lacuna.Holes):
            if not name.startswith("_"):
                self.assertTrue(inspect.getdoc(member), name)


if __name__ == "__main__":
    unittest.main()
