#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares instructions of functions, as callgrind_annotate prints them, with those in a CSV file.

    instructions.py FUNCTIONS CSV [--update]
"""
import csv
import re
import sys

# What of the run, and how the line of its function begins.
PARTS = {
    "all": r"PROGRAM TOTALS",
    "neighbours": r"\S*lacuna::find_neighbourhoods\(",
    "evaluate": r"\S*lacuna::evaluate\(",
    "stars": r"\S*lacuna::tangential::TangentialBoundary::emit\(",
    "loops": r"\S*lacuna::tangential::TangentialBoundary::find_loops\(",
    "levels": r"\S*lacuna::level_above\(",
    "write": r"\S*lacuna::io::write_results\(",
}
MOST = 1.1  # times as many


def main():
    functions, table = sys.argv[1:3]
    with open(functions) as file:
        lines = [(name, int(count.replace(",", ""))) for count, name in re.findall(r"^\s*([\d,]+)\s+(\S.*)$", file.read(), re.M)]
    counts = {}
    for part, pattern in PARTS.items():
        found = [count for name, count in lines if re.match(pattern, name)]
        if not found:
            sys.exit("instructions.py: no function of the part \"%s\"" % part)
        counts[part] = max(found)
    if "--update" in sys.argv:
        with open(table, "w") as file:
            file.write("part,million instructions\n")
            for part, count in counts.items():
                file.write("%s,%.0f\n" % (part, count / 1e6))
        return
    with open(table) as file:
        expected = {row["part"]: float(row["million instructions"]) for row in csv.DictReader(file)}
    if expected.keys() != counts.keys():
        sys.exit("instructions.py: %s has other parts; write it anew with --update" % table)
    failed = False
    print("%-12s %10s %10s %7s" % ("part", "expected", "now", "ratio"))
    for part, count in counts.items():
        ratio = count / 1e6 / expected[part]
        note = " more than %.1f" % MOST if ratio > MOST else ""
        failed |= ratio > MOST
        print("%-12s %10.0f %10.0f %7.3f%s" % (part, expected[part], count / 1e6, ratio, note))
    sys.exit(failed)


main()
