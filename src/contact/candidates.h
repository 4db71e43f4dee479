#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "contact/surface.h"
#include "contact/tolerances.h"

namespace keyblock::contact {

enum class State : std::uint8_t { open = 0, sliding = 1, locked = 2 };

/// What a contact remembers from step to step; of one that took no part in the last step, the slip alone.
struct Memory {
  State state = State::open;
  bool tracked = false;  ///< took part in the last step
  bool bonded = false;   ///< in place, with cohesion and tension not yet broken
  double offset =
      0.0;  ///< m, subtracted from the penetration: a contact born penetrated does not push that out;
            ///< negative: the closure of a joint that carries in-situ stress
  double stiffness = 0.0;     ///< N/m per thickness, of the normal spring in the last step
  double shear = 0.0;         ///< m, elastic shear displacement
  double normal_force = 0.0;  ///< N per thickness, compression positive
  double bounding_force =
      0.0;  ///< N per thickness; times μ it bounds the friction of the next step: the normal force,
            ///< while sliding extrapolated, so that friction does not lag behind it
  double multiplier = 0.0;  ///< m, augmented Lagrangian: normal force over stiffness, in place of penetration
  double drift = 0.0;       ///< m, augmented Lagrangian: shear displacement since the contact last slid
  double stored = 0.0;      ///< J per thickness, elastic energy of the springs
  double slip = 0.0;        ///< m, shear displacement since the slip was last set to zero
};

/// A vertex near an edge of another block.
struct Candidate {
  int vertex = 0;
  int edge = 0;
  Memory memory;
};

/// Collects the vertices near edges, and keeps their list while blocks move little. The list itself belongs to the state.
///
/// Each block has a margin; as long as no vertex of it has moved further than that, its candidates contain every contact
/// there can be. A block that has used up its margin is looked at anew, alone. Candidates are ordered by
/// (smaller block, larger block, vertex, edge), so the order of contacts does not depend on when that happened.
class Candidates {
 public:
  explicit Candidates(const Tolerances& tolerances) : tolerances_(tolerances) {}

  /// Brings `list` up to date; memory of candidates that stay is kept. reach[b]: m, bound on the motion of block b in the
  /// coming step. Returns true when the list has changed.
  bool update(const Surface& surface, std::span<const double> reach, std::vector<Candidate>& list);
  /// Forgets the positions at which blocks were looked at: all are looked at anew in the next update.
  void invalidate() { looked_at_.clear(); }

 private:
  struct Key {
    int low, high, vertex, edge;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  static Key key(const Surface& surface, const Candidate& c);
  bool look_at(const Surface& surface, std::span<const std::uint8_t> dirty,
               std::vector<Candidate>& list) const;
  void collect_pair(const Surface& surface, int a, int b, std::vector<Candidate>& found) const;

  Tolerances tolerances_;
  std::vector<Vec2> looked_at_;  ///< vertex positions when their block was last looked at
  std::vector<double> margin_;   ///< per block
  std::vector<Box> box_;         ///< per block, when looked at, grown by its margin
};

/// The oracle: every vertex against every edge. Returns (vertex, edge) of all that lie within `distance`.
std::vector<Candidate> all_pairs_within(const Surface& surface, double distance);

/// Distance from p to the segment ab.
double distance_to_segment(Vec2 p, Vec2 a, Vec2 b);

}  // namespace keyblock::contact
