#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::loading {

/// From the least value to the largest; with `log`, both above 0, in decades.
struct ChartAxis {
  double from = 0.0, to = 1.0;
  bool log = false;
};

/// One diagram of a picture, in pixels, y downwards.
struct ChartFrame {
  double left = 0.0, top = 0.0, width = 100.0, height = 100.0;
  ChartAxis x, y;

  [[nodiscard]] double at_x(double value) const;
  [[nodiscard]] double at_y(double value) const;
};

/// Values that a scale is labelled with, few whatever the numbers are: multiples of 1, 2 or 5 times a power of ten, on a logarithmic
/// axis these in every decade.
std::vector<double> chart_ticks(const ChartAxis& axis, int most);

/// Lines and numbers of both scales, with a title above; numbers of the x-axis where `numbers` holds.
std::string draw_frame(const ChartFrame& frame, std::string_view title, bool numbers);

/// A line through the points; stretches above or below the frame are left out. For more points than pixels it is their outline: of every half pixel the
/// lowest and the highest.
std::string draw_curve(const ChartFrame& frame, const std::vector<double>& x, const std::vector<double>& y,
                       std::string_view color, double width);

}  // namespace keyblock::loading
