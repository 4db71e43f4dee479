#include "dynamics/intrusions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "dynamics/block_depth.h"

namespace keyblock::dynamics {

Intrusions::Intrusions(std::vector<double> sizes)
    : size_(std::move(sizes)),
      least_size_(size_.empty() ? 0.0 : *std::min_element(size_.begin(), size_.end())) {}

void Intrusions::measure(const Step& step) {
  const contact::Surface& surface = step.surface;
  first_.resize(size_.size());
  differs_.resize(size_.size());
  for (std::size_t b = 0; b < size_.size(); ++b) {
    const std::size_t first = at(surface.block_begin[b]), last = at(surface.block_begin[b + 1]);
    double differs = 0.0;
    for (std::size_t v = first; v < last; ++v)
      differs = std::max(differs, squared_norm(step.displacement[v] - step.displacement[first]));
    first_[b] = step.displacement[first];
    if (!step.prescribed.empty()) first_[b] += step.prescribed[b];
    differs_[b] = std::sqrt(differs);
  }
}

bool Intrusions::comes_in(const Step& step, int vertex, int block, double deepest) const {
  const Vec2 end = step.at_end(at(vertex));
  const double now = depth_in(step.surface, block, end, step.at_end);
  if (now <= deepest || now <= deepest + step.explained(vertex, block)) return false;
  const double before = depth_in(step.surface, block, step.surface.position[at(vertex)],
                                 [&](std::size_t v) { return step.surface.position[v]; });
  return now - before > least_added * deepest;
}

/// Whether no vertex goes far enough in the step to come into any block: most steps end here.
bool Intrusions::all_go_little(const Step& step) const {
  double farthest = 0.0, moved = 0.0;
  for (const Vec2& way : step.displacement) farthest = std::max(farthest, squared_norm(way));
  for (const Vec2& way : step.prescribed) moved = std::max(moved, squared_norm(way));
  return 2.0 * (std::sqrt(farthest) + std::sqrt(moved)) <= least_added * most_share * least_size_;
}

bool Intrusions::any(const Step& step, const contact::CandidateList& candidates) {
  if (all_go_little(step)) return false;
  measure(step);
  for (std::size_t p = 0; p < candidates.block_pairs.size(); ++p) {
    const contact::BlockPair& pair = candidates.block_pairs[p];
    const std::size_t a = at(pair.block_a), b = at(pair.block_b);
    const double deepest = most_share * std::min(size_[a], size_[b]),
                 left = least_added * deepest - differs_[a] - differs_[b];
    if (left >= 0.0 && squared_norm(first_[a] - first_[b]) <= left * left) continue;
    int last = -1;
    for (std::size_t k = at(pair.first); k < candidates.end_of_pair(p); ++k) {
      const contact::Candidate& candidate = candidates.pairs[k];
      if (candidate.vertex == last) continue;  // they come by vertex
      last = candidate.vertex;
      if (comes_in(step, candidate.vertex, candidate.block_b, deepest)) return true;
    }
  }
  return false;
}

bool comes_inside(const Attempt& attempt, const RotationCorrection& rotation, Intrusions& intrusions) {
  const std::function<Vec2(std::size_t)> end = [&](std::size_t v) { return rotation.at_end(attempt, v); };
  const std::function<double(int, int)> explained = [&](int vertex, int block) {
    const int own = attempt.model.surface.block[at(vertex)];
    double closure = 0.0;
    for (std::size_t c = 0; c < attempt.contacts.size(); ++c) {
      const contact::Contact& contact = attempt.contacts[c];
      const bool is_there = contact.block_a == own && contact.block_b == block,
                 is_back = contact.block_a == block && contact.block_b == own;
      if (!(is_there || is_back) || !(attempt.problem.springs().force(c).normal > 0.0)) continue;
      if (is_there && contact.vertex == vertex) return std::numeric_limits<double>::infinity();
      // In statics joints close as a whole. In an impact the neighbours of a vertex that comes in deep are met by no contact yet.
      if (attempt.drive.is_static)
        closure = std::max(closure, contact.depth - dot(contact.normal, attempt.relative[c]));
    }
    return closure;
  };
  return intrusions.any(
      {attempt.model.surface, attempt.displacement, attempt.drive.prescribed, end, explained},
      attempt.state.contacts);
}

}  // namespace keyblock::dynamics
