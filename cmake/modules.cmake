# keyblock_module(name DEPENDS module... LINK library... [UNITY] [LIGHT])
#
# One static library per folder of src/: every *.cpp of the folder, linked to the modules below it.
# Third-party libraries that appear only in the sources are given after LINK.
# UNITY: files are compiled eight at once, as the headers for JSON cost more time than what is written here.
# LIGHT: hardly optimized, as it computes little: a quarter less time to compile.
function(keyblock_module name)
  cmake_parse_arguments(ARG "UNITY;LIGHT" "" "DEPENDS;LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(sources)
    add_library(keyblock_${name} STATIC ${sources})
    if(ARG_UNITY)
      set_target_properties(keyblock_${name} PROPERTIES UNITY_BUILD ON)
    endif()
    if(ARG_LIGHT)
      target_compile_options(keyblock_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    set(scope PUBLIC)
    target_link_libraries(keyblock_${name} PRIVATE ${ARG_LINK})
  else()
    add_library(keyblock_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(keyblock_${name} ${scope} keyblock_options)
  foreach(module IN LISTS ARG_DEPENDS)
    target_link_libraries(keyblock_${name} ${scope} keyblock_${module})
  endforeach()
endfunction()

# The cases of test_<module> in KEYBLOCK_TEST_SHARDS processes, without the longest ones.
function(keyblock_test_shards module)
  math(EXPR last "${KEYBLOCK_TEST_SHARDS} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME unit.${module}.${shard} COMMAND test_${module} --gtest_brief=1 --gtest_filter=-*TenThousandRuns*)
    set_tests_properties(unit.${module}.${shard} PROPERTIES LABELS unit TIMEOUT 900
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${KEYBLOCK_TEST_SHARDS};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()

# keyblock_tests(module...): tests/unit/<module>/*.cpp become the executable test_<module>; the target unit_tests
# builds them all, `ctest -L unit` runs them. Compiled eight files at once, for the headers of the test libraries, and hardly optimized
# where they do not compute much themselves. With KEYBLOCK_TEST_SHARDS each executable runs as so many tests in place of one per case:
# under the sanitizers the start of a process takes longer than most cases.
function(keyblock_tests)
  add_custom_target(unit_tests)
  set(computing geometry cutting block contact linalg coupling solve dynamics simulation)
  foreach(module IN LISTS ARGN)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/unit/${module}/*.cpp)
    if(sources)
      add_executable(test_${module} ${sources})
      set_target_properties(test_${module} PROPERTIES UNITY_BUILD ON)
      if(NOT module IN_LIST computing)
        target_compile_options(test_${module} PRIVATE $<$<NOT:$<CONFIG:Debug>>:${KEYBLOCK_TEST_OPTIMIZATION}>)
      endif()
      target_link_libraries(test_${module} PRIVATE keyblock_${module} GTest::gtest_main GTest::gmock rapidcheck Eigen3::Eigen)
      target_compile_definitions(test_${module} PRIVATE
        KEYBLOCK_SOURCE_DIR="${PROJECT_SOURCE_DIR}" KEYBLOCK_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
      if(KEYBLOCK_TEST_SHARDS)
        keyblock_test_shards(${module})
      else()
        gtest_discover_tests(test_${module} TEST_PREFIX "unit." DISCOVERY_TIMEOUT 60 PROPERTIES LABELS unit TIMEOUT 300)
      endif()
      add_dependencies(unit_tests test_${module})
    endif()
  endforeach()
endfunction()
