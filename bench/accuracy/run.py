#!/usr/bin/env python3
"""Runs `lacuna detect` on scans whose holes are known, evaluates what it finds, and prints one table. See
bench/accuracy/README.md; tools/accuracy.sh builds what it needs and calls it."""

import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from floors import check_floors, read_floors  # noqa: E402
from sets import GROUPS, fail, run  # noqa: E402

PCL_NEIGHBOURS = [15, 30]
PCL_DEGREES = [90, 120]
COLUMNS = ["group", "set", "points", "method", "min_vertices", "true", "found", "false", "repeated", "loops",
           "confidence_auc", "flagged", "boundary", "precision", "recall", "f1", "precision_by_id",
           "recall_by_id", "f1_by_id"]


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
    parser.add_argument("--floors", type=Path, help="what must be found at least; ends with status 1 where it is not")
    parser.add_argument("--only", default="^(?!quick/)", help="sets whose GROUP/NAME matches this expression, such as synth/")
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
    floors = read_floors(arguments.floors) if arguments.floors else []
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
    if arguments.floors:
        check_floors(floors, [row for rows in results for row in rows])


if __name__ == "__main__":
    main()
