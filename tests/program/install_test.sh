#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs to a new prefix, and builds and runs the example of docs/example against it, as a user of the library would.
# Then moves the prefix: the package must not depend on its place. Links of the installed pages lead to installed files.
# The program is hardened as LACUNA_HARDENING says.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source_folder=$PWD
build_folder=$(dirname "${LACUNA_PROGRAM:?}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "install_test.sh: $*" >&2
  exit 1
}

# tools/demo.sh builds the target lacuna alone. With it come all built files that are installed.
if [[ -f $build_folder/build.ninja ]]; then
  in_build=$(ninja -C "$build_folder" -t inputs lacuna)
  installed=$(grep --only-matching --perl-regexp "\"\Q$build_folder\E/\K[^\"]*" "$build_folder/cmake_install.cmake")
  for file in $installed; do
    rule=$(ninja -C "$build_folder" -t query "$file" 2>/dev/null | sed --quiet 's/^  input: //p') || true
    [[ $file != python/* ]] || continue  # installed where it is built
    [[ -z $rule || $rule == CXX_EXECUTABLE_LINKER__lacuna_* ]] || grep --quiet --line-regexp --fixed-strings "$file" <<<"$in_build" ||
      fail "$file is installed, and the target lacuna does not build it"
  done
fi

cmake --install "$build_folder" --prefix "$work/first" >"$work/log"
mv "$work/first" "$work/moved"
prefix=$work/moved
for place in "$source_folder" "$build_folder" "$work"; do
  if grep --recursive --files-with-matches --fixed-strings "$place" "$prefix"; then
    fail "these files name $place"
  fi
done
# Nothing of the engine but what lacuna.hpp includes, and all of that by names of its own.
if grep --recursive '#include "' "$prefix/include"; then
  fail "these includes depend on the user's folders"
fi

version=$("$prefix/bin/lacuna" --version)
[[ $version == "lacuna "*.*.* ]] || fail "--version prints: $version"
"$prefix/bin/lacuna" synth surface "$work/plane.ply" --points 5000 --holes 1 >"$work/log"
"$prefix/bin/lacuna" detect "$work/plane.ply" --out "$work/out" --quiet
grep --quiet '"kind": *"hole"' "$work/out/holes.json" || fail "the installed program finds no hole"
"$prefix/bin/lacuna" detect --print-config --config aerial >"$work/log" || fail "the installed config is not found"
for file in share/man/man1/lacuna.1.gz share/bash-completion/completions/lacuna share/lacuna/configs/aerial.toml \
  share/doc/lacuna/docs/usage.md share/doc/lacuna/LICENSE share/doc/lacuna/CITATION.cff; do
  [[ -s $prefix/$file ]] || fail "$file is missing"
done
python3 tests/program/check_links.py "$prefix/share/doc/lacuna" || fail "links of the installed documents lead nowhere"

if grep --quiet 'LACUNA_HARDENING:BOOL=ON' "$build_folder/CMakeCache.txt"; then
  readelf --wide --dynamic "$prefix/bin/lacuna" >"$work/log"
  grep --quiet 'Flags:.* NOW PIE' "$work/log" || fail "the program is not at a random address with read-only relocations"
  nm --dynamic "$prefix/bin/lacuna" >"$work/log"
  for symbol in __stack_chk_fail _chk@; do
    grep --quiet "$symbol" "$work/log" || fail "the program is not hardened: no call of $symbol"
  done
fi
g++ -shared -Wl,--whole-archive "$prefix"/lib*/liblacuna.a -Wl,--no-whole-archive -o "$work/module.so" ||
  fail "the library cannot be linked into a shared one, such as a module of Python"

# A user's own "engine/config.hpp" does not take the place of the library's.
cp -r docs/example "$work/example"
mkdir "$work/example/engine"
echo '#error "this is not the header of the library"' >"$work/example/engine/config.hpp"
cmake -S "$work/example" -B "$work/example/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS=-I"$work/example" >"$work/log" 2>&1 || { cat "$work/log"; fail "the example cannot be configured"; }
cmake --build "$work/example/build" >"$work/log" 2>&1 || { cat "$work/log"; fail "the example cannot be built"; }
found=$("$work/example/build/find_holes")
expected='^hole at (49|50)\.[0-9] (49|50)\.[0-9] -?0\.0: [0-9]+ points, perimeter [78][0-9]\.[0-9], diameter 2[4-6]\.'
[[ $("$work/example/build/detect_files" "$work/files" "$work/plane.ply") == "2 loops in $work/files" ]] || fail "the second example finds other loops"
[[ -s $work/files/report.html && ! -e $work/files/scratch ]] || fail "the second example writes no report"
cmp "$work/files/loops.ply" "$work/out/loops.ply" || fail "the second example has other loops than the program"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name lacuna.pc)") pkg-config --cflags --libs lacuna >"$work/flags"
g++ -std=c++20 docs/example/find_holes.cpp $(<"$work/flags") -o "$work/by_flags" || fail "pkg-config's flags build no example"
[[ $("$work/by_flags") == "$found" ]] || fail "the example built by pkg-config prints something else"
[[ $found =~ $expected && $(wc -l <<<"$found") == 1 ]] || fail "the example prints: $found"
