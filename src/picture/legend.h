#pragma once
#include <string>
#include <string_view>

#include "picture/quantities.h"

namespace keyblock::picture {

/// The column beside a picture that says what colours, widths and lengths mean, from the top down.
class LegendColumn {
 public:
  LegendColumn(double left, double top) : left_(left), y_(top) {}

  void bar(std::string_view title, const Scale& scale, Quantity quantity, ColorMap map, bool reversed);
  /// Areas, or lines of a width.
  void classes(std::string_view title, const std::vector<NamedColor>& named, bool as_lines);
  /// A line of a width and a length, and what it stands for.
  void line(std::string_view color, double width, double length, std::string_view text);
  void note(std::string_view text);
  [[nodiscard]] const std::string& svg() const { return svg_; }

 private:
  void title(std::string_view text);

  double left_, y_;
  std::string svg_;
};

}  // namespace keyblock::picture
