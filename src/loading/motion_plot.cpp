#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/svg.h"
#include "core/text.h"
#include "loading/motion_measures.h"
#include "loading/motion_series.h"
#include "loading/svg_chart.h"

namespace keyblock::loading {
namespace {

// The picture, in pixels. A component fits on a screen of 1366 × 768.
constexpr double page_width = 1320.0, legend_height = 34.0, sheet_height = 650.0;
constexpr double left_edge = 78.0, left_width = 720.0, right_edge = 880.0, right_width = 420.0;
constexpr double title_height = 66.0, panel_height = 146.0, panel_gap = 30.0;
constexpr double spectrum_height = 258.0, build_up_height = 178.0;

constexpr int font_size = 12;
constexpr double spectrum_damping = 0.05, shortest_period = 0.02, longest_period = 10.0;
constexpr int spectrum_periods = 120;

struct Way {
  Baseline baseline;
  const char* name;
  const char* color;
  double width;
};
// Drawn in this order; what is recorded lies on top.
constexpr std::array<Way, 4> ways{{{Baseline::taper, "taper", "#009E73", 1.2},
                                   {Baseline::linear, "linear", "#D55E00", 1.2},
                                   {Baseline::demean, "demean", "#0072B2", 1.2},
                                   {Baseline::none, "none: as recorded", "#222222", 1.2}}};
constexpr std::size_t recorded = 3;

using AllSeries = std::array<MotionSeries, ways.size()>;
using Curves = std::array<std::vector<double>, ways.size()>;

std::string sheet_title(const MotionComponent& c) {
  std::string name = std::filesystem::path(c.file).filename().string();
  if (c.vertical) return name + ", up";
  if (c.azimuth) return fmt::format("{}, {}°", name, *c.azimuth);
  constexpr std::size_t longest_label = 60;
  return c.label.empty() ? name : name + ", " + printable(c.label, longest_label);
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Half the height of a panel, for the curves without a drift; the others may leave it when they reach more than three times as far.
double value_range(const Curves& curves) {
  constexpr double far = 3.0, margin = 1.08, least = 1e-100;
  double corrected = 0.0, all = 0.0;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    all = std::max(all, largest(curves[w]));
    const bool is_free = ways[w].baseline == Baseline::demean || ways[w].baseline == Baseline::linear;
    if (is_free) corrected = std::max(corrected, largest(curves[w]));
  }
  const double range = all <= far * corrected ? all : corrected;
  return range > least ? margin * range : 1.0;
}

// "at the end: none 0.01, demean 0, …"
std::string end_values(const Curves& curves, const char* unit) {
  std::string text = "at the end: ";
  for (std::size_t w = ways.size(); w-- > 0;) {
    const std::string_view name = ways[w].name;
    const double end = curves[w].back();
    const double shown = std::abs(end) < 1e-6 * largest(curves[w]) ? 0.0 : end;
    text += fmt::format("{} {:.3g}{}", name.substr(0, name.find(':')), shown, w > 0 ? ", " : "");
  }
  return text + " " + unit;
}

std::string time_panel(ChartFrame frame, std::string_view title, const AllSeries& all, const Curves& curves,
                       bool numbers) {
  const double range = value_range(curves);
  frame.y = {-range, range};
  double all_range = 0.0;
  for (const auto& curve : curves) all_range = std::max(all_range, largest(curve));
  const char* cut = all_range > range ? "; drifts leave the picture" : "";
  std::string svg = draw_frame(frame, fmt::format("{}{}", title, cut), numbers);
  for (std::size_t w = 0; w < ways.size(); ++w)
    svg += draw_curve(frame, all[w].time, curves[w], ways[w].color, ways[w].width);
  return svg;
}

Curves curves_of(const AllSeries& all, std::vector<double> MotionSeries::*what) {
  Curves curves;
  for (std::size_t w = 0; w < ways.size(); ++w) curves[w] = all[w].*what;
  return curves;
}

std::string mark_peak(const ChartFrame& frame, const MotionComponent& c, double range) {
  const std::size_t at = c.peak_index();
  ChartFrame scaled = frame;
  scaled.y = {-range, range};
  return fmt::format(
             "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"none\" stroke=\"#c0392b\" "
             "stroke-width=\"1.5\"/>\n",
             scaled.at_x(c.time(at)), scaled.at_y(c.acceleration[at])) +
         svg_text(frame.left + frame.width, frame.top - 7.0, "end",
                  fmt::format("{:.3g} m/s² = {:.3g} g at {:.2f} s", c.acceleration[at],
                              c.acceleration[at] / standard_gravity, c.time(at)),
                  "fill=\"#c0392b\"");
}

std::string time_panels(const MotionComponent& c, const AllSeries& all, double top) {
  ChartFrame frame{left_edge, top + title_height, left_width, panel_height, {c.time(0), c.end()}, {}};
  const Curves accelerations = curves_of(all, &MotionSeries::acceleration);
  std::string svg = time_panel(frame, "acceleration, m/s²", all, accelerations, false);
  svg += mark_peak(frame, c, value_range(accelerations));
  frame.top += panel_height + panel_gap;
  const Curves velocities = curves_of(all, &MotionSeries::velocity);
  svg += time_panel(frame, "velocity, m/s", all, velocities, false);
  svg += svg_text(frame.left + frame.width, frame.top - 7.0, "end", end_values(velocities, "m/s"));
  frame.top += panel_height + panel_gap;
  const Curves displacements = curves_of(all, &MotionSeries::displacement);
  svg += time_panel(frame, "displacement, m", all, displacements, true);
  svg += svg_text(frame.left + frame.width, frame.top - 7.0, "end", end_values(displacements, "m"));
  return svg + svg_text(frame.left + frame.width / 2.0, frame.top + panel_height + 32.0, "middle", "time, s");
}

std::string spectrum_panel(const AllSeries& all, double top) {
  std::vector<double> periods;
  for (int k = 0; k <= spectrum_periods; ++k)
    periods.push_back(shortest_period *
                      std::pow(longest_period / shortest_period, static_cast<double>(k) / spectrum_periods));
  Curves spectra;
  double most = 0.0;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    spectra[w] = response_spectrum(all[w], periods, spectrum_damping);
    most = std::max(most, largest(spectra[w]));
  }
  const ChartFrame frame{right_edge,
                         top + title_height,
                         right_width,
                         spectrum_height,
                         {shortest_period, longest_period, true},
                         {0.0, most > 0.0 ? 1.08 * most : 1.0}};
  std::string svg = draw_frame(frame, "response spectrum of 5 % damping, m/s²", true);
  for (std::size_t w = 0; w < ways.size(); ++w)
    svg += draw_curve(frame, periods, spectra[w], ways[w].color, ways[w].width + 0.3);
  return svg +
         svg_text(frame.left + frame.width / 2.0, frame.top + frame.height + 32.0, "middle", "period, s");
}

std::string build_up_panel(const MotionComponent& c, const AllSeries& all, double top) {
  const Curves arias = curves_of(all, &MotionSeries::arias);
  double most = 0.0;
  for (const auto& curve : arias) most = std::max(most, curve.back());
  const double bottom = top + title_height + 3.0 * panel_height + 2.0 * panel_gap;
  const ChartFrame frame{right_edge,      bottom - build_up_height, right_width,
                         build_up_height, {c.time(0), c.end()},     {0.0, most > 0.0 ? 1.08 * most : 1.0}};
  std::string svg = draw_frame(frame, "build-up of the Arias intensity, m/s", true);
  for (std::size_t w = 0; w < ways.size(); ++w)
    svg += draw_curve(frame, all[w].time, arias[w], ways[w].color, ways[w].width + 0.3);
  const MotionMeasures m = measure(c);
  svg +=
      svg_text(frame.left + frame.width, frame.top - 7.0, "end",
               fmt::format("{:.3g} m/s, 5 to 95 % in {:.3g} s", m.arias_intensity, m.significant_duration));
  return svg + svg_text(frame.left + frame.width / 2.0, bottom + 32.0, "middle", "time, s");
}

std::string draw_sheet(const MotionComponent& c, double top) {
  const MotionMeasures m = measure(c);
  std::string svg =
      svg_text(left_edge, top + 16.0, "start", sheet_title(c), "font-weight=\"bold\" font-size=\"15\"");
  const std::string jumps = jumps_text(end_jumps(c));
  svg += svg_text(
      left_edge, top + 37.0, "start",
      fmt::format("{}; {} samples{}; PGA {:.3g} g, PGV {:.3g} m/s, Arias intensity {:.3g} m/s", c.format,
                  c.acceleration.size(), c.times.empty() ? fmt::format(", dt {:.6g} s", c.dt) : "",
                  std::abs(m.peak) / standard_gravity, m.peak_velocity, m.arias_intensity));
  if (!jumps.empty())
    svg += svg_text(right_edge + right_width, top + 16.0, "end", "It " + jumps + ".", "fill=\"#c0392b\"");
  if (!(c.end() > c.time(0)) || !std::isfinite(c.end()))
    return svg + svg_text(left_edge, top + title_height, "start", "Nothing can be drawn over time, s");
  AllSeries all;
  for (std::size_t w = 0; w < ways.size(); ++w) all[w] = motion_series(c, ways[w].baseline);
  return svg + time_panels(c, all, top) + spectrum_panel(all, top) + build_up_panel(c, all, top);
}

std::string draw_legend() {
  std::string svg = svg_text(left_edge, 22.0, "start", "baseline:", "fill=\"#333\"");
  double x = left_edge + 70.0;
  for (std::size_t w = ways.size(); w-- > 0;) {
    svg += fmt::format("<path d=\"M{:.1f},18H{:.1f}\" stroke=\"{}\" stroke-width=\"2.5\"/>\n", x, x + 26.0,
                       ways[w].color);
    svg += svg_text(x + 33.0, 22.0, "start", ways[w].name);
    x += w == recorded ? 180.0 : 110.0;
  }
  return svg;
}

}  // namespace

std::string plot_motion_svg(const std::vector<MotionComponent>& components) {
  const double height = legend_height + sheet_height * static_cast<double>(components.size());
  std::string svg = svg_begin(page_width, height, font_size);
  svg += draw_legend();
  double top = legend_height;
  for (const MotionComponent& component : components) {
    svg += draw_sheet(component, top);
    top += sheet_height;
  }
  return svg.append(svg_end);
}

}  // namespace keyblock::loading
