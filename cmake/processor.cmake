# What the program is built for, so that it can say so where it is started on another machine. Sets KEYBLOCK_PROCESSOR_DEFINITIONS, and
# KEYBLOCK_PROCESSOR, a name for people.
include(CheckCXXSourceCompiles)
set(KEYBLOCK_MARCH "" CACHE STRING "Instruction set, as -march has it; empty: that of this machine, or any x86-64 without KEYBLOCK_NATIVE")
if(KEYBLOCK_MARCH)
  set(KEYBLOCK_PROCESSOR ${KEYBLOCK_MARCH})
  set(CMAKE_REQUIRED_FLAGS -march=${KEYBLOCK_MARCH})
elseif(KEYBLOCK_NATIVE)
  set(KEYBLOCK_PROCESSOR "native")
  set(CMAKE_REQUIRED_FLAGS -march=native)
else()
  set(KEYBLOCK_PROCESSOR "any")
  set(CMAKE_REQUIRED_FLAGS ${CMAKE_CXX_FLAGS_${CMAKE_BUILD_TYPE}})
endif()
unset(KEYBLOCK_USES_SSE42 CACHE)
unset(KEYBLOCK_USES_AVX2 CACHE)
unset(KEYBLOCK_USES_AVX512 CACHE)
check_cxx_source_compiles("#if !(defined(__SSE4_2__) && defined(__POPCNT__))
#error
#endif
int main() {}" KEYBLOCK_USES_SSE42)
check_cxx_source_compiles("#if !(defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__))
#error
#endif
int main() {}" KEYBLOCK_USES_AVX2)
check_cxx_source_compiles("#ifndef __AVX512VL__
#error
#endif
int main() {}" KEYBLOCK_USES_AVX512)
unset(CMAKE_REQUIRED_FLAGS)
set(KEYBLOCK_PROCESSOR_DEFINITIONS
  $<$<BOOL:${KEYBLOCK_USES_SSE42}>:KEYBLOCK_NEEDS_SSE42>
  $<$<BOOL:${KEYBLOCK_USES_AVX2}>:KEYBLOCK_NEEDS_AVX2> $<$<BOOL:${KEYBLOCK_USES_AVX512}>:KEYBLOCK_NEEDS_AVX512>)
