#include "study/refusal.h"

#include <utility>

#include "core/error.h"

namespace keyblock::study {

void refuse(const std::string& place, const std::string& found, const std::string& expected,
            const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.where.file = place;
  diagnostic.found = found;
  diagnostic.expected = expected;
  diagnostic.hint = hint;
  throw InputError(std::move(diagnostic));
}

}  // namespace keyblock::study
