#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a report with other stations and causes, to work on the page of what few scans have.

    mock_report.py REPORT.html OUT.html [--stations N] [--small]

Holes have each cause in turn, with a smaller second one, and one of six has none. Stations stand over the diagonal of the scan.
--small: all loops but the first are near the spacing, and nothing else is changed.
"""

import argparse
import json
import random
import re
from pathlib import Path

CAUSES = ["hidden", "opening", "out_of_view", "no_return", "filtered"]
DATA = re.compile(r'(<script type="application/json" id="report">)(.*?)(</script>)', re.DOTALL)


def stations_of(count, bounds):
    """The first one has a long name."""
    low, high = bounds["min"], bounds["max"]
    names = ["a long name of a station, as in E57", *(f"station {i}" for i in range(1, count))]
    return [{"name": name, "place": [round(l + (h - l) * (i + 1) / (count + 1), 3) for l, h in zip(low[:2], high[:2])] + [high[2]],
             "path": 0.0, "points": 150000, "certainty": 0.6 if i == 2 else 0.999, "counts": i != 2, "lowest_sine": -0.9,
             "highest_sine": 0.2, "turn": 1.0, "step": 0.003, "farthest": 12.0} for i, name in enumerate(names[:count])]


def next_stations_of(stations):
    return [{"rank": i + 1, "place": [station["place"][0] + 1.5, station["place"][1] + 0.2, station["place"][2]],
             "area": round(0.4 / (i + 1), 4), "share": round(0.5 / (i + 1), 4)} for i, station in enumerate(stations[:3])]


def set_causes(loops, stations):
    chance = random.Random(3)
    holes = [i for i, kind in enumerate(loops["kind"]) if kind == "hole"]
    count = len(loops["kind"])
    loops.update({name: [None] * count for name in ("cause", "hidden_by", "hidden_from_place", *CAUSES)}, hidden_from=[-1] * count)
    for number, i in enumerate(holes):
        main = number % 6
        if main == len(CAUSES):
            continue
        share = round(chance.uniform(0.6, 0.95), 3)
        for k, part in enumerate([share, round(0.995 - share, 3), 0.005, 0.0, 0.0]):
            loops[CAUSES[(main + k) % 5]][i] = part
        loops["cause"][i] = CAUSES[main]
        if loops["hidden"][i] > 0.01:
            station = (number // 6) % len(stations)
            eye = stations[station]["place"]
            loops["hidden_from"][i], loops["hidden_from_place"][i] = station, eye
            loops["hidden_by"][i] = [round(0.6 * c + 0.4 * e, 3) for c, e in zip(loops["centroid"][i], eye)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("report", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--stations", type=int, default=3)
    parser.add_argument("--small", action="store_true")
    arguments = parser.parse_args()
    page = arguments.report.read_text(encoding="utf-8")
    report = json.loads(DATA.search(page)[2])
    if arguments.small:
        report["loops"]["small"] = [i > 0 for i in range(len(report["loops"]["id"]))]
    else:
        report["stations"] = stations_of(arguments.stations, report["bounds"])
        report["next_stations"] = next_stations_of(report["stations"])
        set_causes(report["loops"], report["stations"])
    areas, causes = report["loops"]["area"], report["loops"]["cause"]
    report["opening_area"] = sum(area for area, cause in zip(areas, causes) if cause == "opening")
    data = json.dumps(report).replace("<", "\\u003c")
    arguments.out.write_text(DATA.sub(lambda found: found[1] + data + found[3], page), encoding="utf-8")


if __name__ == "__main__":
    main()
