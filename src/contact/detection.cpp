#include "contact/detection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/index.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t piece = 1'024;  // pairs of blocks

}  // namespace

void Detection::measure_corners(const Surface& surface, ThreadTeam& team) {
  corners_.resize(surface.position.size());
  wholes_.resize(surface.divided.size());
  team.for_range(corners_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += lane_count) {
      const std::size_t count = std::min(end - first, std::size_t{lane_count});
      std::array<Vec2, lane_count> along;
      for (std::size_t i = 0; i < lane_count; ++i) {
        const std::size_t e = first + (i < count ? i : 0);
        along[i] = surface.position[at(surface.next[e])] - surface.position[e];
      }
      const Lanes x = each_lane([&](std::size_t i) { return along[i].x; }),
                  y = each_lane([&](std::size_t i) { return along[i].y; }),
                  length = square_root(x * x + y * y), tx = x / length, ty = y / length;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t e = first + i, next = at(surface.next[e]);
        Corner &corner = corners_[e], &after = corners_[next];
        corner.position = surface.position[e];
        corner.length = length[i];
        // One by one: two numbers that are stored singly cannot be loaded as one vector at once.
        corner.tangent.x = after.before.x = tx[i];
        corner.tangent.y = after.before.y = ty[i];
        corner.kinds = static_cast<double>(surface.kind[e]) + 4.0 * static_cast<double>(surface.kind[next]);
      }
    }
  });
  if (wholes_.empty()) return;
  team.for_range(wholes_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const DividedEdge& whole = surface.divided[e];
      wholes_[e] = {surface.position[at(whole.first)],
                    surface.position[at(surface.next[at(whole.first + whole.pieces - 1)])],
                    surface.start_share[e], static_cast<double>(whole.pieces)};
    }
  });
}

/// Those of a group that are contacts, but for others of the same two corners, to `passed`. Returns their number. All at once and
/// without branches: which of the conditions fails is a matter of chance.
std::size_t Detection::pass(const CandidateList& candidates, const Group& group, Rival* passed) const {
  static_assert(sizeof(Corner) == sizeof(Lanes));
  Lanes edge[lane_count], vertex[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates.pairs[at(group.candidate[i < group.size ? i : 0])];
    edge[i] = load(&corners_[at(c.edge)].position.x);
    vertex[i] = load(&corners_[at(c.vertex)].position.x);
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6], kinds = edge[7];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  const Lanes reach = load(group.reach.data()), deepest = load(group.deepest.data());
  const Lanes zone = least(tolerances_.end_zone + reach, 0.5 * length);
  const Lanes deep_zone = largest(zone, least(deepest, broadcast(tolerances_.depth_limit)));
  const auto reflex_end = kinds >= 4.0, nook_end = kinds >= 8.0;
  const Lanes at_start = kinds - where(nook_end, broadcast(8.0), where(reflex_end, broadcast(4.0), Lanes{}));
  const auto reflex_start = at_start >= 1.0, nook_start = at_start >= 2.0;
  const Lanes past_start = where(nook_start, deep_zone, zone), past_end = where(nook_end, deep_zone, zone);
  const auto presses = load(group.presses.data()) > 0.0;
  const Lanes pressed_zone = largest(zone, deepest), before = where(presses, pressed_zone, past_start),
              after = where(presses, pressed_zone, past_end);
  // The corner of a block that spins may pass the one that is nearest now.
  const Lanes straight = broadcast(Tolerances::sine_inside);
  const Lanes sine = where(gap > 0.0, least(broadcast(1.0), straight + load(group.turn.data())), straight);
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
  const auto disputed =
      (least(along, length - along) < zone) & ~((first_half & reflex_start) | (~first_half & reflex_end));
  const auto is_beyond = (along < -past_start) | (along > length + past_end);
  std::size_t count = 0;
  for (std::size_t i = 0; i < group.size; ++i) {
    passed[count].candidate = group.candidate[i];
    passed[count].pair = group.pair[i];
    passed[count].gap = gap[i];
    passed[count].along = along[i];
    passed[count].first_half = first_half[i] != 0;
    passed[count].is_beyond = is_beyond[i] != 0;
    passed[count].disputed = disputed[i] != 0;
    count += passes[i] != 0 ? 1 : 0;
  }
  return count;
}

