# SPDX-License-Identifier: Apache-2.0
# Puts the page of a report together, with its style, its scripts and three.js, as one string of the program. So is the
# sheet of a check. Sets REPORT_PAGE to the source that has both.
set(page_folder ${CMAKE_CURRENT_LIST_DIR})
set(three_folder /usr/share/javascript/three CACHE PATH "three.js, as Debian's libjs-three has it")
set(page_styles page view widths print)  # in this order: later rules win
set(page_libraries ${three_folder}/three.min.js ${three_folder}/examples/js/controls/OrbitControls.js)
set(page_scripts data format dom legend shading points lines scenes navigation pointer view overlay marks filter table details
    facts controls section print main)  # only main does anything by itself; so their order does not matter
set(sheet_styles page print)  # and sheet.css; the sheet looks on a screen as it does on paper
set(sheet_scripts dom format sheet)
foreach(list page_styles sheet_styles)
  list(TRANSFORM ${list} REPLACE "(.+)" "${page_folder}/\\1.css")
endforeach()
foreach(list page_scripts sheet_scripts)
  list(TRANSFORM ${list} REPLACE "(.+)" "${page_folder}/\\1.js")
endforeach()

function(join_files result)
  set(joined "")
  foreach(file ${ARGN})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "${file} is missing; tools/install.sh installs what the build needs")
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    string(APPEND joined "${text}\n")
  endforeach()
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()

# Sources of a Content-Security-Policy: the SHA-256 of each element without attributes, in base 64.
function(hash_elements result name page)
  set(digits ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
  set(sources "")
  set(rest "${page}")
  string(FIND "${rest}" "<${name}>" at)
  while(NOT at EQUAL -1)
    string(LENGTH "<${name}>" tag)
    math(EXPR at "${at} + ${tag}")
    string(SUBSTRING "${rest}" ${at} -1 rest)
    string(FIND "${rest}" "</${name}>" end)
    string(SUBSTRING "${rest}" 0 ${end} text)
    string(SHA256 hash "${text}")
    string(APPEND hash 00)  # 66 digits: three of them are two of base 64
    set(base64 "")
    foreach(from RANGE 0 63 3)
      string(SUBSTRING ${hash} ${from} 3 part)
      math(EXPR high "0x${part} >> 6")
      math(EXPR low "0x${part} & 63")
      string(SUBSTRING ${digits} ${high} 1 high)
      string(SUBSTRING ${digits} ${low} 1 low)
      string(APPEND base64 ${high}${low})
    endforeach()
    string(REGEX REPLACE ".$" "=" base64 ${base64})
    string(APPEND sources " 'sha256-${base64}'")
    string(FIND "${rest}" "<${name}>" at)
  endwhile()
  string(STRIP "${sources}" sources)
  set(${result} "${sources}" PARENT_SCOPE)
endfunction()

# Fills in {NAME.html} of the folder.
function(make_page result name style three script)
  join_files(page ${page_folder}/${name}.html)
  string(REPLACE "/*{style}*/" "${style}" page "${page}")
  string(REPLACE "/*{three}*/" "${three}" page "${page}")
  string(REPLACE "/*{script}*/" "${script}" page "${page}")
  hash_elements(script_sources script "${page}")
  hash_elements(style_sources style "${page}")
  string(REPLACE "{scripts}" "${script_sources}" page "${page}")
  string(REPLACE "{styles}" "${style_sources}" page "${page}")
  set(${result} "${page}" PARENT_SCOPE)
endfunction()

join_files(style ${page_styles})
join_files(three ${page_libraries})
join_files(script ${page_scripts})
make_page(page page "${style}" "${three}" "${script}")
join_files(style ${sheet_styles})
string(REPLACE "@media print" "@media all" style "${style}")
join_files(own_style ${page_folder}/sheet.css)
join_files(script ${sheet_scripts})
make_page(sheet sheet "${style}${own_style}" "" "${script}")

set(REPORT_PAGE ${CMAKE_CURRENT_BINARY_DIR}/page.cpp)
file(WRITE ${REPORT_PAGE}.new "#include \"io/write/report/report.hpp\"

namespace lacuna::io {

const std::string_view kReportPage = R\"lacuna_page(${page})lacuna_page\";
const std::string_view kSheetPage = R\"lacuna_page(${sheet})lacuna_page\";

}  // namespace lacuna::io
")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different ${REPORT_PAGE}.new ${REPORT_PAGE})
