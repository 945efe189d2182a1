#!/usr/bin/env python3
"""Fits the confidence of the method `tangential`, so that it is a probability. Of the loops said to be 0.7 sure, 7 in
10 are true. Prints the two constants, and how well they hold on the scans of the fit and on those of run.py (see
bench/accuracy/README.md).

The scans of the fit are none of run.py's. A loop's evidence follows from its confidence. Whether the loop is true
is known from `lacuna evaluate`. Logistic regression gives the constants."""

import argparse
import itertools
import json
import math
import os
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from constants import constants  # noqa: E402
from degrade import Scan, doubled, falling_by_ten, halved, kept_with  # noqa: E402
from range_map import SCENES, range_map  # noqa: E402
from sets import (GROUPS, RANGE_NOISES, SYNTH_KINDS, Set, cut_mesh, degraded, fail, made_mesh, real, run,  # noqa: E402
                  synth)

TEST_GROUPS = "^(synth|uneven|meshes|uneven-meshes|half|half-meshes|density|density-meshes|range|range-made)/"
MESH_SEEDS = (11, 12, 13, 14)
CONTRAST = 6  # of densities that vary
WAVES = 12


# ---- the scans of the fit

def varying(length):
    """Density that varies by a factor of six, and over so many spacings: waves of random directions, added up."""
    def treatment(scan, draw):
        scale = 2.2 / (length * scan.spacing)
        waves = [([draw.gauss(0, scale) for _ in range(3)], draw.uniform(0, math.tau)) for _ in range(WAVES)]

        def height(point):
            return sum(math.cos(x * point[0] + y * point[1] + z * point[2] + phase) for (x, y, z), phase in waves)

        heights = [height(point) for point in scan.points]
        low, high = min(heights), max(heights)
        return kept_with(scan, lambda point: CONTRAST ** -((height(point) - low) / (high - low)), draw)

    return treatment


def paired(scan, draw):
    """A second point for a random half of the points."""
    second = doubled(scan, draw).points[len(scan.points):]
    return Scan(scan.points + [point for point in second if draw.random() < 0.5], scan.loops, scan.spacing)


TREATMENTS = {"half": halved, "tenth": falling_by_ten, "varying15": varying(15), "varying40": varying(40),
              "pairs": paired}


def with_treatments(arguments, source, seed):
    """This set, and others derived from it."""
    yield source
    for place, (ending, treatment) in enumerate(TREATMENTS.items()):
        yield degraded(arguments, source, f"uneven {source.group}", f"{source.name}-{ending}", treatment, 8,
                       1000 * seed + place)


def surface_sets(arguments):
    """Near the nodes of a grid, and anywhere."""
    variants = {"jittered": ["--points", 60_000, "--hole-radius", 3, 11, "--noise", 0.25, "--order", "random"],
                "random": ["--points", 40_000, "--hole-radius", 4, 12, "--noise", 0.1, "--positions", "random"]}
    for seed, (kind, variant) in enumerate(itertools.product(SYNTH_KINDS, variants), start=301):
        source = synth(arguments, "surfaces", f"fit-{kind}-{variant}", "surface",
                       ["--kind", kind, "--holes", 13, "--seed", seed, *variants[variant]])
        source.min_vertices = 8
        yield from with_treatments(arguments, source, seed)


def mesh_sets(arguments):
    if bunny := real(arguments, "bun_zipper.ply"):
        for seed in MESH_SEEDS:
            source = made_mesh(arguments, "meshes", f"fit-bunny-cut{seed}",
                               lambda seed=seed: cut_mesh(arguments, bunny, seed))
            yield from with_treatments(arguments, source, seed)


def range_sets(arguments):
    views = itertools.product(SCENES, (False, True), RANGE_NOISES)
    for seed, (scene, perspective, noise) in enumerate(views, start=401):
        yield made_mesh(arguments, "range maps", f"fit-{scene}-{int(perspective)}-noise{round(100 * noise)}",
                        lambda made=(scene, perspective, noise, seed % 2 == 0, seed): range_map(*made))


