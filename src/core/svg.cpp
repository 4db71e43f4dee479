#include "core/svg.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "core/xml_text.h"

namespace keyblock {

std::string svg_begin(double width, double height, int font_size) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:.0f}\" width=\"{0:g}\" "
      "height=\"{1:.0f}\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" "
      "font-size=\"{2}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height, font_size);
}

void svg_number(std::string& to, double x) {
  constexpr double most = 1e9;  // beyond any picture; a viewer draws nothing there
  if (!(std::abs(x) < most)) x = std::copysign(most, x);
  const long long all = std::llround(100.0 * std::abs(x));
  std::array<char, 32> text;
  char* end = text.data();
  if (x < 0.0 && all > 0) *end++ = '-';
  end = std::to_chars(end, text.data() + text.size(), all / 100).ptr;
  *end++ = '.';
  *end++ = static_cast<char>('0' + all / 10 % 10);
  *end++ = static_cast<char>('0' + all % 10);
  to.append(text.data(), end);
}

void svg_point(std::string& to, char command, double x, double y) {
  to += command;
  svg_number(to, x);
  to += ' ';
  svg_number(to, y);
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view text,
                     std::string_view more) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}{}>{}</text>\n", x, y, anchor,
                     more.empty() ? "" : " ", more, xml_text(text));
}

}  // namespace keyblock
