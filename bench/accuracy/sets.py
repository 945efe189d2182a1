# SPDX-License-Identifier: Apache-2.0
"""The scans whose holes are known, group by group: how each is made, or where it lies. See README.md."""

import functools
import itertools
import json
import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from degrade import doubled, falling_by_ten, halved, overlapping, quartered, read_scan, with_outliers, write_points
from mesh import cut_balls, read_mesh, write_ply
from range_map import SCENES, range_map
from screens import SHAPES, screens

SYNTH_KINDS = ["plane", "waves", "cylinder", "torus", "sphere-cap"]
CLOSED_KINDS = ["torus", "sphere", "cube"]
NOISES = [0, 0.25, 0.5]  # spacings
RANGE_NOISES = [0, 0.1, 0.3]  # steps of the grid of rays
UNEVEN_MESHES = ["arm", "beast", "beetle", "max", "rocker"]
# By group: the end of a set's name, how it is degraded, and the vertices of the shortest true loop that counts. None is
# as in the set that it is made of.
DEGRADED = {"half": ("half", halved, 8),
            "density": ("tenth", falling_by_ten, 8),
            "doubled": ("doubled", doubled, None),
            "outliers": ("outliers", with_outliers, None)}


@dataclass
class Set:
    group: str
    name: str
    scan: Path
    truth: Path  # of true loops, or a mesh that is the scan too
    min_vertices: int = 8
    make: Callable[[], None] = lambda: None

    def ensure(self):
        """Made sets are kept for the next time."""
        if not (self.scan.exists() and self.truth.exists()):
            self.make()


def is_lidar(group):
    return group.startswith("lidar") or group == "aerial"


def fail(reason):
    raise SystemExit(f"accuracy: {reason}")


def run(command):
    """What a program says on stdout; ends with its own words where it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        fail(f"status {done.returncode} of: {' '.join(map(str, command))}\n{done.stderr.strip()}")
    return done.stdout


def evaluated(arguments, result, scan, truth, min_vertices):
    """What `lacuna-bench evaluate` says of a folder of `lacuna detect`, or of loops as text."""
    positions = [] if truth == scan else ["--scan", scan]
    return json.loads(run([arguments.bench, "evaluate", result, truth, "--json", *positions, "--min-vertices", min_vertices]))


def detected(arguments, scan, folder, options):
    """The loops of `lacuna detect`, whose results another version would not replace."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    run([arguments.lacuna, "detect", scan, "--out", folder, "--quiet", *options])
    return json.loads((folder / "holes.json").read_text(encoding="utf-8"))["loops"]


def synth(arguments, group, name, kind, options):
    """Made by `lacuna-bench synth KIND`."""
    scan = arguments.work / "sets" / f"{name}.ply"
    return Set(group, name, scan, scan.with_suffix(".loops.txt"), 16,
               lambda: run([arguments.bench, "synth", kind, scan, *options]))


def surface(arguments, group, name, options):
    return synth(arguments, group, name, "surface", options)


def from_dense(arguments, group, name, options, seed, points=160_000, treatment=quartered):
    """Made of a surface with half the spacing, four times the density."""
    dense = surface(arguments, "dense", f"dense-{name}", ["--spacing", 0.005, "--points", points, "--jitter", 0.5, *options])
    return degraded(arguments, dense, group, name, treatment, 8, seed)


def synth_sets(arguments):
    variants = {"noise0": ["--points", 40_000],
                "noise25-random": ["--points", 40_000, "--noise", 0.25, "--order", "random"],
                "noise50": ["--points", 40_000, "--noise", 0.5],
                "factor4": ["--points", 40_000, "--density-factor", 4],
                # The holes keep to the dense half, which must be large enough for them.
                "step4": ["--points", 48_000, "--density-step", 4]}
    for seed, kind in enumerate(SYNTH_KINDS, start=1):
        for variant, options in variants.items():
            yield surface(arguments, "synth", f"{kind}-{variant}",
                          ["--kind", kind, "--holes", 13, "--hole-radius", 4, 12, "--seed", seed, *options])


def uneven_sets(arguments):
    for seed, kind in enumerate(SYNTH_KINDS, start=1):
        for noise in NOISES:
            yield from_dense(arguments, "uneven", f"uneven-{kind}-noise{round(100 * noise)}",
                                 ["--kind", kind, "--holes", 13, "--hole-radius", 8, 24, "--seed", seed,
                                  "--noise", 2 * noise], seed)


def closed_sets(arguments):
    for seed, kind in enumerate(CLOSED_KINDS, start=11):
        for noise in NOISES:
            options = ["--kind", kind, "--holes", 0, "--seed", seed]
            name = f"{kind}-noise{round(100 * noise)}"
            yield surface(arguments, "closed", f"closed-{name}", [*options, "--points", 40_000, "--noise", noise])
            yield from_dense(arguments, "closed-uneven", f"closed-uneven-{name}",
                                 [*options, "--noise", 2 * noise], seed)


