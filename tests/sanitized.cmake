# SPDX-License-Identifier: Apache-2.0
# With sanitizers, only tests of the libraries are built: no program and no benchmark. They find memory errors and
# data races in the engine and in io; what the program does is tested as released.
set(LACUNA_TESTED "engine|io" CACHE STRING "Folders of tests/ whose tests are built with the sanitizers, as an expression")

set(kept)
foreach(source ${TEST_SOURCES})
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE name)
  # Tests that run the program, or make scans with the benchmark. The tree of the plain methods is a header alone.
  file(STRINGS ${source} others REGEX "#include \"(tests/support/run_program|bench/|tools/)" LIMIT_COUNT 1)
  if((NOT others OR name STREQUAL "support/point_tree.cpp") AND name MATCHES "^(main|support/|(${LACUNA_TESTED})/|io/[a-z_]+[.]cpp)")
    list(APPEND kept ${source})
  endif()
endforeach()
set(TEST_SOURCES ${kept})

# A sanitized program takes long to start: one test of ctest for each file.
function(add_tests_by_file)
  set(names)
  foreach(source ${TEST_SOURCES})
    cmake_path(GET source STEM name)
    if(name MATCHES "_test$" AND NOT name IN_LIST names)
      list(APPEND names ${name})
      add_test(NAME ${name} COMMAND lacuna_tests --filenames-as-tags "[#${name}]~[.]")
      set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200)
    endif()
  endforeach()
endfunction()
