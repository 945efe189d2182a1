#!/usr/bin/env bash
# Installs, builds and runs the tests. The last line counts them. Fails if a test fails, or if none ran.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'TEXT'
usage: tools/check.sh [--all | --sanitize | --threads | --odr]
  --all        the slow tests too, and the check of --odr: more than an hour
  --sanitize   the fast tests, built in build-sanitize to check memory accesses and undefined behaviour
  --threads    the fast tests that run in the test program itself, built in build-threads to find data races. Needs
               oneTBB built in the same way: fetched as source from Debian, and built there
  --odr        no test: links the program with link time optimisation, in build-odr, and fails where a name is
               defined twice in different ways
TEXT
}

# The compiler sees one source at a time. Only the linker sees two classes of one name.
check_odr() {
  cmake -G Ninja -S . -B build-odr -DCMAKE_BUILD_TYPE=Release -DLACUNA_TESTS=OFF -DLACUNA_PRECOMPILE=OFF \
    -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON "-DCMAKE_CXX_FLAGS=-Werror=odr -Werror=lto-type-mismatch"
  cmake --build build-odr --parallel "$(nproc)" --target lacuna
}

build=build
options=(-DCMAKE_BUILD_TYPE=Release -DLACUNA_WERROR=ON -DLACUNA_PRECOMPILE=OFF)
labels='^fast$'
excluded='^$'
case "$*" in
  "") ;;
  --odr) ;;
  --all) labels='^(fast|slow)$' ;;
  --sanitize)
    build=build-sanitize
    options=(-DCMAKE_BUILD_TYPE=Release -DLACUNA_SANITIZE=address)  # warnings are no errors: GCC's can be wrong here
    # These measure memory and threads, of which the sanitizers take their own.
    excluded='within the memory limit|stay within|threads that cannot be started'
    export LSAN_OPTIONS=suppressions=$PWD/tests/support/leaks_of_others.txt:print_suppressions=0
    export LACUNA_DRAWN_SHARE=${LACUNA_DRAWN_SHARE:-0.1}       # of the cases that the longest tests draw
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac

tools/install.sh
[[ $* != --odr && $* != --all ]] || check_odr
[[ $* != --odr ]] || exit 0
cmake -G Ninja -S . -B "$build" -DLACUNA_TESTS=ON "${options[@]}"
cmake --build "$build" --parallel "$(nproc)"

report=$PWD/$build/tests.xml
rm -f "$report"
status=0
ctest --test-dir "$build" --label-regex "$labels" --exclude-regex "$excluded" --parallel "$(nproc)" --no-tests=error --output-on-failure \
  --output-junit "$report" || status=$?

count() { grep --max-count=1 --only-matching --perl-regexp "^\s*$1=\"\K[0-9]+" "$report"; }
failed=$(count failures)
skipped=$(count skipped)
passed=$(($(count tests) - failed - skipped - $(count disabled)))
if ((status != 0 && failed == 0)); then
  failed=1  # a test that could not even start
fi
echo "$passed passed, $failed failed, $skipped skipped"
((status == 0 && passed > 0))
