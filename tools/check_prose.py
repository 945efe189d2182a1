#!/usr/bin/env python3
"""Checks the documentation: sentences of more than 25 words, and words that are retired (docs/glossary.md).

    tools/check_prose.py [FILE.md...]     # default: every .md file of the repository

Tables, code blocks and headings are left out; a formula or a name in `code` counts as one word. Exits with 1 if
something is found. Needs Python 3 and no package.
"""

import re
import sys
from pathlib import Path

MOST_WORDS = 25
RETIRED = ["tell", "tells", "told", "telling", "ask", "asks", "asked", "meet", "meets", "seat", "seats", "room", "letter",
           "letters", "breathe", "breathes", "settle", "settles", "settled", "suspect", "suspects", "rough points", "careful",
           "carefully", "seams"]
ALLOWED = ["a room, a court"]


def paragraphs(text):
    """(line number, text) of running text: list items and paragraphs."""
    block, start, in_code = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.startswith("```"):
            in_code = not in_code
            continue
        is_item = re.match(r"\s*([-*]|\d+\.) ", line)
        ends = not line.strip() or line.startswith(("    ", "#", "|", "![")) or in_code or is_item
        if ends and block:
            yield start, " ".join(block)
            block = []
        if in_code or not line.strip() or line.startswith(("    ", "#", "|", "![")):
            continue
        if not block:
            start = number
        block.append(re.sub(r"^\s*([-*]|\d+\.) ", "", line.strip()))


def sentences(paragraph):
    plain = re.sub(r"`[^`]*`", "CODE", paragraph)
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(r"\*[^*]+, (?=[A-Z]{2,})", "TITLE ", plain)
    plain = plain.replace("*", "")
    return re.split(r"(?<=[.:;!?])\s+(?=[A-Z0-9(\"CODE])", plain)


def faults(path):
    text = path.read_text(encoding="utf-8")
    for number, paragraph in paragraphs(text):
        for sentence in sentences(paragraph):
            words = [w for w in sentence.split() if re.search(r"\w", w)]
            if len(words) > MOST_WORDS:
                yield number, f"{len(words)} words: {sentence}"
            rest = sentence
            for allowed in ALLOWED:
                rest = rest.replace(allowed, "")
            for word in RETIRED:
                if re.search(rf"\b{word}\b", rest, re.IGNORECASE):
                    yield number, f"retired word {word!r}: {sentence}"


def main():
    root = Path(__file__).resolve().parent.parent
    paths = [Path(name) for name in sys.argv[1:]]
    if not paths:
        skipped = {"build", "bench/work", "build-bench", ".git"}
        paths = sorted(p for p in root.rglob("*.md") if not any(str(p.relative_to(root)).startswith(s) for s in skipped))
    count = 0
    for path in paths:
        for number, fault in faults(path):
            print(f"{path}:{number}: {fault}")
            count += 1
    raise SystemExit(1 if count else 0)


if __name__ == "__main__":
    main()
