# SPDX-License-Identifier: Apache-2.0
# `cpack -G DEB`: packages for Debian 12. tools/package.sh makes them.
set(CPACK_PACKAGE_NAME lacuna)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Lacuna maintainers <maintainers@lacuna.invalid>" CACHE STRING "Name <address> of the package's maintainer")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_LACUNA_COPYRIGHT ${PROJECT_SOURCE_DIR}/cmake/debian_copyright)
set(CPACK_COMPONENTS_ALL "")

# A package with the files of a component of cmake/install.cmake.
macro(lacuna_debian_package component name summary description)
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_FILE_NAME DEB-DEFAULT)  # NAME_VERSION_ARCHITECTURE.deb
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${description}")
endmacro()

lacuna_debian_package(program lacuna "find holes in scanned surfaces, also in scans larger than memory"
"Lacuna reads a registered laser scan, finds the loops around its holes and
its outer boundaries, and writes them with their measures. The scan may be
larger than memory. Formats: PLY, LAS, LAZ, E57, PTX, PCD, OBJ and text.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS lacuna-gis)
if(LACUNA_BENCH_PROGRAM)
  lacuna_debian_package(bench lacuna-bench "benchmark for programs that find holes in scanned surfaces"
"Makes synthetic scans whose holes are known, and evaluates the loops that a
program has found: those of lacuna, or of any other program.")
endif()
lacuna_debian_package(gis lacuna-gis "files for GIS from lacuna, by GDAL"
"With this package, lacuna writes GeoPackage and GeoJSON, and knows coordinate
reference systems by their codes.")
lacuna_debian_package(library liblacuna-dev "find holes in scanned surfaces: development files"
"The library for C++20, shared and static, with its headers, its CMake package
and its pkg-config file. The static one needs the recommended packages.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS libeigen3-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS
    "libtbb-dev, libopenvdb-dev, libspdlog-dev, libtomlplusplus-dev, libhwy-dev, nlohmann-json3-dev, libpugixml-dev, libpng-dev")
if(LACUNA_SHARED)
  lacuna_debian_package(shared liblacuna${LACUNA_SOVERSION} "find holes in scanned surfaces: shared library"
"Programs that use Lacuna as a library need it.")
  set(CPACK_DEBIAN_SHARED_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_SHARED_PACKAGE_RECOMMENDS lacuna-gis)
  # CPack writes no trigger, and its own shlibs for all packages, with warnings for modules.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/shlibs CONTENT "liblacuna ${LACUNA_SOVERSION} liblacuna${LACUNA_SOVERSION} (>= ${PROJECT_VERSION})\n")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/triggers CONTENT "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_SHARED_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/debian/shlibs;${PROJECT_BINARY_DIR}/debian/triggers")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "liblacuna${LACUNA_SOVERSION} (= ${PROJECT_VERSION}), libeigen3-dev")
endif()
if(LACUNA_PYTHON)
  lacuna_debian_package(python python3-lacuna "find holes in scanned surfaces: Python package"
"Arrays of numpy or scan files in, loops around holes out.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS lacuna-gis)
endif()
include(CPack)
