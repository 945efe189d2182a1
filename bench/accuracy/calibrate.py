#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the confidence of the method `tangential`, so that it is a probability. Of the loops said to be 0.7 sure, 7 in
10 are true. Prints the coefficients of `log_odds` in engine/loops/confidence.cpp, for each kind of loop, and how well
they hold on the scans of the fit. It also prints how well the program's own confidence holds on those of run.py.
bench/accuracy/README.md has more.

The scans of the fit are none of run.py's. `lacuna detect` finds the loops that stand, whatever their confidence, and
the evidence of each. Whether a loop is true is known from `lacuna-bench evaluate`, on real scans from the eye (real.py).
Logistic regression gives the coefficients."""

import argparse
import itertools
import math
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from degrade import Scan, doubled, falling_by_ten, halved, kept_with  # noqa: E402
from range_map import SCENES, range_map  # noqa: E402
import real as eye  # noqa: E402
from sets import (GROUPS, RANGE_NOISES, SYNTH_KINDS, cut_mesh, degraded, detected, evaluated, fail,  # noqa: E402
                  is_lidar, made_mesh, quick_sets, real, synth)

UNDECIDED = ("joined", "parted", "P", "U")  # such loops are neither right nor wrong
RATED = "rated"  # group of the loops that were rated by eye
OF_RATED = 0.3  # their weight, over the weight of all others
REPORTED = 0.5  # the least confidence, by default
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
        scene = name.split("-")[0]
        yield synth(arguments, "aerial" if scene == "aerial" else "lidar", f"fit-{name}", "scan",
                    ["--scene", scene, "--points", 150_000, "--seed", seed, *options])


def fit_sets(arguments):
    return [*surface_sets(arguments), *mesh_sets(arguments), *range_sets(arguments), *lidar_sets(arguments)]


def test_sets(arguments):
    return [case for sets in GROUPS if sets is not quick_sets for case in sets(arguments)]


# ---- their loops

@dataclass
class Loop:
    group: str  # of the set
    verdict: str  # of `lacuna-bench evaluate`, or a mark of the eye
    kind: str
    confidence: float  # of the program
    terms: tuple = ()  # what the coefficients belong to

    @property
    def is_true(self):
        return self.verdict not in ("false", "step", *eye.WRONG)


def probability(log_odds):
    return (1 + np.tanh(log_odds / 2)) / 2  # never overflows


def octaves(ratio):
    mantissa, power = math.frexp(ratio)
    return power + 2 * mantissa - 2


def octaves_within(ratio, least, most):
    return octaves(min(max(ratio, least), most))


def evidence(name, change=lambda value: value):
    return lambda loop: change(loop["evidence"][name])


def within(name, least, most):
    return evidence(name, lambda value: octaves_within(value, least, most))


# As `log_odds` in engine/loops/confidence.cpp has them.
OF_BOTH = {"surface": evidence("surface"), "width": within("width", 0.5, 5),
           "persistence": evidence("persistence", lambda value: min(value, 2.0)),
           "sampling_gap": within("sampling_gap", 0.25, 1), "1": lambda loop: 1.0}
TERMS = {"hole": {**OF_BOTH, "compactness": within("compactness", 1 / 16, 1),
                  "prominence": lambda loop: octaves_within(loop["prominence"], 1, 32)},
         "outer": {**OF_BOTH, "goes_on": evidence("goes_on"), "layers": evidence("layers"), "volume": evidence("volume"),
                   "alike": evidence("alike", lambda count: octaves_within(1 + count, 1, 256))}}


def formula(kind, coefficients):
    return " ".join(f"{coefficient:+.2f} {name}" for coefficient, name in zip(coefficients, TERMS[kind]))


def rated(group, loop, verdict):
    return Loop(group, verdict, loop["kind"], loop["confidence"], tuple(term(loop) for term in TERMS[loop["kind"]].values()))


def standing_loops(arguments, case):
    folder = arguments.work / "out" / "calibrate" / case.name
    found = detected(arguments, case.scan, folder, ["--threads", 1, "--sample-points", 0, "--min-confidence", 0])
    matches = evaluated(arguments, folder, case.scan, case.truth, case.min_vertices)["loop_matches"]
    return [rated(case.group, loop, match["verdict"]) for loop, match in zip(found, matches, strict=True)]


def rated_loops(arguments, name):
    """The loops that stand on a real scan and were rated by eye."""
    arguments.results = None  # Lacuna runs
    reported, marked = eye.reported_loops(arguments, name, ["--min-confidence", 0])
    return [rated(RATED, loop, marked[place][0][0]) for loop, place in reported if place is not None]


def of_all(arguments, cases, loops_of):
    with ThreadPoolExecutor(arguments.jobs) as pool:
        return [loop for loops in pool.map(lambda case: loops_of(arguments, case), cases) for loop in loops]


# ---- the fit

def by_group(loops):
    groups = {}
    for loop in loops:
        groups.setdefault(loop.group, []).append(loop)
    return groups


def weighted(loops):
    """Each loop with its weight. In each group the true loops weigh the same in total; rated loops weigh alike."""
    groups = by_group(loops)
    rated = groups.pop(RATED, [])
    pairs = [(loop, 1 / max(1, sum(other.is_true for other in own))) for own in groups.values() for loop in own]
    if rated:
        weight = OF_RATED * sum(weight for _, weight in pairs) / len(rated)
        pairs += [(loop, weight) for loop in rated]
    return pairs


def fit(loops):
    """The coefficients under which the truth is likeliest, by Newton's method."""
    pairs = weighted(loops)
    terms, truth, weights = (np.array(values, float) for values in zip(*((loop.terms, loop.is_true, weight) for loop, weight in pairs)))
    coefficients = np.zeros(terms.shape[1])
    for _ in range(50):
        sure = probability(terms @ coefficients)
        bends = terms.T @ (terms * (weights * sure * (1 - sure))[:, None])  # second derivatives of the log likelihood, negated
        steps = np.linalg.solve(bends, terms.T @ (weights * (truth - sure)))
        coefficients += steps
        if abs(steps).max() < 1e-9:
            return coefficients
    return fail("the fit does not converge")


