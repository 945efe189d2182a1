#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares loops of `lacuna detect` on real scans with loops that were rated by eye. Scans that are absent are skipped."""

import argparse
import collections
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from sets import detected, evaluated  # noqa: E402

RATED = Path(__file__).resolve().parent / "real"
RIGHT, PARTLY, WRONG = "R", "P", "GVN"  # as real/*.eye.txt have them; G, V and N are three ways to be wrong
KINDS = ("hole", "outer")
SURE = 0.9


def rated_loops(file):
    """Mark, kind and ids of each."""
    lines = (line.split() for line in file.read_text(encoding="utf-8").splitlines())
    return [(words[0], words[1], words[2:]) for words in lines if words and words[0] != "#"]


def present_scans(folder):
    """The names of the rated scans that are in the folder, and how many there are in all."""
    names = [file.name.removesuffix(".eye.txt") for file in sorted(RATED.glob("*.eye.txt"))]
    return [name for name in names if (folder / f"{name}.ply").exists()], len(names)


def written(file, loops):
    file.write_text("".join(" ".join(map(str, ids)) + "\n" for ids in loops), encoding="utf-8")
    return file


def matched(arguments, result, scan, truth):
    """For each loop of the result the place of the true loop that it runs along, or None."""
    return [match["true_loop"] if match["verdict"] in ("found", "repeated") else None
            for match in evaluated(arguments, result, scan, truth, 1)["loop_matches"]]


def reported_loops(arguments, name, options):
    """The loops of `lacuna detect`, each with the place of the rated loop that it matches, or None. Then the rated
    loops, each with whether a reported one runs along it."""
    rated = rated_loops(RATED / f"{name}.eye.txt")
    folder = arguments.work / "out" / "real" / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    scan = arguments.scans / f"{name}.ply"
    truth = written(folder.with_suffix(".loops.txt"), (ids for *_, ids in rated))
    if arguments.results:  # a list has neither kinds nor confidences: a loop is of the kind that it matches
        result = arguments.results / f"{name}.txt"
        places = matched(arguments, result, scan, truth)
        loops = [{"kind": "hole" if place is None else rated[place][1], "confidence": 0} for place in places]
    else:
        loops = detected(arguments, scan, folder, ["--threads", 1, "--sample-points", 0, "--unit", "m", *options])
        result = written(folder.with_suffix(".reported.txt"), (loop["ids"] for loop in loops))
        places = matched(arguments, result, scan, truth)
    is_found = [place is not None for place in matched(arguments, truth, scan, result)]
    return list(zip(loops, places, strict=True)), list(zip(rated, is_found, strict=True))


def right_and_wrong(kind, counts, *sure):
    return (sum(counts[kind, mark, *sure] for mark in marks) for marks in (RIGHT, WRONG))


def count(arguments, name):
    """Counts of one scan. (kind, mark): reported loops, None where none was rated, and with "sure" those of 0.9 and more.
    (kind, "rated") and (kind, "found"): right ones. (kind, "scans"), (kind, "shares"): 1 and the share of right ones, where
    loops are right or wrong."""
    reported, rated = reported_loops(arguments, name, arguments.detect_options)
    counts = collections.Counter()
    for loop, place in reported:
        mark = None if place is None else rated[place][0][0]
        counts[loop["kind"], mark] += 1
        if loop["confidence"] >= SURE:
            counts[loop["kind"], mark, "sure"] += 1
    for (mark, kind, _), is_found in rated:
        if mark == RIGHT:
            counts[kind, "rated"] += 1
            counts[kind, "found"] += is_found
    for kind in KINDS:
        right, wrong = right_and_wrong(kind, counts)
        if right + wrong:
            counts[kind, "scans"] = 1
            counts[kind, "shares"] = right / (right + wrong)
    return counts


def share(part, whole):
    return f"{part / whole:.2f}" if whole else "-"


def row(title, kind, counts):
    right, wrong = right_and_wrong(kind, counts)
    sure, sure_wrong = right_and_wrong(kind, counts, "sure")
    return (f"| {title} | {kind} | {right} | {counts[kind, PARTLY]} | {wrong} | {share(right, right + wrong)} "
            f"| {share(counts[kind, 'shares'], counts[kind, 'scans'])} of {counts[kind, 'scans']} "
            f"| {share(sure, sure + sure_wrong)} | {counts[kind, None]} "
            f"| {share(counts[kind, 'found'], counts[kind, 'rated'])} of {counts[kind, 'rated']} |")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lacuna", type=Path, help="the program that finds holes")
    parser.add_argument("--results", type=Path, help="in its place, a folder with the loops of another program: NAME.txt, the ids "
                        "of a loop in a line")
    parser.add_argument("--bench", type=Path, required=True, help="the program lacuna-bench")
    parser.add_argument("--work", type=Path, required=True, help="results")
    parser.add_argument("--scans", type=Path, required=True, help="folder of the scans, NAME.ply")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scans at a time")
    parser.add_argument("detect_options", nargs="*", help="after --: for every lacuna detect")
    arguments = parser.parse_args()
    if bool(arguments.lacuna) == bool(arguments.results):
        parser.error("--lacuna or --results is needed")
    return arguments


def main():
    arguments = parse_arguments()
    present, rated = present_scans(arguments.scans)
    print(f"{len(present)} of {rated} scans are there\n")
    groups = collections.defaultdict(collections.Counter)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for name, counts in zip(present, pool.map(lambda name: count(arguments, name), present)):
            for title in (name.split("-")[0], "all"):
                groups[title].update(counts)
    print("| scans | loops | right | partly | wrong | right of right and wrong | its mean over scans "
          "| at 0.9 and more | not rated | reported of the rated right |\n|---" + "|---" * 9 + "|")
    for title in sorted(groups, key=lambda title: (title == "all", title)):
        for kind in KINDS:
            print(row(title, kind, groups[title]))


if __name__ == "__main__":
    main()
