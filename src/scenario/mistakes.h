#pragma once
#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/error.h"

namespace keyblock::scenario {

/// What is wrong with a document, each mistake once: a second one at the same place that says the same is left out. So that a document
/// of mistakes takes no more time and memory than another one, those after the first `most` are counted and not kept.
class Mistakes {
 public:
  static constexpr std::size_t most = 1000;

  void add(Diagnostic diagnostic);
  void add(const std::vector<Diagnostic>& diagnostics);
  void add(const Mistakes& mistakes);
  [[nodiscard]] bool empty() const { return kept_.empty(); }
  /// No further one is kept: who adds need not look for hints, nor for other mistakes.
  [[nodiscard]] bool full() const { return kept_.size() >= most; }
  [[nodiscard]] const std::vector<Diagnostic>& kept() const { return kept_; }
  /// Those of the file in its order, then those of overrides, then those of other files.
  void sort(const std::string& file);
  [[nodiscard]] InputError error() const { return InputError(kept_, counted_); }

 private:
  std::vector<Diagnostic> kept_;
  std::unordered_set<std::string> known_;  ///< for look-ups alone
  std::size_t counted_ = 0;
};

}  // namespace keyblock::scenario
