#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs `lacuna detect` on scans whose holes are known, evaluates what it finds, and prints two tables. See
bench/accuracy/README.md; tools/accuracy.sh builds what it needs and calls it."""

import argparse
import csv
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from measure import known_methods, measure  # noqa: E402
from sets import GROUPS, fail  # noqa: E402
from table import print_table, print_widths  # noqa: E402


def write_csv(results, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, list(results[0][0]))
        writer.writeheader()
        for rows in results:
            for row in rows:
                writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value
                                 for key, value in row.items()})


def check_floors(file, results):
    """Every group that has run keeps to all of its floors, and has one; else the reasons and status 1. Columns of the
    file: set (GROUP, or GROUP/SET), method, true, found (at least), false (at most). Lines with # are remarks."""
    rows = [row for rows in results for row in rows]
    groups = {row["group"] for row in rows}
    with open(file, encoding="utf-8", newline="") as lines:
        floors = [floor for floor in csv.DictReader(line for line in lines if not line.startswith("#"))
                  if floor["set"].split("/")[0] in groups]
    problems = []
    for floor in floors:
        name = f"{floor['set']}, {floor['method']}"
        own = [row for row in rows if row["method"] == floor["method"]
               and floor["set"] in (row["group"], f"{row['group']}/{row['set']}")]
        true, found, false = (sum(row[key] for row in own) for key in ("true", "found", "false"))
        if true != int(floor["true"]):
            problems.append(f"{name}: {true} true loops, not {floor['true']}: sets have changed, or have not run")
            continue
        if found < int(floor["found"]):
            problems.append(f"{name}: {found} found of {true}, floor {floor['found']}")
        if false > int(floor["false"]):
            problems.append(f"{name}: {false} false, ceiling {floor['false']}")
    problems += [f"{group}: no floor" for group in sorted(groups - {floor["set"].split("/")[0] for floor in floors})]
    if problems:
        fail("below the floors\n" + "\n".join(problems))
    print(f"{len(floors)} floors held")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lacuna", type=Path, required=True, help="the program that finds holes")
    parser.add_argument("--bench", type=Path, required=True, help="the program lacuna-bench")
    parser.add_argument("--pcl", type=Path, help="pcl_boundary of bench/peers; without it PCL does not run")
    parser.add_argument("--cgal", type=Path, help="cgal_border_loops of bench/peers; without it CGAL does not run")
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
    methods = known_methods(arguments.lacuna)
    results = []
    for sets in GROUPS:
        for case in sets(arguments):
            if not re.search(arguments.only, f"{case.group}/{case.name}"):
                continue
            case.ensure()
            print(f"accuracy: {case.group}/{case.name}", file=sys.stderr)
            results.append(measure(arguments, case, methods))
    if not results:
        fail("no set was run")
    write_csv(results, arguments.csv)
    print_table(results, list(methods))
    print()
    print_widths(results, list(methods))
    if arguments.floors:
        check_floors(arguments.floors, results)


if __name__ == "__main__":
    main()
