#include "drawing/refuse.h"

#include "core/error.h"

namespace keyblock::drawing {

void refuse(const std::string& file, int line, std::string key, std::string found, std::string expected,
            std::string hint) {
  Diagnostic diagnostic;
  diagnostic.where = {file, line, line > 0 ? 1 : 0};
  diagnostic.key = std::move(key);
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

}  // namespace keyblock::drawing
