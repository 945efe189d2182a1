# SPDX-License-Identifier: Apache-2.0
# The public headers: those that engine/lacuna.hpp and io/lacuna_io.hpp include, directly or not.

# Copies `header` and every header of the project that it includes to `to`/lacuna. There, #include "engine/x.hpp" reads
# #include <lacuna/engine/x.hpp>, so that an "engine/x.hpp" of the user's own does not take its place. A new or changed
# include runs CMake again.
function(lacuna_copy_public_headers header to)
  set(waiting ${header})
  set(seen "")
  while(waiting)
    list(POP_FRONT waiting at)
    if(at IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${at})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${at})
    file(READ ${PROJECT_SOURCE_DIR}/${at} text)
    string(REGEX MATCHALL "#include \"[^\"]+\"" includes "${text}")
    list(TRANSFORM includes REPLACE "#include \"([^\"]+)\"" "\\1")
    list(APPEND waiting ${includes})
    string(REGEX REPLACE "#include \"([^\"]+)\"" "#include <lacuna/\\1>" text "${text}")
    set(copy ${at})
    if(at STREQUAL header)
      cmake_path(GET header FILENAME copy)
    endif()
    file(CONFIGURE OUTPUT ${to}/lacuna/${copy} CONTENT "${text}" @ONLY)
  endwhile()
endfunction()
