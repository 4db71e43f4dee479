#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact/surface.h"
#include "contact/tolerances.h"
#include "core/parallel.h"

namespace keyblock::contact {

/// Contacts (or vertices, or candidates), and blocks, from which loops over them are worth the threads of a team.
inline constexpr std::size_t contacts_worth_threads = 10'000, blocks_worth_threads = 2'000;

enum class State : std::uint8_t { open = 0, sliding = 1, locked = 2 };

/// What a contact remembers from step to step.
struct Memory {
  State state = State::open;
  bool bonded = false;  ///< in place, with cohesion and tension not yet broken
  double offset =
      0.0;  ///< m, subtracted from the penetration: a contact born penetrated does not push that out;
            ///< negative: the closure of a joint that carries in-situ stress
  double stiffness = 0.0;     ///< N/m per thickness, of the normal spring in the last step
  double shear = 0.0;         ///< m, elastic shear displacement
  double normal_force = 0.0;  ///< N per thickness, compression positive
  /// N per thickness; times μ it bounds the friction of the next step: the normal force, negative in a bond's tension, and what the
  /// bounds of the steps before have missed of it while the contact slid, as a force over the last one. So friction loses no impulse.
  double bounding_force = 0.0;
  double multiplier = 0.0;  ///< m, augmented Lagrangian: normal force over stiffness, in place of penetration
  double drift = 0.0;       ///< m, augmented Lagrangian: shear displacement since the contact last slid
  double stored = 0.0;      ///< J per thickness, elastic energy of the springs
  double bond_length = 0.0;  ///< m of joint that a bond holds: it stays what it was when the bond was made

  /// Whether the contact is one at any gap, as a bond, or at any depth, as what presses, as long as its vertex is over the edge.
  [[nodiscard]] bool holds() const { return bonded || normal_force > 0.0; }
};

/// A vertex of block a near an edge of block b.
struct Candidate {
  int vertex = 0;
  int edge = 0;
  int block_a = 0, block_b = 0;
  /// m: as long as both blocks together have moved less since they were looked at, this is no contact.
  double clearance = 0.0;
};

/// Two blocks that have candidates, and which of these are contacts: known as long as the blocks move little. Nothing that a
/// restart would miss: looked at anew, the contacts are the same.
struct BlockPair {
  int first = 0;  ///< of its candidates; those of the next pair follow
  int block_a = 0, block_b = 0;
  int wait = 0;  ///< steps until it is looked again for how long its contacts stay the same
  // m: they do as long as how far the blocks have come from `apart`, with the ways of both, and their reaches (Detection::Motion),
  // add up to no more than these.
  double steady = -1.0, reach = 0.0;
  Vec2 apart;  ///< m, from the first vertex of block a to that of block b, when they were looked at
  std::uint64_t contacts = 0;  ///< then: bit k for candidate first + k
  std::uint64_t at_end = 0;    ///< of these: where two corners meet
};

/// Candidates in the order (smaller block, larger block, vertex, edge), and what those remember that were contacts in the last
/// step.
struct CandidateList {
  std::vector<Candidate> pairs;
  std::vector<BlockPair> block_pairs;  ///< derived; Candidates::update sees to it
  /// Likewise: into block_pairs, those of block b from first_of_block[b] to first_of_block[b + 1].
  std::vector<int> pair_of_block, first_of_block;
  std::vector<int> tracked;    ///< contacts of the last step, into pairs; ascending
  std::vector<Memory> memory;  ///< of each of them

  /// For what so many contacts remember.
  void make_room(std::size_t contacts) {
    tracked.resize(contacts);
    memory.resize(contacts);
  }
  /// Memory k, which is there, is that of this candidate. Several threads may do so at once.
  void track(std::size_t k, int candidate) {
    tracked[k] = candidate;
    if (memory[k].bonded) pairs[static_cast<std::size_t>(candidate)].clearance = 0.0;  // any gap is a contact
  }
  /// Of the candidates of a pair of blocks.
  [[nodiscard]] std::size_t end_of_pair(std::size_t p) const {
    return p + 1 < block_pairs.size() ? static_cast<std::size_t>(block_pairs[p + 1].first) : pairs.size();
  }

  /// The candidates of a vertex among those of pair of blocks p.
  [[nodiscard]] std::pair<std::size_t, std::size_t> of_vertex(std::size_t p, int vertex) const {
    const std::size_t first = static_cast<std::size_t>(block_pairs[p].first);
    const auto of_pair = std::span(pairs).subspan(first, end_of_pair(p) - first);
    const auto place = [&](auto candidate) {
      return first + static_cast<std::size_t>(candidate - of_pair.begin());
    };
    return {place(std::ranges::lower_bound(of_pair, vertex, {}, &Candidate::vertex)),
            place(std::ranges::upper_bound(of_pair, vertex, {}, &Candidate::vertex))};
  }

