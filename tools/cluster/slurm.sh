#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Submits a run of Lacuna to Slurm: a chain of job arrays, one for each step. docs/cluster.md describes it. This file
# needs no other one, so a copy of it works anywhere.
set -euo pipefail

usage() {
  cat <<'END'
usage: slurm.sh SCAN... --workspace DIR --tasks N --out DIR [OPTIONS] [PARAMETERS] [-- SBATCH_OPTIONS]

Plans a run, and submits its steps to Slurm. Each step is a job array that starts when the step before it is done. The
last job writes the results. The same command goes on after a failure: tasks that are done end at once.

  --workspace DIR      the workspace, in a folder that all nodes share; DIR/logs has a log of each task
  --tasks N            tasks of an array
  --out DIR            folder for the results
  --threads N          threads of a task, and its cpus                     default 2
  --tries N            starts of a task at most, if it fails               default 3
  --dry-run            plan, and print the commands instead of running them
  -h, --help
PARAMETERS are those of lacuna detect, such as --min-hole 0.5 or --memory-limit 4GiB, for which tasks are planned.
SBATCH_OPTIONS go to each sbatch, and override those of this script: -- --partition=long --account=survey
A task has the planned memory as its limit. Its job may take a quarter and 256 MiB more. It may take twice the planned
time and ten minutes more.
The program is $LACUNA, or lacuna in PATH. Each node has it at the same place.
END
}

fail() {
  echo "slurm.sh: $1" >&2
  exit "${2:-1}"
}

# The job itself: one task. If it fails, or if its time is nearly over, it goes back to the queue, so that another node
# may take it. After a failure of the node, or a preemption, Slurm does so on its own.
run_task() {
  local tries=$1 start=$((${SLURM_RESTART_COUNT:-0} + 1)) job=$SLURM_JOB_ID status=0 is_cancelled=0 child attempt
  local command=("${@:2}")
  if [[ -n ${SLURM_ARRAY_TASK_ID:-} ]]; then
    command+=(--task "$SLURM_ARRAY_TASK_ID")
    job=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID  # SLURM_JOB_ID of one of the tasks is that of the whole array
  fi
  report() { echo "$(date '+%F %T') $(hostname): $1"; }

  report "job $job, start $start: ${command[*]@Q}"
  "${command[@]}" &
  child=$!
  trap 'kill -TERM "$child" 2>/dev/null' USR1  # the time is nearly over
  trap 'is_cancelled=1; kill -TERM "$child" 2>/dev/null' TERM
  while :; do
    wait "$child" && status=0 || status=$?
    kill -0 "$child" 2>/dev/null || break  # else a signal has ended `wait`, but not the child
  done
  report "exit code $status"
  ((status != 0 && status != 2 && start < tries && !is_cancelled)) || exit "$status"
  for attempt in {1..30}; do  # the controller may be down for minutes
    ! scontrol requeue "$job" || exit "$status"
    report "attempt $attempt: the task is not back in the queue"
    sleep 10
  done
  exit "$status"
}

if [[ ${1:-} == --run-task ]]; then
  run_task "${@:2}"
fi

