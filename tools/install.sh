#!/usr/bin/env bash
# Installs what the build needs from Debian 12. Quick, and without the network, where all is there already.
set -euo pipefail

packages=(
  g++ cmake ninja-build dpkg-dev
  libopenvdb-dev libtbb-dev libeigen3-dev libnanoflann-dev libspdlog-dev libtomlplusplus-dev
  libcli11-dev nlohmann-json3-dev libhwy-dev libxxhash-dev libpugixml-dev libgdal-dev libpng-dev catch2
  libjs-three  # a report's 3D view: put into the program by the build
  # OpenVDB's headers include Boost's, and its CMake module needs these:
  libboost-iostreams-dev libblosc-dev zlib1g-dev libimath-dev
  python3 python3-jsonschema gdal-bin  # scripts of tests and benchmarks
  python3-selenium chromium chromium-driver  # the test of the report
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install.sh: missing: ${missing[*]}; run as root, or install sudo" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "install.sh: installing ${missing[*]}" >&2
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
