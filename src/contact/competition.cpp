#include "contact/competition.h"

#include "contact/entry_face.h"

namespace keyblock::contact {

namespace {

using All = std::span<Competitor* const>;

/// Some of the competitors for a pair of corners.
class Few {
 public:
  void add(Competitor* c) { all_[size_++] = c; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] All all() const { return All(all_).first(size_); }

 private:
  std::array<Competitor*, most_competitors> all_{};
  std::size_t size_ = 0;
};

/// Whether both edges of the vertex lie outside the line, now or after the predicted displacement.
bool lies_outside(const CornerView& view, const Competitor& competitor, std::span<const Vec2> predicted) {
  const Surface& surface = view.surface;
  const Candidate& c = view.candidate(competitor);
  const auto outside = [&](const auto& position) {
    const Vec2 along = position(surface.next[at(c.edge)]) - position(c.edge), corner = position(c.vertex);
    const auto is_outside = [&](int other) {
      const Vec2 u = position(other) - corner;
      return cross(u, along) >= -Tolerances::sine_inside * norm(u) * norm(along);
    };
    return is_outside(surface.previous[at(c.vertex)]) && is_outside(surface.next[at(c.vertex)]);
  };
  return outside([&](int v) { return surface.position[at(v)]; }) ||
         outside([&](int v) { return surface.position[at(v)] + predicted[at(v)]; });
}

/// m, gap at the end of the step, by the predicted displacement.
double predicted_gap(const CornerView& view, const Competitor& competitor, std::span<const Vec2> predicted) {
  if (predicted.empty()) return competitor.gap;
  const Candidate& c = view.candidate(competitor);
  const Corner& edge = view.corner(c.edge);
  const Vec2 r =
      predicted[at(c.vertex)] - lerp(predicted[at(c.edge)], predicted[at(view.surface.next[at(c.edge)])],
                                     competitor.along / edge.length);
  return competitor.gap + dot(edge.normal(), r);
}

/// When, as a share of the step, the vertex will be deeper than Tolerances::corner_depth. 0: it is; HUGE_VAL: not in this step.
double time_of_passing(const CornerView& view, const Competitor& c, std::span<const Vec2> predicted) {
  const double depth = view.tolerances.corner_depth;
  if (c.gap <= -depth) return 0.0;
  const double end = predicted_gap(view, c, predicted);
  return end < -depth ? (c.gap + depth) / (c.gap - end) : HUGE_VAL;
}

/// m, the largest gap of competitors that part the corners in another direction than `one`.
double largest_other_gap(const CornerView& view, All all, const Competitor& one) {
  double largest = -HUGE_VAL;
  for (const Competitor* c : all) {
    if (part_otherwise(view, *c, one)) largest = std::max(largest, c->gap);
  }
  return largest;
}

/// When the vertices pass their lines, and of the lines which is passed last and which has the largest gap.
struct Passing {
  std::array<double, most_competitors> when{};
  std::size_t last = 0, farthest = 0;

  Passing(const CornerView& view, All lines, std::span<const Vec2> predicted) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      when[i] = time_of_passing(view, *lines[i], predicted);
      if (lines[i]->gap > lines[farthest]->gap) farthest = i;
      if (when[i] > when[last] || (when[i] == when[last] && lines[i]->gap > lines[last]->gap)) last = i;
    }
  }
  /// Whether a line that is at an angle to the last one is passed in the step.
  [[nodiscard]] bool passes_another(const CornerView& view, All lines) const {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (when[i] > 0.0 && when[i] < HUGE_VAL && are_turned(view.line(*lines[i]), view.line(*lines[last])))
        return true;
    }
    return false;
  }
};

/// The line with the largest gap at the end of the step.
Competitor* nearest_way_out(const CornerView& view, All lines, std::span<const Vec2> predicted, double& gap) {
  Competitor* nearest = nullptr;
  for (Competitor* c : lines) {
    const double end = predicted_gap(view, *c, predicted);
    if (nearest != nullptr && !(end > gap)) continue;
    nearest = c;
    gap = end;
  }
  return nearest;
}

/// Of two corners that have each passed a line of the other, one is in the other when it has passed the last line. A corner that slides
/// along a face and over the joint at its end passes the side of the next block, but not its face. Null: there is no telling.
Competitor* line_passed_last(const CornerView& view, All all, std::span<const Vec2> predicted) {
  Few outside;  // the others are there for turns that blocks might make
  for (Competitor* c : all) {
    if (!predicted.empty() && lies_outside(view, *c, predicted)) outside.add(c);
  }
  const All lines = outside.size() > 0 ? outside.all() : all;
  const Passing passing(view, lines, predicted);
  Competitor *last = lines[passing.last], *farthest = lines[passing.farthest];
  if (passing.when[passing.last] < HUGE_VAL) return last;
  if (farthest->gap - largest_other_gap(view, lines, *farthest) < view.tolerances.corner_tie)
    return passing.passes_another(view, lines) ? last : nullptr;
  // A corner that comes to lie just inside of all lines gets out the shortest way from there: a corner that slides along a face is no deeper
  // behind the side of the next block than behind that face, though that side is farther away now.
  double gap = 0.0;
  Competitor* nearest = nearest_way_out(view, lines, predicted, gap);
  return gap < 0.0 ? nearest : last;
}