workspace='' tasks='' out='' threads=2 tries=3 dry_run=0
planned=()
sbatch_options=()
while (($# > 0)); do
  if [[ $1 =~ ^(--(workspace|tasks|out|threads|tries))=(.*)$ ]]; then
    set -- "${BASH_REMATCH[1]}" "${BASH_REMATCH[3]}" "${@:2}"
  fi
  case $1 in
    -h | --help)
      usage
      exit 0
      ;;
    --)
      sbatch_options=("${@:2}")
      break
      ;;
    --dry-run) dry_run=1 ;;
    --workspace | --tasks | --out | --threads | --tries)
      (($# > 1)) || fail "$1 needs a value" 2
      name=${1:2}
      printf -v "${name//-/_}" %s "$2"
      shift
      ;;
    *) planned+=("$1") ;;
  esac
  shift
done
for name in workspace tasks out; do
  [[ -n ${!name} ]] || fail "--$name is missing; --help has the usage" 2
done
for name in tasks threads tries; do
  [[ ${!name} =~ ^[1-9][0-9]*$ ]] || fail "--$name ${!name}: allowed is a whole number from 1" 2
done
((${#planned[@]} > 0)) || fail "a scan is missing; --help has the usage" 2
((dry_run)) || command -v sbatch >/dev/null || fail "sbatch is not in PATH: this machine submits no jobs to Slurm"

# A job starts in the folder of this command, unless SBATCH_OPTIONS name another one.
absolute() { [[ $1 == /* ]] && printf %s "$1" || printf %s "$PWD/$1"; }
lacuna=$(command -v "${LACUNA:-lacuna}") || fail "${LACUNA:-lacuna}: no such program; \$LACUNA names another one"
lacuna=$(absolute "$lacuna")
workspace=$(absolute "$workspace")
out=$(absolute "$out")
script=$(absolute "${BASH_SOURCE[0]}")
# In a pattern of sbatch, % begins a replacement, and a backslash anywhere turns all of them off.
[[ $workspace != *\\* ]] || fail "$workspace: the name of the workspace has a backslash, which Slurm does not allow for logs" 2
logs=${workspace//%/%%}/logs

plan=$("$lacuna" plan "${planned[@]}" --workspace "$workspace" --tasks "$tasks" --threads "$threads" --tsv)

jobs=()
cancel_jobs() {
  ((${#jobs[@]} == 0)) || scancel "${jobs[@]}"
  fail "not all steps could be submitted; those that were are cancelled"
}

# Prints the number of the job, and a line of the table. A dry run prints the command, which leaves the number in `job`.
exec 3>&1
submit() {
  local command job
  if ((dry_run)); then
    printf -v command ' %q' "$@"
    echo "job=\$(sbatch${command/afterok:JOB/afterok:\$job})" >&3
    echo JOB
  else
    job=$(sbatch "$@") || return
    printf '%-12s %6s %9s %9s  %s\n' "$step" "$count" "$memory" "$minutes" "${job%%;*}" >&3
    echo "${job%%;*}"
  fi
}

if ((dry_run)); then
  printf 'mkdir -p %q\n' "$workspace/logs"
else
  mkdir -p "$workspace/logs"
  printf '%-12s %6s %9s %9s  %s\n' step tasks MiB minutes job
fi
while IFS=$'\t' read -r step count memory minutes; do
  [[ $count$memory$minutes =~ ^[0-9]+$ ]] || fail "lacuna plan --tsv has a line that is no step: $step $count $memory $minutes"
  limit=$memory  # which the task keeps to
  memory=$((limit + limit / 4 + 256))
  minutes=$((2 * minutes + 10))
  if [[ $step == finish ]]; then
    options=(--output="$logs/finish.log")
    command=(finish "$workspace" --out "$out")
  else
    options=(--array="0-$((count - 1))" --output="$logs/$step-%a.log")
    command=(work "$workspace" --step "$step")
  fi
  ((${#jobs[@]} == 0)) || options+=(--dependency="afterok:${jobs[-1]}" --kill-on-invalid-dep=yes)
  job=$(submit --parsable --job-name="lacuna-$step" "${options[@]}" --nodes=1 --ntasks=1 --cpus-per-task="$threads" \
    --mem="$memory" --time="$minutes" --signal=B:USR1@60 --requeue --open-mode=append "${sbatch_options[@]}" \
    "$script" --run-task "$tries" "$lacuna" "${command[@]}" --threads "$threads" --memory-limit "${limit}MiB") ||
    cancel_jobs
  jobs+=("$job")
done <<<"$plan"
((!dry_run)) || exit 0

cat <<END

results   $out
logs      $workspace/logs
state     squeue --jobs=$(IFS=,; echo "${jobs[*]}")
cancel    scancel ${jobs[*]}
The same command goes on after a failure.
END
