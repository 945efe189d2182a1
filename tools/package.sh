#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes build-package/lacuna_VERSION_ARCHITECTURE.deb for the Debian that it runs on, and prints its name. Takes further
# arguments for CMake.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install.sh
build=build-package
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DLACUNA_TESTS=OFF \
  -DLACUNA_ZSH_DIR=zsh/vendor-completions "$@" >&2
cmake --build "$build" --parallel "$(nproc)" >&2
rm -f "$build"/lacuna_*.deb
(cd "$build" && cpack -G DEB) >&2
echo "$build"/lacuna_*.deb
