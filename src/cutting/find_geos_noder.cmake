# The noder of GEOS has no C interface, and its C++ interface is not stable. Where it is there, and is that of GEOS 3.9 to 3.11, it is
# used; elsewhere the lines are noded by their union, which takes longer.
include(CheckCXXSourceCompiles)
find_library(GEOS_CXX_LIBRARY geos HINTS ${GEOS_LIBRARY_DIRS})
if(GEOS_CXX_LIBRARY)
  set(CMAKE_REQUIRED_INCLUDES ${GEOS_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_LIBRARIES ${GEOS_CXX_LIBRARY})
  set(CMAKE_REQUIRED_FLAGS "-std=c++20")
  check_cxx_source_compiles([=[
    #include <geos/geom/CoordinateArraySequence.h>
    #include <geos/geom/PrecisionModel.h>
    #include <geos/noding/NodedSegmentString.h>
    #include <geos/noding/snapround/SnapRoundingNoder.h>
    #include <vector>

    int main() {
      std::vector<geos::geom::Coordinate> points{{0.0, 0.0}, {1.0, 1.0}};
      std::vector<geos::noding::SegmentString*> strings{new geos::noding::NodedSegmentString(
          new geos::geom::CoordinateArraySequence(std::move(points)), nullptr)};
      geos::geom::PrecisionModel grid(1.0);
      geos::noding::snapround::SnapRoundingNoder noder(&grid);
      noder.computeNodes(&strings);
      std::vector<geos::noding::SegmentString*>* noded = noder.getNodedSubstrings();
      return static_cast<int>((*noded)[0]->getCoordinate(0).x);
    }
  ]=] KEYBLOCK_GEOS_NODER)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
  unset(CMAKE_REQUIRED_FLAGS)
endif()
if(KEYBLOCK_GEOS_NODER)
  target_compile_definitions(keyblock_cutting PRIVATE KEYBLOCK_GEOS_NODER=1)
  target_link_libraries(keyblock_cutting PRIVATE ${GEOS_CXX_LIBRARY})
else()
  message(STATUS "GEOS's noder is not there, or not as expected: cutting takes half as long again")
  target_compile_definitions(keyblock_cutting PRIVATE KEYBLOCK_GEOS_NODER=0)
endif()
