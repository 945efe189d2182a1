#!/usr/bin/env python3
"""Runs `lacuna detect` on scans whose holes are known, evaluates what it finds, and prints one table. See
bench/accuracy/README.md; tools/accuracy.sh builds what it needs and calls it."""

import argparse
import csv
import itertools
import json
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from mesh import cut_balls, read_mesh, write_mesh  # noqa: E402
from range_map import SCENES, range_map  # noqa: E402
from thin import thin  # noqa: E402

SYNTH_KINDS = ["plane", "waves", "cylinder", "torus", "sphere-cap"]
CLOSED_KINDS = ["torus", "sphere", "cube"]
NOISES = [0, 0.25, 0.5]  # spacings
RANGE_NOISES = [0, 0.1, 0.3]  # steps of the grid of rays
PCL_NEIGHBOURS = [15, 30]
PCL_DEGREES = [90, 120]
COLUMNS = ["group", "set", "points", "method", "min_vertices", "true", "found", "false", "repeated", "loops",
           "confidence_auc", "flagged", "boundary", "precision", "recall", "f1", "precision_by_id",
           "recall_by_id", "f1_by_id"]


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


def fail(reason):
    raise SystemExit(f"accuracy: {reason}")


def run(command):
    """What a program says on stdout; ends with its own words where it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        fail(f"status {done.returncode} of: {' '.join(map(str, command))}\n{done.stderr.strip()}")
    return done.stdout


# ---- sets

def surface(arguments, group, name, options):
    scan = arguments.work / "sets" / f"{name}.ply"
    return Set(group, name, scan, scan.with_suffix(".loops.txt"), 16,
               lambda: run([arguments.lacuna, "synth", "surface", scan, *options]))


def uneven_surface(arguments, group, name, options, seed):
    """One in four points of a surface with half the spacing: sampled as if each point knew of no other."""
    scan = arguments.work / "sets" / f"{name}.ply"
    truth = scan.with_suffix(".loops.txt")

    def make():
        dense = arguments.work / "dense.ply"
        run([arguments.lacuna, "synth", "surface", dense, "--spacing", 0.005, "--points", 160_000, "--jitter", 0.5,
             *options])
        thin(dense, dense.with_suffix(".loops.txt"), 4, seed, scan)

    return Set(group, name, scan, truth, 8, make)


def synth_sets(arguments):
    variants = {"noise0": ["--points", 40_000],
                "noise25-random": ["--points", 40_000, "--noise", 0.25, "--order", "random"],
                "noise50": ["--points", 40_000, "--noise", 0.5],
                "factor4": ["--points", 40_000, "--density-factor", 4],
                # The holes keep to the dense half, which must have room for them.
                "step4": ["--points", 48_000, "--density-step", 4]}
    for seed, kind in enumerate(SYNTH_KINDS, start=1):
        for variant, options in variants.items():
            yield surface(arguments, "synth", f"{kind}-{variant}",
                          ["--kind", kind, "--holes", 13, "--hole-radius", 4, 12, "--seed", seed, *options])


def uneven_sets(arguments):
    for seed, kind in enumerate(SYNTH_KINDS, start=1):
        for noise in NOISES:
            yield uneven_surface(arguments, "uneven", f"uneven-{kind}-noise{round(100 * noise)}",
                                 ["--kind", kind, "--holes", 13, "--hole-radius", 8, 24, "--seed", seed,
                                  "--noise", 2 * noise], seed)


def closed_sets(arguments):
    for seed, kind in enumerate(CLOSED_KINDS, start=11):
        for noise in NOISES:
            options = ["--kind", kind, "--holes", 0, "--seed", seed]
            name = f"{kind}-noise{round(100 * noise)}"
            yield surface(arguments, "closed", f"closed-{name}", [*options, "--points", 40_000, "--noise", noise])
            yield uneven_surface(arguments, "closed-uneven", f"closed-uneven-{name}",
                                 [*options, "--noise", 2 * noise], seed)


def real(arguments, name):
    """A real scan; none where it is not there."""
    file = arguments.data / name
    if file.exists():
        return file
    print(f"accuracy: {file} is not there: its sets are skipped", file=sys.stderr)
    return None


def made_mesh(arguments, group, name, make):
    """A mesh that `make` returns, scan and truth in one."""
    file = arguments.work / "sets" / f"{name}.ply"
    return Set(group, name, file, file, make=lambda: write_mesh(make(), file))


def spacing_of(arguments, mesh):
    none = arguments.work / "none.loops.txt"
    none.write_text("# no loops\n", encoding="utf-8")
    return json.loads(run([arguments.lacuna, "evaluate", none, mesh, "--json"]))["spacing"]


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


GROUPS = [synth_sets, uneven_sets, closed_sets, mesh_sets, range_sets, range_made_sets]


# ---- runs

def known_methods(arguments):
    """Of every method its name and its options of `lacuna detect`."""
    told = subprocess.run([str(arguments.lacuna), "detect", "--print-config", "--method", "paper"],
                          capture_output=True, check=False)
    return {"default": []} | ({"paper": ["--method", "paper"]} if told.returncode == 0 else {})


def evaluate(arguments, case, method, folder):
    positions = [] if case.truth == case.scan else ["--scan", case.scan]
    told = json.loads(run([arguments.lacuna, "evaluate", folder, case.truth, "--json", *positions,
                           "--min-vertices", case.min_vertices]))
    row = {"group": case.group, "set": case.name, "method": method, "min_vertices": case.min_vertices}
    row |= {key: told[key] for key in ("points", "true", "found", "false", "repeated", "loops", "confidence_auc")}
    points = told["boundary"]
    row |= {"flagged": points["flagged"], "boundary": points["true"]} | points["within_tolerance"]
    return row | {f"{key}_by_id": value for key, value in points["by_id"].items()}


def detect(arguments, case, method, options):
    folder = arguments.work / "out" / method / case.name
    shutil.rmtree(folder, ignore_errors=True)  # another version's results would be refused
    run([arguments.lacuna, "detect", case.scan, "--out", folder, "--quiet", *options, *arguments.detect_options])
    return evaluate(arguments, case, method, folder)


def peer(arguments, case, neighbours, degrees):
    """PCL's boundary points. What it found in an earlier run stays, unless scan or program are newer."""
    folder = arguments.work / "pcl" / f"{case.name}-{neighbours}-{degrees}"
    result = folder / "boundary.ply"
    newest = max(case.scan.stat().st_mtime, arguments.pcl.stat().st_mtime)
    if not result.exists() or result.stat().st_mtime < newest:
        run([arguments.pcl, case.scan, folder, neighbours, degrees])
    row = evaluate(arguments, case, f"pcl-k{neighbours}-a{degrees}", folder)
    return row | dict.fromkeys(("found", "false", "repeated", "loops", "confidence_auc"))


