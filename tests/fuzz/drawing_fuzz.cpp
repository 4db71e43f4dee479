#include "drawing/drawing.h"
#include "try.h"

namespace keyblock::fuzz {

void try_bytes(std::string_view bytes) {
  const drawing::Drawing drawn = drawing::read_drawing(bytes, "drawing");
  const std::vector<drawing::DrawnLine> lines = drawing::lines_on(drawn, {});
  static_cast<void>(drawing::scale_of(drawn, lines, {}));
  static_cast<void>(drawing::skipped_words(drawn, {}));
}

}  // namespace keyblock::fuzz
