// How far the blocks of a pair may move before its contacts are others.
#include <algorithm>
#include <cmath>

#include "contact/detection.h"
#include "contact/line_motion.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

/// How much a distance of a vertex from a line changes at most, over the motion m of both blocks together: n·(V − A) by 1 + 2.2
/// |V − A| / L; the rest is room.
double rate(double distance, double length) {
  return 2.0 + line_turn * distance / length;
}

/// How far two lines may move, as a share of the shorter, before the sine of the angle between them passes a threshold.
double turn_margin(double sine, double threshold) {
  return std::min(std::abs(sine - threshold) / (2.0 * line_turn), largest_line_motion);
}

}  // namespace

/// Before another candidate of the pair passes, or one that does passes no more, or comes to meet other corners.
double Detection::candidate_margin(const Surface& surface, const CandidateList& candidates,
                                   const BlockPair& pair, std::size_t end, std::span<const Rival> rivals,
                                   double reach) const {
  double margin = HUGE_VAL;
  auto rival = rivals.begin();
  for (std::size_t k = at(pair.first); k < end && margin > 0.0; ++k) {
    const Candidate& c = candidates.pairs[k];
    if (rival != rivals.end() && at(rival->candidate) == k) {
      margin = std::min(margin, rival_margin(surface, c, *rival++, reach));
    } else {
      margin = std::min(margin, clearance(surface, surface.position, tolerances_, c.vertex, c.edge) - reach);
    }
  }
  return std::max(0.0, margin);
}

/// The conditions of pass(), each with what is between it and failure. What reach and turn add to them only helps, but where it
/// makes corners meet.
double Detection::rival_margin(const Surface& surface, const Candidate& candidate, const Rival& rival,
                               double reach) const {
  const Corner &line = corners_[at(candidate.edge)], &vertex = corners_[at(candidate.vertex)];
  const double length = line.length, zone = tolerances_.end_zone;
  if (length < 4.0 * zone) return 0.0;
  const double from_start = norm(vertex.position - line.position),
               from_end = norm(vertex.position - line.position - length * line.tangent);
  const double start_rate = rate(from_start, length), end_rate = rate(from_end, length),
               gap_rate = std::min(start_rate, end_rate);
  const double deepest = std::min({tolerances_.depth_limit, surface.thickness[at(candidate.block_a)],
                                   surface.thickness[at(candidate.block_b)]});
  const bool reflex_start = surface.is_reflex(at(candidate.edge)),
             reflex_end = surface.is_reflex(at(surface.next[at(candidate.edge)]));
  const auto beyond = [&](int corner) {
    return surface.is_nook(at(corner)) ? std::max(zone, deepest) : zone;
  };
  double margin = std::min({(tolerances_.activation - rival.gap) / gap_rate, (rival.gap + deepest) / gap_rate,
                            (rival.along + beyond(candidate.edge)) / start_rate,
                            (length + beyond(surface.next[at(candidate.edge)]) - rival.along) / end_rate});

  for (const int other : {surface.previous[at(candidate.vertex)], surface.next[at(candidate.vertex)]}) {
    const Vec2 u = surface.position[at(other)] - vertex.position;
    const double size = norm(u), shortest = std::min(size, length);
    const double outside = dot(line.normal(), u) / size + Tolerances::sine_inside;
    margin = std::min(margin, std::min(outside / line_turn, largest_line_motion) * shortest);
  }

  margin = std::min(margin, depth_margin(surface, candidate, rival, gap_rate));
  const double from_zone_start = (rival.along - zone - reach) / start_rate,
               from_zone_end = (length - rival.along - zone - reach) / end_rate;
  if (from_zone_start > 0.0 && from_zone_end > 0.0) return std::min({margin, from_zone_start, from_zone_end});
  margin = std::min(margin, std::abs(rival.along - 0.5 * length) / std::max(start_rate, end_rate));
  if (rival.first_half ? reflex_start : reflex_end) return margin;
  return std::min(margin, rival.first_half ? (zone - rival.along) / start_rate
                                           : (zone - (length - rival.along)) / end_rate);
}

