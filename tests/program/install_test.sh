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

# With the target lacuna come all built files that are installed, but lacuna-bench.
if [[ -f $build_folder/build.ninja ]]; then
  in_build=$(ninja -C "$build_folder" -t inputs lacuna)
  installed=$(grep --only-matching --perl-regexp "\"\Q$build_folder\E/\K[^\"]*" "$build_folder/cmake_install.cmake")
  for file in $installed; do
    rule=$(ninja -C "$build_folder" -t query "$file" 2>/dev/null | sed --quiet 's/^  input: //p') || true
    [[ $file != python/* && $file != lacuna-bench ]] || continue  # installed where it is built
    # A link to a library is made with it.
    [[ -z $rule || $rule == CXX_EXECUTABLE_LINKER__lacuna_* || $rule == CMAKE_SYMLINK_LIBRARY ]] || grep --quiet --line-regexp --fixed-strings "$file" <<<"$in_build" ||
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

# The Python package is whole, or not there.
[[ $(find "$prefix" -name '_core*.so' | wc -l) == $(find "$prefix" -path '*/lacuna/__init__.py' | wc -l) ]] ||
  fail "the Python package is installed in part"

version=$("$prefix/bin/lacuna" --version)
[[ $version == "lacuna "*.*.* ]] || fail "--version prints: $version"
# The demo takes packages that lie next to the clone, and then what is installed. It builds nothing. Here, apt-get unpacks alone.
mkdir -p "$work/clone" "$work/fake" "$work/root"
cp -r tools CMakeLists.txt "$work/clone"
printf '#!/bin/sh\nexec "$@"\n' >"$work/fake/sudo"
cat >"$work/fake/apt-get" <<END
#!/bin/bash
echo "\$@" >>"$work/apt"
[[ \$1 == update ]] || for file in "\${@: -2}"; do dpkg-deb --extract "\$file" "$work/root"; done
END
chmod +x "$work"/fake/*
for program in lacuna lacuna-bench; do
  mkdir -p "$work/$program/DEBIAN" "$work/$program/usr/bin"
  cp "$prefix/bin/$program" "$work/$program/usr/bin"
  printf '%s\n' "Package: $program" "Version: ${version#lacuna }" "Architecture: $(dpkg --print-architecture)" "Maintainer: none" \
    "Description: none" >"$work/$program/DEBIAN/control"
  dpkg-deb -Znone --build "$work/$program" "$work" >"$work/log"
done
for place in "../lacuna-bench_" PATH; do
  PATH=$work/root/usr/bin:$work/fake:$PATH "$work/clone/tools/demo.sh" >"$work/log" || { cat "$work/log"; fail "the demo fails without a build"; }
  grep --quiet "^This takes .* from $place" "$work/log" || fail "the demo takes nothing from $place"
  [[ -s $work/clone/demo/holes/report.html && ! -e $work/clone/build && $(wc -l <"$work/apt") == 2 ]] || fail "the demo builds, or has no report"
  rm -rf "$work"/*.deb "$work/clone/demo"
done
"$prefix/bin/lacuna-bench" synth surface "$work/plane.ply" --points 5000 --holes 1 >"$work/log"
"$prefix/bin/lacuna" detect "$work/plane.ply" --out "$work/out" --quiet
grep --quiet '"kind": *"hole"' "$work/out/holes.json" || fail "the installed program finds no hole"
"$prefix/bin/lacuna" detect --print-config --config aerial >"$work/log" || fail "the installed config is not found"
for file in share/bash-completion/completions/lacuna share/lacuna/configs/aerial.toml \
  share/doc/lacuna/docs/usage.md share/doc/lacuna/LICENSE share/doc/lacuna/CITATION.cff; do
  [[ -s $prefix/$file ]] || fail "$file is missing"
done
offered() {  # what bash offers for the last of these words
  local COMP_WORDS=("$prefix/bin/lacuna" "$@") COMP_CWORD=$# COMPREPLY=()
  _lacuna
  echo "${COMPREPLY[*]}"
}
source "$prefix/share/bash-completion/completions/lacuna"
[[ $(offered det) == detect && $(offered detect --min-h) == --min-hole && $(offered info --help-) == --help-all ]] ||
  fail "bash completes: $(offered det), $(offered detect --min-h), $(offered info --help-)"
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

# A user's own "engine/config/config.hpp" does not take the place of the library's.
cp -r docs/example "$work/example"
mkdir -p "$work/example/engine/config"
echo '#error "this is not the header of the library"' >"$work/example/engine/config/config.hpp"
cmake -S "$work/example" -B "$work/example/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS=-I"$work/example" >"$work/log" 2>&1 || { cat "$work/log"; fail "the example cannot be configured"; }
! grep --quiet faulty "$work/log" || fail "find_package(lacuna) says that a package is faulty"
cmake --build "$work/example/build" --target find_holes detect_files >"$work/log" 2>&1 || { cat "$work/log"; fail "the example cannot be built"; }
found=$("$work/example/build/find_holes")
expected='^hole at (49|50)\.[0-9] (49|50)\.[0-9] -?0\.0: [0-9]+ points, perimeter [78][0-9]\.[0-9], diameter 2[4-6]\.'
[[ $("$work/example/build/detect_files" "$work/files" "$work/plane.ply") == "2 loops in $work/files" ]] || fail "the second example finds other loops"
[[ -s $work/files/report.html && ! -e $work/files/scratch ]] || fail "the second example writes no report"
cmp "$work/files/loops.ply" "$work/out/loops.ply" || fail "the second example has other loops than the program"
[[ $found =~ $expected && $(wc -l <<<"$found") == 1 ]] || fail "the example prints: $found"

libraries=$(dirname "$(find "$prefix" -name liblacuna.a)")
export PKG_CONFIG_PATH=$libraries/pkgconfig
prints_the_same() {
  [[ $("$@") == "$found" ]] || fail "the example prints something else: $*"
}
read -ra flags < <(pkg-config --cflags lacuna)
g++ -std=c++20 -c docs/example/find_holes.cpp "${flags[@]}" -o "$work/find_holes.o" || fail "pkg-config's flags compile no example"

# The shared library needs none of the packages that it is made of. It exports the public interface alone.
if grep --quiet 'LACUNA_SHARED:BOOL=ON' "$build_folder/CMakeCache.txt"; then
  nm --dynamic --defined-only --demangle "$libraries/liblacuna.so" | cut --delimiter=' ' --fields=3- >"$work/symbols"
  ! grep --invert-match --extended-regexp '^((typeinfo|typeinfo name|vtable) for )?lacuna::' "$work/symbols" ||
    fail "the shared library exports names of others"
  (($(wc -l <"$work/symbols") <= 100)) || fail "the shared library exports $(wc -l <"$work/symbols") names"

  mkdir "$work/user"
  cat >"$work/user/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(lacuna 0.1 REQUIRED COMPONENTS shared)
link_libraries(lacuna::shared)
add_executable(user user.cpp)
END
  cat >"$work/user/user.cpp" <<'END'
#include <lacuna/lacuna.hpp>
#include <lacuna/lacuna_io.hpp>

#include <cstdio>

struct BrokenSource : lacuna::PointSource {
  void rewind() override {}
  bool next(lacuna::PointBatch&) override { throw 7; }
  std::optional<std::uint64_t> expected_points() const override { return {}; }
  bool has_normals() const override { return false; }
};

int main(int, char** arguments) {
  lacuna::io::FilesConfig config;
  try {
    lacuna::io::parameters(config).front().set("nonsense");
  } catch (const lacuna::UsageError&) {
    std::printf("usage, ");
  }
  try {
    const lacuna::io::ScanFiles missing({arguments[0] + std::string(".ply")}, config.input);
  } catch (const lacuna::Error&) {
    std::printf("error, ");
  }
  try {
    BrokenSource broken;
    lacuna::find_holes(broken);
  } catch (int own) {
    std::printf("%d, ", own);
  }
  config.input.crs = "EPSG:25832";  // lacuna_gis.so looks it up
  std::printf("%s\n", lacuna::io::ScanFiles({arguments[1]}, config.input).length_unit().c_str());
}
END
  cmake -S "$work/user" -B "$work/user/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_spdlog=ON >"$work/log" 2>&1 || { cat "$work/log"; fail "the shared library is not found"; }
  cmake --build "$work/user/build" >"$work/log" 2>&1 || { cat "$work/log"; fail "nothing can be linked with the shared library"; }
  said=$("$work/user/build/user" "$work/plane.ply")
  [[ $said == "usage, error, 7, m" ]] || fail "across the shared library's border: $said"
  read -ra flags < <(pkg-config --libs lacuna)
  g++ "$work/find_holes.o" "${flags[@]}" -o "$work/by_flags" || fail "pkg-config's flags link no example"
  prints_the_same env LD_LIBRARY_PATH="$libraries" "$work/by_flags"
  rm "$libraries"/liblacuna.so*
fi
read -ra flags < <(pkg-config --static --libs lacuna)
g++ "$work/find_holes.o" "${flags[@]}" -o "$work/by_flags" || fail "pkg-config's flags for the static library link no example"
prints_the_same "$work/by_flags"
