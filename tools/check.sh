#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs, builds and runs the tests. The last line counts them. Fails if a test fails, or if none ran.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/packages.sh

usage() {
  cat <<'TEXT'
usage: tools/check.sh [--all | --sanitize | --threads | --odr]
  --all        the slow tests too, and the check of --odr: more than an hour
  --sanitize   the fast tests but those that measure, built in build-sanitize to check memory accesses and undefined
               behaviour
  --threads    the fast tests but a few, built in build-threads to find data races, with oneTBB from Debian's source
               built in the same way: about an hour
  --odr        no test: builds the program without precompiled headers, which hide what is not included. Links it
               with link time optimisation, in build-odr, and fails where a name is defined twice in different ways
TEXT
}

# The compiler sees one source at a time. Only the linker sees two classes of one name.
check_odr() {
  cmake -G Ninja -S . -B build-odr -DCMAKE_BUILD_TYPE=Release -DLACUNA_TESTS=OFF -DLACUNA_PRECOMPILE=OFF -DLACUNA_SHARED=OFF \
    -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON "-DCMAKE_CXX_FLAGS=-Werror=odr -Werror=lto-type-mismatch"
  cmake --build build-odr --parallel "$(nproc)" --target lacuna lacuna-bench
}

# ThreadSanitizer knows the order of tasks only where oneTBB was built for it. Debian's was not.
build_tbb() {
  local folder=$PWD/build-threads/tbb
  [[ ! -e $folder/lib/libtbb.so ]] || return 0
  mkdir -p "$folder/lists/partial"
  echo "deb-src http://deb.debian.org/debian bookworm main" >"$folder/sources.list"
  local apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$folder/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$folder" && "${apt[@]}" source --download-only onetbb && tar --strip-components=1 -xf onetbb_*.orig.tar.*)
  cmake -G Ninja -S "$folder" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DTBBMALLOC_BUILD=OFF -DCMAKE_CXX_FLAGS=-fsanitize=thread -DCMAKE_INSTALL_PREFIX="$folder" -DCMAKE_INSTALL_LIBDIR=lib
  cmake --build "$folder/build"
  cmake --install "$folder/build"
}

build=build
options=(-DCMAKE_BUILD_TYPE=Release -DLACUNA_WERROR=ON)
labels='^fast$'
excluded='^$'
case "$*" in
  "") ;;
  --odr) ;;
  --all) labels='^(fast|slow)$' ;;
  --sanitize)
    build=build-sanitize
    options=(-DCMAKE_BUILD_TYPE=Release -DLACUNA_SANITIZE=address -DLACUNA_PYTHON=OFF)  # warnings are no errors: GCC's can be wrong here
    # These measure memory and threads, of which the sanitizers take their own, disk, or what is found.
    excluded='within the memory limit|stay within|threads that cannot be started|the disk that info names|accuracy'
    excluded+='|are those of its scene|what was promised|taken for those of one'
    export ASAN_OPTIONS=quarantine_size_mb=16  # freed memory that is not used again; 256 took a third more time
    export LSAN_OPTIONS=suppressions=$PWD/tests/support/leaks_of_others.txt:print_suppressions=0
    export LACUNA_DRAWN_SHARE=${LACUNA_DRAWN_SHARE:-0.1}       # of the cases that the longest tests draw
    ;;
  --threads)
    build=build-threads
    options=(-DCMAKE_BUILD_TYPE=Release -DLACUNA_SANITIZE=thread -DLACUNA_PYTHON=OFF)
    # What starts scripts or browsers takes too long, and tests no more threads.
    excluded='within the memory limit|stay within|threads that cannot be started|accuracy|schema|GDAL|browser'
    excluded+='|documentation|installed library'
    export LD_LIBRARY_PATH=$PWD/build-threads/tbb/lib
    export TSAN_OPTIONS=suppressions=$PWD/tests/support/races_of_others.txt:exitcode=66
    export LACUNA_DRAWN_SHARE=${LACUNA_DRAWN_SHARE:-0.05}
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac

tools/install.sh
install_packages python3-pandas python3-matplotlib  # whose tests would be skipped
[[ $* != --odr && $* != --all ]] || check_odr
[[ $* != --odr ]] || exit 0
[[ $* != --threads ]] || build_tbb
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
