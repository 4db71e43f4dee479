#include "contact/detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/index.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t piece = 1'024;  // pairs of blocks

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
  team.for_range(corners_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const std::size_t next = at(surface.next[e]);
      const Vec2 along = surface.position[next] - surface.position[e];
      Corner& corner = corners_[e];
      corner.position = surface.position[e];
      corner.length = norm(along);
      corner.tangent = corners_[next].before = along / corner.length;
      corner.reflex = surface.reflex[e] + 2.0 * surface.reflex[next];
    }
  });
}

/// Those of a group that are contacts, but for others of the same two corners, to `found`. Returns their number. All at once and
/// without branches: which of the conditions fails is a matter of chance.
std::size_t Detection::pass(const CandidateList& candidates, const Group& group, Found* found) const {
  static_assert(sizeof(Corner) == sizeof(Lanes));
  Lanes edge[lane_count], vertex[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates.pairs[at(group.candidate[i < group.size ? i : 0])];
    edge[i] = load(&corners_[at(c.edge)].position.x);
    vertex[i] = load(&corners_[at(c.vertex)].position.x);
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6], reflex = edge[7];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  const auto least = [](Lanes a, Lanes b) { return b < a ? b : a; };
  const Lanes reach = load(group.reach.data()), deepest = load(group.deepest.data());
  const Lanes zone = least(tolerances_.end_zone + reach, 0.5 * length);
  const Lanes deep_zone = zone < deepest ? deepest : zone;
  const auto reflex_start = (reflex == 1.0) | (reflex == 3.0), reflex_end = reflex >= 2.0;
  const Lanes before = reflex_start ? deep_zone : zone, after = reflex_end ? deep_zone : zone;
  // The corner of a block that spins may pass the one that is nearest now.
  const Lanes straight = broadcast(Tolerances::sine_inside);
  const Lanes sine = gap > 0.0 ? least(broadcast(1.0), straight + load(group.turn.data())) : straight;
  // Whether an edge of the vertex lies outside the line, up to an angle.
  const auto outside = [&](Lanes x, Lanes y) {
    const Lanes across = nx * x + ny * y;
    return (across >= 0.0) | (across * across <= sine * sine);
  };
  const auto passes = ((load(group.bonded.data()) > 0.0) | (gap <= tolerances_.activation + reach)) &
                      (gap >= -deepest) & (along >= -before) & (along <= length + after) &
                      outside(vertex[2], vertex[3]) & outside(-vertex[4], -vertex[5]);
  // Near an end, a convex one: there others of the same two corners may be the contact.
  const auto first_half = along < 0.5 * length;
  const auto disputed = (least(along, length - along) < zone) & ~(first_half ? reflex_start : reflex_end);
  std::size_t count = 0;
  for (std::size_t i = 0; i < group.size; ++i) {
    found[count].candidate = group.candidate[i];
    found[count].pair = group.pair[i];
    found[count].gap = gap[i];
    found[count].along = along[i];
    found[count].first_half = first_half[i] != 0;
    found[count].disputed = disputed[i] != 0;
    count += passes[i] != 0 ? 1 : 0;
  }
  return count;
}

