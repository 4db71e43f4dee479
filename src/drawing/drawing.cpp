#include "drawing/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "drawing/layer_name.h"
#include "drawing/refuse.h"

namespace keyblock::drawing {
namespace {

// A drawing without a unit that is larger than this is hardly one in metres.
constexpr double largest_without_unit = 500.0;

bool is_on(const std::string& layer, const std::vector<std::string>& layers) {
  return layers.empty() || std::ranges::any_of(layers, [&](const std::string& name) {
           return capitals(name) == capitals(layer);
         });
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 30;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), most); ++k) text += (k == 0 ? "" : ", ") + names[k];
  return text + (names.size() > most ? fmt::format(" and {} more", names.size() - most) : "");
}

std::string_view first_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  text.remove_prefix(std::min<std::size_t>(text.starts_with("\r\n") ? 2 : 1, text.size()));
  const auto first = line.find_first_not_of(" \t");
  line = first == std::string_view::npos ? std::string_view() : line.substr(first);
  return line.substr(0, line.find_last_not_of(" \t") + 1);
}

}  // namespace

Vec2 Placement::operator()(Vec2 p) const {
  const Vec2 q = scale.value_or(1.0) * (p - origin);
  if (rotate == 0.0) return q;
  const double angle = rotate * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * q.x - s * q.y, s * q.x + c * q.y};
}

bool is_dxf(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  // Comments have the code 999.
  while (!text.empty()) {
    const std::string_view code = first_line(text), value = first_line(text);
    if (code != "999") return code == "0" && value == "SECTION";
  }
  return false;
}

bool is_binary_dxf(std::string_view text) {
  return text.starts_with("AutoCAD Binary DXF");
}

Drawing read_drawing(std::string_view text, const std::string& file) {
  if (is_shapefile(text)) return read_shapefile(text, file);
  if (is_dxf(text)) return read_dxf(text, file);
  const bool binary = is_binary_dxf(text), dwg = text.starts_with("AC10");
  std::string found = "a file of another kind";
  if (binary) found = "a drawing (binary DXF)";
  if (dwg) found = "an AutoCAD drawing (DWG)";
  refuse(file, 0, "", std::move(found), "a drawing: ASCII DXF, or a shapefile (.shp)",
         binary || dwg ? "save it as DXF, as text (ASCII)" : "");
}

std::vector<DrawnLine> lines_on(const Drawing& drawing, const std::vector<std::string>& layers) {
  std::vector<Diagnostic> mistakes;
  const auto fail = [&](std::string found, std::string expected) {
    Diagnostic& mistake = mistakes.emplace_back();
    mistake.where.file = drawing.file;
    mistake.key = "layers";
    mistake.found = std::move(found);
    mistake.expected = std::move(expected);
  };
  if (!layers.empty() && drawing.layers.empty() && !drawing.lines.empty())
    fail("layers of a shapefile, which has none", "no layers");
  for (const std::string& name : layers) {
    if (drawing.layers.empty()) break;
    if (std::ranges::none_of(drawing.layers,
                             [&](const std::string& l) { return capitals(l) == capitals(name); }))
      fail(fmt::format("\"{}\", on which there is no line", name),
           "layers with lines: " + list_of(drawing.layers));
  }
  std::vector<DrawnLine> lines;
  for (const DrawnLine& line : drawing.lines) {
    if (is_on(line.layer, layers)) lines.push_back(line);
  }
  if (lines.empty() && mistakes.empty()) {
    const std::string skipped = skipped_words(drawing, {});
    const std::string found = skipped.empty() ? "no line" : "no line, but " + skipped;
    refuse(drawing.file, 0, "", found, "one line or more");
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return lines;
}

double scale_of(const Drawing& drawing, const std::vector<DrawnLine>& lines, const Placement& placement) {
  if (placement.scale) return *placement.scale;
  if (drawing.unit) return *drawing.unit;
  Box box;
  for (const DrawnLine& line : lines) {
    for (const Vec2 p : line.vertices) box.add(p);
  }
  const double size = std::max(box.size().x, box.size().y);
  if (!(size > largest_without_unit)) return 1.0;
  refuse(drawing.file, 0, "scale",
         fmt::format("{:.6g} by {:.6g} units, and no unit in the drawing ($INSUNITS)", box.size().x,
                     box.size().y),
         "the scale, in metres per unit of the drawing",
         "scale = 0.001 if it is in millimetres, scale = 1 if it is in metres");
}

std::string skipped_words(const Drawing& drawing, const std::vector<std::string>& layers) {
  std::string text;
  for (const Skipped& skipped : drawing.skipped) {
    if (!skipped.layer.empty() && !is_on(skipped.layer, layers)) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", skipped.count, skipped.entity);
    if (!skipped.layer.empty()) text += fmt::format(" on layer {}", skipped.layer);
    text += fmt::format(" ({} {}{})", skipped.layer.empty() ? "record" : "line", skipped.line,
                        skipped.count > 1 ? " first" : "");
  }
  return text;
}

}  // namespace keyblock::drawing
