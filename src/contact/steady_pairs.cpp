#include "contact/steady_pairs.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "contact/entry_face.h"
#include "contact/line_motion.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t most_candidates = 64;  // of a pair: bits of SteadyContacts

/// How much a distance of a vertex from a line changes at most, over the motion m of both blocks together: n·(V − A) by 1 + 2.2
/// |V − A| / L; the rest is room.
double rate(double distance, double length) {
  return 2.0 + line_turn * distance / length;
}

/// How far two lines may move, as a share of the shorter, before the sine of the angle between them passes a threshold.
double turn_margin(double sine, double threshold) {
  return std::min(std::abs(sine - threshold) / (2.0 * line_turn), largest_line_motion);
}

/// Before an edge of the vertex comes to face the edge, or does so no more.
double facing_margin(const CornerView& view, const Candidate& candidate) {
  const Corner& edge = view.corner(candidate.edge);
  const std::size_t vertex = at(candidate.vertex);
  const std::array<double, 2> sizes{view.corners[vertex].length,
                                    view.corner(view.surface.previous[vertex]).length};
  const std::array<Vec2, 2> sides = view.sides(candidate.vertex);
  double margin = HUGE_VAL;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double sine = std::abs(cross(sides[k], edge.tangent));
    margin = std::min(margin, turn_margin(sine, Tolerances::sine_facing) * std::min(edge.length, sizes[k]));
  }
  return margin;
}

/// Before has_come_in_elsewhere() is something else.
double depth_margin(const CornerView& view, const Candidate& candidate, const Competitor& competitor,
                    double gap_rate) {
  const double too_deep = -competitor.gap - entry_depth(view, competitor);
  if (too_deep < 0.0) return -too_deep / gap_rate;
  // The vertex and the other edges move by no more than the blocks do.
  const NearEdge nearest = nearest_other_edge(view, candidate.vertex, candidate.edge);
  const double length = view.corner(candidate.edge).length, farther = nearest.distance + competitor.gap;
  const double margin = std::min({too_deep / gap_rate, std::abs(farther) / (1.0 + gap_rate),
                                  std::abs(nearest.gap - view.tolerances.corner_depth) / (1.0 + gap_rate),
                                  std::abs(competitor.along - 0.5 * length) / rate(length, length)});
  return std::min(margin, facing_margin(view, candidate));
}

/// Rates at which distances of the vertex from the ends of the edge, and the gap, change at most.
struct Rates {
  double start, end, gap;
  Rates(const Corner& line, Vec2 vertex) {
    const double from_start = norm(vertex - line.position),
                 from_end = norm(vertex - line.position - line.length * line.tangent);
    start = rate(from_start, line.length);
    end = rate(from_end, line.length);
    gap = std::min(start, end);
  }
};

/// Before the vertex is no longer over the edge, or too deep, or too far.
double place_margin(const CornerView& view, const Candidate& candidate, const Competitor& competitor,
                    const Rates& rates) {
  const Surface& surface = view.surface;
  const double length = view.corner(candidate.edge).length, zone = view.tolerances.end_zone;
  const double deepest = std::min({view.tolerances.depth_limit, surface.thickness[at(candidate.block_a)],
                                   surface.thickness[at(candidate.block_b)]});
  const auto beyond = [&](int corner) {
    return surface.is_concave(at(corner)) ? std::max(zone, deepest) : zone;
  };
  return std::min({(view.tolerances.activation - competitor.gap) / rates.gap,
                   (competitor.gap + deepest) / rates.gap,
                   (competitor.along + beyond(candidate.edge)) / rates.start,
                   (length + beyond(surface.next[at(candidate.edge)]) - competitor.along) / rates.end});
}

/// Before the vertex, deeper than the end zone, is outside another edge.
double tip_margin(const CornerView& view, const Candidate& candidate, double gap, double gap_rate) {
  const double zone = view.tolerances.end_zone;
  if (gap > -zone) return (gap + zone) / gap_rate;
  double margin = HUGE_VAL;
  for (const TipLine& line : tip_lines(view, candidate))
    margin = std::min(margin, (zone - line.outside) / rate(line.away, line.length));
  return margin;
}

