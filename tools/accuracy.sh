#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures how well `lacuna detect` finds holes that are known. See bench/accuracy/README.md.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/options.sh"

usage() {
  cat <<'END'
usage: tools/accuracy.sh [OPTIONS] [-- DETECT_OPTIONS]

Builds the program, makes the sets, finds and evaluates their holes, prints two tables and writes all rows as
bench/accuracy/results/DATE.csv. Where PCL (libpcl-dev) or CGAL (libcgal-dev) are installed, the table has PCL's boundary
points and the border loops of CGAL's advancing front, too.

  --only EXPRESSION   sets whose GROUP/NAME matches: synth/, cube, ...   default all but quick/
  --lacuna PROGRAM    this one, instead of building; --bench too, then
  --bench PROGRAM     lacuna-bench, which makes the sets and evaluates
  --no-peers          without PCL and CGAL
  --build DIR         default build
  --work DIR          sets and results of runs; sets are kept            default bench/work/accuracy
  --data DIR          the real scans                                     default ../shared/data
  --floors FILE       fails where fewer loops are found, or more are false, than this says
  --csv FILE          default bench/accuracy/results/DATE.csv
  -h, --help
DETECT_OPTIONS go to every `lacuna detect`: tools/accuracy.sh -- --k 20
END
}

only='^(?!quick/)'
floors=
lacuna=
bench=
no_peers=0
build=$root/build
work=$root/bench/work/accuracy
data=$root/../shared/data
csv=$root/bench/accuracy/results/$(date +%Y-%m-%d-%H%M%S).csv
detect_options=()
parse_options "$@"

command -v python3 >/dev/null || fail "python3 is missing (package python3)"
if [[ -n $lacuna ]]; then
  [[ -x $lacuna ]] || fail "$lacuna is no program"
  [[ -x $bench ]] || fail "--bench must name the program lacuna-bench"
else
  tools/install.sh
  cmake -G Ninja -S . -B "$build" >/dev/null
  cmake --build "$build" --parallel "$(nproc)" --target lacuna lacuna-bench >&2
  lacuna=$build/lacuna
  bench=$build/lacuna-bench
fi

# Builds a peer of Lacuna where its library is installed, and adds the option of run.py that names it.
peers=()
add_peer() {
  local name=$1 package=$2 program=$3
  if [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
    echo "accuracy.sh: $package is not installed: the table has no $name" >&2
    return
  fi
  cmake -G Ninja -S . -B "$build" >/dev/null
  cmake --build "$build" --parallel "$(nproc)" --target lacuna_shared >&2
  cmake -G Ninja -S bench/peers -B "$build/peers" -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build "$build/peers" --parallel "$(nproc)" --target "$program" >&2
  peers+=("--$name" "$build/peers/$program")
}
if ((!no_peers)); then
  add_peer pcl libpcl-dev pcl_boundary
  add_peer cgal libcgal-dev cgal_border_loops
fi

python3 bench/accuracy/run.py --lacuna "$lacuna" --bench "$bench" "${peers[@]}" --work "$work" --data "$data" --csv "$csv" \
  --only "$only" ${floors:+--floors "$floors"} -- "${detect_options[@]}"
echo
echo "$csv"
