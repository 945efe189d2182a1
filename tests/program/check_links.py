#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the relative links of pages: that their file exists, and the heading that they name.

    tests/program/check_links.py FILE.md|FOLDER...     # of a folder: every page in it and below

Exits with 1 if a link leads nowhere, or if there is no page. Needs Python 3 and no package.
"""

import re
import sys
from pathlib import Path


def anchors(page):
    """As GitHub names headings."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


def broken_links(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if target.startswith("http"):
            continue
        name, _, anchor = target.partition("#")
        file = page.parent / name if name else page
        if not file.exists() or (anchor and anchor not in anchors(file)):
            yield target


def main():
    pages = []
    for path in map(Path, sys.argv[1:]):
        pages += sorted(path.rglob("*.md")) if path.is_dir() else [path]
    broken = [f"{page}: {target} leads nowhere" for page in pages for target in broken_links(page)]
    print(*broken, sep="\n", end="\n" if broken else "")
    raise SystemExit(1 if broken or not pages else 0)


if __name__ == "__main__":
    main()
