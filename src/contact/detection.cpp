#include "contact/detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/index.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t worth_threads = 10'000;  // vertices, candidates or contacts
constexpr std::size_t piece = 4'096;           // candidates

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

void Detection::measure_corners(const Surface& surface, ThreadTeam& team) {
  corners_.resize(surface.position.size());
  team.for_range(corners_.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const std::size_t next = at(surface.next[e]);
      const Vec2 along = surface.position[next] - surface.position[e];
      Corner& corner = corners_[e];
      corner.position = surface.position[e];
      corner.length = norm(along);
      corner.tangent = corners_[next].before = along / corner.length;
      corner.reflex = surface.reflex[e] != 0;
      corner.reflex_end = surface.reflex[next] != 0;
    }
  });
}

/// Whether a candidate is a contact, but for others of the same two corners. Without branches: which of the conditions fails is a
/// matter of chance.
bool Detection::passes(const Candidate& c, const PairMotion& pair, bool bonded, Found& found) const {
  const Corner &edge = corners_[at(c.edge)], &vertex = corners_[at(c.vertex)];
  const Vec2 normal = edge.normal(), from_start = vertex.position - edge.position;
  const double gap = dot(normal, from_start), along = dot(edge.tangent, from_start);
  const double zone = std::min(tolerances_.end_zone + pair.reach, 0.5 * edge.length);
  const double deep_zone = std::max(pair.deepest, zone);
  const double before = edge.reflex ? deep_zone : zone, after = edge.reflex_end ? deep_zone : zone;
  // The corner of a block that spins may pass the one that is nearest now.
  const double sine = std::min(1.0, Tolerances::sine_inside + (gap > 0.0 ? pair.turn : 0.0));
  // Whether an edge of the vertex lies outside the line, up to an angle.
  const auto outside = [&](Vec2 tangent) {
    const double across = dot(normal, tangent);
    return (across >= 0.0) | (across * across <= sine * sine);
  };
  found.gap = gap;
  found.along = along;
  found.near_end = inside(along, edge.length) < zone;
  return (bonded | (gap <= tolerances_.activation + pair.reach)) & (gap >= -pair.deepest) &
         (along >= -before) & (along <= edge.length + after) &
         outside(vertex.tangent) & outside(-1.0 * vertex.before);
}

/// The contacts among the candidates [first, last) of one pair of blocks, into `found`, which has room for all of them. Returns
/// their number.
std::size_t Detection::look_at_pair(const Surface& surface, const CandidateList& candidates,
                                    std::size_t first, std::size_t last, CandidateList::Finder& memory_of,
                                    Found* found) const {
  std::size_t count = 0;
  const std::size_t a = at(candidates.pairs[first].block_a), b = at(candidates.pairs[first].block_b);
  const PairMotion pair{motion_.reach[a] + motion_.reach[b], motion_.turn[a] + motion_.turn[b],
                        std::min({tolerances_.depth_limit, surface.thickness[a], surface.thickness[b]})};
  const double away = motion_.away[a] + motion_.away[b];
  CandidateList::Finder bond_of = memory_of;
  const auto is_bonded = [&](std::size_t k) {
    const int memory = bond_of(k);
    return memory >= 0 && candidates.memory[at(memory)].bonded;
  };
  for (std::size_t k = first; k < last; ++k) {
    const Candidate& c = candidates.pairs[k];
    if (away < c.clearance) continue;
    found[count].candidate = static_cast<int>(k);
    count += passes(c, pair, may_bond_ && is_bonded(k), found[count]) ? 1 : 0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Found& f = found[i];
    f.memory = memory_of(at(f.candidate));
    f.low = f.high = -1;
    if (!f.near_end) continue;
    const Candidate& c = candidates.pairs[at(f.candidate)];
    const Corner& edge = corners_[at(c.edge)];
    const bool first_half = f.along < 0.5 * edge.length;
    if (first_half ? edge.reflex : edge.reflex_end) continue;
    std::tie(f.low, f.high) = std::minmax(c.vertex, first_half ? c.edge : surface.next[at(c.edge)]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (found[i].candidate < 0 || found[i].low < 0) continue;
    std::array<Found*, 4> rivals;  // two edges end in each corner
    std::size_t size = 0;
    for (std::size_t k = i; k < count && size < rivals.size(); ++k) {
      if (found[k].low == found[i].low && found[k].high == found[i].high) rivals[size++] = &found[k];
    }
    compete(std::span(rivals).first(size), candidates);
  }
  const Found* end = std::remove_if(found, found + count, [](const Found& f) { return f.candidate < 0; });
  return static_cast<std::size_t>(end - found);
}

/// Piece by piece of the candidates, so that the order of what is found is the same whoever finds it.
void Detection::look(const Surface& surface, const CandidateList& candidates, ThreadTeam& team) {
  const std::vector<Candidate>& pairs = candidates.pairs;
  const std::size_t n = pairs.size(), pieces = (n + piece - 1) / piece;
  const auto same_blocks = [&](std::size_t k, std::size_t l) {
    const Candidate &x = pairs[k], &y = pairs[l];
    return (x.block_a == y.block_a && x.block_b == y.block_b) ||
           (x.block_a == y.block_b && x.block_b == y.block_a);
  };
  const auto end_of_pair = [&](std::size_t k) {
    while (k < n && same_blocks(k - 1, k)) ++k;
    return k;
  };
  const auto begin_of_piece = [&](std::size_t p) { return p == 0 ? 0 : end_of_pair(std::min(n, p * piece)); };
  room_.resize(n);
  std::vector<std::size_t> count(pieces, 0);
  const auto look_at_piece = [&](std::size_t p) {
    const std::size_t begin = begin_of_piece(p), end = begin_of_piece(p + 1);
    CandidateList::Finder memory_of(candidates, begin);
    for (std::size_t first = begin; first < end;) {
      const std::size_t last = end_of_pair(first + 1);
      count[p] += look_at_pair(surface, candidates, first, last, memory_of, &room_[begin + count[p]]);
      first = last;
    }
  };
  team.for_range(pieces, std::max<std::size_t>(2, worth_threads / piece),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t p = begin; p < end; ++p) look_at_piece(p);
                 });
  std::size_t total = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    if (p > 0) std::copy_n(&room_[begin_of_piece(p)], count[p], &room_[total]);
    total += count[p];
  }
  found_ = std::span(room_).first(total);
}