/// The candidates of these pairs of blocks, ascending, that pass.
void Detection::find_rivals(const Surface& surface, const CandidateList& candidates,
                            std::span<const std::size_t> pairs, std::vector<Rival>& rivals) const {
  rivals.clear();
  if (pairs.empty()) return;
  const int first_candidate = candidates.block_pairs[pairs.front()].first;
  CandidateList::Finder held_by(candidates, first_candidate);
  std::size_t count = 0;
  Group group;
  const auto take = [&] {
    rivals.resize(count + lane_count);
    count += pass(candidates, group, &rivals[count]);
    group.size = 0;
  };
  const Memory nothing;
  for (const std::size_t p : pairs) {
    const BlockPair& pair = candidates.block_pairs[p];
    const std::size_t begin = at(pair.first), end = candidates.end_of_pair(p), a = at(pair.block_a),
                      b = at(pair.block_b);
    const double reach = motion_.reach[a] + motion_.reach[b], turn = motion_.turn[a] + motion_.turn[b],
                 away = motion_.away[a] + motion_.away[b],
                 thickness = std::min(surface.thickness[a], surface.thickness[b]),
                 deepest = std::min(tolerances_.depth_limit, thickness);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = group.size;
      group.candidate[i] = static_cast<int>(k);
      group.pair[i] = static_cast<int>(p);
      group.reach[i] = reach;
      group.turn[i] = turn;
      const int memory = held_by(k);
      const Memory& before = memory >= 0 ? candidates.memory[at(memory)] : nothing;
      group.deepest[i] = before.holds() ? thickness : deepest;
      group.presses[i] = before.normal_force > 0.0 ? 1.0 : 0.0;
      group.bonded[i] = before.bonded ? 1.0 : 0.0;
      group.size += away < candidates.pairs[k].clearance ? 0 : 1;
      if (group.size == lane_count) take();
    }
  }
  if (group.size > 0) take();
  rivals.resize(count);

  CandidateList::Finder memory_of(candidates, first_candidate);
  for (Rival& r : rivals) {
    r.memory = memory_of(at(r.candidate));
    const Candidate& c = candidates.pairs[at(r.candidate)];
    const int corner = r.first_half ? c.edge : surface.next[at(c.edge)];
    const auto [low, high] = std::minmax(c.vertex, corner);
    r.corners = r.disputed ? static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high) : 0;
  }
}

