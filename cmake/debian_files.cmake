# SPDX-License-Identifier: Apache-2.0
# Adds what Debian wants of each package, and `cmake --install` does not write: changelog.gz and copyright.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # or SOURCE_DATE_EPOCH
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(folder ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}${CPACK_PACKAGING_INSTALL_PREFIX}/share/doc/${package})
  file(WRITE ${folder}/changelog
       "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) bookworm; urgency=medium

  * CHANGELOG.md has the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  execute_process(COMMAND gzip -9nf ${folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
  file(COPY_FILE ${CPACK_LACUNA_COPYRIGHT} ${folder}/copyright)
  if(EXISTS ${folder}/LICENSE)  # Debian has one copy of this text, which the file `copyright` names
    file(REMOVE ${folder}/LICENSE)
    file(CREATE_LINK ../../common-licenses/Apache-2.0 ${folder}/LICENSE SYMBOLIC)
  endif()
  file(CHMOD ${folder}/copyright ${folder}/changelog.gz PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endforeach()
