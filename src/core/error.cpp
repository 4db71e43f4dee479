#include "core/error.h"

#include <fmt/format.h>

namespace keyblock {

std::string Diagnostic::to_string() const {
  std::string text = where.file;
  if (where.line > 0) text += fmt::format(":{}:{}", where.line, where.column);
  if (!text.empty()) text += ": ";
  if (!key.empty()) text += key + ": ";
  if (!found.empty()) text += "found " + found;
  if (!expected.empty()) text += (found.empty() ? "expected " : "; expected ") + expected;
  if (!hint.empty()) text += "; " + hint;
  return text;
}

namespace {
std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + d.to_string();
  return text;
}
}  // namespace

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace keyblock