def lidar_sets(arguments):
    """Every scene, and each thing that makes a lidar scan harder. Other seeds and values than in sets.py."""
    def to_top(degrees, *options):
        return ["--field-of-view", -60, degrees, *options]

    scans = {"room-top85": to_top(85, "--stations", 1),
             "room-noise": ["--noise", 0.03],  # about the spacing
             "room-rings8": ["--ring-ratio", 8, "--stations", 3],
             "room-crossing": ["--sweeps", 2, "--ring-ratio", 3],
             "room-step": ["--station-factor", 10],
             "court-top88": to_top(88, "--stations", 3),
             "court-registration": ["--stations", 4, "--registration", 0.01],
             "court-rings3": ["--ring-ratio", 3],
             "court-step": ["--station-factor", 6, "--noise", 0.005],
             "hall-top85": to_top(85, "--noise", 0.01),
             "hall-crossing": ["--sweeps", 3, "--ring-ratio", 6, "--stations", 3],
             "hall-rings5": ["--ring-ratio", 5, "--noise", 0.02],
             "vault-top90": to_top(90, "--stations", 3),
             "vault-top88": to_top(88, "--stations", 2, "--noise", 0.008),
             "vault-noise": ["--stations", 4, "--noise", 0.06],
             "vault-step": ["--stations", 3, "--station-factor", 7],
             "street-top85": to_top(85, "--stations", 3, "--registration", 0.01),
             "street-rings8": ["--stations", 3, "--ring-ratio", 8],
             "street-crossing": ["--stations", 3, "--sweeps", 3, "--ring-ratio", 5],
             "plant-top88": to_top(88, "--stations", 4),
             "plant-noise": ["--stations", 3, "--noise", 0.05],
             "plant-registration": ["--stations", 3, "--registration", 0.02, "--ring-ratio", 3],
             "aerial-even": ["--stations", 3, "--noise", 0.03],
             "aerial-noise": ["--stations", 5, "--noise", 0.15, "--registration", 0.1],
             "aerial-rings": ["--stations", 4, "--ring-ratio", 3],
             "aerial-step": ["--stations", 2, "--station-factor", 6, "--noise", 0.05]}
    for seed, (name, options) in enumerate(scans.items(), start=501):
        yield synth(arguments, "lidar", f"fit-{name}", "scan",
                    ["--scene", name.split("-")[0], "--points", 150_000, "--seed", seed, *options])


def fit_sets(arguments):
    """Without --lidar none of the scans is a lidar scan: the present evidence does not serve these."""
    return [*surface_sets(arguments), *mesh_sets(arguments), *range_sets(arguments),
            *(lidar_sets(arguments) if arguments.lidar else ())]


def test_sets(arguments):
    return [case for sets in GROUPS for case in sets(arguments)
            if re.search(TEST_GROUPS, f"{case.group}/{case.name}")]


# ---- their loops

@dataclass
class Logistic:
    """The confidence of a loop with some evidence."""
    middle: float
    slope: float

    def confidence(self, evidence):
        return 1 / (1 + math.exp(-self.slope * (evidence - self.middle)))

    def evidence(self, confidence):
        return self.middle + math.log(confidence / (1 - confidence)) / self.slope


@dataclass
class Loop:
    kind: str  # of the set
    evidence: float
    is_true: bool


def loops_of(arguments, case, logistic, config):
    """Loops that are joined, parted or along steps of density take no part: they are neither right nor wrong."""
    folder = arguments.work / "out" / "calibrate" / case.name
    run([arguments.lacuna, "detect", case.scan, "--out", folder, "--quiet", "--overwrite", "--threads", 1,
         "--config", config, "--min-confidence", arguments.least])
    found = json.loads((folder / "holes.json").read_text(encoding="utf-8"))["loops"]
    positions = [] if case.truth == case.scan else ["--scan", case.scan]
    verdicts = json.loads(run([arguments.lacuna, "evaluate", folder, case.truth, "--json", *positions,
                               "--min-vertices", case.min_vertices]))["loop_matches"]
    return [Loop(case.group, logistic.evidence(loop["confidence"]), match["verdict"] != "false")
            for loop, match in zip(found, verdicts, strict=True) if match["verdict"] not in ("joined", "parted", "step")]


def detect_all(arguments, cases, logistic):
    """The loops that `lacuna detect` reports with these constants."""
    config = arguments.work / "calibrate.toml"
    config.write_text(f"[tangential]\nconfidence_middle = {logistic.middle!r}\nconfidence_slope = {logistic.slope!r}\n",
                      encoding="utf-8")
    with ThreadPoolExecutor(arguments.jobs) as pool:
        return [loop for loops in pool.map(lambda case: loops_of(arguments, case, logistic, config), cases)
                for loop in loops]


