#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::drawing {

/// A drawing as ASCII DXF of R12 (AC1009), which every program reads: polylines on layers, in metres. R12 has no place for a unit.
class DxfWriter {
 public:
  /// `layer`: any text; R12 has capitals, digits, `_`, `-` and `$`, at most 31 of them, and other characters become `_`.
  void polyline(std::string_view layer, std::span<const Vec2> vertices, bool closed);
  /// The whole file. Layers have a colour each, in the order of their names.
  [[nodiscard]] std::string text() const;

 private:
  std::string entities_;
  std::vector<std::string> layers_;  ///< ascending
};

}  // namespace keyblock::drawing
