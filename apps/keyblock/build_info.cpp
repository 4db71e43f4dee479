#include "build_info.h"

#include <fmt/format.h>

#include <string_view>

namespace keyblock::app {
namespace {

#if defined(__AVX512F__)
constexpr int register_width = 8;
#elif defined(__AVX__)
constexpr int register_width = 4;
#elif defined(__SSE2__) || defined(__ARM_NEON)
constexpr int register_width = 2;
#else
constexpr int register_width = 1;
#endif

#if defined(__clang__)
constexpr const char* compiler = "clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* compiler = "GCC " __VERSION__;
#else
constexpr const char* compiler = "unknown";
#endif

std::string processor() {
  const std::string_view name = KEYBLOCK_PROCESSOR;
  if (name == "native") return "the machine where it was built, and others with the same instructions";
  if (name == "any") return "any processor of its family";
  return std::string(name);
}

}  // namespace

std::string build_info() {
  return fmt::format(
      "keyblock {}\n"
      "processor: {}\n"
      "registers: {} numbers of double precision\n"
      "compiler:  {}",
      KEYBLOCK_VERSION, processor(), register_width, compiler);
}

}  // namespace keyblock::app
