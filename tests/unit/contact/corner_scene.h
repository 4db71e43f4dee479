#pragma once
#include <utility>
#include <vector>

#include "contact/candidates.h"
#include "contact/competitor.h"
#include "surface_builder.h"

namespace keyblock::contact {

/// A surface that stands still, with all that a CornerView shows of it. Memory may be added to `list` before the view is taken.
class CornerScene {
 public:
  explicit CornerScene(Surface surface) : surface_(std::move(surface)) {
    const auto blocks = static_cast<std::size_t>(surface_.blocks());
    still_.assign(blocks, 0.0);
    Candidates candidates(tolerances_);
    candidates.update(surface_, still_, list, team_);
    away_.assign(candidates.away().begin(), candidates.away().end());
    motion = {still_, still_, away_, still_};
    corners_.measure(surface_, team_);
  }
  [[nodiscard]] CornerView view() const { return {surface_, list, tolerances_, motion, corners_.all(), {}}; }
  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Tolerances& tolerances() const { return tolerances_; }
  [[nodiscard]] const Corners& corners() const { return corners_; }

  /// Into list.block_pairs: of two blocks that have candidates.
  [[nodiscard]] std::size_t pair_of(int a, int b) const {
    for (std::size_t p = 0; p < list.block_pairs.size(); ++p) {
      if (list.block_pairs[p].block_a == a && list.block_pairs[p].block_b == b) return p;
    }
    return list.block_pairs.size();
  }
  /// The candidate of a vertex and an edge; −1: none.
  [[nodiscard]] int candidate_of(int vertex, int edge) const {
    for (std::size_t k = 0; k < list.pairs.size(); ++k) {
      if (list.pairs[k].vertex == vertex && list.pairs[k].edge == edge) return static_cast<int>(k);
    }
    return -1;
  }
  [[nodiscard]] std::vector<Competitor> competitors(std::size_t pair) const {
    std::vector<Competitor> found;
    find_competitors(view(), std::vector{pair}, found);
    return found;
  }
  /// Makes a candidate a contact of the last step that presses. No other one is.
  void press(int candidate, double force = 1.0) {
    list.make_room(1);
    list.memory[0] = {};
    list.memory[0].normal_force = force;
    list.track(0, candidate);
  }

  CandidateList list;
  StepMotion motion;

 private:
  Surface surface_;
  Tolerances tolerances_{1.0};
  ThreadTeam team_{1};
  std::vector<double> still_, away_;
  Corners corners_;
};

/// The competitor of a vertex and an edge; null: none.
inline Competitor* competitor_of(const CornerView& view, std::vector<Competitor>& all, int vertex, int edge) {
  for (Competitor& c : all) {
    if (c.candidate >= 0 && view.candidate(c).vertex == vertex && view.candidate(c).edge == edge) return &c;
  }
  return nullptr;
}

inline std::vector<Competitor*> pointers_to(std::vector<Competitor>& all) {
  std::vector<Competitor*> pointers;
  for (Competitor& c : all) pointers.push_back(&c);
  return pointers;
}

}  // namespace keyblock::contact
