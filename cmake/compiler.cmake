# One set of compiler options for every target of the project.
add_library(keyblock_options INTERFACE)
target_compile_options(keyblock_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror
  # GCC 12 sees overlapping copies in `"literal" + std::string` that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Vector registers are passed between inlined functions only, so their calling convention does not matter.
  -Wno-psabi
  # The same bits from every build: no fused multiply-add behind our back, and never -ffast-math. GCC 12's vectorizer
  # makes vfmaddsub of x·c ∓ y·s in spite of -ffp-contract=off (tests/integration/instructions.py).
  -ffp-contract=off
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-vectorize>
  # The same objects make the program and the library: what is not of its headers is hidden, and calls within it are direct.
  -fno-semantic-interposition)
target_include_directories(keyblock_options INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include ${PROJECT_BINARY_DIR}/generated)
# Eigen would pick other instructions, and other roundings, on other machines.
target_compile_definitions(keyblock_options INTERFACE EIGEN_DONT_VECTORIZE)
# A target may ask for an instruction set of its own (property KEYBLOCK_ARCHITECTURE).
set(architecture $<TARGET_PROPERTY:KEYBLOCK_ARCHITECTURE>)
include(${CMAKE_CURRENT_LIST_DIR}/processor.cmake)
if(KEYBLOCK_MARCH)
  set(march -march=${KEYBLOCK_MARCH})
elseif(KEYBLOCK_NATIVE)
  set(march -march=native)
endif()
target_compile_options(keyblock_options INTERFACE $<IF:$<BOOL:${architecture}>,-march=${architecture},${march}>)

# ccache where there is one, unless another launcher was asked for.
find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
