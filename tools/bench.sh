#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures `lacuna detect` from scan file to results, next to other tools where wanted. See bench/SPEED.md.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/options.sh"
source tools/packages.sh

usage() {
  cat <<'END'
usage: tools/bench.sh [OPTIONS] [-- DETECT_OPTIONS]

Builds a release, makes the scans, runs the programs in turns, each twice of which once to warm up, and writes
bench/results/DATE.csv with a table of medians (DATE.txt) and the table of docs/results.md (DATE.md).

  --points LIST         synthetic scans, millions of points           default "1 4"; all: "1 4 16 64"
  --positions LIST      near a grid or anywhere: jittered, random     default "random jittered"
  --orders LIST         of the points in the file: scanline, random   default "scanline random"
  --threads LIST        default: one per core
  --memory-limit LIST   as for lacuna: 1GiB; or default               default "default"
  --runs N              that count; as many warm up                   default 5
  --real                the real scans, too
  --data DIR            where they are                                default ../shared/data
  --peers               PCL and Open3D too (installs about 1 GB of packages)
  --peer-programs LIST  which of them                             default "pcl open3d"
  --peer-points N       largest synthetic scan that peers get, millions of points    default 4
  --timeout SECONDS     for one run; what takes longer is left out    default 3600
  --against PROGRAM     another build of lacuna in turns with this one, called "against"
  --kernel PROGRAM      one that finds 15 exact nearest neighbours and does nothing else: PROGRAM SCAN THREADS hilbert
  --build DIR           default build-bench
  --work DIR            scans and results of runs; scans are kept     default bench/work
  -h, --help
DETECT_OPTIONS go to every `lacuna detect`: tools/bench.sh -- --eps 0.03
END
}

# ---- what the options request

points=(1 4)
positions=(random jittered)
orders=(scanline random)
threads=("$(nproc)")
memory_limit=(default)
runs=5
real=0
data=$root/../shared/data
peers=0
peer_programs=(pcl open3d)
peer_points=4
timeout=3600
against=
kernel=
build=$root/build-bench
work=$root/bench/work
detect_options=()
parse_options "$@"

for size in "${points[@]}" "$peer_points"; do
  [[ $size =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "\"$size\" is not a number of million points" 2
done
for kind in "${positions[@]}"; do
  [[ $kind == jittered || $kind == random ]] || fail "positions \"$kind\": must be jittered or random" 2
done
for order in "${orders[@]}"; do
  [[ $order == scanline || $order == random ]] || fail "order \"$order\": must be scanline or random" 2
done
for number in "${threads[@]}" "$runs" "$timeout"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || fail "\"$number\" is not a whole number from 1 on" 2
done
for program in "$against" "$kernel"; do [[ -z $program || -x $program ]] || fail "$program is no program"; done

# ---- programs

tools/install.sh
install_packages python3 time
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target lacuna lacuna-bench lacuna_shared
lacuna=$build/lacuna

if ((peers)); then
  for name in "${peer_programs[@]}"; do install_packages "lib$name-dev"; done
  cmake -G Ninja -S bench/peers -B "$build/peers" -DCMAKE_BUILD_TYPE=Release
  for name in "${peer_programs[@]}"; do
    cmake --build "$build/peers" --parallel "$(nproc)" --target "${name}_boundary"
  done
fi

# ---- scans

mkdir -p "$work" bench/results
work=$(cd "$work" && pwd)
stem=bench/results/$(date +%Y-%m-%d-%H%M%S)
csv=$stem.csv

# Sets `scan` to the file of a synthetic scan, made unless it is there.
make_scan() {
  local millions=$1 kind=$2 order=$3 count
  count=$(awk -v m="$millions" 'BEGIN { printf "%.0f", m * 1e6 }')
  scan=$work/waves-${millions}M-$kind-positions-$order-order.ply
  [[ -e $scan ]] && return
  "$build/lacuna-bench" synth surface "$scan" --kind waves --density-factor 4 --points "$count" --positions "$kind" \
    --order "$order" --holes "$((count / 10000 + 1))"
}

at_most() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a <= b) }'; }

# ---- runs

cleanup() { rm -rf "$work/out" "$work/printed" "$work/time"; }
trap cleanup EXIT

