#include "picture/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/svg.h"

namespace keyblock::picture {
namespace {

constexpr double bar_width = 20.0, bar_height = 200.0, row = 22.0, gap = 14.0;
constexpr std::size_t letters = 30;  // of a row

// A letter of several bytes counts as these: rows are broken early rather than late.
std::vector<std::string> wrapped(std::string_view text) {
  std::vector<std::string> rows{""};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (!rows.back().empty() && rows.back().size() + 1 + word.size() > letters) rows.emplace_back();
    rows.back() += (rows.back().empty() ? "" : " ") + std::string(word);
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return rows;
}

}  // namespace

void LegendColumn::title(std::string_view text) {
  for (const std::string& line : wrapped(text)) {
    y_ += 18.0;
    svg_ += svg_text(left_, y_, "start", line, "font-weight=\"bold\"");
  }
  y_ += 10.0;
}

void LegendColumn::bar(std::string_view name, const Scale& scale, Quantity quantity, ColorMap map,
                       bool reversed) {
  title(name);
  y_ += 6.0;  // for half of the topmost label
  const double step = bar_height / shades;
  for (int k = 0; k < shades; ++k)
    svg_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                        left_, y_ + bar_height - (k + 1) * step, bar_width, step + 0.4,
                        shade(map, reversed ? shades - 1 - k : k));
  for (const double tick : scale.ticks()) {
    const double y = y_ + bar_height * (1.0 - scale.place(tick));
    svg_ += fmt::format("<path stroke=\"{}\" d=\"M{:.1f} {:.1f}h6\"/>\n", ink_color, left_ + bar_width, y);
    svg_ += svg_text(left_ + bar_width + 11.0, y + 5.0, "start", with_unit(tick, quantity));
  }
  y_ += bar_height + gap + 8.0;
}

void LegendColumn::classes(std::string_view name, const std::vector<NamedColor>& named, bool as_lines) {
  title(name);
  for (const NamedColor& one : named) {
    svg_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"26\" height=\"{}\" fill=\"{}\"{}/>\n", left_,
                        as_lines ? y_ + 5.0 : y_, as_lines ? 3 : 14, one.color,
                        as_lines ? "" : " stroke=\"#33373b\" stroke-width=\"0.6\"");
    svg_ += svg_text(left_ + 34.0, y_ + 12.0, "start", one.name);
    y_ += row;
  }
  y_ += gap;
}

void LegendColumn::line(std::string_view color, double width, double length, std::string_view text) {
  svg_ +=
      fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>\n",
                  color, width, left_, y_ + 8.0, length);
  double y = y_ + 13.0;
  const bool beside = length < 60.0;
  if (!beside) y += row;
  for (const std::string& part : wrapped(text)) {
    svg_ += svg_text(beside ? left_ + length + 8.0 : left_, y, "start", part);
    y += 18.0;
  }
  y_ = y - 5.0;
}

void LegendColumn::note(std::string_view text) {
  for (const std::string& part : wrapped(text)) {
    svg_ += svg_text(left_, y_ + 12.0, "start", part, "fill=\"#555555\" font-size=\"12\"");
    y_ += 16.0;
  }
  y_ += gap;
}

}  // namespace keyblock::picture
