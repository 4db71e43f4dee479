// Systems of the neighbourhood of some blocks.
#include <algorithm>
#include <utility>

#include "linalg/block_conjugate_residual.h"

namespace keyblock::linalg {

namespace {

/// Blocks that a change is followed over. What it does beyond is left over in the residual.
constexpr int layers = 6;
/// Share of the blocks, beyond which a system of all takes little more.
constexpr double most_share = 0.3;

}  // namespace

/// Some blocks, and those so many layers around them. False where they are so many that all are as well.
bool BlockConjugateResidual::collect_near(std::span<const std::size_t> blocks) {
  const auto most = static_cast<std::size_t>(most_share * static_cast<double>(place_.size()));
  if (blocks.size() > most) return false;
  near_.places.clear();
  near_.has.assign(place_.size(), 0);
  const auto reach = [&](std::size_t place) {
    if (near_.has[place] != 0) return;
    near_.has[place] = 1;
    near_.places.push_back(static_cast<std::uint32_t>(place));
  };
  for (const std::size_t block : blocks) reach(place_[block]);
  std::size_t next = 0;
  for (int layer = 0; layer < layers; ++layer) {
    for (const std::size_t end = near_.places.size(); next < end; ++next) {
      for (const std::uint32_t place : neighbours(near_.places[next])) reach(place);
    }
    if (near_.places.size() > most) return false;
  }
  near_.edge.clear();
  for (; next < near_.places.size(); ++next) {
    for (const std::uint32_t place : neighbours(near_.places[next])) {
      if (near_.has[place] != 0) continue;
      near_.has[place] = at_edge;
      near_.edge.push_back(place);
    }
  }
  near_.places.clear();  // to have them in order
  for (std::size_t place = 0; place < near_.has.size(); ++place) {
    if (near_.has[place] == 1) near_.places.push_back(static_cast<std::uint32_t>(place));
  }
  near_.begin.assign(1, 0);
  for (std::size_t piece = 1; piece < begin_.size(); ++piece) {
    const auto end = std::lower_bound(near_.places.begin(), near_.places.end(), begin_[piece]);
    const auto here = static_cast<std::size_t>(end - near_.places.begin());
    // That between the parts comes first, be it empty.
    if (piece == 1 || here > near_.begin.back()) near_.begin.push_back(here);
  }
  return true;
}

bool BlockConjugateResidual::find_near(std::span<const std::size_t> blocks, Reach& reach) {
  if (!collect_near(blocks)) return false;
  reach.moved = near_.places.size();
  reach.blocks.clear();
  for (const auto* places : {&near_.places, &near_.edge}) {
    for (const std::size_t place : *places) reach.blocks.push_back(at(block_at_[place]));
  }
  return true;
}

void BlockConjugateResidual::solve_near(std::span<double> x, std::span<double> residual,
                                        const Excess& excess) {
  estimate_.resize(x.size());
  for (const auto* places : {&near_.places, &near_.edge}) {
    for (const std::size_t place : *places) {
      for (std::size_t k = offset_[place]; k < offset_[place] + at(size_[place]); ++k)
        estimate_[k] = residual[k] = std::exchange(x[k], 0.0);
    }
  }
  is_near_ = true;
  lag_.swap(lag_near_);
  solved_ = true;
  if (const double too_large = excess(residual); too_large > 1.0) {
    start(residual);
    const Iterations taken = iterate(too_large, excess, most_iterations);
    take_over(x, residual, Residual::exact);
    // What is left over beyond may be more than there was, unless the iteration came to nothing.
    solved_ = excess(residual) < (taken.enough ? most_growth : 1.0) * too_large;
  }
  lag_.swap(lag_near_);
  is_near_ = false;
}

}  // namespace keyblock::linalg
