#include "study/hold_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/index.h"
#include "study/limit_words.h"

namespace keyblock::study {
namespace {

using record::BlockStatus;

constexpr double drawing_width = 640.0, line_height = 20.0;  // px
constexpr int legend_digits = 4;
/// From what goes first to what goes last; the order is seen without colours, too.
constexpr std::array<std::array<double, 3>, 4> ramp{
    {{103, 0, 13}, {203, 24, 29}, {251, 106, 74}, {254, 224, 210}}};

std::string ramp_color(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (ramp.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
  const auto channel = [&](std::size_t c) {
    return static_cast<int>(
        std::lround(std::lerp(ramp[k][c], ramp[k + 1][c], place - static_cast<double>(k))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2));
}

bool is_gone(BlockStatus status) {
  return status == BlockStatus::loosened || status == BlockStatus::fallen;
}

Vec2 middle_of(const MapGrid& grid, std::size_t cell) {
  const std::size_t row = cell / at(grid.columns), column = cell % at(grid.columns);
  return grid.corner + grid.cell * Vec2{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
}

/// What cells hold, and how it is drawn.
class Picture {
 public:
  Picture(const HoldMap& map, const LimitResult& result) : map_(map), result_(result) {
    for (std::size_t c = 0; c < map.holds.size(); ++c)
      if (map.holds[c]) levels_.push_back(*map.holds[c]);
    const bool rises = result.request.from < result.request.to;
    std::ranges::sort(levels_, [&](double a, double b) { return rises ? a < b : a > b; });
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
  }

  [[nodiscard]] std::string draw() const {
    const double height = scale() * map_.grid.cell * map_.grid.rows;
    std::string svg = fmt::format(
        "<svg class=\"plot\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"Up to which value rock "
        "holds\">",
        drawing_width, height + line_height * static_cast<double>(levels_.size() + 1) + 5.0);
    svg += group(ramp_color(0.0), [&](std::size_t c) { return map_.lost[c]; });
    for (const double level : levels_)
      svg += group(color_of(level), [&](std::size_t c) { return map_.holds[c] == level; });
    return svg + outlines() + legend(height) + "</svg>";
  }

 private:
  [[nodiscard]] double scale() const { return drawing_width / (map_.grid.cell * map_.grid.columns); }
  [[nodiscard]] Vec2 place(Vec2 p) const {
    const Vec2 from = p - map_.grid.corner;
    return {scale() * from.x, scale() * (map_.grid.cell * map_.grid.rows - from.y)};
  }
  [[nodiscard]] std::string color_of(double level) const {
    const auto k = std::ranges::find(levels_, level) - levels_.begin();
    return ramp_color(static_cast<double>(k + 1) / static_cast<double>(levels_.size() + 1));
  }

  template <class Is>
  [[nodiscard]] std::string group(const std::string& fill, const Is& is) const {
    std::string path;
    const double side = scale() * map_.grid.cell;
    for (std::size_t c = 0; c < map_.holds.size(); ++c) {
      if (!is(c)) continue;
      const Vec2 p = place(middle_of(map_.grid, c));
      path += fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", p.x - 0.5 * side, p.y - 0.5 * side, side,
                          side, -side);
    }
    return path.empty() ? path : fmt::format("<path fill=\"{}\" d=\"{}\"/>", fill, path);
  }

  [[nodiscard]] std::string outlines() const {
    std::string path;
    for (const Ring& ring : map_.outlines) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 p = place(ring[k]);
        path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', p.x, p.y);
      }
      path += ring.empty() ? "" : "Z";
    }
    return path.empty() ? path : fmt::format("<path class=\"axis\" fill=\"none\" d=\"{}\"/>", path);
  }

  [[nodiscard]] std::string legend(double top) const {
    std::string svg;
    double y = top + 5.0;
    const auto line = [&](const std::string& fill, const std::string& text) {
      svg += fmt::format(
          "<rect x=\"0\" y=\"{0:.0f}\" width=\"14\" height=\"14\" fill=\"{1}\"/><text x=\"22\" "
          "y=\"{2:.0f}\">{3}</text>",
          y, fill, y + 12.0, text);
      y += line_height;
    };
    if (std::ranges::find(map_.lost, true) != map_.lost.end())
      line(ramp_color(0.0),
           "goes at " + quantity(result_.request.from, result_.unit, legend_digits) + " already");
    for (const double level : levels_)
      line(color_of(level), "holds to " + quantity(level, result_.unit, legend_digits));
    return svg;
  }

  const HoldMap& map_;
  const LimitResult& result_;
  std::vector<double> levels_;  ///< from `from` on
};

}  // namespace

bool HoldMap::empty() const {
  return std::ranges::none_of(holds, [](const auto& value) { return value.has_value(); }) &&
         std::ranges::find(lost, true) == lost.end();
}

HoldMap hold_map(const MapGrid& grid, const std::vector<Ring>& outlines, double from,
                 std::vector<std::pair<double, const std::vector<BlockStatus>*>> trials) {
  std::ranges::sort(trials, [&](const auto& a, const auto& b) {
    return std::abs(a.first - from) < std::abs(b.first - from);
  });
  HoldMap map{grid, outlines, {}, {}};
  const std::size_t cells = at(grid.columns) * at(grid.rows);
  map.holds.resize(cells);
  map.lost.resize(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    const auto goes = std::ranges::find_if(
        trials, [&](const auto& trial) { return c < trial.second->size() && is_gone((*trial.second)[c]); });
    if (goes == trials.end()) continue;
    map.lost[c] = goes == trials.begin();
    if (!map.lost[c]) map.holds[c] = std::prev(goes)->first;
  }
  return map;
}

std::string hold_map_csv(const HoldMap& map) {
  std::string text = "x_m,y_m,holds_to\n";
  for (std::size_t c = 0; c < map.holds.size(); ++c) {
    if (!map.holds[c] && !map.lost[c]) continue;
    const Vec2 p = middle_of(map.grid, c);
    text += fmt::format("{:.9g},{:.9g},{}\n", p.x, p.y, map.holds[c] ? fmt::format("{}", *map.holds[c]) : "");
  }
  return text;
}

std::string hold_map_svg(const HoldMap& map, const LimitResult& result) {
  return map.empty() ? std::string() : Picture(map, result).draw();
}

}  // namespace keyblock::study
