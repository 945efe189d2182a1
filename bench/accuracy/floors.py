# SPDX-License-Identifier: Apache-2.0
"""What must be found at least, and false at most: floors.csv."""

import csv


def read_floors(file):
    """Columns: set (GROUP, or GROUP/SET), method, true, found (at least), false (at most). Lines with # are remarks."""
    with open(file, encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return [row | {key: int(row[key]) for key in ("true", "found", "false")} for row in rows]


def sums(rows, floor):
    """True, found and false loops of the sets that a floor is for."""
    own = [row for row in rows if row["method"] == floor["method"]
           and floor["set"] in (row["group"], f"{row['group']}/{row['set']}")]
    return {key: sum(row[key] for row in own) for key in ("true", "found", "false")}


def problems_of(floor, found):
    name = f"{floor['set']}, {floor['method']}"
    if found["true"] != floor["true"]:
        return [f"{name}: {found['true']} true loops, not {floor['true']}: sets have changed, or have not run"]
    problems = []
    if found["found"] < floor["found"]:
        problems.append(f"{name}: {found['found']} found of {found['true']}, floor {floor['found']}")
    if found["false"] > floor["false"]:
        problems.append(f"{name}: {found['false']} false, ceiling {floor['false']}")
    return problems


def check_floors(floors, rows):
    """Every group that has run keeps to all of its floors, and has one; else the reasons and status 1."""
    groups = {row["group"] for row in rows}
    floors = [floor for floor in floors if floor["set"].split("/")[0] in groups]
    problems = [problem for floor in floors for problem in problems_of(floor, sums(rows, floor))]
    problems += [f"{group}: no floor" for group in sorted(groups - {floor["set"].split("/")[0] for floor in floors})]
    if problems:
        raise SystemExit("accuracy: below the floors\n" + "\n".join(problems))
    print(f"{len(floors)} floors held")
