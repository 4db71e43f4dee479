// Where two corners meet: which of their lines keeps them apart.
#include <algorithm>
#include <array>
#include <cmath>

#include "contact/detection.h"
#include "core/index.h"

namespace keyblock::contact {

bool Detection::lies_outside(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                             std::span<const Vec2> ahead) const {
  const Candidate& c = candidates.pairs[at(rival.candidate)];
  const auto outside = [&](const auto& place) {
    const Vec2 along = place(surface.next[at(c.edge)]) - place(c.edge), corner = place(c.vertex);
    const auto is_outside = [&](int other) {
      const Vec2 u = place(other) - corner;
      return cross(u, along) >= -Tolerances::sine_inside * norm(u) * norm(along);
    };
    return is_outside(surface.previous[at(c.vertex)]) && is_outside(surface.next[at(c.vertex)]);
  };
  return outside([&](int v) { return surface.position[at(v)]; }) ||
         outside([&](int v) { return surface.position[at(v)] + ahead[at(v)]; });
}

double Detection::gap_ahead(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                            std::span<const Vec2> ahead) const {
  if (ahead.empty()) return rival.gap;
  const Candidate& c = candidates.pairs[at(rival.candidate)];
  const Corner& edge = corners_[at(c.edge)];
  const Vec2 r = ahead[at(c.vertex)] -
                 lerp(ahead[at(c.edge)], ahead[at(surface.next[at(c.edge)])], rival.along / edge.length);
  return rival.gap + dot(edge.normal(), r);
}

double Detection::passing(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                          std::span<const Vec2> ahead) const {
  const double depth = tolerances_.corner_depth;
  if (rival.gap <= -depth) return 0.0;
  const double end = gap_ahead(surface, rival, candidates, ahead);
  return end < -depth ? (rival.gap + depth) / (rival.gap - end) : HUGE_VAL;
}

/// Of two corners of which each has passed a line of the other, the one is in the other when it has passed the last: a corner that slides
/// along a face and over the joint at its end passes the side of the next block, but not its face. Null: there is no telling.
Detection::Rival* Detection::line_passed_last(const Surface& surface, std::span<Rival* const> all,
                                              const CandidateList& candidates,
                                              std::span<const Vec2> ahead) const {
  std::array<Rival*, 4> outside{};  // the others are there for turns that blocks might make
  std::size_t count = 0;
  for (Rival* r : all) {
    if (!ahead.empty() && lies_outside(surface, *r, candidates, ahead)) outside[count++] = r;
  }
  const std::span<Rival* const> rivals = count > 0 ? std::span<Rival* const>(outside).first(count) : all;
  std::array<double, 4> when{};
  std::size_t last = 0, farthest = 0;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    when[i] = passing(surface, *rivals[i], candidates, ahead);
    if (rivals[i]->gap > rivals[farthest]->gap) farthest = i;
    if (when[i] > when[last] || (when[i] == when[last] && rivals[i]->gap > rivals[last]->gap)) last = i;
  }
  if (when[last] < HUGE_VAL) return rivals[last];
  double second = -HUGE_VAL;
  bool passes_another = false;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    if (part_otherwise(*rivals[i], *rivals[farthest], candidates)) second = std::max(second, rivals[i]->gap);
    passes_another =
        passes_another || (when[i] > 0.0 && when[i] < HUGE_VAL &&
                           turned(line(*rivals[i], candidates), line(*rivals[last], candidates)));
  }
  if (rivals[farthest]->gap - second < tolerances_.corner_tie) return passes_another ? rivals[last] : nullptr;
  // One that comes to lie just inside of all lines gets out the shortest way from there: a corner that slides along a face is no deeper
  // behind the side of the next block than behind that face, though that side is farther away now.
  std::array<double, 4> ends{};
  for (std::size_t i = 0; i < rivals.size(); ++i) ends[i] = gap_ahead(surface, *rivals[i], candidates, ahead);
  const auto nearest = static_cast<std::size_t>(
      std::max_element(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(rivals.size())) -
      ends.begin());
  return ends[nearest] < 0.0 ? rivals[nearest] : rivals[last];
}

bool Detection::faces(const Rival& rival, const CandidateList& candidates) const {
  const Corner& vertex = corners_[at(candidates.pairs[at(rival.candidate)].vertex)];
  const Vec2 tangent = line(rival, candidates).tangent;
  const auto runs_against = [&](Vec2 u) {
    return dot(u, tangent) < 0.0 && std::abs(cross(u, tangent)) <= Tolerances::sine_facing;
  };
  return runs_against(vertex.tangent) || runs_against(vertex.before);
}

Detection::Outcome Detection::compete(const Surface& surface, std::span<Rival* const> all,
                                      const CandidateList& candidates) const {
  // Both faces of a sharp tip are one line to the corner beside it, and only one of them has that corner's block on its other side.
  std::array<Rival*, 4> facing{};
  std::size_t count = 0;
  bool parallel = true;
  for (Rival* f : all) {
    parallel = parallel && !turned(line(*f, candidates), line(*all[0], candidates));
    if (faces(*f, candidates)) facing[count++] = f;
  }
  const bool left_out = parallel && count > 0 && count < all.size();
  const std::span<Rival* const> rivals = left_out ? std::span<Rival* const>(facing).first(count) : all;
  const auto line = [&](const Rival& f) -> const Corner& { return this->line(f, candidates); };
  const auto over = [&](const Rival& f) { return inside(f.along, line(f).length); };
  const auto force = [&](const Rival& f) { return candidates.memory[at(f.memory)].normal_force; };
  Rival* holder = nullptr;  // the one that was in contact; the strongest, should there be several
  for (Rival* f : rivals) {
    if (f->memory >= 0 && (holder == nullptr || force(*f) > force(*holder))) holder = f;
  }
  Rival* winner = nullptr;
  if (parallel) {
    for (Rival* f : rivals) {
      if (winner == nullptr || over(*f) > over(*winner)) winner = f;
    }
    if (holder != nullptr && (over(*holder) > leave() || over(*winner) < -tolerances_.rounding)) {
      winner = holder;
    } else if (holder == nullptr && over(*winner) < -tolerances_.rounding) {
      winner = nullptr;  // a vertex beyond the end of an edge, with nothing of it on the other side
    }
  } else {
    winner = line_passed_last(surface, rivals, candidates, motion_.ahead);
    // Corners that were held in the first look at the step seem to go nowhere in the next.
    if (winner == nullptr && !motion_.ahead_at_first.empty())
      winner = line_passed_last(surface, rivals, candidates, motion_.ahead_at_first);
    // Corners that press on each other may part in the step, where one of them meets a third block.
    if (winner == nullptr && holder != nullptr && force(*holder) > 0.0) winner = holder;
    // Nor does one leave a face that holds it, and that it is over, by a line that it has long passed without having been held there.
    if (winner != nullptr && holder != nullptr && winner->gap <= -tolerances_.corner_depth &&
        holds(*holder, candidates))
      winner = holder;
  }
  // Slip of the one block against the other has the same sign on both sides: when the vertex and the edge change sides, the
  // tangents of the two lines run against each other, and normal and tangent turn together.
  const auto alike = [&](const Rival& f, const Rival& other) {
    return std::abs(dot(line(f).tangent, line(other).tangent)) > Tolerances::cosine_alike;
  };
  const bool hands_over =
      winner != nullptr && holder != nullptr && winner != holder &&
      (parallel || (force(*holder) > 0.0 && winner->memory < 0 && alike(*winner, *holder)));
  if (hands_over) winner->memory = holder->memory;
  return {winner, parallel, hands_over, left_out};
}

}  // namespace keyblock::contact