/// The rule of has_come_in_elsewhere().
double Detection::depth_margin(const Surface& surface, const Candidate& candidate, const Rival& rival,
                               double gap_rate) const {
  const double too_deep = -rival.gap - deep(rival);
  if (too_deep < 0.0) return -too_deep / gap_rate;
  // The vertex and the other edges move by no more than the blocks do.
  const double length = corners_[at(candidate.edge)].length,
               farther = to_nearest_other_edge(surface, candidate.vertex, candidate.edge) + rival.gap;
  const double margin = std::min({too_deep / gap_rate, std::abs(farther) / (1.0 + gap_rate),
                                  std::abs(rival.along - 0.5 * length) / rate(length, length)});
  return std::min(margin, facing_margin(surface, candidate));
}

/// Before an edge of the vertex comes to face the edge, or does so no more.
double Detection::facing_margin(const Surface& surface, const Candidate& candidate) const {
  const Corner& edge = corners_[at(candidate.edge)];
  const std::size_t vertex = at(candidate.vertex);
  const std::array<double, 2> sizes{corners_[vertex].length, corners_[at(surface.previous[vertex])].length};
  double margin = HUGE_VAL;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double sine = std::abs(cross(sides(candidate)[k], edge.tangent));
    margin = std::min(margin, turn_margin(sine, Tolerances::sine_facing) * std::min(edge.length, sizes[k]));
  }
  return margin;
}

/// The rules of compete(), with the winner as the one that was in contact. They hold where the corners are now and, as long as both
/// are within the margin, where they will be.
double Detection::outcome_margin(const Surface& surface, std::span<Rival* const> rivals,
                                 const Outcome& outcome, const CandidateList& candidates) const {
  // Which line parts two corners hangs on third blocks, too.
  if (outcome.handed_over || outcome.left_out || (outcome.winner != nullptr && !outcome.parallel)) return 0.0;
  const auto line = [&](const Rival* r) -> const Corner& { return this->line(*r, candidates); };
  // Near an end of their lines, all of them.
  const auto over_rate = [&](const Rival* r) {
    return rate(line(r).length + tolerances_.depth_limit, line(r).length);
  };
  const auto gap_rate = [&](const Rival* r) {
    return rate(std::abs(r->gap) + std::abs(inside(r->along, line(r).length)), line(r).length);
  };
  double margin = HUGE_VAL, while_alike = HUGE_VAL, fastest = 0.0, least_gap = HUGE_VAL,
         largest_gap = -HUGE_VAL;
  bool each_has_other = true;  // that parts the corners another way
  for (const Rival* r : rivals) {
    bool has_other = false;
    for (const Rival* other : rivals) {
      if (other == r) continue;
      const double sine = std::abs(cross(line(r).tangent, line(other).tangent)),
                   shortest = std::min(line(r).length, line(other).length);
      margin = std::min(margin, turn_margin(sine, Tolerances::sine_parallel) * shortest);
      const double cosine = cosine_between(*r, *other, candidates);
      while_alike = std::min(while_alike, turn_margin(cosine, Tolerances::cosine_alike) * shortest);
      has_other = has_other || part_otherwise(*r, *other, candidates);
    }
    each_has_other = each_has_other && has_other;
    fastest = std::max(fastest, gap_rate(r));
    least_gap = std::min(least_gap, r->gap);
    largest_gap = std::max(largest_gap, r->gap);
  }
  const Rival* winner = outcome.winner;
  if (outcome.parallel) {
    for (const Rival* r : rivals)
      margin = std::min(margin, facing_margin(surface, candidates.pairs[at(r->candidate)]));
    if (winner != nullptr)
      return std::min(margin, (inside(winner->along, line(winner).length) - leave()) / over_rate(winner));
    for (const Rival* r : rivals)
      margin = std::min(margin, (-tolerances_.rounding - inside(r->along, line(r).length)) / over_rate(r));
    return margin;
  }
  // A tie, whichever has the largest gap.
  if (!each_has_other) return 0.0;
  for (const Rival* r : rivals)
    margin = std::min(margin, std::abs(r->gap + tolerances_.corner_depth) / fastest);
  return std::min({margin, while_alike, (largest_gap + tolerances_.corner_depth) / fastest,
                   (tolerances_.corner_tie - (largest_gap - least_gap)) / (2.0 * fastest)});
}

}  // namespace keyblock::contact
