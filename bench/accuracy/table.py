# SPDX-License-Identifier: Apache-2.0
"""Two tables of all results. The first has a line for each set, and one for the sums of each group. The second has the
holes found by width, for each group and for the sums of each kind. A column is a title and what it
shows of a list of sets, where a set is the list of its rows. So a line and a line of sums are the same columns."""

from measure import COUNTS, WIDTHS
from sets import is_lidar


def total(rows, key):
    known = [row[key] for row in rows if row[key] is not None]
    return sum(known) if known else None


def mean(values):
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def number(value):
    return "-" if value is None else str(value)


def share(value):
    return "-" if value is None else f"{value:.3f}"


def f1_of(row):
    """None where nothing is true: all that is known there is how many are flagged."""
    return row["f1"] if row["boundary"] else None


def of_method(sets, method):
    return [row for rows in sets for row in rows if row["method"] == method]


def methods_of(sets, peer):
    return list(dict.fromkeys(row["method"] for rows in sets for row in rows if row["method"].startswith(peer)))


def flagged_share(rows):
    flagged = total(rows, "flagged")
    return "-" if flagged is None else f"{100 * flagged / total(rows, 'points'):.1f}"


def method_columns(method, mark):
    columns = {f"{key}{mark}": lambda sets, key=key: number(total(of_method(sets, method), key)) for key in COUNTS[1:]}
    columns[f"flagged %{mark}"] = lambda sets: flagged_share(of_method(sets, method))
    columns[f"F1{mark}"] = lambda sets: share(mean(map(f1_of, of_method(sets, method))))
    return columns


def best_pcl(rows):
    """The best F1 of a set, and whose it is."""
    scored = [(f1_of(row), row["method"]) for row in rows if row["method"].startswith("pcl") and row["boundary"]]
    return max(scored, default=(None, ""))


def pcl_columns():
    return {"best PCL F1": lambda sets: share(mean(best_pcl(rows)[0] for rows in sets)),
            "of": lambda sets: best_pcl(sets[0])[1].removeprefix("pcl-") if len(sets) == 1 else ""}


def best_cgal(group):
    """The bound with the best F1 of loops over a whole group; where nothing is true, with the fewest false loops."""
    def score(method):
        rows = of_method(group, method)
        true, found, false = (total(rows, key) for key in ("true", "found", "false"))
        return 2 * found / (true + found + false) if true else 0, -false

    return max(methods_of(group, "cgal"), key=score)


def cgal_columns(group):
    best = best_cgal(group)
    columns = {f"{key} CGAL": lambda sets, key=key: number(total(of_method(sets, best), key))
               for key in ("found", "false")}
    return columns | {"at": lambda sets: best.removeprefix("cgal-")}


def columns_of(group, methods):
    columns = {"points": lambda sets: f"{total(of_method(sets, methods[0]), 'points'):,}",
               "true": lambda sets: number(total(of_method(sets, methods[0]), "true"))}
    for method in methods:
        columns |= method_columns(method, "" if len(methods) == 1 else f" {method}")
    if methods_of(group, "pcl"):
        columns |= pcl_columns()
    if methods_of(group, "cgal"):
        columns |= cgal_columns(group)
    return columns


def group_lines(group, methods):
    columns = columns_of(group, methods)
    named = [(rows[0]["set"], [rows]) for rows in group]
    named.append((f"{group[0][0]['group']}: {len(group)} sets", group))
    return ["set", *columns], [[name, *(text(sets) for text in columns.values())] for name, sets in named]


def by_group(results):
    groups = {}
    for rows in results:
        groups.setdefault(rows[0]["group"], []).append(rows)
    return groups


def print_lines(lines):
    header = lines[0]
    widths = [max(len(line[i]) for line in lines) for i in range(len(header))]
    for place, line in enumerate(lines):
        cells = [cell.ljust(width) if i == 0 else cell.rjust(width)
                 for i, (cell, width) in enumerate(zip(line, widths))]
        print(f"| {' | '.join(cells)} |")
        if place == 0:
            print(f"|{'|'.join('-' * (width + 2) for width in widths)}|")


def print_table(results, methods):
    """`results`: a list of rows for each set. `methods`: those of Lacuna."""
    lines = []
    for group in by_group(results).values():
        header, own = group_lines(group, methods)
        lines += own
    print_lines([header, *lines])


def found_of_true(rows, width):
    true = total(rows, f"true {width}")
    return f"{total(rows, f'found {width}')} of {true}" if true else "-"


def print_widths(results, methods):
    """Holes found, of the true ones, by their width in spacings. Arguments as of print_table."""
    groups = by_group(results)
    sums = {"lidar and aerial": [rows for group in groups if is_lidar(group) for rows in groups[group]],
            "others": [rows for group in groups if not is_lidar(group) for rows in groups[group]]}
    columns = [(method, width) for method in methods for width in WIDTHS]
    lines = [["holes by width", *(width if len(methods) == 1 else f"{width} {method}" for method, width in columns)]]
    for name, sets in [*groups.items(), *sums.items()]:
        lines.append([name, *(found_of_true(of_method(sets, method), width) for method, width in columns)])
    print_lines(lines)
