#pragma once
#include <string>
#include <utility>

#include "core/error.h"

namespace keyblock::simulation {

/// Throws InputError about the value of a key of the scenario; who knows the file adds its place there.
[[noreturn]] inline void refuse(const std::string& key, std::string found, std::string expected) {
  Diagnostic diagnostic;
  diagnostic.key = key;
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  throw InputError(std::move(diagnostic));
}

}  // namespace keyblock::simulation
