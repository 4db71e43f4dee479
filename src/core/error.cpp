#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.h"

namespace keyblock {
namespace {

// Characters of a message: what was found may be a line of megabytes, or no text at all.
constexpr std::size_t longest_path = 4096, longest_key = 300, longest_found = 300, longest_words = 2000;

}  // namespace

std::string Diagnostic::to_string() const {
  std::string text = printable(where.file, longest_path);
  if (where.line > 0) text += fmt::format(":{}:{}", where.line, where.column);
  if (!text.empty()) text += ": ";
  if (!key.empty()) text += printable(key, longest_key) + ": ";
  if (!found.empty()) text += "found " + printable(found, longest_found);
  if (!expected.empty())
    text += (found.empty() ? "expected " : "; expected ") + printable(expected, longest_words);
  if (!hint.empty()) text += "; " + printable(hint, longest_words);
  return text;
}

namespace {
std::string join(const std::vector<Diagnostic>& diagnostics, std::size_t more) {
  const std::size_t listed = std::min(diagnostics.size(), InputError::most_listed);
  more += diagnostics.size() - listed;
  std::string text;
  for (std::size_t k = 0; k < listed; ++k) text += (k == 0 ? "" : "\n") + diagnostics[k].to_string();
  if (more > 0) text += fmt::format("\nand {} more {}", more, more == 1 ? "mistake" : "mistakes");
  return text;
}
}  // namespace

InputError::InputError(std::vector<Diagnostic> diagnostics, std::size_t more)
    : std::runtime_error(join(diagnostics, more)), diagnostics_(std::move(diagnostics)) {}

}  // namespace keyblock
