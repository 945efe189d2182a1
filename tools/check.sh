#!/usr/bin/env bash
# Installs, builds and runs the tests; with --all the slow ones too. The last line counts them. Fails if a
# test fails, if the tests end early, or if none ran.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

selections=("")  # Catch2's own choice: all but the hidden ones
case "$*" in
  "") ;;
  --all) selections+=("[slow]") ;;
  *)
    echo "usage: tools/check.sh [--all]" >&2
    exit 2
    ;;
esac

tools/build.sh -DLACUNA_TESTS=ON

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
report=$scratch/report
: >"$report"
broken=0  # runs that ended in a way that the report does not explain
for selection in "${selections[@]}"; do
  before=$(grep -c '^fail ' "$report" || true)
  status=0
  LACUNA_TEST_REPORT=$report build/tests/lacuna_tests ${selection:+"$selection"} || status=$?
  after=$(grep -c '^fail ' "$report" || true)
  if ((status != 0 && before == after)); then
    echo "check.sh: the tests ended with status $status" >&2
    broken=$((broken + 1))
  fi
done

for script in tests/program/*.sh; do
  [[ -e $script ]] || continue
  echo "begin $script" >>"$report"
  if LACUNA_PROGRAM=$PWD/build/lacuna bash "$script"; then
    echo "pass $script" >>"$report"
  else
    echo "fail $script" >>"$report"
  fi
done

begun=$(grep -c '^begin ' "$report" || true)
passed=$(grep -c '^pass ' "$report" || true)
failed=$((begun - passed))  # those that never came to an end too
if ((failed == 0)); then
  failed=$broken
fi
grep '^fail ' "$report" >&2 || true
echo "$passed passed, $failed failed"
((failed == 0 && passed > 0))
