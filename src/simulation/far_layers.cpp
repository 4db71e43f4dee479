#include "simulation/far_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/build_boundary.h"

namespace keyblock::simulation {

namespace {

using dynamics::RockLayer;

constexpr double share_of_width = 0.25, blocks_wide = 6.0;  // of a strip
constexpr double least_filled = 0.9;                        // of a strip, by blocks
constexpr double one_layer = 1.03;                          // impedances of bands that are one layer
constexpr double alike_sides = 1.15;                        // impedances of sides that are one
constexpr double jump = 1.5;    // of compliances, where a band ends without a change of the rock
constexpr double slice = 0.25;  // of a block, in which a change is looked for
constexpr int most_slices = 200;
constexpr double steepest = 0.36;  // slope of the border of a layer, 20 degrees

double contrast_of(const RockLayer& a, const RockLayer& b) {
  const Vec2 first = a.impedance(), second = b.impedance();
  const auto ratio = [](double x, double y) { return std::max(x, y) / std::min(x, y); };
  return std::max(ratio(first.x, second.x), ratio(first.y, second.y));
}

class Strips {
 public:
  Strips(const RunSetup& setup, std::span<const JointPiece> pieces)
      : setup_(setup), pieces_(pieces), size_(mean_block_size(setup)) {
    const Box box = boundary_box(setup);
    width_ = std::min(std::max(share_of_width * box.size().x, blocks_wide * size_), 0.5 * box.size().x);
    const ColumnHeights left = column_heights(setup, ColumnSide::left),
                        right = column_heights(setup, ColumnSide::right);
    const double depth = setup.boundary->depth;
    boxes_ = {Box{{box.min.x, box.min.y}, {box.min.x + width_, left.ground - depth}},
              Box{{box.max.x - width_, box.min.y}, {box.max.x, right.ground - depth}}};
  }

  FarLayers measure() const {
    FarLayers far;
    for (const bool right : {false, true}) {
      if (far.gap.empty()) far.gap = gap(right);
    }
    const RockSample all = sample({0, 1}, bottom(), top({0, 1}));
    far.source = fmt::format("{} blocks and {:.3g} m of joints in the outer {:.3g} m", all.blocks(),
                             all.joint_length(), width_);
    far.left = layers({0, 1});
    for (std::size_t k = 0; k < far.left.size(); ++k) {
      const double low = k + 1 < far.left.size() ? far.left[k + 1].top : bottom();
      const auto left = sample({0}, low, far.left[k].top).layer(0.0),
                 right = sample({1}, low, far.left[k].top).layer(0.0);
      if (left && right) far.contrast = std::max(far.contrast, contrast_of(*left, *right));
    }
    if (far.contrast <= alike_sides) return far;
    far.left = layers({0});
    far.right = layers({1});
    return far;
  }

 private:
  using Sides = std::vector<std::size_t>;

  [[nodiscard]] double bottom() const { return boxes_[0].min.y; }
  [[nodiscard]] double top(const Sides& sides) const {
    double highest = bottom();
    for (const std::size_t s : sides) highest = std::max(highest, boxes_[s].max.y);
    return highest;
  }
  [[nodiscard]] RockSample sample(const Sides& sides, double low, double high) const {
    const auto part = [&](std::size_t s) {
      Box box = boxes_[s];
      box.max.y = std::min(high, box.max.y);
      box.min.y = std::min(low, box.max.y);
      return RockSample(setup_, pieces_, box);
    };
    RockSample sum = part(sides.front());
    for (std::size_t k = 1; k < sides.size(); ++k) sum += part(sides[k]);
    return sum;
  }

  [[nodiscard]] std::string gap(bool right) const {
    constexpr int pieces = 10;
    const Box& box = boxes_[right ? 1 : 0];
    const Sides side{right ? std::size_t{1} : std::size_t{0}};
    if (sample(side, box.min.y, box.max.y).filled() >= least_filled) return "";
    double worst = HUGE_VAL, from = box.min.y, height = box.size().y / pieces;
    for (int k = 0; k < pieces; ++k) {
      const double low = box.min.y + k * height, filled = sample(side, low, low + height).filled();
      if (filled >= worst) continue;
      worst = filled;
      from = low;
    }
    const double origin = setup_.system.origin.y;
    return fmt::format("{} side, {:.4g} to {:.4g} m", right ? "right" : "left", from + origin,
                       from + height + origin);
  }

