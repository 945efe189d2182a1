#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the English of documentation and comments: long sentences, retired words, and comments without a verb.

    tools/check_prose.py [FILE...]     # default: every file of the repository that it can read

Reads Markdown, and the comments of C++, JavaScript, Python, CMake, shell and TOML. Tables, code blocks and headings are
left out. A formula or a name in `code` counts as one word. Exits with 1 if something is found. Needs Python 3 and no
package.
"""

import io
import re
import sys
import tokenize
from pathlib import Path

MOST_WORDS = 25
# Words that docs/glossary.md replaces. Others that are retired have everyday meanings, too, and are not searched for.
RETIRED = re.compile(
    r"\b(tells?|told|telling|asks?|asked|asking|meets?|met|seats?|room|letters?|breathes?|settle[sd]?|suspects?"
    r"|careful|carefully|seams|beside|rims?|judge[sd]?|verdicts?|rough points|by themselves"
    r"|made (?=(scan|surface|range|lidar|room|court|hall)))\b", re.IGNORECASE)
ALLOWED = re.compile(r"\ba room, a court\b|\broom and court\b")
WITHOUT_VERB = re.compile(
    r"(The same|Likewise)\b(?!.*\b(is|are|was|were|has|have|can|must|may|does|do|gives?|holds?|appl(y|ies)|goes|takes?)\b)")

LICENCE = re.compile(r"^(?://|#) SPDX-License-Identifier: .*$", re.MULTILINE)

SLASHES = {".cpp", ".hpp", ".h", ".js", ".cjs"}
HASHES = {".sh", ".cmake", ".toml", ".txt"}
SKIPPED = re.compile(r"build[^/]*/|bench/work/|demo/|\.git/|tests/data/|(?!.*CMakeLists).*\.txt$")


def markdown(text):
    in_code = False
    for line in text.splitlines():
        if line.startswith("```"):
            in_code = not in_code
        is_prose = not in_code and not line.startswith(("    ", "#", "|", "![", "```"))
        yield line if is_prose else ""


def marked_comments(text, mark):
    """What stands behind the mark in each line; a comment in another column is another one."""
    column = None
    for line in text.splitlines():
        code, found, comment = line.partition(mark)
        is_comment = found and code.count('"') % 2 == 0 and code[-1:] in ("", " ") and comment[:1] in (" ", "")
        same_block = is_comment and len(code) == column and not code.strip()
        column = len(code) if is_comment else None
        yield ("" if same_block or not is_comment else "\n") + (comment[1:] if is_comment else "")


def python_comments(text):
    """Comments, and strings that are statements: docstrings."""
    lines = [""] * (text.count("\n") + 2)
    before, last_comment = tokenize.NEWLINE, (0, 0)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        row, column = token.start
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            goes_on = (row - 1, column) == last_comment and not token.line[:column].strip()
            lines[row] = ("" if goes_on else "\n") + token.string[2:]
            last_comment = token.start
        elif token.type == tokenize.STRING and before in (tokenize.NEWLINE, tokenize.INDENT):
            for offset, line in enumerate(token.string.strip('"').splitlines()):
                lines[row + offset] = line[column if offset and line[:column].isspace() else 0:]
        if token.type not in (tokenize.NL, tokenize.COMMENT):
            before = token.type
    return lines[1:]


def lines_of(path):
    text = LICENCE.sub("", path.read_text(encoding="utf-8"))
    if path.suffix == ".md":
        return markdown(text)
    if path.suffix == ".py":
        return python_comments(text)
    return marked_comments(text, "//" if path.suffix in SLASHES else "#")


def paragraphs(lines):
    """(line number, text) of running text: list items and paragraphs, without indented code and columns."""
    block, start = [], 0
    for number, line in enumerate([*lines, ""], 1):
        is_new = line.startswith("\n")
        line = line.lstrip("\n")
        is_item = re.match(r"\s*([-*]|\d+\.) ", line)
        is_text = line.strip() and not line.startswith("    ") and not re.search(r"\S {3,}\S", line)
        if block and (is_new or is_item or not is_text):
            yield start, " ".join(block)
            block = []
        if is_text:
            start = start if block else number
            block.append(re.sub(r"^\s*([-*]|\d+\.) ", "", line).strip())


def sentences(paragraph):
    plain = re.sub(r"`[^`]*`", "CODE", paragraph)
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(r"\*[^*]+, (?=[A-Z]{2,})", "TITLE ", plain)
    return re.split(r"(?<=[.!?])\)?\s+(?=[A-Z0-9(\"])", plain.replace("*", ""))


def faults(path):
    for number, paragraph in paragraphs(lines_of(path)):
        if path.suffix != ".md" and paragraph.startswith("Of "):
            yield number, f"a comment that begins with 'Of': {paragraph}"
        for sentence in sentences(paragraph):
            words = [w for w in sentence.split() if re.search(r"\w", w)]
            if len(words) > MOST_WORDS:
                yield number, f"{len(words)} words: {sentence}"
            if path.suffix != ".md" and WITHOUT_VERB.match(sentence):
                yield number, f"no verb: {sentence}"
            for found in RETIRED.finditer(ALLOWED.sub("", sentence)):
                yield number, f"retired word '{found.group(0).strip()}': {sentence}"


def main():
    root = Path(__file__).resolve().parent.parent
    paths = [Path(name) for name in sys.argv[1:]]
    if not paths:
        suffixes = SLASHES | HASHES | {".md", ".py"}
        found = [p.relative_to(root).as_posix() for p in root.rglob("*") if p.suffix in suffixes]
        paths = [root / name for name in sorted(found) if not SKIPPED.match(name)]
    count = 0
    for path in paths:
        for number, fault in faults(path):
            print(f"{path}:{number}: {fault}")
            count += 1
    raise SystemExit(1 if count else 0)


if __name__ == "__main__":
    main()