/// Those that lose to another of the same two corners, and for how long that and everything else about a pair stays as it is.
/// end: of its candidates; rivals: those that pass.
void Detection::decide(const Surface& surface, const CandidateList& candidates, BlockPair& pair,
                       std::size_t end, std::span<Rival> rivals) const {
  constexpr int steps = 16;                    // after which a pair that was not steady is tried again
  constexpr double reach_share = 2.0;          // of the reach now, up to which a steady pair is left alone
  constexpr double least_share = 0.02;         // of the reach, that is worth being steady for
  constexpr std::size_t most_candidates = 64;  // bits
  const double reach = motion_.reach[at(pair.block_a)] + motion_.reach[at(pair.block_b)];
  const bool tries = pair.wait == 0 && end - at(pair.first) <= most_candidates;
  double margin = tries ? candidate_margin(surface, candidates, pair, end, rivals, reach_share * reach) : 0.0;
  const auto leave_out = [](Rival& r) {
    r.candidate = -1;
    r.corners = 0;
  };
  for (Rival& r : rivals) {
    if (r.memory >= 0 || r.disputed || r.gap >= -tolerances_.corner_depth) continue;
    const bool counts = take_over_joint(surface, candidates, pair, rivals, r);
    if (!counts || r.memory >= 0) margin = 0.0;  // hangs on third blocks
    if (!counts) leave_out(r);
  }
  for (Rival& r : rivals) {
    if (r.candidate < 0) continue;
    if (!r.is_beyond && !has_come_in_elsewhere(surface, r, candidates)) continue;
    margin = 0.0;  // hangs on third blocks
    if (is_out(surface, pair, r, candidates)) leave_out(r);
  }
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    const std::uint64_t corners = rivals[i].corners;
    if (corners == 0) continue;
    std::array<Rival*, 4> meeting{&rivals[i]};  // two edges end in each corner
    std::size_t size = 1;
    for (std::size_t k = i + 1; k < rivals.size() && size < meeting.size(); ++k) {
      if (rivals[k].corners == corners) meeting[size++] = &rivals[k];
    }
    const auto same = std::span(meeting).first(size);
    const Outcome outcome = compete_in_joints(surface, pair, same, candidates);
    if (margin > 0.0) margin = std::min(margin, outcome_margin(surface, same, outcome, candidates));
    for (Rival* r : same) {
      r->corners = 0;
      // Corners that meet only because their blocks may move far in the step: lines as good as one hold both.
      const bool is_apart = outcome.parallel && !outcome.left_out &&
                            inside(r->along, line(*r, candidates).length) > tolerances_.end_zone;
      if (r != outcome.winner && !is_apart) r->candidate = -1;
    }
  }
  pair.wait = std::max(0, pair.wait - 1);
  if (!tries) return;
  if (!(margin > least_share * reach)) {
    pair.wait = steps;
    return;
  }
  pair.steady = motion_.way[at(pair.block_a)] + motion_.way[at(pair.block_b)] + margin;
  pair.reach = reach_share * reach;
  pair.apart = apart(surface, pair);
  pair.contacts = pair.at_end = 0;
  for (const Rival& r : rivals) {
    if (r.candidate < 0) continue;
    const std::uint64_t bit = std::uint64_t{1} << (r.candidate - pair.first);
    pair.contacts |= bit;
    if (r.disputed) pair.at_end |= bit;
  }
}

Vec2 Detection::apart(const Surface& surface, const BlockPair& pair) {
  const auto first = [&](int block) { return surface.position[at(surface.block_begin[at(block)])]; };
  return first(pair.block_b) - first(pair.block_a);
}

/// Blocks that go together, as where the rock sways, have not moved. Nor may they with where they go in this step.
bool Detection::is_steady(const Surface& surface, const BlockPair& pair) const {
  if (!uses_steady_pairs_) return false;
  const std::size_t a = at(pair.block_a), b = at(pair.block_b);
  double left = pair.steady - motion_.way[a] - motion_.way[b];
  const Vec2 moved = apart(surface, pair) - pair.apart;
  Vec2 will_have_moved = moved;
  if (!motion_.ahead.empty()) {
    left -= motion_.way_ahead[a] + motion_.way_ahead[b];
    will_have_moved += motion_.ahead[at(surface.block_begin[b])] - motion_.ahead[at(surface.block_begin[a])];
  }
  return left >= 0.0 && std::max(squared_norm(moved), squared_norm(will_have_moved)) <= left * left &&
         motion_.reach[a] + motion_.reach[b] <= pair.reach;
}