/// The contacts among the candidates of pairs of blocks [first, last), into `found`, which has room for all of them. Returns their
/// number.
std::size_t Detection::look_at_pairs(const Surface& surface, const CandidateList& candidates,
                                     std::size_t first, std::size_t last, Found* found) const {
  CandidateList::Finder bond_of(candidates, candidates.block_pairs[first]);
  const auto is_bonded = [&](std::size_t k) {
    const int memory = bond_of(k);
    return memory >= 0 && candidates.memory[at(memory)].bonded;
  };
  std::size_t count = 0;
  Group group;
  const auto take = [&] {
    if (group.size > 0) count += pass(candidates, group, found + count);
    group.size = 0;
  };
  for (std::size_t p = first; p < last; ++p) {
    const std::size_t begin = candidates.block_pairs[p], end = candidates.block_pairs[p + 1];
    const std::size_t a = at(candidates.pairs[begin].block_a), b = at(candidates.pairs[begin].block_b);
    const double reach = motion_.reach[a] + motion_.reach[b], turn = motion_.turn[a] + motion_.turn[b],
                 away = motion_.away[a] + motion_.away[b],
                 deepest = std::min({tolerances_.depth_limit, surface.thickness[a], surface.thickness[b]});
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = group.size;
      group.candidate[i] = static_cast<int>(k);
      group.pair[i] = static_cast<int>(p);
      group.reach[i] = reach;
      group.turn[i] = turn;
      group.deepest[i] = deepest;
      if (any_bond_) group.bonded[i] = is_bonded(k) ? 1.0 : 0.0;
      group.size += away < candidates.pairs[k].clearance ? 0 : 1;
      if (group.size == lane_count) take();
    }
  }
  take();

  CandidateList::Finder memory_of(candidates, candidates.block_pairs[first]);
  for (std::size_t i = 0; i < count; ++i) {
    Found& f = found[i];
    f.memory = memory_of(at(f.candidate));
    const Candidate& c = candidates.pairs[at(f.candidate)];
    const int corner = f.first_half ? c.edge : surface.next[at(c.edge)];
    const auto [low, high] = std::minmax(c.vertex, corner);
    f.corners = f.disputed ? static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high) : 0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t corners = found[i].corners;
    if (corners == 0) continue;
    std::array<Found*, 4> rivals{&found[i]};  // two edges end in each corner
    std::size_t size = 1;
    for (std::size_t k = i + 1; k < count && found[k].pair == found[i].pair && size < rivals.size(); ++k) {
      if (found[k].corners == corners) rivals[size++] = &found[k];
    }
    compete(std::span(rivals).first(size), candidates);
  }
  const Found* end = std::remove_if(found, found + count, [](const Found& f) { return f.candidate < 0; });
  return static_cast<std::size_t>(end - found);
}

/// Piece by piece of the pairs of blocks, so that the order of what is found is the same whoever finds it.
void Detection::look(const Surface& surface, const CandidateList& candidates, ThreadTeam& team) {
  const std::vector<std::size_t>& begins = candidates.block_pairs;
  const std::size_t n = begins.empty() ? 0 : begins.size() - 1, pieces = (n + piece - 1) / piece;
  room_.resize(candidates.pairs.size());
  std::vector<std::size_t> count(pieces, 0);
  const auto look_at_piece = [&](std::size_t p) {
    count[p] = look_at_pairs(surface, candidates, p * piece, std::min(n, (p + 1) * piece),
                             &room_[begins[p * piece]]);
  };
  team.for_range(pieces, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) look_at_piece(p);
  });
  std::size_t total = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    if (p > 0) std::copy_n(&room_[begins[p * piece]], count[p], &room_[total]);
    total += count[p];
  }
  found_ = std::span(room_).first(total);
}

void Detection::find(const Surface& surface, const Motion& motion, const CandidateList& candidates,
                     ThreadTeam& team, std::vector<Contact>& contacts) {
  motion_ = motion;
  measure_corners(surface, team);
  any_bond_ = std::any_of(candidates.memory.begin(), candidates.memory.end(),
                          [](const Memory& memory) { return memory.bonded; });
  look(surface, candidates, team);
  contacts.resize(found_.size());
  team.for_range(found_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
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
    f->corners = 0;
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

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team) {
  candidates.tracked.resize(contacts.size());
  candidates.memory.resize(contacts.size());
  team.for_range(contacts.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Contact& c = contacts[k];
      candidates.tracked[k] = c.candidate;
      candidates.memory[k] = c.memory;
      if (c.memory.bonded)
        candidates.pairs[at(c.candidate)].clearance = 0.0;  // of a bond, any gap is a contact
    }
  });
}

}  // namespace keyblock::contact
