#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Records the runs of tools/bench.sh, and prints medians of such files: as tables, or as the table of docs/results.md.

    speed.py record --csv RESULTS.csv ...   appends one run
    speed.py table|results RESULTS.csv...
"""

import argparse
import csv
import json
import os
import re
import statistics
import sys
from dataclasses import dataclass, replace

# ---- one run

COLUMNS = ["case", "points", "positions", "order", "program", "threads", "memory_limit", "run", "phase", "seconds",
           "points_per_second", "bytes_per_second", "peak_bytes", "processor_seconds"]


def read_time(time_file):
    """What /usr/bin/time -v found: the peak of resident bytes, and the seconds of all processors."""
    with open(time_file, encoding="utf-8") as lines:
        text = lines.read()
    found = {name: float(value) for name, value in re.findall(r"^\s*(.+?)(?: \(.*\))?: ([0-9.]+)$", text, re.M)}
    return 1024 * int(found["Maximum resident set size"]), found["User time"] + found["System time"]


def read_report(report_file):
    """Points, memory limit, seconds by phase and own peak memory of a run of Lacuna; all of it counts."""
    with open(report_file, encoding="utf-8") as file:
        report = json.load(file)
    phases = {phase["name"]: phase["seconds"] for phase in report["phases"]}
    return (report["points"], report["tiling"]["memory_limit_bytes"], phases,
            report["peak_memory_bytes"], 0.0)


def read_printed(printed_file):
    """The same of a peer, from the lines that it prints, and the seconds that are not to be counted. It has no
    limit and does not know its peak."""
    with open(printed_file, encoding="utf-8") as lines:
        values = dict(line.split() for line in lines)
    phases = {name: float(values[name]) for name in ("load", "normals", "boundary")}
    return int(values["points"]), "", phases, "", float(values["untimed"])


def read_kernel(scan_file):
    """The program that only finds neighbours has nothing but a total."""
    with open(scan_file, "rb") as lines:
        points = next(int(line.split()[2]) for line in lines if line.startswith(b"element vertex "))
    return points, "", {}, "", 0.0


def record(words):
    """Appends the rows of one run to the results: one per phase, and `total`."""
    parser = argparse.ArgumentParser(prog="speed.py record")
    for name in ("csv", "case", "positions", "order", "program", "threads", "run", "scan", "begin", "end", "time",
                 "printed", "report"):
        parser.add_argument("--" + name, required=True)
    given = parser.parse_args(words)

    if given.program in ("lacuna", "against"):
        points, memory_limit, phases, peak, untimed = read_report(given.report)
    elif given.program == "kernel":
        points, memory_limit, phases, peak, untimed = read_kernel(given.scan)
    else:
        points, memory_limit, phases, peak, untimed = read_printed(given.printed)
    total = float(given.end) - float(given.begin) - untimed
    rows = [(name, seconds, peak, "") for name, seconds in phases.items()]
    rows.append(("rest", max(total - sum(phases.values()), 0), "", ""))  # starting, writing the results, ending
    rows.append(("total", total, *read_time(given.time)))

    scan_bytes = os.path.getsize(given.scan)
    is_new = not os.path.exists(given.csv)
    with open(given.csv, "a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if is_new:
            writer.writerow(COLUMNS)
        for phase, seconds, *whole in rows:
            rates = [round(amount / seconds) if seconds > 0 else "" for amount in (points, scan_bytes)]
            writer.writerow([given.case, points, given.positions, given.order, given.program, given.threads,
                             memory_limit, given.run, phase, f"{seconds:.6f}", *rates, *whole])


# ---- medians of all

LEAST_POINTS = 100_000  # of the scans of docs/results.md: smaller ones last milliseconds
KINDS = {"jittered": "jittered grid", "random": "uniformly random"}
REAL = {"dragon_30scans_793k": "dragon, 30 raw scans", "balm_23scans_1.7M": "BALM, 23 lidar scans",
        "vol_total": "aerial survey"}


@dataclass(frozen=True)
class Configuration:
    case: str
    points: int
    positions: str  # "file" for a real scan
    order: str
    program: str
    threads: int
    limit: int  # bytes of memory; 0: none


def read(files):
    """The values of every configuration, in the order of the files. By phase, they are those of all runs as (seconds,
    peak bytes or None). "processor" is no phase: its seconds are those of all threads together."""
    configurations = {}
    for file in files:
        with open(file, encoding="utf-8", newline="") as lines:
            for row in csv.DictReader(lines):
                key = Configuration(row["case"], int(row["points"]), row["positions"], row["order"], row["program"],
                                    int(row["threads"]), int(row["memory_limit"] or 0))
                phases = configurations.setdefault(key, {})
                peak = int(row["peak_bytes"]) if row["peak_bytes"] else None
                phases.setdefault(row["phase"], []).append((float(row["seconds"]), peak))
                if row.get("processor_seconds"):
                    phases.setdefault("processor", []).append((float(row["processor_seconds"]), None))
    return configurations


def seconds(phases, phase="total"):
    return statistics.median(value for value, _ in phases[phase])


def processor(phases):
    return f"{seconds(phases, 'processor'):#.3g}" if "processor" in phases else "-"


def peak(phases):
    return max(value for _, value in phases["total"])


def spread(phases):
    """Slowest over fastest run, above 1, in percent."""
    totals = [value for value, _ in phases["total"]]
    return 100 * (max(totals) / min(totals) - 1)


def times_of(program, key, configurations):
    """Seconds of a program on the scan of another configuration; with the most memory, where it ran with several
    limits. None if it did not run."""
    # Peers count only points with finite coordinates.
    wanted = replace(key, program=program, limit=0, points=0)
    found = [(other.limit, seconds(phases)) for other, phases in configurations.items()
             if replace(other, limit=0, points=0) == wanted]
    return max(found)[1] if found else None


def print_table(rows, left):
    """`left`: how many columns are of text."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) if i < left else cell.rjust(width)
                        for i, (cell, width) in enumerate(zip(row, widths))).rstrip())