  /// Heights at which the rock of the blocks changes, and the two ends.
  [[nodiscard]] std::vector<double> ends(const Sides& sides) const {
    struct Border {
      double height, length;
    };
    std::vector<Border> borders;
    for (const JointPiece& piece : pieces_) {
      if (setup_.properties[piece.a].material == setup_.properties[piece.b].material) continue;
      const Vec2 way = piece.to - piece.from, middle = lerp(piece.from, piece.to, 0.5);
      const bool is_level = std::abs(way.y) <= steepest * std::abs(way.x),
                 is_inside = std::ranges::any_of(
                     sides, [&](std::size_t s) { return boxes_[s].grown(0.01 * size_).contains(middle); });
      if (is_level && is_inside) borders.push_back({middle.y, norm(way)});
    }
    std::ranges::sort(borders, {}, &Border::height);
    std::vector<double> heights{bottom()};
    for (std::size_t k = 0; k < borders.size();) {
      double sum = 0.0, length = 0.0;
      const double first = borders[k].height;
      for (; k < borders.size() && borders[k].height <= first + size_; ++k) {
        sum += borders[k].height * borders[k].length;
        length += borders[k].length;
      }
      const double height = sum / length;
      if (height > heights.back() + 0.5 * size_ && height < top(sides) - 0.5 * size_)
        heights.push_back(height);
    }
    heights.push_back(top(sides));
    return heights;
  }

  /// Where the sum of compliances from below goes farthest from a straight line, if it bends there by enough.
  void divide(const Sides& sides, double low, double high, std::vector<double>& heights) const {
    const int count = std::min(most_slices, static_cast<int>((high - low) / (slice * size_)));
    const double least = 2.0 * size_;
    if (!(high - low >= 2.0 * least) || count < 2) return;
    std::vector<double> sum{0.0};
    const auto at = [&](int k) { return std::lerp(low, high, static_cast<double>(k) / count); };
    for (int k = 0; k < count; ++k)
      sum.push_back(sum.back() + sample(sides, at(k), at(k + 1)).shear_compliance() * (at(k + 1) - at(k)));
    double farthest = 0.0;
    int where = 0;
    for (int k = 1; k < count; ++k) {
      if (at(k) - low < least || high - at(k) < least) continue;
      const double away = std::abs(sum[static_cast<std::size_t>(k)] - sum.back() * k / count);
      if (away <= farthest) continue;
      farthest = away;
      where = k;
    }
    if (where == 0) return;
    const double below = sum[static_cast<std::size_t>(where)] / where,
                 above = (sum.back() - sum[static_cast<std::size_t>(where)]) / (count - where);
    if (std::max(below, above) < jump * std::min(below, above)) return;
    divide(sides, low, at(where), heights);
    heights.push_back(at(where));
    divide(sides, at(where), high, heights);
  }

  [[nodiscard]] std::vector<RockLayer> layers(const Sides& sides) const {
    const std::vector<double> given = ends(sides);
    std::vector<double> heights;
    for (std::size_t k = 0; k + 1 < given.size(); ++k) {
      heights.push_back(given[k]);
      divide(sides, given[k], given[k + 1], heights);
    }
    heights.push_back(given.back());
    // Bands that are alike are measured as one.
    for (std::size_t k = 1; k + 1 < heights.size();) {
      const auto below = sample(sides, heights[k - 1], heights[k]).layer(0.0),
                 above = sample(sides, heights[k], heights[k + 1]).layer(0.0);
      if (below && above && contrast_of(*below, *above) > one_layer)
        ++k;
      else
        heights.erase(heights.begin() + static_cast<std::ptrdiff_t>(k));
    }
    std::vector<RockLayer> from_above;
    for (std::size_t k = heights.size() - 1; k-- > 0;) {
      if (const auto layer = sample(sides, heights[k], heights[k + 1]).layer(heights[k + 1]))
        from_above.push_back(*layer);
    }
    return from_above;
  }

  const RunSetup& setup_;
  std::span<const JointPiece> pieces_;
  double size_, width_ = 0.0;
  std::vector<Box> boxes_;
};

}  // namespace

FarLayers far_layers(const RunSetup& setup, std::span<const JointPiece> pieces) {
  return Strips(setup, pieces).measure();
}

}  // namespace keyblock::simulation