/// Before an edge of the vertex no longer lies outside the line.
double outside_margin(const CornerView& view, const Candidate& candidate) {
  const Surface& surface = view.surface;
  const Corner &line = view.corner(candidate.edge), &vertex = view.corner(candidate.vertex);
  double margin = HUGE_VAL;
  for (const int other : {surface.previous[at(candidate.vertex)], surface.next[at(candidate.vertex)]}) {
    const Vec2 u = surface.position[at(other)] - vertex.position;
    const double size = norm(u), shortest = std::min(size, line.length);
    const double outside = dot(line.normal(), u) / size + Tolerances::sine_inside;
    margin = std::min(margin, std::min(outside / line_turn, largest_line_motion) * shortest);
  }
  return margin;
}

/// Before a competitor passes find_competitors() no more, or meets other corners: every condition there, with what is between it and failure.
/// What reach and turn add to the conditions only helps, except where it makes corners meet. reach: m, of both blocks at most.
double competitor_margin(const CornerView& view, const Candidate& candidate, const Competitor& competitor,
                         double reach) {
  const Surface& surface = view.surface;
  const Corner& line = view.corner(candidate.edge);
  const double length = line.length, zone = view.tolerances.end_zone, along = competitor.along;
  if (length < 4.0 * zone) return 0.0;
  const Rates rates(line, view.corner(candidate.vertex).position);
  const double margin =
      std::min({place_margin(view, candidate, competitor, rates), outside_margin(view, candidate),
                depth_margin(view, candidate, competitor, rates.gap),
                tip_margin(view, candidate, competitor.gap, rates.gap)});
  const double from_zone_start = (along - zone - reach) / rates.start,
               from_zone_end = (length - along - zone - reach) / rates.end;
  if (from_zone_start > 0.0 && from_zone_end > 0.0) return std::min({margin, from_zone_start, from_zone_end});
  const double to_middle =
      std::min(margin, std::abs(along - 0.5 * length) / std::max(rates.start, rates.end));
  const int corner = competitor.first_half ? candidate.edge : surface.next[at(candidate.edge)];
  if (surface.is_reflex(at(corner))) return to_middle;
  return std::min(to_middle, competitor.first_half ? (zone - along) / rates.start
                                                   : (zone - (length - along)) / rates.end);
}

/// Before another candidate of the pair passes, or a competitor passes no more, or comes to meet other corners.
double candidate_margin(const CornerView& view, const BlockPair& pair, std::size_t end,
                        std::span<const Competitor> competitors, double reach) {
  double margin = HUGE_VAL;
  auto next = competitors.begin();
  for (std::size_t k = at(pair.first); k < end && margin > 0.0; ++k) {
    const Candidate& c = view.candidates.pairs[k];
    if (next != competitors.end() && at(next->candidate) == k) {
      margin = std::min(margin, competitor_margin(view, c, *next++, reach));
    } else {
      margin = std::min(
          margin, clearance(view.surface, view.surface.position, view.tolerances, c.vertex, c.edge) - reach);
    }
  }
  return std::max(0.0, margin);
}

/// The competitors for a pair of corners, near an end of their lines, and how their lines are to each other.
struct Meeting {
  double turn_margin = HUGE_VAL;   ///< m, before lines become parallel, or parallel lines do not stay so
  double alike_margin = HUGE_VAL;  ///< m, before lines come to part the corners alike, or do so no more
  double fastest = 0.0;            ///< rate of a gap
  double least_gap = HUGE_VAL, largest_gap = -HUGE_VAL;  ///< m
  bool each_has_other = true;                            ///< that parts the corners in another direction
};

Meeting measure_meeting(const CornerView& view, std::span<Competitor* const> competitors) {
  Meeting m;
  for (const Competitor* c : competitors) {
    const Corner& line = view.line(*c);
    bool has_other = false;
    for (const Competitor* other : competitors) {
      if (other == c) continue;
      const double sine = std::abs(cross(line.tangent, view.line(*other).tangent)),
                   shortest = std::min(line.length, view.line(*other).length);
      m.turn_margin = std::min(m.turn_margin, turn_margin(sine, Tolerances::sine_parallel) * shortest);
      const double cosine = cosine_between(view, *c, *other);
      m.alike_margin = std::min(m.alike_margin, turn_margin(cosine, Tolerances::cosine_alike) * shortest);
      has_other = has_other || part_otherwise(view, *c, *other);
    }
    m.each_has_other = m.each_has_other && has_other;
    m.fastest =
        std::max(m.fastest, rate(std::abs(c->gap) + std::abs(inside(c->along, line.length)), line.length));
    m.least_gap = std::min(m.least_gap, c->gap);
    m.largest_gap = std::max(m.largest_gap, c->gap);
  }
  return m;
}

