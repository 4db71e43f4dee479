#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "keyblock/export.h"

namespace keyblock {

/// Where in a file something was found. Line and column count from 1; 0 means unknown.
struct KEYBLOCK_API SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

/// One mistake in the user's input. Printed as `file:line:column: key: found …; expected …; hint`, long texts cut, others escaped.
struct KEYBLOCK_API Diagnostic {
  SourcePosition where;
  std::string key;       ///< full key path, e.g. `joint_set[2].spacing.mean`; empty where no key is meant
  std::string found;     ///< what stands there
  std::string expected;  ///< what should
  std::string hint;      ///< suggestion, may be empty

  [[nodiscard]] std::string to_string() const;
};

/// The user's input is wrong (exit code 1). Carries every mistake found, not only the first; its text lists the first 50.
class KEYBLOCK_API InputError : public std::runtime_error {
 public:
  static constexpr std::size_t most_listed = 50;

  /// `more` mistakes were found beside these.
  explicit InputError(std::vector<Diagnostic> diagnostics, std::size_t more = 0);
  explicit InputError(Diagnostic diagnostic) : InputError(std::vector{std::move(diagnostic)}) {}
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The run could not go on (exit code 2); what was computed so far is kept.
class KEYBLOCK_API RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace keyblock
