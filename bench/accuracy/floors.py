"""What must be found at least, and false at most: floors.csv."""

import csv


def read_floors(file):
    """Columns: set (GROUP, or GROUP/SET), method, true, found (at least), false (at most). Lines with # are remarks."""
    with open(file, encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return [row | {key: int(row[key]) for key in ("true", "found", "false")} for row in rows]


def sums(rows, floor):
    """True, found and false loops of the rows that a floor is for; None where there are none."""
    own = [row for row in rows if row["method"] == floor["method"]
           and floor["set"] in (row["group"], f"{row['group']}/{row['set']}")]
    return {key: sum(row[key] for row in own) for key in ("true", "found", "false")} if own else None


def problems_of(floor, found):
    name = f"{floor['set']}, {floor['method']}"
    if found["true"] != floor["true"]:
        return [f"{name}: {found['true']} true loops, not {floor['true']}: the sets have changed, or some are missing"]
    problems = []
    if found["found"] < floor["found"]:
        problems.append(f"{name}: {found['found']} found of {found['true']}, floor {floor['found']}")
    if found["false"] > floor["false"]:
        problems.append(f"{name}: {found['false']} false, ceiling {floor['false']}")
    return problems


def check_floors(floors, rows):
    """Every group that has run has a floor, and none is broken; else the reasons and status 1."""
    measured = [(floor, sums(rows, floor)) for floor in floors]
    measured = [(floor, found) for floor, found in measured if found]
    problems = [problem for floor, found in measured for problem in problems_of(floor, found)]
    with_floor = {floor["set"].split("/")[0] for floor, _ in measured}
    problems += [f"{group}: no floor" for group in sorted({row["group"] for row in rows} - with_floor)]
    if problems:
        raise SystemExit("accuracy: below the floors\n" + "\n".join(problems))
    print(f"{len(measured)} floors held")
