# What is installed, in three parts that become three Debian packages: the program with its known answers and examples; the C++ library with
# its headers; the Python module.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# ── the program ──────────────────────────────────────────────────────────────────────────────────────────────────────
install(TARGETS keyblock RUNTIME COMPONENT program)
install(DIRECTORY verification examples DESTINATION ${CMAKE_INSTALL_DATADIR}/keyblock COMPONENT program
  PATTERN "*.py" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY packaging/htcondor DESTINATION ${CMAKE_INSTALL_DATADIR}/keyblock COMPONENT program)
install(FILES packaging/Snakefile DESTINATION ${CMAKE_INSTALL_DATADIR}/keyblock COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
# What the program says of itself.
set(made ${PROJECT_BINARY_DIR}/share)
file(MAKE_DIRECTORY ${made})
add_custom_command(OUTPUT ${made}/keyblock.1 ${made}/keyblock.bash ${made}/_keyblock ${made}/keyblock.fish
  COMMAND keyblock manual-page > ${made}/keyblock.1
  COMMAND keyblock completion bash > ${made}/keyblock.bash
  COMMAND keyblock completion zsh > ${made}/_keyblock
  COMMAND keyblock completion fish > ${made}/keyblock.fish
  DEPENDS keyblock)
add_custom_target(keyblock_pages ALL DEPENDS ${made}/keyblock.1)
install(FILES ${made}/keyblock.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${made}/keyblock.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME keyblock COMPONENT program)
install(FILES ${made}/_keyblock DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${made}/keyblock.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)

# ── the library ──────────────────────────────────────────────────────────────────────────────────────────────────────
# One shared library of all modules, of which only the public headers are seen.
add_library(keyblock_shared SHARED ${PROJECT_SOURCE_DIR}/src/api/shared_library.cpp)
target_link_libraries(keyblock_shared PRIVATE keyblock_options $<LINK_LIBRARY:WHOLE_ARCHIVE,keyblock_api>)
target_include_directories(keyblock_shared INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
target_compile_features(keyblock_shared INTERFACE cxx_std_20)
set_target_properties(keyblock_shared PROPERTIES
  OUTPUT_NAME keyblock EXPORT_NAME keyblock VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
install(TARGETS keyblock_shared EXPORT keyblockTargets LIBRARY COMPONENT library NAMELINK_COMPONENT library)
install(DIRECTORY include/keyblock DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
install(EXPORT keyblockTargets NAMESPACE keyblock:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/keyblock COMPONENT library)
file(WRITE ${PROJECT_BINARY_DIR}/keyblockConfig.cmake "include(\"\${CMAKE_CURRENT_LIST_DIR}/keyblockTargets.cmake\")\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/keyblockConfigVersion.cmake COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH KEYBLOCK_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/keyblock.pc.in ${PROJECT_BINARY_DIR}/keyblock.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/keyblockConfig.cmake ${PROJECT_BINARY_DIR}/keyblockConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/keyblock COMPONENT library)
install(FILES ${PROJECT_BINARY_DIR}/keyblock.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libkeyblock-dev RENAME copyright COMPONENT library)

# ── Python ───────────────────────────────────────────────────────────────────────────────────────────────────────────
if(KEYBLOCK_PYTHON)
  set(python_folder lib/python3/dist-packages/keyblock)
  install(TARGETS keyblock_python LIBRARY DESTINATION ${python_folder} COMPONENT python)
  install(FILES ${PROJECT_BINARY_DIR}/python/keyblock/_build.py DESTINATION ${python_folder} COMPONENT python)
  install(DIRECTORY python/keyblock/ DESTINATION ${python_folder} COMPONENT python PATTERN "__pycache__" EXCLUDE)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-keyblock RENAME copyright COMPONENT python)
endif()

# ── Debian packages ──────────────────────────────────────────────────────────────────────────────────────────────────
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the keyblock maintainers <maintainers@keyblock.invalid>")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL program library python)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME keyblock)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "jointed rock under earthquakes, by discontinuous deformation analysis
 Draws joints from statistics, cuts them into blocks, opens a tunnel and shakes it. Says which blocks fall, how joints slip, and with what
 probability.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libkeyblock-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "C++ library of keyblock
 Headers and the shared library: scenarios, runs step by step, results.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-keyblock)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-h5py")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, python3-matplotlib")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Python module of keyblock
 Scenarios from Python, runs that are steered step by step, and results as tables and figures.")
include(CPack)
