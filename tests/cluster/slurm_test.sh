#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/cluster/slurm.sh on a real Slurm, whose controller and only node are this machine. Whatever happens to tasks, the
# results have the bytes of those of one `lacuna detect`. Skipped where Slurm or MUNGE is not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export LACUNA=${LACUNA_PROGRAM:-$PWD/build/lacuna}
slurm=$PWD/tools/cluster/slurm.sh
most_seconds=3600  # of one chain

export PATH=$PATH:/usr/sbin:/sbin
for command in slurmctld slurmd sbatch munged; do
  if ! command -v "$command" >/dev/null; then
    echo "skipped: $command is not installed (packages slurm-wlm and munge)"
    exit 77
  fi
done

work=$(mktemp -d)
chmod 700 "$work"
ends=()  # files with the numbers of processes that this script has to end, the last one first
end_by_file() {
  local pid
  pid=$(cat "$1" 2>/dev/null) || return 0
  kill "$pid" 2>/dev/null || return 0
  while kill -0 "$pid" 2>/dev/null; do sleep 0.1; done
}
cancel_all() {
  local i
  scancel --full --user="$(id -un)" 2>/dev/null || true
  for i in {1..100}; do
    [[ -n $(squeue --noheader 2>/dev/null) ]] || break
    sleep 0.2
  done
}
clean_up() {
  cancel_all
  for ((i = ${#ends[@]} - 1; i >= 0; --i)); do end_by_file "${ends[i]}"; done
  rm -rf "$work"
}
trap clean_up EXIT

fail() {
  echo "slurm_test.sh: $*" >&2
  squeue >&2 || true
  [[ -z ${chain:-} ]] || tail -n 4 "$chain"/work*/logs/*.log >&2 || true
  exit 1
}

start_controller() { nice -n 10 slurmctld -f "$SLURM_CONF"; }

start_slurm() {
  local folder=$work/slurm host ports
  host=$(hostname -s)
  mkdir -p "$folder/state" "$folder/spool"
  head -c 128 /dev/urandom >"$folder/munge.key"
  chmod 400 "$folder/munge.key"
  ports=$(python3 -c 'import socket
sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(s.getsockname()[1] for s in sockets))')
  export SLURM_CONF=$folder/slurm.conf
  # A task that goes back to the queue pauses for the lifetime of credentials: 5 seconds at least, else two minutes. Two
  # tasks at a time run even on one core.
  cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports% *}
SlurmdPort=${ports#* }
AuthType=auth/munge
AuthInfo=socket=$folder/munge.sock,cred_expire=5
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,batch_sched_delay=1
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000000 State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
  ends+=("$folder/munged.pid" "$folder/slurmctld.pid" "$folder/slurmd.pid")
  munged --force --key-file="$folder/munge.key" --socket="$folder/munge.sock" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/seed"
  start_controller
  nice -n 10 slurmd -f "$SLURM_CONF"
  for _ in {1..100}; do
    [[ $(sinfo --noheader --format=%t 2>/dev/null) != idle ]] || return 0
    sleep 0.2
  done
  cat "$folder"/*.log >&2
  fail "the node is not idle"
}

# Each run has a folder of its own, with a space and a % in its name.
new_chain() {
  chain_name=$1
  chain="$work/$1 %j"
  mkdir "$chain"
}
parameters=(--tile-points 10000 --points)
submit() {
  local tasks=$1
  "$slurm" "$scan" --workspace "$chain/work" --tasks "$tasks" --out "$chain/out" --threads 1 "${parameters[@]}" "${@:2}" \
    >>"$chain/submitted" || fail "$tasks tasks: not submitted"
}
await_end() {
  local until=$((SECONDS + most_seconds))
  while [[ -n $(squeue --noheader 2>&1) ]]; do  # an error, too, while the controller is down
    ((SECONDS < until)) || fail "$chain_name: not at its end after $most_seconds seconds"
    sleep 0.5
  done
}
is_as_expected() {
  [[ -d $chain/out ]] || fail "$chain_name: no results"
  diff --recursive --brief --exclude=run.json "$work/expected" "$chain/out" >&2 ||
    fail "$chain_name: other results than those of lacuna detect"
  echo "$chain_name: same bytes, $(starts) starts of tasks${1:+, $1} ($((SECONDS - began)) s)"
  rm -rf "$chain"
  began=$SECONDS
}
starts() { cat "$chain"/work/logs/*.log | grep --count ': job [0-9_]*, start '; }
# The numbers of the processes of tasks, one a line.
running() { pgrep --full "^$LACUNA (work|finish) $chain/work( |\$)" || true; }
# Stops a task by a signal, as soon as one runs, and sets `pid` to its number.
stop_task() {
  local until=$((SECONDS + most_seconds))
  until pid=$(running | head -n 1) && [[ -n $pid ]] && kill -STOP "$pid" 2>/dev/null; do
    ((SECONDS < until)) || fail "no task runs"
    sleep 0.02
  done
}
# Kills tasks at random moments, `most` of them at most, until the chain ends.
kill_some() {
  local most=$1 pid pause
  killed=0
  while ((killed < most)) && [[ -n $(squeue --noheader 2>&1) ]]; do
    pid=$(running | shuf --head-count=1)
    pause=$((RANDOM % 1000))
    sleep "0.$(printf %03d "$pause")"
    [[ -z $pid ]] || ! kill -KILL "$pid" 2>/dev/null || ((killed += 1))
  done
}

scan=$work/scan.ply
"${LACUNA_BENCH_PROGRAM:-$PWD/build/lacuna-bench}" synth surface "$scan" --points 1000000 --holes 40 --positions random --density-factor 30 >/dev/null
nice -n 10 "$LACUNA" detect "$scan" --out "$work/expected" --quiet --threads 2 "${parameters[@]}"
start_slurm
began=$SECONDS

for tasks in 1 2 7 32; do
  new_chain "$tasks tasks"
  submit "$tasks"
  await_end
  is_as_expected
done

new_chain "killed at random"
submit 7 --tries 50
kill_some 10
await_end
((killed > 0)) || fail "no task was killed"
is_as_expected "$killed killed"

new_chain "cancelled, and submitted again"
submit 7
while [[ -z $(squeue --noheader --states=RUNNING --name=lacuna-evaluate-0) ]]; do sleep 0.05; done
scancel --signal=KILL "$(squeue --noheader --states=RUNNING --name=lacuna-evaluate-0 --format=%A | head -n 1)"
await_end
[[ ! -e $chain/out ]] || fail "a chain went on after one of its tasks was cancelled"
submit 7
await_end
is_as_expected

# One task at a time of each chain, so the two run each step at once. The commands of a dry run submit the second one.
new_chain "each task twice at once"
submit 1
submit 1 --dry-run
grep sbatch "$chain/submitted" | bash
await_end
twice=$(awk 'FNR == 1 {running = 0} /: job [0-9_]+, start / && ++running == 2 {++twice} /: exit code / {--running}
             END {print twice + 0}' "$chain"/work/logs/*.log)
((twice > 0)) || fail "no task ran twice at once"
is_as_expected "$twice tasks ran twice at once"

# Slurm itself puts the task back in the queue.
new_chain "a node that is down for a while"
submit 7
stop_task
scontrol update NodeName="$(hostname -s)" State=DOWN Reason=test
sleep 2
scontrol update NodeName="$(hostname -s)" State=RESUME 2>/dev/null || true  # unless it is back already
await_end
grep --quiet 'start 2: ' "$chain"/work/logs/*.log || fail "the task did not start again"
is_as_expected

# A task is killed meanwhile. It is stopped first, so that it does not end before.
new_chain "without a controller for a while"
submit 7 --tries 5
stop_task
end_by_file "$work/slurm/slurmctld.pid"
kill -KILL "$pid"
sleep 15
start_controller
await_end
grep --quiet 'start 2: ' "$chain"/work/logs/*.log || fail "the killed task did not start again"
is_as_expected
