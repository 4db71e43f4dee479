#include "contact/detection.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/index.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t worth_threads = 10'000;  // vertices, candidates or contacts
constexpr std::size_t piece = 4'096;           // candidates

/// Whether the edge from v to `other` lies outside the line, up to the angle tolerance.
bool outside(const Surface& surface, Vec2 v, int other, Vec2 normal) {
  const Vec2 u = surface.position[at(other)] - v;
  const double along = dot(normal, u);
  return along >= 0.0 || along * along <= Tolerances::sine_inside * Tolerances::sine_inside * squared_norm(u);
}

/// Length over [0, edge_length] that the edge of the vertex towards `other` shares with an edge it faces.
double shared_length(const Surface& surface, Vec2 v, int other, Vec2 a, Vec2 normal, Vec2 tangent,
                     double edge_length) {
  const Vec2 u = surface.position[at(other)] - v;
  const double across = dot(normal, u);
  if (across * across > Tolerances::sine_facing * Tolerances::sine_facing * squared_norm(u)) return 0.0;
  const double from = dot(v - a, tangent), to = from + dot(u, tangent);
  const double low = std::max(0.0, std::min(from, to)), high = std::min(edge_length, std::max(from, to));
  return std::max(0.0, high - low);
}

}  // namespace

void Detection::measure_edges(const Surface& surface, ThreadTeam& team) {
  lines_.resize(surface.position.size());
  team.for_range(lines_.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Vec2 along = surface.position[at(surface.next[e])] - surface.position[e];
      const double length = norm(along);
      lines_[e] = {along / length, length};
    }
  });
}

bool Detection::passes(const Surface& surface, std::span<const double> reach, const Candidate& c, bool bonded,
                       Found& found) const {
  const Vec2 a = surface.position[at(c.edge)], v = surface.position[at(c.vertex)];
  const Line& line = lines_[at(c.edge)];
  const Vec2 normal = line.normal();
  const double gap = dot(normal, v - a), along = dot(line.tangent, v - a), length = line.length;
  const int block_a = c.block_a, block_b = c.block_b;
  const double motion = reach[at(block_a)] + reach[at(block_b)];
  if (!bonded && gap > tolerances_.activation + motion) return false;
  const double deepest =
      std::min({tolerances_.depth_limit, surface.thickness[at(block_a)], surface.thickness[at(block_b)]});
  if (gap < -deepest) return false;
  const int end = surface.next[at(c.edge)];
  const double zone = std::min(tolerances_.end_zone + motion, 0.5 * length);
  const double before = surface.reflex[at(c.edge)] ? std::max(deepest, zone) : zone;
  const double after = surface.reflex[at(end)] ? std::max(deepest, zone) : zone;
  if (along < -before || along > length + after) return false;
  if (!outside(surface, v, surface.previous[at(c.vertex)], normal) ||
      !outside(surface, v, surface.next[at(c.vertex)], normal))
    return false;

  found.gap = gap;
  found.along = along;
  found.low = found.high = -1;
  const int corner = along < 0.5 * length ? c.edge : end;
  if (inside(along, length) < zone && !surface.reflex[at(corner)])
    std::tie(found.low, found.high) = std::minmax(c.vertex, corner);
  return true;
}

/// Orders those near corners by their two corners.
void Detection::sort_corners(const Surface& surface) {
  corner_begin_.assign(surface.position.size() + 1, 0);
  for (const Found& f : found_) {
    if (f.low >= 0) ++corner_begin_[at(f.low) + 1];
  }
  for (std::size_t v = 1; v < corner_begin_.size(); ++v) corner_begin_[v] += corner_begin_[v - 1];
  members_.resize(at(corner_begin_.back()));
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (found_[k].low >= 0) members_[at(corner_begin_[at(found_[k].low)]++)] = static_cast<int>(k);
  }
  // corner_begin_ has moved on by one. A corner has few others near it: insertion keeps their order.
  int begin = 0;
  for (std::size_t v = 0; v + 1 < corner_begin_.size(); ++v) {
    const int end = corner_begin_[v];
    for (int k = begin + 1; k < end; ++k) {
      const int member = members_[at(k)], high = found_[at(member)].high;
      int place = k;
      for (; place > begin && found_[at(members_[at(place - 1)])].high > high; --place)
        members_[at(place)] = members_[at(place - 1)];
      members_[at(place)] = member;
    }
    begin = end;
  }
}

