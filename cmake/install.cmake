# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` writes: the program with its completion for bash, the library, configs and documentation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(cmake/public_headers.cmake)

install(TARGETS lacuna COMPONENT program)
if(LACUNA_BENCH_PROGRAM)
  install(TARGETS lacuna-bench COMPONENT bench OPTIONAL)
endif()
install(TARGETS lacuna_gis LIBRARY DESTINATION lib/lacuna COMPONENT gis)  # where the program looks for it

# The libraries: lacuna::lacuna, lacuna::io with the files, and lacuna::shared with both.
set(public_headers ${PROJECT_BINARY_DIR}/include)
file(REMOVE_RECURSE ${public_headers})  # headers that are public no more
lacuna_copy_public_headers(engine/lacuna.hpp ${public_headers})
lacuna_copy_public_headers(io/lacuna_io.hpp ${public_headers})
install(DIRECTORY ${public_headers}/lacuna DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
target_include_directories(lacuna_engine INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(lacuna_engine PROPERTIES OUTPUT_NAME lacuna EXPORT_NAME lacuna)
set_target_properties(lacuna_io PROPERTIES EXPORT_NAME io)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lacuna)
install(TARGETS lacuna_engine lacuna_io EXPORT lacuna-targets COMPONENT library)
install(EXPORT lacuna-targets NAMESPACE lacuna:: DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(cmake/lacuna-config.cmake.in ${PROJECT_BINARY_DIR}/lacuna-config.cmake
                              INSTALL_DESTINATION ${package_folder})
# Before 1.0 each minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lacuna-config-version.cmake COMPATIBILITY SameMinorVersion)
file(CONFIGURE OUTPUT ${public_headers}/lacuna/version.hpp @ONLY CONTENT
"// SPDX-License-Identifier: Apache-2.0
// The version of the library that these headers belong to.
#pragma once

#define LACUNA_VERSION_MAJOR @PROJECT_VERSION_MAJOR@
#define LACUNA_VERSION_MINOR @PROJECT_VERSION_MINOR@
#define LACUNA_VERSION_PATCH @PROJECT_VERSION_PATCH@
#define LACUNA_VERSION_STRING \"@PROJECT_VERSION@\"
")
file(RELATIVE_PATH LACUNA_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/lacuna.pc.in ${PROJECT_BINARY_DIR}/lacuna.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lacuna.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
if(LACUNA_SHARED)
  # Apart from the static ones, so that its users need none of the libraries that those are linked with.
  install(TARGETS lacuna_shared EXPORT lacuna-shared-targets LIBRARY COMPONENT shared NAMELINK_COMPONENT library)
  install(EXPORT lacuna-shared-targets NAMESPACE lacuna:: DESTINATION ${package_folder} COMPONENT library)
  target_include_directories(lacuna_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endif()
install(FILES ${PROJECT_BINARY_DIR}/lacuna-config.cmake ${PROJECT_BINARY_DIR}/lacuna-config-version.cmake
        DESTINATION ${package_folder} COMPONENT library)

# The script that submits a run to Slurm. Pages link to it in the documentation, too.
install(PROGRAMS tools/cluster/slurm.sh DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools/cluster COMPONENT program)

# Configs, and the documentation with its figures but without their scripts.
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/lacuna COMPONENT program FILES_MATCHING PATTERN "*.toml")
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
        FILES_MATCHING PATTERN "*.md" PATTERN "*.json" PATTERN "*.svg" PATTERN "*.png"
        PATTERN example EXCLUDE PATTERN __pycache__ EXCLUDE)
foreach(page engine/README.md engine/store/README.md io/README.md io/read/README.md io/explain/README.md io/write/README.md tools/README.md bench/README.md bench/SPEED.md bench/NOTES.md bench/accuracy/README.md)  # others link to them
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT program)
endforeach()
install(DIRECTORY docs/example DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT library PATTERN __pycache__ EXCLUDE)

# tools/package.sh makes the manual pages, which have what --help-all says.
install(FILES ${PROJECT_BINARY_DIR}/lacuna.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program OPTIONAL)
install(FILES ${PROJECT_BINARY_DIR}/lacuna-bench.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT bench OPTIONAL)
install(FILES tools/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME lacuna
        COMPONENT program)
