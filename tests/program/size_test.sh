#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The house stays as small as it is: whoever brings lines or files takes as many away elsewhere, and lowers these numbers.
set -euo pipefail
most_lines=83097 most_files=476
cd ../..
mapfile -t files < <(find engine io tools tests bench -name '*.?pp' -not -path '*/work/*')
lines=$(cat "${files[@]}" | wc -l)
echo "C++: $lines lines in ${#files[@]} files; at most $most_lines in $most_files"
((lines <= most_lines && ${#files[@]} <= most_files))
