#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "core/xml_text.h"
#include "loading/motion_measures.h"

namespace keyblock::loading {
namespace {

// The page, in pixels.
constexpr double width = 960.0, left = 70.0, right = 20.0, panel_height = 150.0, panel_gap = 34.0, top = 40.0,
                 bottom = 44.0;
constexpr double plot_width = width - left - right;

// A step of 1, 2 or 5 times a power of ten that divides `range` into at most `most` parts.
double tick_step(double range, int most) {
  const double raw = range / most;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10.0 * power;
}

// The multiples of `step` in [from, to]. They are counted, so that there are few whatever the numbers are.
std::vector<double> ticks(double from, double to, double step) {
  constexpr int most = 20;
  const double first = std::ceil(from / step);
  std::vector<double> places;
  for (int k = 0; k < most && (first + k) * step <= to + 1e-9 * step; ++k)
    places.push_back((first + k) * step);
  return places;
}

// Smallest and largest acceleration of every column of pixels: what a line through all samples would cover.
std::string outline(const MotionComponent& c, double t0, double seconds_per_pixel, double zero,
                    double pixels_per_unit) {
  std::string path;
  const auto add = [&](double x, double a) {
    fmt::format_to(std::back_inserter(path), "{}{:.1f},{:.2f}", path.empty() ? "M" : "L", left + x,
                   zero - a * pixels_per_unit);
  };
  constexpr double columns_per_pixel = 2.0;
  for (std::size_t k = 0; k < c.acceleration.size();) {
    const double column = std::floor((c.time(k) - t0) / seconds_per_pixel * columns_per_pixel);
    std::size_t low = k, high = k, next = k + 1;
    for (; next < c.acceleration.size(); ++next) {
      if (std::floor((c.time(next) - t0) / seconds_per_pixel * columns_per_pixel) != column) break;
      if (c.acceleration[next] < c.acceleration[low]) low = next;
      if (c.acceleration[next] > c.acceleration[high]) high = next;
    }
    for (const std::size_t sample : {std::min(low, high), std::max(low, high)}) {
      add((c.time(sample) - t0) / seconds_per_pixel, c.acceleration[sample]);
      if (low == high) break;
    }
    k = next;
  }
  return path;
}

std::string title(const MotionComponent& c) {
  std::string name = std::filesystem::path(c.file).filename().string();
  if (c.vertical) return name + ", up";
  if (c.azimuth) return fmt::format("{}, {}°", name, *c.azimuth);
  return c.label.empty() ? name : name + ", " + c.label;
}

}  // namespace

std::string plot_motion_svg(const std::vector<MotionComponent>& components) {
  double t0 = HUGE_VAL, t1 = -HUGE_VAL, peak = 0.0;
  for (const MotionComponent& c : components) {
    t0 = std::min(t0, c.time(0));
    t1 = std::max(t1, c.end());
    peak = std::max(peak, std::abs(c.acceleration[c.peak_index()]));
  }
  if (components.empty() || !(t1 > t0)) t0 = 0.0, t1 = 1.0;
  if (!(peak > 1e-100)) peak = 1.0;
  const double value_step = tick_step(2.0 * peak, 5), time_step = tick_step(t1 - t0, 10);
  const double range = 1.08 * peak;
  const double seconds_per_pixel = (t1 - t0) / plot_width, pixels_per_unit = panel_height / (2.0 * range);
  const auto count = static_cast<double>(components.size());
  const double height = top + count * panel_height + std::max(0.0, count - 1.0) * panel_gap + bottom;

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  double panel = top;
  for (const MotionComponent& c : components) {
    const double zero = panel + panel_height / 2.0;
    svg += fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n", left, panel - 7.0,
                       xml_text(title(c)));
    for (const double t : ticks(t0, t1, time_step)) {
      const double x = left + (t - t0) / seconds_per_pixel;
      svg += fmt::format("<path d=\"M{0:.1f},{1}V{2}\" stroke=\"#ddd\"/>\n", x, panel, panel + panel_height);
    }
    for (const double a : ticks(-range, range, value_step)) {
      const double y = zero - a * pixels_per_unit;
      svg += fmt::format("<path d=\"M{},{:.1f}H{}\" stroke=\"{}\"/>\n", left, y, width - right,
                         a == 0.0 ? "#888" : "#ddd");
      svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.6g}</text>\n", left - 6.0,
                         y + 4.0, a);
    }
    svg += fmt::format(
        "<text transform=\"translate(16,{}) rotate(-90)\" text-anchor=\"middle\">m/s²</text>\n", zero);
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#14507d\" stroke-width=\"0.8\"/>\n",
                       outline(c, t0, seconds_per_pixel, zero, pixels_per_unit));
    const std::size_t at = c.peak_index();
    const double x = left + (c.time(at) - t0) / seconds_per_pixel,
                 y = zero - c.acceleration[at] * pixels_per_unit;
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"none\" stroke=\"#c0392b\" "
        "stroke-width=\"1.5\"/>\n",
        x, y);
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"#c0392b\">{:.3g} m/s² = {:.3g} g at {:.2f} "
        "s</text>\n",
        width - right, panel - 7.0, c.acceleration[at], c.acceleration[at] / standard_gravity, c.time(at));
    panel += panel_height + panel_gap;
  }
  const double axis = height - bottom + 16.0;
  for (const double t : ticks(t0, t1, time_step)) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:.6g}</text>\n",
                       left + (t - t0) / seconds_per_pixel, axis, t);
  }
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">time, s</text>\n</svg>\n",
                     left + plot_width / 2.0, axis + 18.0);
  return svg;
}

}  // namespace keyblock::loading
