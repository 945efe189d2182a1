#!/usr/bin/env bash
# The documentation: figures are those that the script draws, and the method behind them finds the program's loops. Links
# lead somewhere. Sentences of documents and comments are short.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

cp docs/figures/*.py "$scratch"
python3 "$scratch/make.py"
for figure in "$scratch"/*.svg; do
  cmp "$figure" "docs/figures/$(basename "$figure")" || failed=1
done
for figure in docs/figures/*.svg; do
  [[ -e $scratch/$(basename "$figure") ]] || { echo "$figure: no script draws it"; failed=1; }
done

if [[ -n ${LACUNA_PROGRAM:-} ]]; then
  python3 "$scratch/compare.py" "$LACUNA_PROGRAM" || failed=1
fi

python3 tools/check_prose.py || failed=1

python3 - README.md CONTRIBUTING.md CHANGELOG.md docs/*.md bench/*.md bench/accuracy/README.md <<'END' || failed=1
import re
import sys
from pathlib import Path


def anchors(page):
    """As GitHub names headings."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


broken = 0
for page in map(Path, sys.argv[1:]):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if target.startswith("http"):
            continue
        name, _, anchor = target.partition("#")
        file = page.parent / name if name else page
        if not file.exists() or (anchor and anchor not in anchors(file)):
            print(f"{page}: {target} leads nowhere")
            broken += 1
sys.exit(broken > 0)
END
exit "$failed"
