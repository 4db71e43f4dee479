#include "study/array_index.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>

#include "study/refusal.h"

namespace keyblock::study {
namespace {

constexpr std::array variables{"SLURM_ARRAY_TASK_ID", "SGE_TASK_ID",  "PBS_ARRAY_INDEX",
                               "PBS_ARRAYID",         "LSB_JOBINDEX", "JOB_COMPLETION_INDEX"};

std::optional<long> to_number(const std::string& text) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::size_t array_index(const std::string& given, long first, std::size_t count) {
  std::string source = given;
  std::optional<long> number = to_number(given);
  for (std::size_t k = 0; k < variables.size() && given.empty() && !number; ++k) {
    const char* value = std::getenv(variables[k]);  // NOLINT(concurrency-mt-unsafe)
    if (value == nullptr) continue;
    number = to_number(value);
    source = fmt::format("{}={}", variables[k], value);
  }
  const std::string range =
      fmt::format("a number from {} to {}", first, static_cast<long>(count) - 1 + first);
  if (!number) {
    std::string names;
    for (const char* name : variables) names += std::string(names.empty() ? "" : ", ") + name;
    refuse("INDEX", source.empty() ? "nothing" : source,
           given.empty() ? range + ", or one of " + names : range);
  }
  if (*number < first || *number - first >= static_cast<long>(count)) refuse("INDEX", source, range);
  return static_cast<std::size_t>(*number - first);
}

}  // namespace keyblock::study
