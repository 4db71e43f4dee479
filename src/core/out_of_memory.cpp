#include "core/out_of_memory.h"

#include <fmt/format.h>
#include <sys/resource.h>

namespace keyblock {

std::string out_of_memory_text(const std::string& purpose) {
  constexpr double kilobytes_of_a_gigabyte = 1e6;
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return fmt::format(
      "out of memory{}{}: {:.2f} GB were taken, and more was needed than the system gives; a smaller model, "
      "or a machine with more memory, may help",
      purpose.empty() ? "" : " for ", purpose,
      static_cast<double>(usage.ru_maxrss) / kilobytes_of_a_gigabyte);
}

}  // namespace keyblock