# ---- the fit

def by_kind(loops):
    kinds = {}
    for loop in loops:
        kinds.setdefault(loop.kind, []).append(loop)
    return kinds


def fit(loops, start):
    """The constants under which the truth is likeliest, by Newton's method. In each kind of set the true loops weigh
    the same in total."""
    weighted = [(loop, 1 / sum(other.is_true for other in own)) for own in by_kind(loops).values() for loop in own]
    offset, slope = -start.middle * start.slope, start.slope
    for _ in range(50):
        g0 = g1 = h00 = h01 = h11 = 0.0  # of the log likelihood its gradient, and its second derivatives negated
        for loop, weight in weighted:
            sure = 1 / (1 + math.exp(-offset - slope * loop.evidence))
            error, bend = weight * (loop.is_true - sure), weight * sure * (1 - sure)
            g0, g1 = g0 + error, g1 + error * loop.evidence
            h00, h01, h11 = h00 + bend, h01 + bend * loop.evidence, h11 + bend * loop.evidence ** 2
        determinant = h00 * h11 - h01 * h01
        steps = (h11 * g0 - h01 * g1) / determinant, (h00 * g1 - h01 * g0) / determinant
        offset, slope = offset + steps[0], slope + steps[1]
        if max(map(abs, steps)) < 1e-9:
            break
    else:
        fail("the fit does not converge")
    return Logistic(-offset / slope, slope)


# ---- what is printed

def share(loops):
    return f"{sum(loop.is_true for loop in loops) / len(loops):.2f}" if loops else "-"


def print_curve(columns, logistic):
    """`columns`: a title and loops."""
    print("| confidence |" + "".join(f" {title}: true | loops |" for title in columns))
    print("|---" * (2 * len(columns) + 1) + "|")
    for tenth in range(10):
        cells = []
        for loops in columns.values():
            own = [loop for loop in loops if min(9, int(10 * logistic.confidence(loop.evidence))) == tenth]
            cells += [share(own), f"{len(own):,}"]
        print(f"| {tenth / 10:.1f} to {(tenth + 1) / 10:.1f} | {' | '.join(cells)} |")


def print_kinds(loops, logistic):
    print("| sets | loops | mean confidence | true |\n|---|---|---|---|")
    for kind, own in by_kind(loops).items():
        mean = sum(logistic.confidence(loop.evidence) for loop in own) / len(own)
        print(f"| {kind} | {len(own):,} | {mean:.2f} | {share(own)} |")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lacuna", type=Path, required=True, help="the program")
    parser.add_argument("--work", type=Path, required=True, help="sets and results; sets are kept")
    parser.add_argument("--data", type=Path, required=True, help="folder of the real scans")
    parser.add_argument("--rounds", type=int, default=3,
                        help="fits, each to the loops found with the constants of the one before; with 0 the program's "
                             "own constants are checked (default 3)")
    parser.add_argument("--least", type=float, default=0.02, help="confidence of the loops that take part (default 0.02)")
    parser.add_argument("--lidar", action="store_true", help="lidar scans take part in the fit, too")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scans at a time")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    (arguments.work / "sets").mkdir(parents=True, exist_ok=True)
    fitted, tested = fit_sets(arguments), test_sets(arguments)
    for case in [*fitted, *tested]:
        if not case.scan.exists():
            print(f"calibrate: {case.name}", file=sys.stderr)
        case.ensure()
    values = dict(constants(arguments.lacuna))
    logistic = Logistic(float(values["confidence_middle"]), float(values["confidence_slope"]))
    loops = detect_all(arguments, fitted, logistic)
    for _ in range(arguments.rounds):
        logistic = fit(loops, logistic)
        print(f"confidence_middle = {logistic.middle:.3f}, confidence_slope = {logistic.slope:.2f}", flush=True)
        loops = detect_all(arguments, fitted, logistic)
    others = detect_all(arguments, tested, logistic)
    print()
    print_curve({"fit": loops, "test": others}, logistic)
    print()
    print_kinds([*loops, *others], logistic)


if __name__ == "__main__":
    main()