def run_set(arguments, case, methods):
    rows = [detect(arguments, case, method, options) for method, options in methods.items()]
    if arguments.pcl:
        rows += [peer(arguments, case, k, angle) for k in PCL_NEIGHBOURS for angle in PCL_DEGREES]
    return rows


# ---- what came of it

def share(value):
    return "-" if value is None else f"{value:.3f}"


def f1_of(row):
    """None where nothing is true: all that can be told there is how many are flagged."""
    return row["f1"] if row["boundary"] else None


def mean(values):
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def best_peer(rows):
    scored = [(f1_of(row), row["method"]) for row in rows if row["method"].startswith("pcl") and row["boundary"]]
    return max(scored, default=(None, ""))


def table_row(name, points, true, of_method, pcl, pcl_name):
    cells = [name, f"{points:,}", str(true)]
    for found, false, repeated, flagged, f1 in of_method:
        cells += [str(found), str(false), str(repeated), f"{100 * flagged / points:.1f}", share(f1)]
    return cells + [share(pcl), pcl_name.removeprefix("pcl-")]


def group_rows(cases, methods):
    """A line for each set of a group, and their sums: of loops and points sums, of F1 means."""
    keys = ("found", "false", "repeated", "flagged")
    lines, numbers = [], []
    for rows in cases:
        own = [next(row for row in rows if row["method"] == method) for method in methods]
        values = [[*(row[key] for key in keys), f1_of(row)] for row in own]
        pcl, pcl_name = best_peer(rows)
        numbers.append((own[0]["points"], own[0]["true"], values, pcl))
        lines.append(table_row(own[0]["set"], own[0]["points"], own[0]["true"], values, pcl, pcl_name))
    sums = [[*(sum(values[i][k] for _, _, values, _ in numbers) for k in range(len(keys))),
             mean(values[i][-1] for _, _, values, _ in numbers)] for i in range(len(methods))]
    group = cases[0][0]["group"]
    lines.append(table_row(f"{group}: {len(cases)} sets", sum(n[0] for n in numbers), sum(n[1] for n in numbers),
                           sums, mean(n[3] for n in numbers), ""))
    return lines


def print_table(results, methods):
    header = ["set", "points", "true"]
    for method in methods:
        mark = "" if len(methods) == 1 else f" {method}"
        header += [f"{name}{mark}" for name in ("found", "false", "repeated", "flagged %", "F1")]
    header += ["best PCL F1", "of"]
    groups = {}
    for rows in results:
        groups.setdefault(rows[0]["group"], []).append(rows)
    lines = [header]
    for cases in groups.values():
        lines += group_rows(cases, methods)
    widths = [max(len(line[i]) for line in lines) for i in range(len(header))]
    for number, line in enumerate(lines):
        cells = [cell.ljust(width) if i == 0 else cell.rjust(width)
                 for i, (cell, width) in enumerate(zip(line, widths))]
        print(f"| {' | '.join(cells)} |")
        if number == 0:
            print(f"|{'|'.join('-' * (width + 2) for width in widths)}|")


def write_csv(results, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, COLUMNS)
        writer.writeheader()
        for rows in results:
            for row in rows:
                writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value
                                 for key, value in row.items()})


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lacuna", type=Path, required=True, help="the program")
    parser.add_argument("--pcl", type=Path, help="pcl_boundary_points of bench/peers; without it no peer runs")
    parser.add_argument("--work", type=Path, required=True, help="sets and results; sets are kept")
    parser.add_argument("--data", type=Path, required=True, help="folder of the real scans")
    parser.add_argument("--csv", type=Path, required=True, help="file for every row")
    parser.add_argument("--only", default="", help="sets whose GROUP/NAME matches this expression, such as synth/")
    parser.add_argument("detect_options", nargs="*", help="after --: for every lacuna detect")
    arguments = parser.parse_args()
    try:
        re.compile(arguments.only)
    except re.error as error:
        parser.error(f"--only: {error}")
    return arguments


def main():
    arguments = parse_arguments()
    (arguments.work / "sets").mkdir(parents=True, exist_ok=True)
    methods = known_methods(arguments)
    results = []
    for sets in GROUPS:
        for case in sets(arguments):
            if not re.search(arguments.only, f"{case.group}/{case.name}"):
                continue
            case.ensure()
            print(f"accuracy: {case.group}/{case.name}", file=sys.stderr)
            results.append(run_set(arguments, case, methods))
    if not results:
        fail("no set was run")
    write_csv(results, arguments.csv)
    print_table(results, list(methods))


if __name__ == "__main__":
    main()
