#include "contact/deep_contacts.h"

#include "geometry/vec2.h"

namespace keyblock::contact {

namespace {

/// m, how far the normal spring is pressed; 0: it is a bond.
double stretch_of(const Memory& memory) {
  const bool is_spring = memory.normal_force > 0.0 && memory.stiffness > 0.0 && !memory.bonded;
  return is_spring ? memory.normal_force / memory.stiffness : 0.0;
}

/// m, of the vertex behind the edge at the end of the last step.
double depth_of(const Memory& memory) {
  return memory.offset + stretch_of(memory);
}

/// Outward, not of unit length.
Vec2 normal_of(const Surface& surface, int edge) {
  const Vec2 along = surface.position[at(surface.next[at(edge)])] - surface.position[at(edge)];
  return {along.y, -along.x};
}

bool are_alike(Vec2 one, Vec2 other) {
  return dot(one, other) > Tolerances::cosine_alike * norm(one) * norm(other);
}

}  // namespace

std::vector<double> pressed_depths(const CandidateList& candidates, const Tolerances& tolerances,
                                   std::size_t blocks) {
  std::vector<double> depths;
  const double least = 0.5 * tolerances.depth_limit;
  for (std::size_t k = 0; k < candidates.memory.size(); ++k) {
    const Memory& memory = candidates.memory[k];
    if (!(memory.normal_force > 0.0) || memory.bonded || !(depth_of(memory) > least)) continue;
    depths.resize(blocks, 0.0);
    const Candidate& c = candidates.pairs[at(candidates.tracked[k])];
    for (const int block : {c.block_a, c.block_b})
      depths[at(block)] = std::max(depths[at(block)], depth_of(memory));
  }
  return depths;
}

std::vector<int> deep_contacts(const CandidateList& candidates, const Tolerances& tolerances) {
  std::vector<int> deep;
  for (std::size_t k = 0; k < candidates.memory.size(); ++k) {
    const Memory& memory = candidates.memory[k];
    if (std::min(stretch_of(memory), depth_of(memory)) > tolerances.end_zone)
      deep.push_back(candidates.tracked[k]);
  }
  return deep;
}

SidesOfVertex sides_to_deep(const Surface& surface, const CandidateList& candidates,
                            std::span<const int> deep, const Candidate& candidate) {
  const Vec2 normal = normal_of(surface, candidate.edge);
  const auto is_deep = [&](int vertex, int edge) {
    return std::ranges::any_of(deep, [&](int k) {
      const Candidate& c = candidates.pairs[at(k)];
      const Vec2 other = normal_of(surface, c.edge);
      return (c.vertex == vertex && are_alike(normal, other)) ||
             (c.edge == edge && are_alike(normal, -1.0 * other));
    });
  };
  const auto leads_to_deep = [&](bool forward) {
    for (int v = candidate.vertex;;) {
      const int other = (forward ? surface.next : surface.previous)[at(v)];
      const bool goes_in = dot(normal, surface.position[at(other)] - surface.position[at(v)]) < 0.0;
      if (!goes_in || other == candidate.vertex) return false;
      if (is_deep(other, forward ? v : other)) return true;
      v = other;
    }
  };
  return {leads_to_deep(true), leads_to_deep(false)};
}

}  // namespace keyblock::contact
