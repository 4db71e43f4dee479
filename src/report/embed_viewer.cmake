# Builds the pages of the reports from viewer/ (TypeScript, with npm packages by lock file) into generated/viewer/ of the
# build folder, template.html for a run and study_template.html for a study, and embeds them into keyblock_report.
# The packages are installed in the build folder, so that build folders do not disturb each other.
find_program(NODE_EXECUTABLE NAMES node nodejs)
find_program(NPM_EXECUTABLE npm)
if(NOT NODE_EXECUTABLE OR NOT NPM_EXECUTABLE)
  message(FATAL_ERROR "node and npm are needed to build the page of the report (Debian packages nodejs and npm); "
                      "who uses the built program needs neither")
endif()

set(viewer_source ${PROJECT_SOURCE_DIR}/viewer)
set(viewer_build ${PROJECT_BINARY_DIR}/viewer)
set(viewer_generated ${PROJECT_BINARY_DIR}/generated/viewer)
file(GLOB_RECURSE viewer_files CONFIGURE_DEPENDS ${viewer_source}/src/*)

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
  OUTPUT ${viewer_generated}/template.html ${viewer_generated}/study_template.html
  COMMAND ${NODE_EXECUTABLE} ${viewer_source}/build.mjs --packages ${viewer_build}/node_modules --out ${viewer_generated}
  DEPENDS ${viewer_build}/installed ${viewer_source}/build.mjs ${viewer_files}
  COMMENT "Bundling the reports' pages"
  VERBATIM)

# embed_page(FILE FUNCTION): FILE of the bundled pages, given by a function of viewer_template.h.
function(embed_page page function)
  set(embedded ${viewer_generated}/${function}.cpp)
  add_custom_command(
    OUTPUT ${embedded}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${viewer_generated}/${page} -DOUTPUT=${embedded} -DFUNCTION=${function}
            -P ${PROJECT_SOURCE_DIR}/src/report/embed_file.cmake
    DEPENDS ${viewer_generated}/${page} ${PROJECT_SOURCE_DIR}/src/report/embed_file.cmake
    VERBATIM)
  target_sources(keyblock_report PRIVATE ${embedded})
endfunction()
embed_page(template.html viewer_template)
embed_page(study_template.html study_template)
