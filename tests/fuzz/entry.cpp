// What libFuzzer calls, the same for all fuzzers.
#include <cstddef>
#include <cstdint>

#include "core/error.h"
#include "try.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    keyblock::fuzz::try_bytes({reinterpret_cast<const char*>(data), size});
  } catch (const keyblock::InputError&) {  // as it should be
  } catch (const keyblock::RunError&) {
  }
  return 0;
}
