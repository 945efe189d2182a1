# SPDX-License-Identifier: Apache-2.0
"""Finds the holes of a set, with Lacuna and with its peers, and evaluates them: one row for each method."""

import os
import subprocess

from sets import detected, evaluated, run

# Numbers of loops from `lacuna-bench evaluate`. All are columns of the CSV; all but the first are columns of the table.
COUNTS = ("true", "found", "false", "joined", "parted", "step", "repeated")
# Classes of the widths of holes, in local spacings: those of `lacuna-bench evaluate`, in its order.
WIDTHS = ("below 2", "2 to 3", "3 to 5", "5 to 10", "10 and more")
PCL_NEIGHBOURS = [15, 30]
PCL_DEGREES = [90, 120]
CGAL_BOUNDS = [1.5, 2, 3, 4]  # circumradii of triangles, spacings
CGAL_FEWEST = 8  # points of a border loop: what Lacuna's curves have at least


def known_methods(lacuna):
    """The name of every method, and its options of `lacuna detect`."""
    config = subprocess.run([str(lacuna), "detect", "--print-config", "--method", "paper"], capture_output=True,
                            check=False)
    return {"default": []} | ({"paper": ["--method", "paper"]} if config.returncode == 0 else {})


def evaluate(arguments, case, method, result):
    """`result` is a folder of `lacuna detect`, or loops as text. Loops as text have no boundary points."""
    scores = evaluated(arguments, result, case.scan, case.truth, case.min_vertices)
    row = {"group": case.group, "set": case.name, "points": scores["points"], "method": method,
           "min_vertices": case.min_vertices}
    row |= {key: scores.get(key) for key in (*COUNTS, "loops", "confidence_auc")}
    points = scores["boundary"] or {"flagged": None, "true": None, "within_tolerance": {}, "by_id": {}}
    row |= {"flagged": points["flagged"], "boundary": points["true"]}
    row |= {key: points["within_tolerance"].get(key) for key in ("precision", "recall", "f1")}
    row |= {f"{key}_by_id": points["by_id"].get(key) for key in ("precision", "recall", "f1")}
    for width, holes in zip(WIDTHS, scores["holes_by_width"], strict=True):
        row |= {f"{key} {width}": holes[key] for key in ("true", "found")}
    return row | {"spacing": scores["spacing"]}


def detect(arguments, case, method, options):
    folder = arguments.work / "out" / method / case.name
    detected(arguments, case.scan, folder, [*options, *arguments.detect_options])
    return evaluate(arguments, case, method, folder)


def peer_result(result, program, case, command):
    """What a peer found in an earlier run stays, unless scan or program are newer."""
    newest = max(case.scan.stat().st_mtime, program.stat().st_mtime)
    if not result.exists() or result.stat().st_mtime < newest:
        run(command)


def pcl(arguments, case, neighbours, degrees):
    """PCL's boundary points. It finds no loops."""
    folder = arguments.work / "pcl" / f"{case.name}-{neighbours}-{degrees}"
    peer_result(folder / "boundary.ply", arguments.pcl, case, [arguments.pcl, case.scan, os.cpu_count(), neighbours, degrees, folder])
    row = evaluate(arguments, case, f"pcl-k{neighbours}-a{degrees}", folder)
    return row | dict.fromkeys((*COUNTS[1:], "loops", "confidence_auc", *(f"found {width}" for width in WIDTHS)))


def cgal(arguments, case, bound, spacing):
    """Border loops of CGAL's advancing front."""
    loops = arguments.work / "cgal" / f"{case.name}-{bound}.loops.txt"
    peer_result(loops, arguments.cgal, case, [arguments.cgal, case.scan, loops, bound * spacing, CGAL_FEWEST])
    return evaluate(arguments, case, f"cgal-r{bound}", loops)


def measure(arguments, case, methods):
    rows = [detect(arguments, case, method, options) for method, options in methods.items()]
    if arguments.pcl:
        rows += [pcl(arguments, case, k, angle) for k in PCL_NEIGHBOURS for angle in PCL_DEGREES]
    if arguments.cgal:
        rows += [cgal(arguments, case, bound, rows[0]["spacing"]) for bound in CGAL_BOUNDS]
    return rows