  /// Into block_pairs, ascending.
  [[nodiscard]] std::span<const int> pairs_of(int block) const {
    const int *first = &first_of_block[static_cast<std::size_t>(block)], *all = pair_of_block.data();
    return {all + first[0], all + first[1]};
  }

  /// Walks over the candidates in their order: where the memory of each is.
  class Finder {
   public:
    Finder(const CandidateList& list, int first)
        : tracked_(list.tracked),
          next_(static_cast<std::size_t>(std::lower_bound(tracked_.begin(), tracked_.end(), first) -
                                         tracked_.begin())) {}
    /// Into `memory`; −1: none. No candidate before the last one that was asked for.
    int operator()(std::size_t candidate) {
      const int wanted = static_cast<int>(candidate);
      while (next_ < tracked_.size() && tracked_[next_] < wanted) ++next_;
      return next_ < tracked_.size() && tracked_[next_] == wanted ? static_cast<int>(next_) : -1;
    }

   private:
    std::span<const int> tracked_;
    std::size_t next_;
  };
};

/// Clearance of a candidate with vertices at `position`: 0 where it is, or may at once be, a contact. Detection::pass says
/// what a contact is; with m_a and m_b the motion of the blocks, reach of the step included, a line of length L that runs from A turns
/// by less than 2.2 m_b / L, so that distances of V from it change by less than (3 + 2.2 |V − A| / L) (m_a + m_b). The turn that
/// detection allows the edges for in the step is at most 2 reach / L, and covered by the same bound.
double clearance(const Surface& surface, std::span<const Vec2> position, const Tolerances& tolerances,
                 int vertex, int edge);

/// Collects the vertices near edges, and keeps their list while blocks move little. The list itself belongs to the state.
///
/// Each block has a margin; as long as no vertex of it has moved further than that, its candidates contain every contact
/// there can be. A block that has used up its margin is looked at anew, alone. The order of the candidates does not depend on
/// when that happened.
class Candidates {
 public:
  explicit Candidates(const Tolerances& tolerances) : tolerances_(tolerances) {}

  /// Brings `list` up to date; memory of candidates that stay is kept. reach[b]: m, bound on the motion of block b in the
  /// coming step. Returns true when the list has changed.
  bool update(const Surface& surface, std::span<const double> reach, CandidateList& list, ThreadTeam& team);
  /// m, per block, as of the last update: how far it may be, by the end of the step, from where it was looked at.
  [[nodiscard]] std::span<const double> away() const { return away_; }
  /// Forgets the positions at which blocks were looked at: all are looked at anew in the next update.
  void invalidate() { looked_at_.clear(); }

 private:
  void measure_motion(const Surface& surface, std::span<const double> reach, ThreadTeam& team);
  static bool before(const Candidate& x, const Candidate& y);
  /// Blocks that are looked at anew: which, ascending, and of each block whether it is one of them.
  struct Dirty {
    std::vector<int> blocks;
    std::vector<std::uint8_t> is;
    /// Of a candidate or a pair of blocks.
    [[nodiscard]] bool has_one_of(const auto& two) const {
      return is[static_cast<std::size_t>(two.block_a)] != 0 || is[static_cast<std::size_t>(two.block_b)] != 0;
    }
  };
  [[nodiscard]] std::vector<Candidate> collect(const Surface& surface, const Dirty& dirty) const;
  template <typename OfCandidate>
  static void for_old(const Dirty& dirty, const CandidateList& list, const OfCandidate& of_candidate);
  static void add_held(const Surface& surface, const Dirty& dirty, const CandidateList& list,
                       std::vector<Candidate>& found);
  static bool merge(std::span<const Candidate> found, const Dirty& dirty, CandidateList& list);
  void collect_pair(const Surface& surface, int a, int b, std::vector<Candidate>& found) const;

  Tolerances tolerances_;
  std::vector<Vec2> looked_at_;  ///< vertex positions when their block was last looked at
  std::vector<double> margin_;   ///< per block
  std::vector<double> away_;     ///< per block
  std::vector<Box> box_;         ///< per block, when looked at, grown by its margin
};

/// The oracle: every vertex against every edge. Returns (vertex, edge) of all that lie within `distance`.
std::vector<Candidate> all_pairs_within(const Surface& surface, double distance);

/// Distance from p to the segment ab.
double distance_to_segment(Vec2 p, Vec2 a, Vec2 b);

}  // namespace keyblock::contact
