#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that each folder of a source folder includes only those above it in the table of its README.

usage: check_arrows.py FOLDER
"""
import pathlib
import re
import sys

folder = pathlib.Path(sys.argv[1])
rows = re.findall(r"^\| `([\w]+)/?` \|", (folder / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
order = {name: place for place, name in enumerate(rows)}


def room(path):
    return path.relative_to(folder).parts[0].removesuffix(path.suffix)


failed = False
for source in sorted(folder.rglob("*.[ch]pp")):
    if room(source) not in order:
        sys.exit(f"{source}: its folder is not in the table of {folder}/README.md")
    for name in re.findall(rf'^#include "({folder.name}/[^"]+)"', source.read_text(encoding="utf-8"), re.MULTILINE):
        included = folder.parent / name
        if included.exists() and order[room(included)] > order[room(source)]:
            print(f"{source}: includes {name}, which is below it in the table of {folder}/README.md")
            failed = True
sys.exit(failed)