@functools.cache  # so that a missing file is named once
def existing(file):
    if file.exists():
        return file
    print(f"accuracy: {file} is not there: its sets are skipped", file=sys.stderr)
    return None


def real(arguments, name):
    """A real scan; none where it is not there."""
    return existing(arguments.data / name)


def made_mesh(arguments, group, name, make):
    """A mesh that `make` returns, scan and truth in one."""
    file = arguments.work / "sets" / f"{name}.ply"

    def write():
        mesh = make()
        write_ply(file, mesh.positions, mesh.faces)

    return Set(group, name, file, file, make=write)


def spacing_of(arguments, truth):
    """The spacing of the scan whose truth this is."""
    none = arguments.work / "none.loops.txt"
    none.write_text("# no loops\n", encoding="utf-8")
    return evaluated(arguments, none, truth, truth, 8)["spacing"]


def cut_mesh(arguments, file, seed):
    draw = random.Random(seed)
    radii = [draw.uniform(4, 20) for _ in range(15)]
    return cut_balls(read_mesh(file), spacing_of(arguments, file), radii, margin=6, seed=seed)


def mesh_sets(arguments):
    if bunny := real(arguments, "bun_zipper.ply"):
        yield Set("meshes", "bunny", bunny, bunny)
        for seed in (1, 2, 3):
            yield made_mesh(arguments, "meshes", f"bunny-cut{seed}",
                            lambda seed=seed: cut_mesh(arguments, bunny, seed))


def uneven_mesh_sets(arguments):
    for name in UNEVEN_MESHES:
        scan, truth = (real(arguments, f"uneven/{name}{ending}") for ending in (".ply", ".loops.txt"))
        if scan and truth:
            yield Set("uneven-meshes", name, scan, truth, 16)


def degraded(arguments, source, group, name, treatment, min_vertices, seed):
    scan = arguments.work / "sets" / f"{name}.ply"

    def make():
        source.ensure()
        whole = read_scan(source.scan, source.truth, spacing_of(arguments, source.truth))
        made = treatment(whole, random.Random(seed))
        write_points(made.points, made.loops, scan)

    return Set(group, name, scan, scan.with_suffix(".loops.txt"), min_vertices, make)


def degraded_sets(arguments):
    noisy = "-noise25-random"
    surfaces = [case for case in synth_sets(arguments) if case.name.endswith(noisy)]
    for group, (ending, treatment, min_vertices) in DEGRADED.items():
        for seed, source in enumerate([*surfaces, *mesh_sets(arguments)], start=201):
            yield degraded(arguments, source, f"{group}-meshes" if source.group == "meshes" else group,
                           f"{source.name.removesuffix(noisy)}-{ending}", treatment,
                           min_vertices or source.min_vertices, seed)


def range_sets(arguments):
    if lato := real(arguments, "lato000.ply"):
        yield Set("range", "lato000", lato, lato)
        yield made_mesh(arguments, "range", "lato000-no-strays", lambda: read_mesh(lato).without(set()))
    if (scan := real(arguments, "bun000.ply")) and (truth := real(arguments, "bun000.loops.txt")):
        yield Set("range", "bun000", scan, truth)


def range_made_sets(arguments):
    for number, (scene, view) in enumerate(itertools.product(SCENES, ("orthographic", "perspective"))):
        noise = RANGE_NOISES[number % 3]
        strays = number % 4 in (1, 2)  # so in half of the sets of each noise and of each view
        name = f"{scene}-{view}-noise{round(100 * noise)}{'-strays' if strays else ''}"
        yield made_mesh(arguments, "range-made", name,
                        lambda made=(scene, view == "perspective", noise, strays, number): range_map(*made))


def lidar_sets(arguments):
    scans = {"room": ["--stations", 2],
             "room-registration": ["--stations", 3, "--noise", 0.005, "--registration", 0.005],
             "court": ["--stations", 2],
             "court-registration": ["--stations", 3, "--registration", 0.02],
             "hall": ["--stations", 2, "--noise", 0.005],
             "hall-rings": ["--stations", 3, "--ring-ratio", 5]}
    for seed, (name, options) in enumerate(scans.items(), start=41):
        yield synth(arguments, "lidar", f"lidar-{name}", "scan",
                    ["--scene", name.split("-")[0], "--points", 200_000, "--seed", seed, *options])


