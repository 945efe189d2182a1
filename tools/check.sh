#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs, builds and runs the tests. The last line counts them. Fails if a test fails, or if none ran.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'TEXT'
usage: tools/check.sh [--all]
  without      the fast tests: a quarter of an hour on two cores
  --all        before a release, and at the end of a large change: the slow tests, too; all tests of the libraries
               built to find memory errors, and built to find data races; instructions of a run; the program
               without headers that hide what is not included, linked to find classes defined twice: hours
TEXT
}

case "$*" in
  "") all=0 ;;
  --all) all=1 ;;
  *)
    usage >&2
    exit 2
    ;;
esac
passed=0 failed=0 skipped=0

build() {  # FOLDER TARGET OPTION...
  local folder=$1 target=$2
  cmake -G Ninja -S . -B "$folder" -DCMAKE_BUILD_TYPE=Release -DLACUNA_TESTS=ON "${@:3}"
  cmake --build "$folder" --parallel "$(nproc)" --target "$target"
}

# Runs tests of a folder, with further options for ctest, and counts them.
run_tests() {  # FOLDER OPTION...
  local folder=$1 report=$PWD/$1/tests.xml status=0 failures
  rm -f "$report" "$folder/Testing/Temporary/LastTestsFailed.log"
  ctest --test-dir "$@" --parallel "$(nproc)" --no-tests=error --output-on-failure --output-junit "$report" || status=$?
  count() { grep --max-count=1 --only-matching --perl-regexp "^\s*$1=\"\K[0-9]+" "$report"; }
  failures=$(count failures)
  if ((status != 0 && failures == 0)); then
    failures=1  # a test that could not even start
  fi
  failed=$((failed + failures))
  skipped=$((skipped + $(count skipped)))
  passed=$((passed + $(count tests) - failures - $(count skipped) - $(count disabled)))
  [[ ! -s $folder/Testing/Temporary/LastTestsFailed.log ]] ||
    sed "s|^|failed in $folder: |" "$folder/Testing/Temporary/LastTestsFailed.log"
}

# The compiler sees one source at a time. Only the linker sees two classes of one name.
check_odr() {
  cmake -G Ninja -S . -B build-odr -DCMAKE_BUILD_TYPE=Release -DLACUNA_TESTS=OFF -DLACUNA_UNITY=OFF -DLACUNA_SHARED=OFF \
    -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON "-DCMAKE_CXX_FLAGS=-Werror=odr -Werror=lto-type-mismatch"
  cmake --build build-odr --parallel "$(nproc)" --target lacuna lacuna-bench
}

# ThreadSanitizer knows the order of tasks only where oneTBB was built for it. Debian's was not.
build_tbb() {
  local folder=$PWD/build-threads/tbb
  [[ ! -e $folder/lib/libtbb.so ]] || return 0
  mkdir -p "$folder/lists/partial"
  # Sources from where the machine has its packages.
  apt-get indextargets --format "deb-src \$(REPO_URI) \$(RELEASE) \$(COMPONENT)" "Created-By: Packages" |
    sort -u >"$folder/sources.list"
  local apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$folder/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$folder" && "${apt[@]}" source --download-only onetbb && tar --strip-components=1 -xf onetbb_*.orig.tar.*)
  cmake -G Ninja -S "$folder" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DTBBMALLOC_BUILD=OFF -DCMAKE_CXX_FLAGS=-fsanitize=thread -DCMAKE_INSTALL_PREFIX="$folder" -DCMAKE_INSTALL_LIBDIR=lib
  cmake --build "$folder/build"
  cmake --install "$folder/build"
}

# ---- as released

tools/install.sh "$( ((all)) && echo --all || echo --tests)"
build build all -DLACUNA_WERROR="${LACUNA_WERROR:-OFF}"
run_tests build --label-regex "$( ((all)) && echo '^(fast|slow)$' || echo '^fast$')"

# ---- with sanitizers, and all else

if ((all)); then
  measures='memory_test'  # of memory and threads, of which the sanitizers take their own
  export ASAN_OPTIONS=quarantine_size_mb=16  # freed memory that is not used again; 256 took a third more time
  export LSAN_OPTIONS=suppressions=$PWD/tests/support/leaks_of_others.txt:print_suppressions=0
  build build-sanitize lacuna_tests -DLACUNA_SANITIZE=address -DLACUNA_PYTHON=OFF
  LACUNA_DRAWN_SHARE=0.1 run_tests build-sanitize --exclude-regex "$measures"
  tools/instructions.sh || failed=$((failed + 1))
  check_odr
  build_tbb
  export LD_LIBRARY_PATH=$PWD/build-threads/tbb/lib
  export TSAN_OPTIONS=suppressions=$PWD/tests/support/races_of_others.txt:exitcode=66
  build build-threads lacuna_tests -DLACUNA_SANITIZE=thread -DLACUNA_PYTHON=OFF
  LACUNA_DRAWN_SHARE=0.05 run_tests build-threads --exclude-regex "$measures"
fi

echo "$passed passed, $failed failed, $skipped skipped"
((failed == 0 && passed > 0))
