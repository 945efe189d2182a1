#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Appends the rows of one run to the results: one per phase, and `total`."""

import argparse
import csv
import json
import os
import re

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


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("csv", "case", "positions", "order", "program", "threads", "run", "scan", "begin", "end", "time",
                 "printed", "report"):
        parser.add_argument("--" + name, required=True)
    given = parser.parse_args()

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


main()
