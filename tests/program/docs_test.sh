#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The documentation: figures are those that the script draws from what the plain method of the tests finds. Links
# lead somewhere. Sentences of documents and comments are short. README.md is one screen. Each file that names the version
# names the same one. docs/confidence.md has the numbers of bench/accuracy/README.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

drawn=$scratch/docs/figures
mkdir -p "$drawn" "$scratch/bench/accuracy"
cp docs/figures/*.py "$drawn"
cp bench/accuracy/README.md "$scratch/bench/accuracy"
LACUNA_FIGURE_DATA=${LACUNA_FIGURE_DATA:-$PWD/build/tests/figure_data} python3 "$drawn/make.py"
for figure in "$drawn"/*.svg; do
  cmp "$figure" "docs/figures/$(basename "$figure")" || failed=1
done
for figure in docs/figures/*.svg; do
  [[ -e $drawn/$(basename "$figure") ]] || { echo "$figure: no script draws it"; failed=1; }
done

python3 tools/check_prose.py || failed=1

python3 tests/program/check_links.py *.md docs bench/*.md bench/accuracy/*.md engine/*.md engine/*/*.md io/*.md tools/*.md || failed=1

for storey in io io/read io/explain io/write; do
  python3 tests/program/check_arrows.py $storey || failed=1
done
python3 tests/program/check_arrows.py engine store || failed=1

(($(wc --lines <README.md) <= 60 && $(wc --words <README.md) <= 600)) || { echo "README.md: more than 60 lines or 600 words"; failed=1; }

# By eye, and by confidence.
measured=$(tr -d , <bench/accuracy/README.md)
while IFS= read -r cells; do
  [[ $measured == *"| $cells |"* ]] || { echo "docs/confidence.md: bench/accuracy/README.md has no row with $cells"; failed=1; }
done < <(sed -nE 's/,//g; s/^\| (holes|outer curves|0\.[5-9] to [01]\.[0-9]) \| ([^|]*( \| [^|]*){4}) \|.*/\2/p' docs/confidence.md)

# The version is that of project() in CMakeLists.txt.
version=$(sed -n 's/^project(lacuna VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
grep --quiet --line-regexp "version: $version" CITATION.cff || { echo "CITATION.cff: is not of version $version"; failed=1; }
newest=$(grep --max-count=1 '^## ' CHANGELOG.md)
[[ $newest == "## $version" || $newest == "## $version ("* ]] || { echo "CHANGELOG.md: begins with '$newest', not $version"; failed=1; }
for file in LICENSE cmake/debian_copyright; do
  grep --quiet 'Copyright:* .* The Lacuna authors' "$file" || { echo "$file: does not name the authors"; failed=1; }
done
exit "$failed"