/// The contacts among the candidates of pairs of blocks [first, last).
void Detection::look_at_pairs(const Surface& surface, CandidateList& candidates, std::size_t first,
                              std::size_t last, std::vector<Found>& found) const {
  std::vector<std::size_t> unsteady;
  for (std::size_t p = first; p < last; ++p) {
    if (!is_steady(surface, candidates.block_pairs[p])) unsteady.push_back(p);
  }
  std::vector<Rival> rivals;
  find_rivals(surface, candidates, unsteady, rivals);
  std::size_t count = 0;
  const auto add = [&](std::size_t more) {
    if (count + more > found.size()) found.resize(std::max(count + more, 2 * found.size()));
    Found* begin = found.data() + count;
    count += more;
    return begin;
  };
  CandidateList::Finder memory_of(candidates, candidates.block_pairs[first].first);
  auto r = rivals.begin();
  auto next_unsteady = unsteady.begin();
  for (std::size_t p = first; p < last; ++p) {
    BlockPair& pair = candidates.block_pairs[p];
    if (next_unsteady == unsteady.end() || *next_unsteady != p) {
      Found* next = add(static_cast<std::size_t>(std::popcount(pair.contacts)));
      for (std::uint64_t left = pair.contacts; left != 0; left &= left - 1, ++next) {
        const int k = std::countr_zero(left);
        next->candidate = pair.first + k;
        next->memory = memory_of(at(next->candidate));
        next->at_end = (pair.at_end >> k & 1) != 0;
      }
      continue;
    }
    ++next_unsteady;
    const auto next = std::find_if(r, rivals.end(), [&](const Rival& other) { return at(other.pair) != p; });
    decide(surface, candidates, pair, candidates.end_of_pair(p), {r, next});
    for (; r != next; ++r) {
      if (r->candidate >= 0) *add(1) = {r->candidate, r->memory, r->disputed};
    }
  }
  found.resize(count);
}

void Detection::find(const Surface& surface, const Motion& motion, CandidateList& candidates,
                     ThreadTeam& team, std::vector<Contact>& contacts) {
  contacts.resize(find_which(surface, motion, candidates, team));
  describe(surface, candidates, team, contacts);
}

/// Piece by piece of the pairs of blocks, so that the order of what is found is the same whoever finds it.
std::size_t Detection::find_which(const Surface& surface, const Motion& motion, CandidateList& candidates,
                                  ThreadTeam& team) {
  motion_ = motion;
  measure_corners(surface, team);
  const std::size_t pairs = candidates.block_pairs.size(), pieces = (pairs + piece - 1) / piece;
  found_.resize(pieces);
  team.for_range(pieces, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      look_at_pairs(surface, candidates, p * piece, std::min(pairs, (p + 1) * piece), found_[p]);
  });
  first_found_.resize(pieces);
  std::size_t total = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    first_found_[p] = total;
    total += found_[p].size();
  }
  return total;
}

/// m, from a vertex to the nearest edge of the block of edge `of` but this and `except`, without a reflex vertex between the two.
double Detection::to_nearest_other_edge(const Surface& surface, int vertex, int of, int except) const {
  const Vec2 from = corners_[at(vertex)].position;
  double nearest = HUGE_VAL;
  const auto look_at = [&](int edge) {
    if (edge == except) return;
    const Corner& other = corners_[at(edge)];
    const Vec2 from_start = from - other.position;
    const double along = std::clamp(dot(other.tangent, from_start), 0.0, other.length);
    nearest = std::min(nearest, squared_norm(from_start - along * other.tangent));
  };
  int edge = surface.next[at(of)];
  for (; edge != of && !surface.is_reflex(at(edge)); edge = surface.next[at(edge)]) look_at(edge);
  if (edge != of) {
    for (edge = of; !surface.is_reflex(at(edge));) look_at(edge = surface.previous[at(edge)]);
  }
  return std::sqrt(nearest);
}

/// Whether a vertex deep behind an edge is nearer to another: one that has come in by one face of a sharp corner, or that has slid past a
/// corner beside it, lies behind the other face, too. Not a vertex whose own edge lies on the face, nor one that has come in
/// by the face, however deep an impact presses it in.
bool Detection::has_come_in_elsewhere(const Surface& surface, const Rival& rival,
                                      const CandidateList& candidates, int except) const {
  if (rival.gap >= -deep(rival)) return false;
  if (has_come_in_here(rival, candidates)) return false;
  const Candidate& c = candidates.pairs[at(rival.candidate)];
  for (const Vec2 side : sides(c)) {
    const Vec2 inwards = line_inwards(rival, c);
    if (dot(side, inwards) > 0.0 && std::abs(cross(side, inwards)) < Tolerances::sine_facing) return false;
  }
  return to_nearest_other_edge(surface, c.vertex, c.edge, except) < -rival.gap;
}

}  // namespace keyblock::contact
