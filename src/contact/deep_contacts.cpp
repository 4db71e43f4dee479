#include "contact/deep_contacts.h"

#include <array>
#include <cmath>
#include <optional>

#include "geometry/vec2.h"

namespace keyblock::contact {

namespace {

/// m, of the vertex behind the edge at the end of the last step.
double depth_of(const Memory& memory) {
  const bool is_spring = memory.normal_force > 0.0 && memory.stiffness > 0.0 && !(memory.multiplier > 0.0);
  return memory.offset + (is_spring ? memory.normal_force / memory.stiffness : 0.0);
}

bool presses_deeper(const Memory& memory, double depth) {
  return memory.normal_force > 0.0 && !memory.bonded && depth_of(memory) > depth;
}

/// An edge as a line.
struct Line {
  Vec2 start, tangent;
  double length;
  Line(const Surface& surface, int edge) : start(surface.position[at(edge)]) {
    const Vec2 along = surface.position[at(surface.next[at(edge)])] - start;
    length = norm(along);
    tangent = along / length;
  }
  [[nodiscard]] Vec2 normal() const { return {tangent.y, -tangent.x}; }
  [[nodiscard]] double gap(Vec2 p) const { return dot(normal(), p - start); }
  [[nodiscard]] double inside(Vec2 p) const {
    const double along = dot(tangent, p - start);
    return std::min(along, length - along);
  }
};

class Rolling {
 public:
  Rolling(const Surface& surface, const Tolerances& tolerances, std::span<const Contact> contacts,
          CandidateList& list)
      : surface_(surface), tolerances_(tolerances), list_(list) {
    for (const Contact& contact : contacts) shear_stiffness_.push_back(contact.shear_stiffness);
  }

  void run() {
    for (std::size_t k = 0; k < list_.memory.size();) {
      const bool is_given = std::ranges::find(given_, list_.tracked[k]) != given_.end();
      if (!is_given && presses_deeper(list_.memory[k], tolerances_.end_zone) && hand_over(k)) {
        k = 0;  // the order has changed; seldom
      } else {
        ++k;
      }
    }
  }

 private:
  /// From a vertex on, as long as the outline goes on into the line: the vertex there.
  [[nodiscard]] int deepest_from(int vertex, const Line& line) const {
    const Vec2 n = line.normal();
    for (const std::vector<int>* way : {&surface_.next, &surface_.previous}) {
      int v = vertex;
      for (;;) {
        const int other = (*way)[at(v)];
        const Vec2 u = surface_.position[at(other)] - surface_.position[at(v)];
        if (other == vertex || dot(n, u) >= -Tolerances::sine_inside * norm(u)) break;
        v = other;
      }
      if (v != vertex) return v;
    }
    return vertex;
  }

  /// The candidate of a vertex with the edge that it is least deep behind, of those that part blocks as the line does.
  [[nodiscard]] std::optional<int> candidate_of(int vertex, int block, const Line& line) const {
    std::optional<int> found;
    double largest = -HUGE_VAL;
    const Vec2 where = surface_.position[at(vertex)];
    for (const int p : list_.pairs_of(block)) {
      const auto [first, last] = list_.of_vertex(at(p), vertex);
      for (std::size_t k = first; k < last; ++k) {
        const Line other(surface_, list_.pairs[k].edge);
        const double gap = other.gap(where);
        if (dot(other.normal(), line.normal()) < Tolerances::cosine_alike || gap >= 0.0 || gap <= largest ||
            other.inside(where) < -tolerances_.end_zone)
          continue;
        largest = gap;
        found = static_cast<int>(k);
      }
    }
    return found;
  }

  /// m, of the normal spring, as the energy has it that is stored.
  [[nodiscard]] double stretch_of(std::size_t k) const {
    const Memory& memory = list_.memory[k];
    const double of_shear = 0.5 * shear_stiffness_[k] * memory.shear * memory.shear;
    return std::sqrt(2.0 * std::max(0.0, memory.stored - of_shear) / memory.stiffness);
  }