def mebibytes(amount):
    return f"{amount / 2**20:,.0f}" if amount else "-"


def limit_in_words(amount):
    if not amount:
        return "-"
    return f"{amount / 2**30:.3g} GiB" if amount >= 2**30 else f"{mebibytes(amount)} MiB"


def print_medians(configurations):
    rows = [("case", "positions", "order", "program", "points", "threads", "limit MiB", "runs", "seconds", "M points/s",
             "spread %", "processor s", "peak MiB", "x lacuna")]
    for key, phases in configurations.items():
        total = seconds(phases)
        ours = None if key.program == "lacuna" else times_of("lacuna", key, configurations)
        rows.append((key.case, key.positions, key.order, key.program, f"{key.points:,}", str(key.threads),
                     mebibytes(key.limit), str(len(phases["total"])), f"{total:.3f}", f"{key.points / total / 1e6:.3f}",
                     f"{spread(phases):.0f}", processor(phases), mebibytes(peak(phases)), f"{total / ours:.2f}" if ours else ""))
    print_table(rows, 4)


def print_results(configurations):
    """A row for each scan, order, number of threads and limit: random positions, then jittered ones, then real scans as
    they come."""
    print("| scan | points | order | memory limit | seconds | spread % | processor seconds | M points/s a core | "
          "peak MiB | times as fast as PCL | times the kernel |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    ours = [key for key in configurations if key.program == "lacuna" and key.points >= LEAST_POINTS]
    for key in sorted(ours, key=lambda key: ("random", "jittered", "file").index(key.positions)):
        phases = configurations[key]
        total = seconds(phases)
        pcl, kernel = (times_of(program, key, configurations) for program in ("pcl", "kernel"))
        name = KINDS.get(key.positions) or REAL.get(key.case, key.case)
        print(f"| {name} | {key.points / 1e6:.1f} M | {key.order} | {limit_in_words(key.limit)} | {total:#.3g} | "
              f"{spread(phases):.0f} | {processor(phases)} | {key.points / total / key.threads / 1e6:.2f} | {mebibytes(peak(phases))} | "
              f"{f'{pcl / total:.1f}' if pcl else '-'} | {f'{total / kernel:.1f}' if kernel else '-'} |")


def main():
    if len(sys.argv) < 3 or sys.argv[1] not in ("record", "table", "results"):
        sys.exit("usage:" + __doc__.split("\n\n", 1)[1].rstrip())
    if sys.argv[1] == "record":
        return record(sys.argv[2:])
    configurations = read(sys.argv[2:])
    if sys.argv[1] == "results":
        print_results(configurations)
    else:
        print_medians(configurations)


main()
