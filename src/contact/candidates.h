#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidate_list.h"
#include "contact/surface.h"
#include "contact/tolerances.h"
#include "core/parallel.h"

namespace keyblock::contact {

/// Contacts (or vertices, or candidates), and blocks, from which loops over them are worth the threads of a team.
inline constexpr std::size_t contacts_worth_threads = 10'000, blocks_worth_threads = 2'000;

/// m, clearance of a candidate with vertices at `position`: 0 where it is, or may at once be, a contact (find_competitors). With m_a and m_b
/// the motion of the blocks, reach of the step included, a line of length L that runs from A turns by less than 2.2 m_b / L. So distances of
/// V from it change by less than (3 + 2.2 |V − A| / L) (m_a + m_b). The turn that detection allows the edges for in the step is at most
/// 2 reach / L, and covered by the same bound.
double clearance(const Surface& surface, std::span<const Vec2> position, const Tolerances& tolerances,
                 int vertex, int edge);

/// Collects the vertices near edges, and keeps their list while blocks move little. The list itself belongs to the state.
///
/// Each block has a margin. As long as no vertex of it has moved further than that, its candidates contain every contact there can be. A block
/// that has used up its margin is searched again, alone. The order of the candidates does not depend on when that happened.
class Candidates {
 public:
  explicit Candidates(const Tolerances& tolerances) : tolerances_(tolerances) {}

  /// Brings `list` up to date; memory of candidates that stay is kept. reach[b]: m, bound on the motion of block b in the
  /// coming step. Returns true when the list has changed.
  bool update(const Surface& surface, std::span<const double> reach, CandidateList& list, ThreadTeam& team);
  /// m, per block, as of the last update: how far it may be, by the end of the step, from where it was searched.
  [[nodiscard]] std::span<const double> away() const { return away_; }
  /// Forgets the positions at which blocks were searched: all are searched again in the next update.
  void invalidate() { searched_at_.clear(); }

 private:
  /// Blocks that are searched again: which, ascending, and of each block whether it is one of them.
  struct Dirty {
    std::vector<int> blocks;
    std::vector<std::uint8_t> is;
    /// Of a candidate or a pair of blocks.
    [[nodiscard]] bool has_one_of(const auto& two) const {
      return is[static_cast<std::size_t>(two.block_a)] != 0 || is[static_cast<std::size_t>(two.block_b)] != 0;
    }
  };
  void measure_motion(const Surface& surface, std::span<const double> reach, ThreadTeam& team);
  [[nodiscard]] Dirty begin_search(const Surface& surface, std::span<const double> reach, ThreadTeam& team);
  [[nodiscard]] std::vector<Candidate> collect(const Surface& surface, const Dirty& dirty) const;
  void collect_pair(const Surface& surface, int a, int b, std::vector<Candidate>& found) const;
  template <typename OfCandidate>
  static void for_old(const Dirty& dirty, const CandidateList& list, const OfCandidate& of_candidate);
  static void add_held(const Surface& surface, const Dirty& dirty, const CandidateList& list,
                       std::vector<Candidate>& found);
  static bool is_unchanged(std::span<const Candidate> found, const Dirty& dirty, CandidateList& list);
  static void merge(std::span<const Candidate> found, const Dirty& dirty, CandidateList& list);

  Tolerances tolerances_;
  std::vector<Vec2> searched_at_;  ///< vertex positions when their block was searched last
  std::vector<double> margin_;     ///< per block
  std::vector<double> away_;       ///< per block
  std::vector<double> pressed_;    ///< pressed_depths(), when blocks were searched last
  std::vector<Box> box_;           ///< per block, when searched, grown by its margin
};

/// The oracle: every vertex against every edge. Returns (vertex, edge) of all that lie within `distance`.
std::vector<Candidate> all_pairs_within(const Surface& surface, double distance);

/// Distance from p to the segment ab.
double distance_to_segment(Vec2 p, Vec2 a, Vec2 b);

}  // namespace keyblock::contact
