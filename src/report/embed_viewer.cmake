# Builds the page of the report from viewer/ (TypeScript, with npm packages by lock file) into
# generated/viewer/template.html of the build folder, and embeds it into keyblock_report.
# The packages are installed in the build folder, so that build folders do not disturb each other.
find_program(NODE_EXECUTABLE NAMES node nodejs)
find_program(NPM_EXECUTABLE npm)
if(NOT NODE_EXECUTABLE OR NOT NPM_EXECUTABLE)
  message(FATAL_ERROR "node and npm are needed to build the page of the report (Debian packages nodejs and npm); "
                      "who uses the built program needs neither")
endif()

set(viewer_source ${PROJECT_SOURCE_DIR}/viewer)
set(viewer_build ${PROJECT_BINARY_DIR}/viewer)
set(viewer_template ${PROJECT_BINARY_DIR}/generated/viewer/template.html)
set(viewer_embedded ${PROJECT_BINARY_DIR}/generated/viewer/template.cpp)
file(GLOB viewer_files CONFIGURE_DEPENDS ${viewer_source}/src/*)

add_custom_command(
  OUTPUT ${viewer_build}/installed
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_source}/package.json ${viewer_source}/package-lock.json
          ${viewer_source}/.npmrc ${viewer_build}
  COMMAND ${CMAKE_COMMAND} -E chdir ${viewer_build} ${NPM_EXECUTABLE} ci --omit=dev --prefer-offline --silent
  COMMAND ${CMAKE_COMMAND} -E touch ${viewer_build}/installed
  DEPENDS ${viewer_source}/package.json ${viewer_source}/package-lock.json ${viewer_source}/.npmrc
  COMMENT "Installing the npm packages of the report's page"
  VERBATIM)
add_custom_command(
  OUTPUT ${viewer_template}
  COMMAND ${NODE_EXECUTABLE} ${viewer_source}/build.mjs --packages ${viewer_build}/node_modules --out ${viewer_template}
  DEPENDS ${viewer_build}/installed ${viewer_source}/build.mjs ${viewer_files}
  COMMENT "Bundling the report's page"
  VERBATIM)
add_custom_command(
  OUTPUT ${viewer_embedded}
  COMMAND ${CMAKE_COMMAND} -DINPUT=${viewer_template} -DOUTPUT=${viewer_embedded}
          -P ${CMAKE_CURRENT_LIST_DIR}/embed_file.cmake
  DEPENDS ${viewer_template} ${CMAKE_CURRENT_LIST_DIR}/embed_file.cmake
  VERBATIM)
target_sources(keyblock_report PRIVATE ${viewer_embedded})
