#include "contact/competitor.h"

#include <cmath>

#include "contact/deep_contacts.h"
#include "core/lanes.h"

namespace keyblock::contact {

namespace {

/// Up to as many candidates as there are lanes, and what their two blocks together may do (StepMotion).
struct Group {
  std::size_t size = 0;
  std::array<int, lane_count> candidate{}, pair{};
  std::array<double, lane_count> reach{}, turn{};
  std::array<double, lane_count> deepest{};            ///< m, depth up to which they may be in contact
  std::array<double, lane_count> past_end{};           ///< m, beyond an end, what presses may be
  std::array<double, lane_count> bonded{}, presses{};  ///< 1 or 0
  std::array<double, lane_count>
      closure{};  ///< m, that in-situ stress has closed a joint by that still presses
  std::array<double, lane_count> next_deep{}, previous_deep{};  ///< 1 or 0: sides_to_deep()
  std::array<double, lane_count> pressed{};                     ///< m, by the spring of what presses
  std::array<double, lane_count> in_face{};  ///< 1: it shares the pressure of a face that presses; 0
};

/// What comes in there in the step meets the other edge: reach does not count. A tip that an impact has pressed through another one is held as long as
/// its spring explains it. pressed: m, by that spring.
bool is_through_tip(const CornerView& view, const Candidate& candidate, double pressed) {
  const auto lines = tip_lines(view, candidate);
  return std::max(lines[0].outside, lines[1].outside) > view.tolerances.end_zone + pressed;
}

/// The candidates of a group that are contacts, unless they lose to others of the same two corners, to `passed`. Returns their number. All
/// at once and without branches: which of the conditions fails is a matter of chance.
std::size_t pass(const CornerView& view, const Group& group, Competitor* passed) {
  const Tolerances& tolerances = view.tolerances;
  Lanes edge[lane_count], vertex[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = view.candidates.pairs[at(group.candidate[i < group.size ? i : 0])];
    edge[i] = load(&view.corner(c.edge).position.x);
    vertex[i] = load(&view.corner(c.vertex).position.x);
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6], kinds = edge[7];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  const Lanes reach = load(group.reach.data()), deepest = load(group.deepest.data());
  const Lanes zone = least(tolerances.end_zone + reach, 0.5 * length);
  const Lanes deep_zone = largest(zone, least(deepest, broadcast(tolerances.depth_limit)));
  const auto reflex_end = kinds >= 4.0, concave_end = kinds >= 8.0;
  const Lanes at_start =
      kinds - where(concave_end, broadcast(8.0), where(reflex_end, broadcast(4.0), Lanes{}));
  const auto reflex_start = at_start >= 1.0, concave_start = at_start >= 2.0;
  const Lanes past_start = where(concave_start, deep_zone, zone),
              past_end = where(concave_end, deep_zone, zone);
  const auto presses = load(group.presses.data()) > 0.0;
  const Lanes pressed_zone = largest(zone, load(group.past_end.data())),
              before = where(presses, pressed_zone, past_start),
              after = where(presses, pressed_zone, past_end);
  // The corner of a block that spins may pass the corner that is nearest now.
  // The open end of a face that presses at the other lies inside by as much as the face is tilted.
  const auto in_face = load(group.in_face.data()) > 0.0;
  const Lanes straight =
      where(in_face, broadcast(Tolerances::sine_facing), broadcast(Tolerances::sine_inside));
  const Lanes sine = where(gap > 0.0, least(broadcast(1.0), straight + load(group.turn.data())), straight);
  // Whether an edge of the vertex lies outside the line, up to an angle.
  const auto outside = [&](Lanes x, Lanes y) {
    const Lanes across = nx * x + ny * y;
    return (across >= 0.0) | (across * across <= sine * sine);
  };
  const auto passes = ((load(group.bonded.data()) > 0.0) | in_face |
                       (gap <= tolerances.activation + reach + load(group.closure.data()))) &
                      (gap >= -deepest) & (along >= -before) & (along <= length + after) &
                      (outside(vertex[2], vertex[3]) | (load(group.next_deep.data()) > 0.0)) &
                      (outside(-vertex[4], -vertex[5]) | (load(group.previous_deep.data()) > 0.0));
  // Near an end at a convex corner: there others of the same two corners may be the contact.
  const auto first_half = along < 0.5 * length;
  const auto disputed =
      (least(along, length - along) < zone) & ~((first_half & reflex_start) | (~first_half & reflex_end));
  const auto is_beyond = (along < -past_start) | (along > length + past_end);
  const auto may_be_through =
      passes & (gap < -tolerances.end_zone) & ~is_beyond & ~(load(group.bonded.data()) > 0.0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < group.size; ++i) {
    passed[count].candidate = group.candidate[i];
    passed[count].pair = group.pair[i];
    passed[count].gap = gap[i];
    passed[count].along = along[i];
    passed[count].first_half = first_half[i] != 0;
    passed[count].is_beyond = is_beyond[i] != 0;
    passed[count].disputed = disputed[i] != 0;
    const bool is_through =
        may_be_through[i] != 0 &&
        is_through_tip(view, view.candidates.pairs[at(group.candidate[i])], group.pressed[i]);
    count += passes[i] != 0 && !is_through ? 1 : 0;
  }
  return count;
}

/// What two blocks together may do in the step.
struct PairLimits {
  double reach, turn, away, thickness, pressed, deepest;
  PairLimits(const CornerView& view, std::size_t a, std::size_t b)
      : reach(view.motion.reach[a] + view.motion.reach[b]),
        turn(view.motion.turn[a] + view.motion.turn[b]),
        away(view.motion.away[a] + view.motion.away[b]),
        thickness(std::min(view.surface.thickness[a], view.surface.thickness[b])),
        pressed(pressed_depth(view.pressed, static_cast<int>(a), static_cast<int>(b))),
        deepest(std::min(view.tolerances.depth_limit + pressed, thickness)) {}
};

/// Into the group, unless the candidate is too far to be a contact: without a branch.
inline void add(Group& group, std::size_t candidate, std::size_t pair, const PairLimits& limits,
                const Memory& before, double clearance, SidesOfVertex sides) {
  const std::size_t i = group.size;
  group.candidate[i] = static_cast<int>(candidate);
  group.pair[i] = static_cast<int>(pair);
  group.reach[i] = limits.reach;
  group.turn[i] = limits.turn;
  // What presses has come in here, or was let in: its spring pushes it out, however deep an impact takes it.
  group.past_end[i] = before.holds() ? limits.thickness : limits.deepest;
  group.deepest[i] = before.normal_force > 0.0 ? HUGE_VAL : group.past_end[i];
  group.presses[i] = before.normal_force > 0.0 ? 1.0 : 0.0;
  group.bonded[i] = before.bonded ? 1.0 : 0.0;
  group.pressed[i] =
      before.normal_force > 0.0 && before.stiffness > 0.0 ? before.normal_force / before.stiffness : 0.0;
  group.closure[i] = before.normal_force > 0.0 ? std::max(0.0, -before.offset) : 0.0;
  group.in_face[i] = before.in_face && before.normal_force > 0.0 ? 1.0 : 0.0;
  group.next_deep[i] = sides.next ? 1.0 : 0.0;
  group.previous_deep[i] = sides.previous ? 1.0 : 0.0;
  group.size += limits.away < clearance ? 0 : 1;
}

/// What the competitors remember, and which two corners meet where they are near an end. first_candidate: none has a smaller number.
void name_corners(const CornerView& view, int first_candidate, std::span<Competitor> competitors) {
  CandidateList::Finder memory_of(view.candidates, first_candidate);
  for (Competitor& r : competitors) {
    r.memory = memory_of(at(r.candidate));
    const Candidate& c = view.candidate(r);
    const int corner = r.first_half ? c.edge : view.surface.next[at(c.edge)];
    const auto [low, high] = std::minmax(c.vertex, corner);
    r.corners = r.disputed ? static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high) : 0;
  }
}

}  // namespace

