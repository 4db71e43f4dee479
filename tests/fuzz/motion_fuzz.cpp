#include "loading/motion_file.h"
#include "loading/motion_measures.h"
#include "places.h"
#include "try.h"

namespace keyblock::fuzz {

void try_bytes(std::string_view bytes) {
  static MemoryFile file;
  const auto path = file.hold(bytes);
  // Files that end with these letters are read by hand, so that a file of the corpus is what it is.
  constexpr std::string_view by_hand = "\n#hand";
  loading::MotionReading reading;
  if (bytes.ends_with(by_hand)) {
    reading.dt = 0.01;
    reading.skip = 1;
    reading.unit = "g";
  }
  static_cast<void>(loading::describe_motion(loading::read_motion_file(path, reading)));
}

}  // namespace keyblock::fuzz
