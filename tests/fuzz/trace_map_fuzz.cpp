#include "places.h"
#include "rockmass/trace_map.h"
#include "try.h"

namespace keyblock::fuzz {

void try_bytes(std::string_view bytes) {
  static MemoryFile file;
  static_cast<void>(rockmass::read_trace_map(file.hold(bytes), 0));
}

}  // namespace keyblock::fuzz