std::array<TipLine, 2> tip_lines(const CornerView& view, const Candidate& candidate) {
  const Surface& surface = view.surface;
  const DividedEdge whole =
      surface.divided.empty() ? DividedEdge{candidate.edge} : surface.divided[at(candidate.edge)];
  const int start = whole.first, end = surface.next[at(start + whole.pieces - 1)];
  const Vec2 vertex = view.corner(candidate.vertex).position;
  const auto line = [&](int corner, int edge) {
    const Vec2 from = vertex - view.corner(corner).position;
    const Corner& other = view.corner(edge);
    return TipLine{surface.is_reflex(at(corner)) ? -HUGE_VAL : cross(from, other.tangent), norm(from),
                   other.length};
  };
  return {line(start, surface.previous[at(start)]), line(end, end)};
}

void find_competitors(const CornerView& view, std::span<const std::size_t> pairs,
                      std::vector<Competitor>& competitors) {
  competitors.clear();
  if (pairs.empty()) return;
  const CandidateList& candidates = view.candidates;
  const int first_candidate = candidates.block_pairs[pairs.front()].first;
  CandidateList::Finder held_by(candidates, first_candidate);
  std::size_t count = 0;
  Group group;
  const auto take = [&] {
    competitors.resize(count + lane_count);
    count += pass(view, group, &competitors[count]);
    group.size = 0;
  };
  const Memory nothing;
  for (const std::size_t p : pairs) {
    const BlockPair& pair = candidates.block_pairs[p];
    const PairLimits limits(view, at(pair.block_a), at(pair.block_b));
    const std::size_t first = at(pair.first), end = candidates.end_of_pair(p);
    const std::span<const int> deep = of_pair(view.deep, first, end);
    const bool is_deep = limits.pressed > 0.0 || !deep.empty();
    for (std::size_t k = first; k < end; ++k) {
      const int memory = held_by(k);
      const Candidate& c = candidates.pairs[k];
      add(group, k, p, limits, memory >= 0 ? candidates.memory[at(memory)] : nothing,
          is_deep ? 0.0 : c.clearance,
          deep.empty() ? SidesOfVertex{} : sides_to_deep(view.surface, candidates, deep, c));
      if (group.size == lane_count) take();
    }
  }
  if (group.size > 0) take();
  competitors.resize(count);
  name_corners(view, first_candidate, competitors);
}

}  // namespace keyblock::contact