/// The candidates that pass, piece by piece, so that their order is the same whoever finds them.
void Detection::look(const Surface& surface, std::span<const double> reach, std::span<const double> away,
                     const CandidateList& candidates, ThreadTeam& team) {
  const std::size_t n = candidates.pairs.size(), pieces = (n + piece - 1) / piece;
  room_.resize(n);
  std::vector<std::size_t> passed(pieces, 0);
  const auto look_at_piece = [&](std::size_t p) {
    const std::size_t first = p * piece, last = std::min(n, first + piece);
    CandidateList::Finder memory_of(candidates, first);
    for (std::size_t k = first; k < last; ++k) {
      const Candidate& c = candidates.pairs[k];
      if (away[at(c.block_a)] + away[at(c.block_b)] < c.clearance) continue;
      const int memory = memory_of(k);
      Found& next = room_[first + passed[p]];
      if (!passes(surface, reach, c, memory >= 0 && candidates.memory[at(memory)].bonded, next)) continue;
      next.candidate = static_cast<int>(k);
      next.memory = memory;
      ++passed[p];
    }
  };
  team.for_range(pieces, std::max<std::size_t>(2, worth_threads / piece),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t p = begin; p < end; ++p) look_at_piece(p);
                 });
  std::size_t total = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    if (p > 0) std::copy_n(&room_[p * piece], passed[p], &room_[total]);
    total += passed[p];
  }
  found_ = std::span(room_).first(total);
}

void Detection::find(const Surface& surface, std::span<const double> reach, std::span<const double> away,
                     const CandidateList& candidates, ThreadTeam& team, std::vector<Contact>& contacts) {
  measure_edges(surface, team);
  look(surface, reach, away, candidates, team);
  sort_corners(surface);
  dropped_.assign(found_.size(), 0);
  for (std::size_t first = 0; first < members_.size();) {
    const Found& f = found_[at(members_[first])];
    std::size_t last = first + 1;
    while (last < members_.size() && found_[at(members_[last])].low == f.low &&
           found_[at(members_[last])].high == f.high)
      ++last;
    compete(std::span(members_).subspan(first, last - first), candidates);
    first = last;
  }
  kept_.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (dropped_[k] == 0) kept_.push_back(static_cast<int>(k));
  }
  contacts.resize(kept_.size());
  team.for_range(kept_.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) add(surface, found_[at(kept_[k])], candidates, contacts[k]);
  });
}

/// Which of the candidates for one pair of corners is the contact.
void Detection::compete(std::span<const int> members, const CandidateList& candidates) {
  const auto line = [&](const Found& f) -> const Line& {
    return lines_[at(candidates.pairs[at(f.candidate)].edge)];
  };
  const auto over = [&](const Found& f) { return inside(f.along, line(f).length); };
  const auto turned = [&](const Found& f, const Found& g) {
    return std::abs(cross(line(f).tangent, line(g).tangent)) >= Tolerances::sine_parallel;
  };
  const auto force = [&](const Found& f) { return candidates.memory[at(f.memory)].normal_force; };
  bool parallel = true;
  const Found* holder = nullptr;  // the one that was in contact; the strongest, should there be several
  for (const int m : members) {
    const Found& f = found_[at(m)];
    parallel = parallel && !turned(f, found_[at(members[0])]);
    if (f.memory >= 0 && (holder == nullptr || force(f) > force(*holder))) holder = &f;
  }
  Found* winner = nullptr;
  if (parallel) {
    for (const int m : members) {
      if (winner == nullptr || over(found_[at(m)]) > over(*winner)) winner = &found_[at(m)];
    }
    const double leave = -0.5 * tolerances_.end_zone;
    if (holder != nullptr && (over(*holder) > leave || over(*winner) < -tolerances_.rounding)) {
      winner = &found_[at(static_cast<int>(holder - found_.data()))];
    } else if (holder == nullptr && over(*winner) < -tolerances_.rounding) {
      winner = nullptr;  // a vertex beyond the end of an edge, with nothing of it on the other side
    }
  } else {
    for (const int m : members) {
      if (winner == nullptr || found_[at(m)].gap > winner->gap) winner = &found_[at(m)];
    }
    double second = -HUGE_VAL;
    for (const int m : members) {
      if (turned(found_[at(m)], *winner)) second = std::max(second, found_[at(m)].gap);
    }
    const double best = winner->gap;
    if (best > -tolerances_.corner_depth && best - second < tolerances_.corner_tie) winner = nullptr;
  }
  for (const int m : members) dropped_[at(m)] = &found_[at(m)] != winner;
  // Slip of the one block against the other has the same sign on both sides: when the vertex and the edge change sides, the
  // tangents of the two lines run against each other, and normal and tangent turn together.
  if (winner != nullptr && holder != nullptr && parallel) winner->memory = holder->memory;
}

