#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::contact {

enum class State : std::uint8_t { open = 0, sliding = 1, locked = 2 };

/// What a contact remembers from step to step.
struct Memory {
  State state = State::open;
  bool bonded = false;   ///< in place, with cohesion and tension not yet broken
  bool in_face = false;  ///< it shared the pressure of a face with others (JointFaces)
  double offset = 0.0;   ///< m, subtracted from the penetration: a contact born penetrated is not pushed out;
                         ///< negative: the closure of a joint that carries in-situ stress
  double stiffness = 0.0;  ///< N/m per thickness, of the normal spring in the last step
  double shear = 0.0;      ///< m, elastic shear displacement
  /// N per thickness, compression positive; of the pressure of a face what the contact bears (JointPressure), never its nodal force.
  double normal_force = 0.0;
  /// N per thickness; times μ it bounds the friction of the next step. It is the normal force, negative in the tension of a bond, and the part of
  /// it that the bounds of the steps before have missed while the contact slid, as a force over the last step. So friction loses no impulse.
  double bounding_force = 0.0;
  double stored = 0.0;       ///< J per thickness, elastic energy of the springs
  double bond_length = 0.0;  ///< m of joint that a bond holds: it stays what it was when the bond was made
  double worn = 0.0;         ///< m, slip that has worn the joint under the contact

  /// Whether the candidate is a contact as long as its vertex is over the edge: a bond at any gap, and what presses at any depth.
  [[nodiscard]] bool holds() const { return bonded || normal_force > 0.0; }
};

/// A vertex of block a near an edge of block b.
struct Candidate {
  int vertex = 0;
  int edge = 0;
  int block_a = 0, block_b = 0;
  /// m: as long as both blocks together have moved less since they were searched, this is no contact.
  double clearance = 0.0;
};

/// Which candidates of two blocks are contacts: known as long as the blocks move little (steady_pairs.h). Nothing that a restart would
/// miss: searched again, the contacts are the same.
struct SteadyContacts {
  int wait = 0;  ///< steps until it is tried again for how long the contacts stay the same
  // m: the contacts are the same as long as two sums are no more than these: how far the blocks have come from `apart`, with the paths of
  // both; and their reaches (StepMotion).
  double limit = -1.0, reach = 0.0;
  Vec2
      apart;  ///< m, from the first vertex of block a to the first vertex of block b, when they were searched
  std::uint64_t contacts = 0;   ///< then: bit k for candidate `first` + k of the pair
  std::uint64_t at_corner = 0;  ///< of these: where two corners meet

  void forget() { limit = -1.0; }
};

/// Two blocks that have candidates.
struct BlockPair {
  int first = 0;  ///< of its candidates; those of the next pair follow
  int block_a = 0, block_b = 0;
  SteadyContacts steady;
};

/// Candidates in the order (smaller block, larger block, vertex, edge), and what the contacts of the last step among them remember.
struct CandidateList {
  std::vector<Candidate> pairs;
  std::vector<BlockPair> block_pairs;  ///< derived; Candidates::update sees to it
  /// Likewise: into block_pairs, those of block b from first_of_block[b] to first_of_block[b + 1].
  std::vector<int> pair_of_block, first_of_block;
  std::vector<int> tracked;    ///< contacts of the last step, into pairs; ascending
  std::vector<Memory> memory;  ///< of each of them

  /// For the memory of so many contacts.
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
    const auto index = [&](auto candidate) {
      return first + static_cast<std::size_t>(candidate - of_pair.begin());
    };
    return {index(std::ranges::lower_bound(of_pair, vertex, {}, &Candidate::vertex)),
            index(std::ranges::upper_bound(of_pair, vertex, {}, &Candidate::vertex))};
  }

  /// Into block_pairs, ascending.
  [[nodiscard]] std::span<const int> pairs_of(int block) const {
    const int *first = &first_of_block[static_cast<std::size_t>(block)], *all = pair_of_block.data();
    return {all + first[0], all + first[1]};
  }

  /// Goes over the candidates in their order, and finds the memory of each.
  class Finder {
   public:
    Finder(const CandidateList& list, int first)
        : tracked_(list.tracked),
          next_(static_cast<std::size_t>(std::lower_bound(tracked_.begin(), tracked_.end(), first) -
                                         tracked_.begin())) {}
    /// Index into `memory`; −1: none. Candidates have to be asked for in ascending order.
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

}  // namespace keyblock::contact
