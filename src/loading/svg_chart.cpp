#include "loading/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/svg.h"

namespace keyblock::loading {
namespace {

constexpr int most_ticks = 40;  // that are ever drawn

// A step of 1, 2 or 5 times a power of ten that divides `range` into at most `most` parts.
double tick_step(double range, int most) {
  const double raw = range / most;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10.0 * power;
}

double share(const ChartAxis& axis, double value) {
  if (!axis.log) return (value - axis.from) / (axis.to - axis.from);
  return std::log(value / axis.from) / std::log(axis.to / axis.from);
}

std::vector<double> log_ticks(const ChartAxis& axis) {
  std::vector<double> places;
  double power = std::pow(10.0, std::floor(std::log10(axis.from)));
  for (int decade = 0; decade < most_ticks / 3 && power <= axis.to; ++decade, power *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double place = factor * power;
      if (place >= 0.999 * axis.from && place <= 1.001 * axis.to) places.push_back(place);
    }
  }
  return places;
}

}  // namespace

double ChartFrame::at_x(double value) const {
  return left + width * share(x, value);
}

double ChartFrame::at_y(double value) const {
  return top + height * (1.0 - share(y, value));
}

std::vector<double> chart_ticks(const ChartAxis& axis, int most) {
  if (axis.log) return log_ticks(axis);
  const double step = tick_step(axis.to - axis.from, most), first = std::ceil(axis.from / step);
  std::vector<double> places;
  for (int k = 0; k < most_ticks && (first + k) * step <= axis.to + 1e-9 * step; ++k)
    places.push_back((first + k) * step);
  return places;
}

std::string draw_frame(const ChartFrame& frame, std::string_view title, bool numbers) {
  constexpr double pixels_per_x = 80.0, pixels_per_y = 24.0;
  const double right = frame.left + frame.width, bottom = frame.top + frame.height;
  std::string svg = svg_text(frame.left, frame.top - 7.0, "start", title, "fill=\"#333\"");
  for (const double x : chart_ticks(frame.x, static_cast<int>(frame.width / pixels_per_x))) {
    svg += fmt::format("<path d=\"M{:.1f},{:.1f}V{:.1f}\" stroke=\"#ddd\"/>\n", frame.at_x(x), frame.top,
                       bottom);
    if (numbers) svg += svg_text(frame.at_x(x), bottom + 16.0, "middle", fmt::format("{:.6g}", x));
  }
  for (const double y : chart_ticks(frame.y, static_cast<int>(frame.height / pixels_per_y))) {
    svg += fmt::format("<path d=\"M{:.1f},{:.1f}H{:.1f}\" stroke=\"{}\"/>\n", frame.left, frame.at_y(y),
                       right, y == 0.0 ? "#999" : "#ddd");
    svg += svg_text(frame.left - 6.0, frame.at_y(y) + 4.0, "end", fmt::format("{:.6g}", y));
  }
  return svg + fmt::format(
                   "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
                   "stroke=\"#999\"/>\n",
                   frame.left, frame.top, frame.width, frame.height);
}

std::string draw_curve(const ChartFrame& frame, const std::vector<double>& x, const std::vector<double>& y,
                       std::string_view color, double width) {
  constexpr double columns_per_pixel = 2.0;
  std::string path;
  double before = 0.0;  // where the last point would be
  const auto column = [&](std::size_t k) { return std::floor(frame.at_x(x[k]) * columns_per_pixel); };
  const double bottom = frame.top + frame.height;
  const auto add = [&](std::size_t k) {
    const double place = frame.at_y(y[k]);
    const bool outside = (place < frame.top && before < frame.top) || (place > bottom && before > bottom);
    fmt::format_to(std::back_inserter(path), "{}{:.1f},{:.2f}", path.empty() || outside ? "M" : "L",
                   frame.at_x(x[k]), std::clamp(place, frame.top, bottom));
    before = place;
  };
  for (std::size_t k = 0; k < x.size();) {
    std::size_t low = k, high = k, next = k + 1;
    for (; next < x.size() && column(next) == column(k); ++next) {
      if (y[next] < y[low]) low = next;
      if (y[next] > y[high]) high = next;
    }
    add(std::min(low, high));
    if (low != high) add(std::max(low, high));
    k = next;
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", path, color,
                     width);
}

}  // namespace keyblock::loading