void Detection::find(const Surface& surface, const Motion& motion, const CandidateList& candidates,
                     ThreadTeam& team, std::vector<Contact>& contacts) {
  motion_ = motion;
  measure_corners(surface, team);
  may_bond_ = std::any_of(laws_.begin(), laws_.end(), [](const JointLaw& law) { return law.may_bond(); });
  look(surface, candidates, team);
  contacts.resize(found_.size());
  team.for_range(found_.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) add(surface, found_[k], candidates, contacts[k]);
  });
}

/// Which of the candidates for one pair of corners is the contact.
void Detection::compete(std::span<Found* const> rivals, const CandidateList& candidates) const {
  const auto line = [&](const Found& f) -> const Corner& {
    return corners_[at(candidates.pairs[at(f.candidate)].edge)];
  };
  const auto over = [&](const Found& f) { return inside(f.along, line(f).length); };
  const auto turned = [&](const Found& f, const Found& g) {
    return std::abs(cross(line(f).tangent, line(g).tangent)) >= Tolerances::sine_parallel;
  };
  const auto force = [&](const Found& f) { return candidates.memory[at(f.memory)].normal_force; };
  bool parallel = true;
  Found* holder = nullptr;  // the one that was in contact; the strongest, should there be several
  for (Found* f : rivals) {
    parallel = parallel && !turned(*f, *rivals[0]);
    if (f->memory >= 0 && (holder == nullptr || force(*f) > force(*holder))) holder = f;
  }
  Found* winner = nullptr;
  if (parallel) {
    for (Found* f : rivals) {
      if (winner == nullptr || over(*f) > over(*winner)) winner = f;
    }
    const double leave = -0.5 * tolerances_.end_zone;
    if (holder != nullptr && (over(*holder) > leave || over(*winner) < -tolerances_.rounding)) {
      winner = holder;
    } else if (holder == nullptr && over(*winner) < -tolerances_.rounding) {
      winner = nullptr;  // a vertex beyond the end of an edge, with nothing of it on the other side
    }
  } else {
    for (Found* f : rivals) {
      if (winner == nullptr || f->gap > winner->gap) winner = f;
    }
    double second = -HUGE_VAL;
    for (const Found* f : rivals) {
      if (turned(*f, *winner)) second = std::max(second, f->gap);
    }
    const double best = winner->gap;
    if (best > -tolerances_.corner_depth && best - second < tolerances_.corner_tie) winner = nullptr;
  }
  // Slip of the one block against the other has the same sign on both sides: when the vertex and the edge change sides, the
  // tangents of the two lines run against each other, and normal and tangent turn together.
  if (winner != nullptr && holder != nullptr && parallel) winner->memory = holder->memory;
  for (Found* f : rivals) {
    f->low = f->high = -1;
    if (f != winner) f->candidate = -1;
  }
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
  const Corner& line = corners_[at(candidate.edge)];
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