namespace {

/// The stiffness of a contact goes with the joint that belongs to it, and jumps when an edge comes to lie flat. Its elastic
/// energy stays what it was: penetration that the new spring would turn into energy nobody spent goes to the offset, and
/// comes back from there when the joint gets shorter again.
void keep_energy(Memory& memory, double gap, double stiffness) {
  const double depth = -gap - memory.offset;
  if (memory.multiplier > 0.0) {  // a force that belongs to no penetration stays
    memory.multiplier *= memory.stiffness / stiffness;
    memory.shear *= memory.stiffness / stiffness;
  } else if (memory.stiffness > 0.0 && stiffness != memory.stiffness && depth > 0.0) {
    const double scale = std::sqrt(memory.stiffness / stiffness);
    memory.offset = std::max(-gap - scale * depth, std::min(memory.offset, 0.0));
    memory.shear *= scale;
  }
  memory.stiffness = stiffness;
}

}  // namespace

void Detection::add(const Surface& surface, const Found& found, const CandidateList& candidates,
                    Contact& contact) const {
  const Candidate& candidate = candidates.pairs[at(found.candidate)];
  const Line& line = lines_[at(candidate.edge)];
  const Vec2 a = surface.position[at(candidate.edge)], v = surface.position[at(candidate.vertex)],
             normal = line.normal();
  contact.candidate = found.candidate;
  contact.block_a = candidate.block_a;
  contact.block_b = candidate.block_b;
  contact.vertex = candidate.vertex;
  contact.edge = candidate.edge;
  contact.normal = normal;
  contact.position = found.along / line.length;
  contact.gap = found.gap;
  contact.length = 0.5 * (shared_length(surface, v, surface.previous[at(candidate.vertex)], a, normal,
                                        line.tangent, line.length) +
                          shared_length(surface, v, surface.next[at(candidate.vertex)], a, normal,
                                        line.tangent, line.length));

  Memory& memory = contact.memory;
  if (found.memory < 0) {
    memory = {};
    memory.offset = std::max(0.0, -found.gap);
  } else {
    memory = candidates.memory[at(found.memory)];
    if (memory.offset > 0.0) memory.offset = std::min(memory.offset, std::max(0.0, -found.gap));
  }

  const JointLaw& law = laws_[at(surface.joint[at(contact.edge)])];
  const double per_length = law.normal_stiffness > 0.0
                                ? law.normal_stiffness
                                : std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  contact.normal_stiffness = per_length * std::max(contact.length, tolerances_.least_length);
  contact.shear_stiffness = law.stiffness_ratio * contact.normal_stiffness;
  contact.friction_coefficient = law.friction_coefficient;
  contact.cohesion = memory.bonded ? law.cohesion * contact.length : 0.0;
  contact.tension = memory.bonded ? law.tension * contact.length : 0.0;
  contact.fused = memory.bonded && law.fused;
  keep_energy(memory, contact.gap, contact.normal_stiffness);
  contact.depth = -contact.gap - memory.offset + memory.multiplier;
}

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates) {
  candidates.tracked.clear();
  candidates.memory.clear();
  for (const Contact& c : contacts) {
    candidates.tracked.push_back(c.candidate);
    candidates.memory.push_back(c.memory);
    if (c.memory.bonded)
      candidates.pairs[at(c.candidate)].clearance = 0.0;  // of a bond, any gap is a contact
  }
}

}  // namespace keyblock::contact