  bool hand_over(std::size_t k) {
    const Candidate from = list_.pairs[at(list_.tracked[k])];
    const Line line(surface_, from.edge);
    const double stretch = stretch_of(k), shear = shear_stiffness_[k];
    if (!(-line.gap(surface_.position[at(from.vertex)]) > tolerances_.end_zone) || !(stretch > 0.0))
      return false;
    const int next = deepest_from(from.vertex, line);
    if (next == from.vertex || surface_.is_reflex(at(next))) return false;
    const std::optional<int> to = candidate_of(next, from.block_a, line);
    if (!to) return false;
    const Memory memory = list_.memory[k];
    const auto place = static_cast<std::ptrdiff_t>(k);
    list_.tracked.erase(list_.tracked.begin() + place);
    list_.memory.erase(list_.memory.begin() + place);
    shear_stiffness_.erase(shear_stiffness_.begin() + place);
    give(*to, memory, stretch, shear);
    return true;
  }

  /// A contact of the last step to a candidate. What no spring keeps of its energy is lost: numerical, as what contacts lose that end.
  void give(int candidate, Memory given, double stretch, double shear_stiffness) {
    const Candidate& c = list_.pairs[at(candidate)];
    const double depth = -Line(surface_, c.edge).gap(surface_.position[at(c.vertex)]);
    const auto place = std::ranges::lower_bound(list_.tracked, candidate);
    const auto k = place - list_.tracked.begin();
    list_.pairs[at(candidate)].clearance = 0.0;
    given_.push_back(candidate);
    if (place == list_.tracked.end() || *place != candidate) {
      const double kept = std::min(stretch, depth - std::min(given.offset, 0.0));
      given.offset = depth - kept;
      given.stored -= 0.5 * given.stiffness * (stretch * stretch - kept * kept);
      list_.tracked.insert(place, candidate);
      list_.memory.insert(list_.memory.begin() + k, given);
      shear_stiffness_.insert(shear_stiffness_.begin() + k, shear_stiffness);
      return;
    }
    Memory& own = list_.memory[static_cast<std::size_t>(k)];
    if (own.bonded) return;
    const double before = stretch_of(static_cast<std::size_t>(k)), room = std::max(0.0, own.offset),
                 both = std::sqrt(before * before + stretch * stretch * given.stiffness / own.stiffness),
                 now = std::min(both, before + room);
    own.offset -= now - before;
    own.stored += 0.5 * own.stiffness * (now * now - before * before);
    own.normal_force = std::max(own.normal_force, own.stiffness * now);
    own.bounding_force = std::max(own.bounding_force, own.normal_force);
  }

  const Surface& surface_;
  const Tolerances& tolerances_;
  CandidateList& list_;
  std::vector<double> shear_stiffness_;  ///< N/m per thickness, of each memory
  std::vector<int> given_;               ///< candidates that have taken over: each contact goes on once
};

}  // namespace

std::vector<double> pressed_depths(const CandidateList& candidates, const Tolerances& tolerances,
                                   std::size_t blocks) {
  std::vector<double> depths;
  const double least = 0.5 * tolerances.depth_limit;
  for (std::size_t k = 0; k < candidates.memory.size(); ++k) {
    if (!presses_deeper(candidates.memory[k], least)) continue;
    depths.resize(blocks, 0.0);
    const Candidate& c = candidates.pairs[at(candidates.tracked[k])];
    for (const int block : {c.block_a, c.block_b})
      depths[at(block)] = std::max(depths[at(block)], depth_of(candidates.memory[k]));
  }
  return depths;
}

void hand_over_to_next_vertices(const Surface& surface, const Tolerances& tolerances,
                                std::span<const Contact> contacts, CandidateList& candidates) {
  const bool any = std::ranges::any_of(
      candidates.memory, [&](const Memory& memory) { return presses_deeper(memory, tolerances.end_zone); });
  if (any) Rolling(surface, tolerances, contacts, candidates).run();
}

}  // namespace keyblock::contact
