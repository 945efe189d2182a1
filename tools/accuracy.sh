#!/usr/bin/env bash
# Measures how well `lacuna detect` finds holes that are known. See bench/accuracy/README.md.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/options.sh"

usage() {
  cat <<'END'
usage: tools/accuracy.sh [OPTIONS] [-- DETECT_OPTIONS]

Builds the program, makes the sets, finds and evaluates their holes, prints one table and writes it as
bench/accuracy/results/DATE.csv. Where PCL is installed (libpcl-dev), its boundary points stand beside ours.

  --only EXPRESSION   sets whose GROUP/NAME matches: synth/, cube, ...   default all but quick/
  --lacuna PROGRAM    this one, instead of building
  --no-peers          without PCL
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
else
  tools/install.sh
  cmake -G Ninja -S . -B "$build" >/dev/null
  cmake --build "$build" --parallel "$(nproc)" --target lacuna >&2
  lacuna=$build/lacuna
fi

pcl=()
if ((!no_peers)); then
  if [[ $(dpkg-query --show --showformat='${db:Status-Status}' libpcl-dev 2>/dev/null) == installed ]]; then
    cmake -G Ninja -S bench/peers -B "$build/peers" -DCMAKE_BUILD_TYPE=Release >/dev/null
    cmake --build "$build/peers" --parallel "$(nproc)" --target pcl_boundary_points >&2
    pcl=(--pcl "$build/peers/pcl_boundary_points")
  else
    echo "accuracy.sh: PCL is not installed (libpcl-dev): nothing stands beside Lacuna" >&2
  fi
fi

python3 bench/accuracy/run.py --lacuna "$lacuna" "${pcl[@]}" --work "$work" --data "$data" --csv "$csv" \
  --only "$only" ${floors:+--floors "$floors"} -- "${detect_options[@]}"
echo
echo "$csv"
