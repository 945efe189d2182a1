#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The pictures of the documentation are those that its script draws; those of real scans are left out.
set -euo pipefail
: "${LACUNA_PROGRAM:?}" "${LACUNA_BENCH_PROGRAM:?}"
cd "$(dirname "${BASH_SOURCE[0]}")/../../docs/pictures"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp draw.sh "$scratch"
"$scratch/draw.sh" "$LACUNA_PROGRAM" "$LACUNA_BENCH_PROGRAM"
status=0
for picture in "$scratch"/*.png; do
  cmp "$picture" "$(basename "$picture")" || status=1
done
exit "$status"
