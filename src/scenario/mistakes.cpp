#include "scenario/mistakes.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace keyblock::scenario {
namespace {

/// What makes two mistakes the same: a hint may say which of several values led to it.
std::string identity(Diagnostic diagnostic) {
  diagnostic.hint.clear();
  return diagnostic.to_string();
}

}  // namespace

void Mistakes::add(Diagnostic diagnostic) {
  if (full()) {
    ++counted_;
  } else if (known_.insert(identity(diagnostic)).second) {
    kept_.push_back(std::move(diagnostic));
  }
}

void Mistakes::add(const std::vector<Diagnostic>& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics) add(diagnostic);
}

void Mistakes::add(const Mistakes& mistakes) {
  add(mistakes.kept_);
  counted_ += mistakes.counted_;
}

void Mistakes::sort(const std::string& file) {
  const auto rank = [&](const Diagnostic& d) {
    const int place = d.where.file == file ? 0 : d.where.line == 0 ? 1 : 2;
    return place == 0 ? std::tuple(place, d.where.line, d.where.column) : std::tuple(place, 0, 0);
  };
  std::stable_sort(kept_.begin(), kept_.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return rank(a) < rank(b); });
}

}  // namespace keyblock::scenario