# Runs one program on the current case (scan, case, kind, order) with the current number of threads. Its lines go to the
# csv, but not those of run "warm-up".
run_once() {
  local program=$1 limit=$2 run=$3 command begin end status=0
  case $program in
    lacuna | against)
      local binary=$lacuna
      [[ $program == lacuna ]] || binary=$against
      command=("$binary" detect "$scan" --out "$work/out" --quiet --threads "$thread_count")
      [[ $limit == default ]] || command+=(--memory-limit "$limit")
      command+=("${detect_options[@]}")
      ;;
    kernel) command=("$kernel" "$scan" "$thread_count" hilbert) ;;
    *) command=("$build/peers/${program}_boundary" "$scan" "$thread_count") ;;
  esac
  rm -rf "$work/out"
  begin=$EPOCHREALTIME
  /usr/bin/time -v -o "$work/time" timeout --foreground "$timeout" "${command[@]}" >"$work/printed" || status=$?
  end=$EPOCHREALTIME
  if ((status != 0)); then
    cat "$work/printed" >&2
    ((status != 124)) || echo "bench.sh: more than $timeout seconds" >&2
    echo "bench.sh: ended with status $status: ${command[*]}" >&2
    return 1
  fi
  [[ $run != warm-up ]] || return 0
  python3 bench/speed.py record --csv "$csv" --case "$case" --positions "$kind" --order "$order" \
    --program "$program" --threads "$thread_count" --run "$run" --scan "$scan" --begin "$begin" --end "$end" \
    --time "$work/time" --printed "$work/printed" --report "$work/out/run.json"
}

failures=()
load_before=$(cut -d ' ' -f 1-3 /proc/loadavg)

# Runs all programs on one case in turns, A A B B A A B B. So a slow minute of the machine affects all. The first run of
# a turn warms up. When a program of many gigabytes ends, a virtual machine gives them back to its host, and the next
# program would wait for every page. What fails on a case is left out of the rest of it.
run_case() {
  local with_peers=$1 run limit program turn
  local -a turns=()
  local -A failed=()
  for limit in "${memory_limit[@]}"; do
    turns+=("lacuna $limit")
    [[ -z $against ]] || turns+=("against $limit")
  done
  [[ -z $kernel ]] || turns+=("kernel default")
  if ((with_peers && peers)); then
    for program in "${peer_programs[@]}"; do turns+=("$program default"); done
  fi
  for ((run = 1; run <= runs; ++run)); do
    for turn in "${turns[@]}"; do
      [[ -z ${failed[$turn]-} ]] || continue
      read -r program limit <<<"$turn"
      echo "bench.sh: $case, $kind positions, $order order, $thread_count threads: $program ($limit), run $run" >&2
      run_once "$program" "$limit" warm-up && run_once "$program" "$limit" "$run" && continue
      failed[$turn]=yes
      failures+=("$program ($limit) on $case, $kind positions, $order order, $thread_count threads")
    done
  done
}

for millions in "${points[@]}"; do
  for order in "${orders[@]}"; do
    for kind in "${positions[@]}"; do
      make_scan "$millions" "$kind" "$order"
      case=waves-${millions}M
      for thread_count in "${threads[@]}"; do
        run_case "$(at_most "$millions" "$peer_points" && echo 1 || echo 0)"
      done
    done
  done
done

if ((real)); then
  order=file
  kind=file
  found=0
  for scan in "$data"/*.ply; do
    [[ -e $scan ]] || continue
    found=1
    case=$(basename "$scan" .ply)
    for thread_count in "${threads[@]}"; do run_case 1; done
  done
  ((found)) || echo "bench.sh: no scans in $data" >&2
fi

# ---- what came of it

{
  echo "$(date +%Y-%m-%d), commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
  lscpu | sed -n 's/^Model name: */processor: /p; s/^CPU(s): */cores: /p'
  awk '/^MemTotal/ { printf "memory: %.1f GiB\n", $2 / 1048576 }' /proc/meminfo
  echo "load before and after: $load_before; $(cut -d ' ' -f 1-3 /proc/loadavg)"
  ((${#detect_options[@]} == 0)) || echo "detect options: ${detect_options[*]}"
  echo
  for failure in "${failures[@]}"; do echo "FAILED: $failure"; done
  [[ ! -e $csv ]] || python3 bench/speed.py table "$csv"
} | tee "$stem.txt"

[[ ! -e $csv ]] || python3 bench/speed.py results "$csv" >"$stem.md"
echo
ls -1 "$stem".*
((${#failures[@]} == 0))
