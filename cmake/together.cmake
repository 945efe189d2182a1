# SPDX-License-Identifier: Apache-2.0
# Compiles the sources of a folder together, eight at a time. The compiler reads headers once for all of them, so a
# build takes less than half of the time. Names in unnamed namespaces must differ within a folder.
option(LACUNA_UNITY "Compile the sources of a folder together: whole builds are faster, small changes slower" ON)

function(compile_together target)
  if(NOT LACUNA_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    # Some sources stay apart: those that are compiled once for each instruction set, and a table that the compiler
    # computes.
    file(STRINGS ${source} apart REGEX "simd/targets.hpp" LIMIT_COUNT 1)
    if(apart OR source MATCHES "e57_header")
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      continue()
    endif()
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER ${folder} folder)
    math(EXPR group "${count_${folder}} + 0")
    math(EXPR count_${folder} "${group} + 1")
    math(EXPR group "${group} / 8")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
  endforeach()
  # A source that another one includes counts as a header for this warning.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
