#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what the build needs from Debian 12; with --tests, what the fast tests need, too; with --all, what all do.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/packages.sh"

packages=(
  g++ cmake ninja-build dpkg-dev pkg-config
  libopenvdb-dev libtbb-dev libeigen3-dev libnanoflann-dev libspdlog-dev libtomlplusplus-dev
  libcli11-dev nlohmann-json3-dev libhwy-dev libxxhash-dev libpugixml-dev libgdal-dev libpng-dev catch2
  libjs-three  # a report's 3D view: put into the program by the build
  # OpenVDB's headers include Boost's, and its CMake module needs these:
  libboost-iostreams-dev libblosc-dev zlib1g-dev libimath-dev
  python3-dev python3-numpy pybind11-dev  # the Python package
)
[[ ${1-} != --tests && ${1-} != --all ]] || packages+=(
  python3 python3-jsonschema gdal-bin  # scripts of tests and benchmarks
  python3-pandas python3-matplotlib  # tests of the Python package
)
[[ ${1-} != --all ]] || packages+=(python3-selenium chromium chromium-driver)  # tests of the report

install_packages "${packages[@]}"
