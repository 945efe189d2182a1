#!/usr/bin/env python3
"""Medians of the runs in a file of results: as tables, or as gnuplot's data."""

import csv
import statistics
import sys


def read(file):
    """Of every configuration (case, points, order, program, threads, memory limit), in the order of the
    file: by phase, the values of all runs as (seconds, peak bytes or None)."""
    configurations = {}
    with open(file, encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            key = (row["case"], int(row["points"]), row["order"], row["program"], int(row["threads"]),
                   int(row["memory_limit"] or 0))
            phases = configurations.setdefault(key, {})
            peak = int(row["peak_bytes"]) if row["peak_bytes"] else None
            phases.setdefault(row["phase"], []).append((float(row["seconds"]), peak))
    return configurations


def seconds(phases, phase="total"):
    return statistics.median(value for value, _ in phases[phase])


def spread(phases):
    """Slowest over fastest run, above 1, in percent."""
    totals = [value for value, _ in phases["total"]]
    return 100 * (max(totals) / min(totals) - 1)


def print_table(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) if i < 3 else cell.rjust(width)
                        for i, (cell, width) in enumerate(zip(row, widths))).rstrip())


def mebibytes(amount):
    return f"{amount / 2**20:,.0f}" if amount else "-"


def print_medians(configurations):
    rows = [("case", "order", "program", "points", "threads", "limit MiB", "runs", "seconds", "M points/s",
             "spread %", "peak MiB", "x lacuna")]
    for key, phases in configurations.items():
        case, points, order, program, threads, limit = key
        total = seconds(phases)
        # With the most memory, where it ran with several limits.
        ours = [(name[5], seconds(other)) for name, other in configurations.items()
                if name[0] == case and name[2:5] == (order, "lacuna", threads)]
        rows.append((case, order, program, f"{points:,}", str(threads), mebibytes(limit), str(len(phases["total"])),
                     f"{total:.3f}", f"{points / total / 1e6:.3f}", f"{spread(phases):.0f}",
                     mebibytes(max(peak for _, peak in phases["total"])),
                     "" if program == "lacuna" or not ours else f"{total / max(ours)[1]:.2f}"))
    print_table(rows)


def print_phases(configurations):
    print("\nNanoseconds per point, by phase:")
    for program in dict.fromkeys(key[3] for key in configurations):
        chosen = {key: phases for key, phases in configurations.items() if key[3] == program}
        names = list(dict.fromkeys(name for phases in chosen.values() for name in phases))
        print()
        rows = [("case", "order", "program", "threads", "limit MiB", *names)]
        for (case, points, order, _, threads, limit), phases in chosen.items():
            rows.append((case, order, program, str(threads), mebibytes(limit),
                         *(f"{1e9 * seconds(phases, name) / points:.1f}" if name in phases else "-" for name in names)))
        print_table(rows)


def print_plot(configurations):
    """A block per line: its title, then points and points per second. Real scans are no sizes of one thing,
    so they are in no line."""
    lines = {}
    synthetic = {key: phases for key, phases in configurations.items() if key[2] != "file"}
    several_threads = len({key[4] for key in synthetic}) > 1
    several_limits = len({key[5] for key in synthetic if key[5]}) > 1
    for (_, points, order, program, threads, limit), phases in synthetic.items():
        title = f"{program}, {order}"
        if several_threads:
            title += f", {threads} threads"
        if several_limits and limit:
            title += f", {mebibytes(limit)} MiB"
        lines.setdefault(title, []).append((points, points / seconds(phases)))
    if lines:
        print("\n\n\n".join("\n".join([f'"{title}"', *(f"{x} {y:.0f}" for x, y in sorted(values))])
                            for title, values in lines.items()))


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("table", "plot"):
        sys.exit("usage: summarise.py table|plot RESULTS.csv")
    configurations = read(sys.argv[2])
    if sys.argv[1] == "plot":
        print_plot(configurations)
    else:
        print_medians(configurations)
        print_phases(configurations)


main()