/// Before another of the competitors with parallel lines wins.
double parallel_margin(const CornerView& view, std::span<Competitor* const> competitors,
                       const Competitor* winner) {
  const Tolerances& tolerances = view.tolerances;
  const auto over_rate = [&](const Competitor* c) {
    const double length = view.line(*c).length;
    return rate(length + tolerances.depth_limit, length);
  };
  double margin = HUGE_VAL;
  for (const Competitor* c : competitors) margin = std::min(margin, facing_margin(view, view.candidate(*c)));
  if (winner != nullptr)
    return std::min(margin, (inside(view, *winner) - leave(tolerances)) / over_rate(winner));
  for (const Competitor* c : competitors)
    margin = std::min(margin, (-tolerances.rounding - inside(view, *c)) / over_rate(c));
  return margin;
}

/// Before compete() has another outcome, with the winner as the contact of the last step. That holds where the corners are now and, as long
/// as both are within the margin, where they will be.
double outcome_margin(const CornerView& view, std::span<Competitor* const> competitors,
                      const Outcome& outcome) {
  // Which line parts two corners hangs on other blocks, too.
  const bool is_tie = !outcome.parallel && outcome.winner == nullptr && view.motion.predicted.empty();
  if (outcome.handed_over || outcome.left_out || is_tie || (outcome.winner != nullptr && !outcome.parallel))
    return 0.0;
  const Tolerances& tolerances = view.tolerances;
  const Meeting m = measure_meeting(view, competitors);
  if (outcome.parallel) return std::min(m.turn_margin, parallel_margin(view, competitors, outcome.winner));
  // A tie, whichever has the largest gap.
  if (!m.each_has_other) return 0.0;
  double margin = m.turn_margin;
  for (const Competitor* c : competitors)
    margin = std::min(margin, std::abs(c->gap + tolerances.corner_depth) / m.fastest);
  return std::min({margin, m.alike_margin, (m.largest_gap + tolerances.corner_depth) / m.fastest,
                   (tolerances.corner_tie - (m.largest_gap - m.least_gap)) / (2.0 * m.fastest)});
}

}  // namespace

SteadyMargin::SteadyMargin(const SteadyPairs& steady_pairs, const CornerView& view, const BlockPair& pair,
                           std::size_t end, std::span<const Competitor> competitors)
    : reach_(view.reach(pair.block_a, pair.block_b)),
      tries_(steady_pairs.is_on() && pair.steady.wait == 0 && end - at(pair.first) <= most_candidates),
      margin_(tries_ ? candidate_margin(view, pair, end, competitors, reach_share * reach_) : 0.0) {}

void SteadyMargin::take(const CornerView& view, std::span<Competitor* const> competitors,
                        const Outcome& outcome) {
  if (margin_ > 0.0) margin_ = std::min(margin_, outcome_margin(view, competitors, outcome));
}

void SteadyMargin::keep(const CornerView& view, std::span<const Competitor> competitors,
                        BlockPair& pair) const {
  SteadyContacts& steady = pair.steady;
  steady.wait = std::max(0, steady.wait - 1);
  if (!tries_) return;
  if (!(margin_ > least_share * reach_)) {
    steady.wait = steps_between_tries;
    return;
  }
  steady.limit = view.motion.path[at(pair.block_a)] + view.motion.path[at(pair.block_b)] + margin_;
  steady.reach = reach_share * reach_;
  steady.apart = SteadyPairs::apart(view.surface, pair);
  steady.contacts = steady.at_corner = 0;
  for (const Competitor& c : competitors) {
    if (c.candidate < 0) continue;
    const std::uint64_t bit = std::uint64_t{1} << (c.candidate - pair.first);
    steady.contacts |= bit;
    if (c.disputed) steady.at_corner |= bit;
  }
}

}  // namespace keyblock::contact