# ---- what is printed

def decided(loops):
    return [loop for loop in loops if loop.verdict not in UNDECIDED]


def share(loops):
    return f"{sum(loop.is_true for loop in loops) / len(loops):.2f}" if loops else "-"


def print_tenths(loops, confidence):
    """By tenths of their confidence, lidar scans apart from the others."""
    columns = {"lidar": [loop for loop in loops if is_lidar(loop.group)],
               "others": [loop for loop in loops if not is_lidar(loop.group)]}
    print("| confidence |" + "".join(f" {title}: true | loops | {', '.join(UNDECIDED)} |" for title in columns))
    print("|---" * (3 * len(columns) + 1) + "|")
    for tenth in range(10):
        cells = []
        for column in columns.values():
            own = [loop for loop in column if min(9, int(10 * confidence(loop))) == tenth]
            cells += [share(decided(own)), f"{len(decided(own)):,}", f"{len(own) - len(decided(own)):,}"]
        print(f"| {tenth / 10:.1f} to {(tenth + 1) / 10:.1f} | {' | '.join(cells)} |")


def print_groups(loops, confidence):
    print("| group | loops | mean confidence | true |\n|---|---|---|---|")
    for group, own in by_group(loops).items():
        mean = sum(map(confidence, own)) / len(own)
        print(f"| {group} | {len(own):,} | {mean:.2f} | {share(own)} |")


def print_section(title, loops, confidence):
    print(f"\n{title}\n")
    print_tenths(loops, confidence)
    print(f"\nOf these, with a confidence of {REPORTED} or more:\n")
    print_groups([loop for loop in decided(loops) if confidence(loop) >= REPORTED], confidence)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lacuna", type=Path, required=True, help="the program that finds holes")
    parser.add_argument("--bench", type=Path, required=True, help="the program lacuna-bench")
    parser.add_argument("--work", type=Path, required=True, help="sets and results; sets are kept")
    parser.add_argument("--data", type=Path, required=True, help="folder of the real scans")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scans at a time")
    arguments = parser.parse_args()
    arguments.scans = arguments.data / "real"
    return arguments


def main():
    arguments = parse_arguments()
    (arguments.work / "sets").mkdir(parents=True, exist_ok=True)
    fitted, tested = fit_sets(arguments), test_sets(arguments)
    for case in [*fitted, *tested]:
        if not case.scan.exists():
            print(f"calibrate: {case.name}", file=sys.stderr)
        case.ensure()
    loops = of_all(arguments, fitted, standing_loops)
    loops += of_all(arguments, eye.present_scans(arguments.scans)[0], rated_loops)
    coefficients = {}
    for kind in eye.KINDS:
        coefficients[kind] = fit([loop for loop in decided(loops) if loop.kind == kind])
        print(f"{kind}: {formula(kind, coefficients[kind])}", flush=True)
    print_section("The loops that stand on the scans of the fit, with these coefficients:", loops,
                  lambda loop: probability(np.dot(coefficients[loop.kind], loop.terms)))
    print_section("The loops that stand on the test scans, as the program has them:",
                  of_all(arguments, tested, standing_loops), lambda loop: loop.confidence)


if __name__ == "__main__":
    main()
