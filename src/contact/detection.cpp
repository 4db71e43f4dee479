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

/// Whether the edge from v to `other` lies outside the line, up to an angle.
int outside(const Surface& surface, Vec2 v, int other, Vec2 normal, double sine) {
  const Vec2 u = surface.position[at(other)] - v;
  const double along = dot(normal, u);
  // Which of the two holds is a matter of chance where edges lie on each other: no branch.
  return static_cast<int>(along >= 0.0) | static_cast<int>(along * along <= sine * sine * squared_norm(u));
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

bool Detection::passes(const Surface& surface, const Candidate& c, const PairMotion& pair, bool bonded,
                       Found& found) const {
  const Vec2 a = surface.position[at(c.edge)], v = surface.position[at(c.vertex)];
  const Line& line = lines_[at(c.edge)];
  const Vec2 normal = line.normal();
  const double gap = dot(normal, v - a), along = dot(line.tangent, v - a), length = line.length;
  if (!bonded && gap > tolerances_.activation + pair.reach) return false;
  if (gap < -pair.deepest) return false;
  const int end = surface.next[at(c.edge)];
  const double zone = std::min(tolerances_.end_zone + pair.reach, 0.5 * length);
  const double before = surface.reflex[at(c.edge)] ? std::max(pair.deepest, zone) : zone;
  const double after = surface.reflex[at(end)] ? std::max(pair.deepest, zone) : zone;
  if (along < -before || along > length + after) return false;
  // The corner of a block that spins may pass the one that is nearest now.
  const double sine = std::min(1.0, Tolerances::sine_inside + (gap > 0.0 ? pair.turn : 0.0));
  if ((outside(surface, v, surface.previous[at(c.vertex)], normal, sine) &
       outside(surface, v, surface.next[at(c.vertex)], normal, sine)) == 0)
    return false;

  found.gap = gap;
  found.along = along;
  found.low = found.high = -1;
  const int corner = along < 0.5 * length ? c.edge : end;
  if (inside(along, length) < zone && !surface.reflex[at(corner)])
    std::tie(found.low, found.high) = std::minmax(c.vertex, corner);
  return true;
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
  for (std::size_t k = first; k < last; ++k) {
    const Candidate& c = candidates.pairs[k];
    if (away < c.clearance) continue;
    const int memory = memory_of(k);
    if (!passes(surface, c, pair, memory >= 0 && candidates.memory[at(memory)].bonded, found[count]))
      continue;
    found[count].candidate = static_cast<int>(k);
    found[count].memory = memory;
    ++count;
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
  measure_edges(surface, team);
  look(surface, candidates, team);
  contacts.resize(found_.size());
  team.for_range(found_.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) add(surface, found_[k], candidates, contacts[k]);
  });
}

/// Which of the candidates for one pair of corners is the contact.
void Detection::compete(std::span<Found* const> rivals, const CandidateList& candidates) const {
  const auto line = [&](const Found& f) -> const Line& {
    return lines_[at(candidates.pairs[at(f.candidate)].edge)];
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
