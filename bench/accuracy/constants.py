#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How the results change when each constant of the method `tangential` is halved and doubled. The table has one line for
each value, and one column for each group of sets (see bench/accuracy/README.md). Values are set by a config file, so
that a new constant needs no change here. The constants are the section [tangential] of `lacuna detect --print-config`."""

import argparse
import os
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from measure import detect  # noqa: E402
from sets import GROUPS, fail, run  # noqa: E402

DEFAULT_SETS = "noise50|closed-uneven|^meshes|range/|range-made"


def constants(lacuna):
    """The name of each constant, and its value as text."""
    section = ""
    for line in run([lacuna, "detect", "--print-config"]).splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        elif section == "tangential" and (match := re.fullmatch(r"(\w+) = ([0-9.e+-]+)", line)):
            yield match[1], match[2]


def changed(value, factor):
    """A number of the kind that it was, whole or real."""
    return str(round(int(value) * factor)) if re.fullmatch(r"\d+", value) else str(float(value) * factor)


def measure(arguments, cases, options):
    """By group the loops found, those not true, and how many are true."""
    def one(case):
        row = detect(arguments, case, "constants", options)
        return case.group, row["found"], row["false"], row["true"]

    groups = {}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for group, *numbers in pool.map(one, cases):
            groups[group] = [a + b for a, b in zip(groups.get(group, [0, 0, 0]), numbers)]
    return groups


def line(name, groups):
    cells = [f"{found}, {false}" for found, false, _ in groups.values()]
    found, false, _ = (sum(numbers) for numbers in zip(*groups.values()))
    return f"| {' | '.join([name, *cells, f'{found}, {false}'])} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lacuna", type=Path, required=True, help="the program")
    parser.add_argument("--work", type=Path, required=True, help="sets and results; sets are kept")
    parser.add_argument("--data", type=Path, required=True, help="folder of the real scans")
    parser.add_argument("--only", default=DEFAULT_SETS, help="sets whose GROUP/NAME matches this expression")
    parser.add_argument("--constants", default="", help="constants whose name matches this expression")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scans at a time")
    arguments = parser.parse_args()
    arguments.detect_options = ["--threads", "1"]
    (arguments.work / "sets").mkdir(parents=True, exist_ok=True)

    cases = [case for sets in GROUPS for case in sets(arguments)
             if re.search(arguments.only, f"{case.group}/{case.name}")]
    if not cases:
        fail("no set was run")
    for case in cases:
        case.ensure()
    groups = measure(arguments, cases, [])
    heads = [f"{group} ({true})" for group, (_, _, true) in groups.items()]
    print(f"| found, false (of true) | {' | '.join(heads)} | all ({sum(g[2] for g in groups.values())}) |")
    print("|---" * (len(heads) + 2) + "|")
    print(line("defaults", groups), flush=True)
    for name, value in constants(arguments.lacuna):
        if not re.search(arguments.constants, name):
            continue
        for factor in (0.5, 2):
            other = changed(value, factor)
            file = arguments.work / f"{name}.toml"
            file.write_text(f"[tangential]\n{name} = {other}\n", encoding="utf-8")
            print(line(f"{name} {value}: {other}", measure(arguments, cases, ["--config", file])), flush=True)


if __name__ == "__main__":
    main()