/// The competitor that was in contact; the strongest, should there be several. Null: none.
Competitor* last_contact(const CornerView& view, All all) {
  Competitor* found = nullptr;
  for (Competitor* c : all) {
    if (c->memory >= 0 &&
        (found == nullptr || view.memory(*c).normal_force > view.memory(*found).normal_force))
      found = c;
  }
  return found;
}

/// Of parallel lines. before: last_contact().
Competitor* winner_of_parallel(const CornerView& view, All all, Competitor* before) {
  Competitor* winner = nullptr;
  for (Competitor* c : all) {
    if (winner == nullptr || inside(view, *c) > inside(view, *winner)) winner = c;
  }
  const bool is_over = !(inside(view, *winner) < -view.tolerances.rounding);
  if (before != nullptr) return inside(view, *before) > leave(view.tolerances) || !is_over ? before : winner;
  return is_over ? winner : nullptr;  // else beyond the end of an edge, with nothing of it on the other side
}

/// Of lines at an angle.
Competitor* winner_of_turned(const CornerView& view, All all, Competitor* before) {
  Competitor* winner = line_passed_last(view, all, view.motion.predicted);
  // Corners that were held in the first attempt seem to go nowhere in the next.
  if (winner == nullptr && !view.motion.first_predicted.empty())
    winner = line_passed_last(view, all, view.motion.first_predicted);
  if (before == nullptr) return winner;
  // Corners that press on each other may part in the step, where one of them meets another block.
  if (winner == nullptr) return view.memory(*before).normal_force > 0.0 ? before : nullptr;
  // A vertex does not leave a face that holds it by a line that it has passed long ago without having been held there.
  return winner->gap <= -view.tolerances.corner_depth && holds_vertex(view, *before) ? before : winner;
}

/// Whether corners meet tip to tip, where they pressed on each other before or, in a static step, nothing tells which side they go: two lines part
/// them in other directions, and neither is nearer to being the way out, nor passed in the step. Each direction between the normals of the
/// lines keeps them apart then, as it does where tips are a little round.
bool meet_tip_to_tip(const CornerView& view, All all, const Competitor* before, const Competitor* winner) {
  const bool pressed = before != nullptr && view.memory(*before).normal_force > 0.0;
  const bool is_static = view.motion.predicted.empty();
  if (!pressed && !(is_static && winner == nullptr)) return false;
  const Competitor& one = pressed ? *before : *all[0];
  bool turned = false;
  for (const Competitor* c : all) {
    if (std::abs(c->gap - one.gap) >= view.tolerances.corner_tie) return false;
    if (predicted_gap(view, *c, view.motion.predicted) < std::min(c->gap, 0.0) - view.tolerances.corner_depth)
      return false;
    turned = turned || part_otherwise(view, *c, one);
  }
  return turned;
}

}  // namespace

double cosine_between(const CornerView& view, const Competitor& one, const Competitor& other) {
  const double cosine = dot(view.line(one).tangent, view.line(other).tangent);
  return view.candidate(one).block_b == view.candidate(other).block_b ? cosine : -cosine;
}

bool part_otherwise(const CornerView& view, const Competitor& one, const Competitor& other) {
  return are_turned(view.line(one), view.line(other)) &&
         cosine_between(view, one, other) < Tolerances::cosine_alike;
}

bool faces(const CornerView& view, const Competitor& c) {
  const Corner& vertex = view.corner(view.candidate(c).vertex);
  const Vec2 tangent = view.line(c).tangent;
  const auto runs_against = [&](Vec2 u) {
    return dot(u, tangent) < 0.0 && std::abs(cross(u, tangent)) <= Tolerances::sine_facing;
  };
  return runs_against(vertex.tangent) || runs_against(vertex.before);
}

Outcome compete(const CornerView& view, All all) {
  // Both faces of a sharp tip are one line to the corner beside it, and only one of them has the block of that corner on its other side.
  Few facing;
  bool parallel = true;
  for (Competitor* c : all) {
    parallel = parallel && !are_turned(view.line(*c), view.line(*all[0]));
    if (faces(view, *c)) facing.add(c);
  }
  const bool left_out = parallel && facing.size() > 0 && facing.size() < all.size();
  const All competing = left_out ? facing.all() : all;
  Competitor* before = last_contact(view, competing);
  Competitor* winner =
      parallel ? winner_of_parallel(view, competing, before) : winner_of_turned(view, competing, before);
  // Slip of one block against the other has the same sign on both sides. When the vertex and the edge change sides, the tangents of the two
  // lines run against each other, and normal and tangent turn together.
  const auto alike = [&](const Competitor& c, const Competitor& other) {
    return std::abs(dot(view.line(c).tangent, view.line(other).tangent)) > Tolerances::cosine_alike;
  };
  const bool hands_over = winner != nullptr && before != nullptr && winner != before &&
                          (parallel || (view.memory(*before).normal_force > 0.0 && winner->memory < 0 &&
                                        alike(*winner, *before)));
  const bool each = !parallel && meet_tip_to_tip(view, competing, before, winner);
  if (hands_over && !each) winner->memory = before->memory;
  return {winner, parallel, each, hands_over && !each, left_out};
}

}  // namespace keyblock::contact