def hard_lidar_sets(arguments):
    """By group: what makes each of its scans hard."""
    groups = {"lidar-view": {"room": ["--stations", 1, "--field-of-view", -60, 85],
                             "vault": ["--stations", 3, "--field-of-view", -60, 85],
                             "hall": ["--stations", 2, "--field-of-view", -55, 88, "--noise", 0.005]},
              "lidar-noise": {"room": ["--noise", 0.03],  # about the spacing
                              "plant": ["--stations", 3, "--noise", 0.05],
                              "street": ["--stations", 3, "--noise", 0.05]},
              "lidar-rings": {"court": ["--stations", 3, "--ring-ratio", 5],
                              "vault": ["--stations", 3, "--ring-ratio", 5, "--noise", 0.01],
                              "street": ["--stations", 3, "--ring-ratio", 5, "--noise", 0.01]},
              "lidar-crossing": {"room": ["--stations", 1, "--sweeps", 3, "--ring-ratio", 5],
                                 "hall": ["--stations", 3, "--sweeps", 3, "--ring-ratio", 5],
                                 "plant": ["--stations", 3, "--sweeps", 2, "--ring-ratio", 4, "--noise", 0.01]},
              "lidar-steps": {"room": ["--stations", 2, "--station-factor", 10],
                              "court": ["--stations", 2, "--station-factor", 8],
                              "vault": ["--stations", 3, "--station-factor", 5]},
              "aerial": {"aerial-even": ["--stations", 4, "--noise", 0.03],
                         "aerial-noise": ["--stations", 3, "--noise", 0.2, "--registration", 0.1],
                         "aerial-lines": ["--stations", 3, "--ring-ratio", 2.5],
                         "aerial-steps": ["--stations", 3, "--station-factor", 5, "--noise", 0.05]}}
    scans = [(group, name, options) for group, own in groups.items() for name, options in own.items()]
    for seed, (group, name, options) in enumerate(scans, start=61):
        yield synth(arguments, group, name if group == "aerial" else f"{group}-{name}", "scan",
                    ["--scene", name.split("-")[0], "--points", 150_000, "--seed", seed, *options])


def screen_set(arguments, group, kind, seed):
    scan = arguments.work / "sets" / f"{group}-{kind}-{seed}.ply"
    return Set(group, scan.stem, scan, scan.with_suffix(".loops.txt"), 16,
               lambda: write_points(*screens(kind, 0.1, seed), scan))


def screen_sets(arguments):
    for kind in SHAPES:
        for seed in range(1, 5):
            yield screen_set(arguments, "screens", kind, seed)


def quick_sets(arguments):
    """Small ones of every kind, for tools/check.sh."""
    def holes(kind, *options):
        return ["--kind", kind, "--holes", 8, "--hole-radius", 4, 10, "--seed", 21, *options]

    def dense_holes(kind, *options):
        return ["--kind", kind, "--holes", 8, "--hole-radius", 8, 20, "--seed", 22, *options]

    for name, options in {
            "jittered": holes("plane", "--points", 16_000),
            "noise": holes("waves", "--points", 16_000, "--noise", 0.5),
            "random-order": holes("cylinder", "--points", 16_000, "--noise", 0.25, "--order", "random"),
            "density-factor": holes("torus", "--points", 30_000, "--density-factor", 4),
            "density-step": holes("sphere-cap", "--points", 32_000, "--density-step", 4),
            "far-away": holes("plane", "--points", 16_000, "--spacing", 0.002, "--double",
                              "--translate", 500_000, 5_400_000, 300),
            "closed": ["--kind", "sphere", "--holes", 0, "--points", 16_000, "--noise", 0.5],
            "closed-edges": ["--kind", "cube", "--holes", 0, "--points", 16_000, "--noise", 0.25]}.items():
        yield surface(arguments, "quick", f"quick-{name}", options)
    for seed in (1, 2, 3):
        for kind in ("waves", "torus"):
            yield from_dense(arguments, "quick", f"quick-uneven-{kind}-{seed}",
                                 dense_holes(kind, "--noise", 0.5), seed, 64_000)
        yield from_dense(arguments, "quick", f"quick-uneven-closed-{seed}",
                         ["--kind", "sphere", "--holes", 0, "--noise", 0.5], seed, 64_000)
    yield from_dense(arguments, "quick", "quick-overlapping", dense_holes("plane"), 1, 64_000, overlapping)
    for seed, (name, kind, treatment) in enumerate([("half", "cylinder", halved), ("tenth", "waves", falling_by_ten),
                                                    ("doubled", "sphere-cap", doubled)], start=221):
        source = surface(arguments, "quick", f"quick-whole-{kind}", holes(kind, "--points", 16_000, "--noise", 0.25))
        yield degraded(arguments, source, "quick", f"quick-{name}", treatment, 8, seed)
    yield screen_set(arguments, "quick", "screens", 31)
    for scene, perspective, noise, strays in (("table", False, 0, True), ("wall", True, 0.1, False)):
        yield made_mesh(arguments, "quick", f"quick-range-{scene}",
                        lambda made=(scene, perspective, noise, strays, 31): range_map(*made))


# By group; a group of the table may be one of several that a function yields.
GROUPS = [synth_sets, uneven_sets, closed_sets, mesh_sets, uneven_mesh_sets, degraded_sets, range_sets, range_made_sets,
          lidar_sets, hard_lidar_sets, screen_sets, quick_sets]
