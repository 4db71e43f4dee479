#include "dynamics/contact_audit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "dynamics/block_depth.h"

namespace keyblock::dynamics {

namespace {

void take_farther(VertexPlace& place, const VertexPlace& other) {
  if (other.distance > place.distance) place = other;
}

/// m², of a point from a segment.
double squared_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a, from = p - a;
  const double s = std::clamp(dot(from, along) / squared_norm(along), 0.0, 1.0);
  return squared_norm(from - s * along);
}

class Audit {
 public:
  explicit Audit(const TakenStep& step) : step_(step) {}

  ContactAudit run() {
    const contact::CandidateList& list = step_.contacts;
    const std::vector<Vec2>& position = step_.surface.position;
    const double zone = step_.end_zone * step_.end_zone;
    for (std::size_t k = 0; k < list.tracked.size(); ++k) {
      if (!(list.memory[k].normal_force > 0.0)) continue;
      const contact::Candidate& c = list.pairs[at(list.tracked[k])];
      // On its edge, nearly all are.
      if (squared_distance(position[at(c.vertex)], position[at(c.edge)],
                           position[at(step_.surface.next[at(c.edge)])]) > zone)
        look_at(k, c);
    }
    return found_;
  }

 private:
  void look_at(std::size_t k, const contact::Candidate& c) {
    const Vec2 where = step_.surface.position[at(c.vertex)];
    const double depth = depth_of(where, c.block_b), offset = step_.contacts.memory[k].offset;
    if (depth > 0.0) {
      take_farther(found_.deepest, {depth, c.block_a, c.block_b, where});
      take_farther(found_.unexplained, {std::min(depth, offset), c.block_a, c.block_b, where});
      return;
    }
    const double near = near_enough(k);
    if (-depth <= near || -depth <= near + depth_in_others(c, where) || shares_pressure(k)) return;
    ++found_.across_gaps;
    take_farther(found_.farthest, {-depth, c.block_a, c.block_b, where});
  }

  /// m, that the vertex of a contact that presses may be outside.
  [[nodiscard]] double near_enough(std::size_t k) const {
    const contact::Candidate& c = step_.contacts.pairs[at(step_.contacts.tracked[k])];
    return step_.end_zone + step_.reach[at(c.block_a)] + step_.reach[at(c.block_b)] +
           norm(step_.relative[k]) + std::max(0.0, -step_.contacts.memory[k].offset);
  }
  [[nodiscard]] double depth_of(Vec2 where, int block) const {
    return depth_in(step_.surface, block, where, [&](std::size_t v) { return step_.surface.position[v]; });
  }

  /// Whether the contact has its force of the pressure of a face (contact::JointFaces) that is closed at another contact of the same blocks.
  [[nodiscard]] bool shares_pressure(std::size_t k) const {
    const contact::CandidateList& list = step_.contacts;
    if (!list.memory[k].in_face) return false;
    const auto blocks = [&](std::size_t i) {
      const contact::Candidate& c = list.pairs[at(list.tracked[i])];
      return std::pair(std::min(c.block_a, c.block_b), std::max(c.block_a, c.block_b));
    };
    const auto is_closed = [&](std::size_t i) {
      const contact::Candidate& c = list.pairs[at(list.tracked[i])];
      return i != k && list.memory[i].in_face && list.memory[i].normal_force > 0.0 &&
             depth_of(step_.surface.position[at(c.vertex)], c.block_b) >= -near_enough(i);
    };
    std::size_t first = k, end = k + 1;
    while (first > 0 && blocks(first - 1) == blocks(k)) --first;
    while (end < list.tracked.size() && blocks(end) == blocks(k)) ++end;
    for (std::size_t i = first; i < end; ++i) {
      if (is_closed(i)) return true;
    }
    return false;
  }
  /// m, of the vertex in the block, beside block_b, in which it is deepest; 0: in none.
  [[nodiscard]] double depth_in_others(const contact::Candidate& c, Vec2 where) const {
    double deepest = 0.0;
    for (const int p : step_.contacts.pairs_of(c.block_a)) {
      const contact::BlockPair& pair = step_.contacts.block_pairs[at(p)];
      const int other = pair.block_a == c.block_a ? pair.block_b : pair.block_a;
      if (other != c.block_b) deepest = std::max(deepest, depth_of(where, other));
    }
    return deepest;
  }

  const TakenStep& step_;
  ContactAudit found_;
};

}  // namespace

void ContactAudit::add(const ContactAudit& other) {
  across_gaps += other.across_gaps;
  take_farther(farthest, other.farthest);
  take_farther(deepest, other.deepest);
  take_farther(unexplained, other.unexplained);
}

ContactAudit audit_contacts(const TakenStep& step) {
  return Audit(step).run();
}

}  // namespace keyblock::dynamics
