#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that each folder of a source folder includes only those above it in the table of its README.

With BASE, the folders from that one on are a base: each includes only those below it, and all others may include
them. Files of FOLDER itself may include all.

usage: check_arrows.py FOLDER [BASE]
"""
import pathlib
import re
import sys

if len(sys.argv) < 2:
    sys.exit(__doc__.splitlines()[-1])
folder = pathlib.Path(sys.argv[1])
rows = re.findall(r"^\| `([\w]+)/?` \|", (folder / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
order = {name: place for place, name in enumerate(rows)}
if len(sys.argv) > 2:
    order |= {name: -order[name] for name in rows[rows.index(sys.argv[2]):]}


def room(path):
    return path.relative_to(folder).parts[0].removesuffix(path.suffix)


failed = False
for source in sorted(folder.glob("*/**/*.[ch]pp" if len(sys.argv) > 2 else "**/*.[ch]pp")):
    if room(source) not in order:
        sys.exit(f"{source}: its folder is not in the table of {folder}/README.md")
    for name in re.findall(rf'^#include "({folder.as_posix()}/[^"]+)"', source.read_text(encoding="utf-8"), re.MULTILINE):
        included = pathlib.Path(name)
        if included.exists() and order.get(room(included), -len(rows)) > order[room(source)]:
            print(f"{source}: includes {name}, against the order of the table of {folder}/README.md")
            failed = True
sys.exit(failed)
