#include "loading/significant_window.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace keyblock::loading {
namespace {

constexpr double share_before = 0.001, share_after = 0.999;
constexpr double margin = 5.0;  // s

/// What a piece between two samples adds to ∫ a² dt.
struct WindowPiece {
  double end;
  double adds;
};

}  // namespace

std::pair<double, double> significant_window(std::span<const MotionComponent* const> components) {
  std::vector<WindowPiece> pieces;
  double begin = HUGE_VAL, end = -HUGE_VAL, all = 0.0;
  for (const MotionComponent* c : components) {
    begin = std::min(begin, c->time(0));
    end = std::max(end, c->end());
    for (std::size_t k = 1; k < c->acceleration.size(); ++k) {
      const double p = c->acceleration[k - 1], q = c->acceleration[k];
      pieces.push_back({c->time(k), (c->time(k) - c->time(k - 1)) / 3.0 * (p * p + p * q + q * q)});
      all += pieces.back().adds;
    }
  }
  std::ranges::stable_sort(pieces, {}, &WindowPiece::end);
  double from = begin, to = end, sum = 0.0;
  bool has_begun = false;
  for (const WindowPiece& piece : pieces) {
    sum += piece.adds;
    if (!has_begun && sum >= share_before * all) {
      from = piece.end;
      has_begun = true;
    }
    if (sum < share_after * all) continue;
    to = piece.end;
    break;
  }
  return {std::max(begin, from - margin), std::min(end, to + margin)};
}

}  // namespace keyblock::loading
