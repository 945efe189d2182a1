# SPDX-License-Identifier: Apache-2.0
# `cpack -G DEB`: one package for Debian 12 with the program, its documentation and the library. tools/package.sh makes it.
set(CPACK_PACKAGE_NAME lacuna)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Lacuna maintainers <maintainers@lacuna.invalid>" CACHE STRING "Name <address> of the package's maintainer")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "find holes in scanned surfaces, also in scans larger than memory")
set(CPACK_PACKAGE_DESCRIPTION
    "Lacuna reads a registered laser scan, finds the loops around its holes and
its outer boundaries, and writes them with their measures. The scan may be
larger than memory. Formats: PLY, LAS, LAZ, E57, PTX, PCD, OBJ, OFF, STL and
text.
.
The package holds the program, its documentation, and a static library for
C++20 with its CMake package.")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)  # lacuna_VERSION_ARCHITECTURE.deb
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What the static library is linked with.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libeigen3-dev, libtbb-dev, libopenvdb-dev, libspdlog-dev, libtomlplusplus-dev, libhwy-dev")
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_LACUNA_COPYRIGHT ${PROJECT_SOURCE_DIR}/cmake/debian_copyright)
include(CPack)
