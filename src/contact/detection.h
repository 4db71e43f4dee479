#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/surface.h"
#include "core/lanes.h"
#include "core/parallel.h"

namespace keyblock::contact {

/// Direction of an edge from its outward normal.
inline Vec2 tangent_of(Vec2 normal) {
  return {-normal.y, normal.x};
}

/// A contact of this step: vertex V of block a against edge AB of block b, linear in the displacements of both.
///
///     gap  g = n · (V − P),     g(D) = gap + n · r,     r = D_a(V) − D_b(P),   P = (1 − s) A + s B
///     slip u(D) = shear + t · r
///
/// n is the outward unit normal of the edge, t its direction (A to B). Where AB is a piece of a divided edge, P is on the curve through
/// all vertices of that (edge_curve.h).
struct Contact {
  int candidate = 0;  ///< of the list
  int block_a = 0, block_b = 0;
  int vertex = 0, edge = 0;
  Vec2 normal;
  double position = 0.0;  ///< s, 0 at A, 1 at B; a little outside near the ends
  double gap = 0.0;       ///< m, of the geometry
  /// m of joint that belongs to it: half of what each facing pair of edges shares, at either end. Of two corners that meet in one contact
  /// it has the share of both.
  double length = 0.0;
  double depth = 0.0;  ///< m, −(gap + offset): what the normal spring sees at the start of the step
  double normal_stiffness = 0.0, shear_stiffness = 0.0;  ///< N/m per thickness
  double friction_coefficient = 0.0;
  double cohesion = 0.0, tension = 0.0;  ///< N per thickness, of a bond
  bool fused = false;
  Memory memory;  ///< at the start of the step; no bond any more where that breaks in it

  [[nodiscard]] Vec2 tangent() const { return tangent_of(normal); }
};

/// Takes what the contacts of a step remember over into the list. Candidates that were no contacts remember nothing.
void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team);

/// Geometry of candidates turned into the contacts of a step.
///
/// A candidate takes part when its vertex lies over the edge (or within a zone of its ends), not deeper than the depth
/// limit, and both edges of the vertex lie outside, or may come to in the step by the turn of the blocks. Where two corners meet, up to four candidates describe the same
/// corner pair; they compete, so that one contact remains (vertex-vertex contact with a unique entrance line):
///   - all lines parallel: the end of an edge-edge contact. The vertex that lies over the other's edge; the one that
///     already was in contact stays until it has clearly left, and then hands its memory over. Both, where each vertex is far from the
///     end and the corners meet only as their blocks may move far in the step.
///   - otherwise corner to corner: the line that is passed last in the step, as the corners go now. Of lines that are not passed,
///     or were before, that of the largest gap, which is the shortest way out; while that is a tie
///     none, or the one that presses. Not a line that a third block is in the way of (closed_joints.cpp).
///
/// All this hangs on thresholds of a share of a block, while blocks in contact move by a millionth of one in a step. A pair of blocks
/// is looked at when it may have passed one (BlockPair); of the others only the geometry of their contacts is computed.
class Detection {
 public:
  /// penalty[b]: Pa/m, normal stiffness of joints of block b that give none; the softer of two blocks counts. laws[k]: by
  /// Surface::joint.
  Detection(const Tolerances& tolerances, std::vector<JointLaw> laws, std::vector<double> penalty)
      : tolerances_(tolerances), laws_(std::move(laws)), penalty_(std::move(penalty)) {}
  /// Has all pairs looked at in each step: slower, and the same contacts.
  void leave_out_steady_pairs() { uses_steady_pairs_ = false; }

  /// How far every block may move. `turn` is at most `reach` over the radius of the block: clearances count on it.
  struct Motion {
    std::span<const double> reach;  ///< m, in the step
    std::span<const double> turn;   ///< rad, in the step
    std::span<const double> away;   ///< m, Candidates::away
    /// m, per block: length of the way that its vertices have gone against its first one since some time in the past, by the one
    /// that moved furthest in each step.
    std::span<const double> way;
    /// m, per vertex: where its velocity takes it in the step, unless something stops it, or where it went when the step was looked at
    /// before; and, per block, how far from where the first one goes at most. Empty: nowhere.
    std::span<const Vec2> ahead = {};
    std::span<const double> way_ahead = {};
    std::span<const Vec2> ahead_at_first = {};  ///< `ahead` of the first look at the step; empty: this is it
  };
  /// Contacts of the step in the order of the candidates: find_which() and describe().
  void find(const Surface& surface, const Motion& motion, CandidateList& candidates, ThreadTeam& team,
            std::vector<Contact>& contacts);
  /// Which candidates are contacts. Returns their number.
  std::size_t find_which(const Surface& surface, const Motion& motion, CandidateList& candidates,
                         ThreadTeam& team);
  /// Of contacts [first, last): what is done with them while a cache has them. Threads may do so at once.
  using OfSome = std::function<void(std::size_t first, std::size_t last)>;
  /// What find_which() found, into as many contacts. Returns whether these were contacts of the same vertices and edges before.
  bool describe(const Surface& surface, const CandidateList& candidates, ThreadTeam& team,
                std::span<Contact> contacts, const OfSome& then = {}) const;

 private:
  /// A vertex, and the edge that begins there: eight numbers, to be read at once.
  struct Corner {
    Vec2 position;
    Vec2 tangent, before;  ///< directions of the edge and of the one that ends here
    double length = 0.0;   ///< m, of the edge
    double kinds = 0.0;    ///< CornerKind here, and four times that at the end of the edge
    [[nodiscard]] Vec2 normal() const { return {tangent.y, -tangent.x}; }
  };
  /// What an edge is a piece of, likewise.
  struct Whole {
    Vec2 from, to;             ///< where it begins and ends
    double start_share = 0.5;  ///< Surface::start_share of the edge
    double pieces = 1.0;
    double unused[2]{};
  };
  /// A candidate that passes the geometry.
  struct Rival {
    int candidate;          ///< −1: has lost to another of the same two corners
    int pair;               ///< of blocks
    int memory;             ///< of the list, that it goes on with; −1: none
    bool first_half;        ///< of the edge is where the vertex is
    bool is_beyond;         ///< the end zone: a contact only in a nook between two blocks
    bool disputed;          ///< the vertex is near an end of the edge, so that two corners meet
    std::uint64_t corners;  ///< the two that meet; 0: none
    double gap, along;      ///< m
  };
  /// A contact of the step.
  struct Found {
    int candidate;
    int memory;   ///< of the list, that it goes on with; −1: none
    bool at_end;  ///< Rival::disputed: it stands for both corners that meet
  };
  void measure_corners(const Surface& surface, ThreadTeam& team);
  void look_at_pairs(const Surface& surface, CandidateList& candidates, std::size_t first, std::size_t last,
                     std::vector<Found>& found) const;
  void find_rivals(const Surface& surface, const CandidateList& candidates,
                   std::span<const std::size_t> pairs, std::vector<Rival>& rivals) const;
  void decide(const Surface& surface, const CandidateList& candidates, BlockPair& pair, std::size_t end,
              std::span<Rival> rivals) const;
  [[nodiscard]] bool is_steady(const Surface& surface, const BlockPair& pair) const;
  // m, from the first vertex of block a to that of block b.
  [[nodiscard]] static Vec2 apart(const Surface& surface, const BlockPair& pair);
  [[nodiscard]] double to_nearest_other_edge(const Surface& surface, int vertex, int of,
                                             int except = -1) const;
  [[nodiscard]] bool has_come_in_elsewhere(const Surface& surface, const Rival& rival,
                                           const CandidateList& candidates, int except = -1) const;
  [[nodiscard]] bool is_out(const Surface& surface, const BlockPair& pair, const Rival& rival,
                            const CandidateList& candidates) const;
  /// m, behind an edge, from which on it is asked where a vertex has come in. A tip that presses on the very end of a face is nearer to the
  /// side below.
  [[nodiscard]] double deep(const Rival& rival) const {
    return rival.disputed ? tolerances_.end_zone : tolerances_.corner_depth;
  }
  /// Whether the vertex has come in by the face: that has been in contact with it since it was no deeper behind it than the end zone.
  [[nodiscard]] bool has_come_in_here(const Rival& rival, const CandidateList& candidates) const {
    return rival.memory >= 0 &&
           candidates.memory[static_cast<std::size_t>(rival.memory)].offset <= tolerances_.end_zone;
  }
  /// Whether the vertex is over the face, presses on it, and has come in by it.
  [[nodiscard]] bool holds(const Rival& rival, const CandidateList& candidates) const {
    return has_come_in_here(rival, candidates) &&
           candidates.memory[static_cast<std::size_t>(rival.memory)].normal_force > 0.0 &&
           inside(rival.along, line(rival, candidates).length) >= 0.0;
  }
  /// Directions of the edges of the vertex, away from it.
  [[nodiscard]] std::array<Vec2, 2> sides(const Candidate& candidate) const {
    const Corner& vertex = corners_[static_cast<std::size_t>(candidate.vertex)];
    return {vertex.tangent, -1.0 * vertex.before};
  }
  /// Of the edge, away from the end that is nearer to the vertex.
  [[nodiscard]] Vec2 line_inwards(const Rival& rival, const Candidate& candidate) const {
    return (rival.first_half ? 1.0 : -1.0) * corners_[static_cast<std::size_t>(candidate.edge)].tangent;
  }
  /// Which of the candidates for one pair of corners is the contact.
  struct Outcome {
    Rival* winner = nullptr;   ///< null: none
    bool parallel = true;      ///< all their lines
    bool handed_over = false;  ///< the winner goes on with the memory of another
    bool left_out = false;     ///< others were, that no edge of their vertex faces or that are closed
  };
  /// Whether an edge of the vertex and the edge face each other: they run against each other, each with its block on the left.
  [[nodiscard]] bool faces(const Rival& rival, const CandidateList& candidates) const;
  [[nodiscard]] Outcome compete(const Surface& surface, std::span<Rival* const> rivals,
                                const CandidateList& candidates) const;
  [[nodiscard]] Outcome compete_in_joints(const Surface& surface, const BlockPair& pair,
                                          std::span<Rival* const> all, const CandidateList& candidates) const;
  /// What third blocks are to a line, near the end where two corners meet.
  struct Third {
    /// `closed`: one covers the edge there, or is inside the line beyond an edge of the vertex that it covers. Less: both corners stand on
    /// its face, and this is the sine of the angle at which the line pushes one of them into that.
    double in_the_way = 0.0;
    bool is_beside = false;    ///< one covers the edge that follows at that end
    bool is_in_front = false;  ///< and goes on in front of this one: what it lets in has nowhere else to go
  };
  static constexpr double closed = 2.0;
  [[nodiscard]] Third third(const Surface& surface, const BlockPair& pair, const Rival& rival,
                            const CandidateList& candidates) const;
  template <typename Call>
  void for_third_candidates(const CandidateList& candidates, const BlockPair& pair, int vertex, int block,
                            const Call& call) const;
  template <typename Call>
  void for_third_edges(const CandidateList& candidates, const BlockPair& pair, int vertex, int block,
                       const Call& call) const;
  [[nodiscard]] bool goes_on(const Surface& surface, int vertex, int face, int edge) const;
  [[nodiscard]] bool take_over_joint(const Surface& surface, const CandidateList& candidates,
                                     const BlockPair& pair, std::span<const Rival> rivals,
                                     Rival& rival) const;
  [[nodiscard]] bool lies_behind(const Rival& rival, const Candidate& candidate, int edge) const;
  [[nodiscard]] Vec2 beyond_joint(const Surface& surface, int corner, bool begins, int edge) const;
  [[nodiscard]] Rival* line_passed_last(const Surface& surface, std::span<Rival* const> rivals,
                                        const CandidateList& candidates, std::span<const Vec2> ahead) const;
  // Whether both edges of the vertex lie outside the line, now or as the corners go.
  [[nodiscard]] bool lies_outside(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                                  std::span<const Vec2> ahead) const;
  // m, as the corners go.
  [[nodiscard]] double gap_ahead(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                                 std::span<const Vec2> ahead) const;
  // When, as a share of the step, the vertex will be deeper than Tolerances::corner_depth; 0: it is; HUGE_VAL: not in this step.
  [[nodiscard]] double passing(const Surface& surface, const Rival& rival, const CandidateList& candidates,
                               std::span<const Vec2> ahead) const;
  // m by which both blocks of a pair together may move before its contacts are others; 0: not known. `reach`: m, what their reaches
  // add up to at most.
  [[nodiscard]] double candidate_margin(const Surface& surface, const CandidateList& candidates,
                                        const BlockPair& pair, std::size_t end, std::span<const Rival> rivals,
                                        double reach) const;
  [[nodiscard]] double rival_margin(const Surface& surface, const Candidate& candidate, const Rival& rival,
                                    double reach) const;
  [[nodiscard]] double depth_margin(const Surface& surface, const Candidate& candidate, const Rival& rival,
                                    double gap_rate) const;
  [[nodiscard]] double facing_margin(const Surface& surface, const Candidate& candidate) const;
  [[nodiscard]] double outcome_margin(const Surface& surface, std::span<Rival* const> rivals,
                                      const Outcome& outcome, const CandidateList& candidates) const;
  /// Up to as many candidates as there are lanes, and what their two blocks together may do (Motion).
  struct Group {
    std::size_t size = 0;
    std::array<int, lane_count> candidate{}, pair{};
    std::array<double, lane_count> reach{}, turn{};
    std::array<double, lane_count> deepest{};            ///< m, depth up to which they may be in contact
    std::array<double, lane_count> bonded{}, presses{};  ///< 1 or 0
  };
  std::size_t pass(const CandidateList& candidates, const Group& group, Rival* passed) const;
  /// Whether lines cannot count as one.
  [[nodiscard]] static bool turned(const Corner& one, const Corner& other) {
    return std::abs(cross(one.tangent, other.tangent)) >= Tolerances::sine_parallel;
  }
  /// m, how far beyond an end the contact of parallel lines stays where it is.
  [[nodiscard]] double leave() const { return -0.5 * tolerances_.end_zone; }
  /// m by which the vertex lies over the edge; negative: beyond the end.
  [[nodiscard]] static double inside(double along, double length) { return std::min(along, length - along); }
  /// Cosine of the angle between the ways in which two lines push the one block away from the other.
  [[nodiscard]] double cosine_between(const Rival& one, const Rival& other,
                                      const CandidateList& candidates) const {
    const auto owner = [&](const Rival& r) {
      return candidates.pairs[static_cast<std::size_t>(r.candidate)].block_b;
    };
    const double cosine = dot(line(one, candidates).tangent, line(other, candidates).tangent);
    return owner(one) == owner(other) ? cosine : -cosine;
  }
  /// Whether it matters which of two lines of the same corners parts them.
  [[nodiscard]] bool part_otherwise(const Rival& one, const Rival& other,
                                    const CandidateList& candidates) const {
    return turned(line(one, candidates), line(other, candidates)) &&
           cosine_between(one, other, candidates) < Tolerances::cosine_alike;
  }
  [[nodiscard]] const Corner& line(const Rival& rival, const CandidateList& candidates) const {
    return corners_[static_cast<std::size_t>(
        candidates.pairs[static_cast<std::size_t>(rival.candidate)].edge)];
  }
  bool describe_some(const Surface& surface, const CandidateList& candidates, std::span<const Found> found,
                     std::span<Contact> contacts) const;
  /// What is computed of as many contacts as there are lanes at once.
  struct Geometry {
    Lanes gap, position, length;  ///< as of Contact
    /// m, of joint that gives the contact its stiffness at the least: Tolerances::least_length, but no more than belongs to the vertex
    /// where the edges that face each other share all that they have.
    Lanes least_length;
    /// m of the length that belongs to it beyond the end of its edge, where two corners meet, and the edge that begins or ends there.
    Lanes length_beyond;
    std::array<std::size_t, lane_count> beyond;
  };
  struct Vertices;
  template <bool divided, typename OfEdge>
  void for_facing(const Vertices& vertices, const Lanes (&line)[lane_count],
                  const std::array<std::size_t, lane_count>& lines, const OfEdge& of_edge) const;
  template <bool divided>
  [[nodiscard]] Lanes length_beyond(const Vertices& vertices, const Lanes (&edge)[lane_count],
                                    const std::array<std::size_t, lane_count>& beyond) const;
  template <bool divided>
  [[nodiscard]] Geometry measure(const Surface& surface, const CandidateList& candidates,
                                 std::span<const Found> found) const;
  /// Of the edge beyond a corner.
  struct Beyond {
    double share;  ///< of the length that belongs to the contact at the corner
    int joint;     ///< Surface::joint
  };
  static void bend(const Surface& surface, Contact& contact);
  static JointLaw law_over_corner(JointLaw law, const JointLaw& beyond, double share, double penalty);
  /// What the springs of a contact have of its joint.
  struct SpringLaw {
    double per_length;  ///< Pa/m, normal stiffness
    double stiffness_ratio, friction;
    double cohesion, tension;  ///< Pa, of a bond
    bool fused;
  };
  void find_law(const Surface& surface, const Contact& contact, const Beyond& beyond,
                SpringLaw& of_contact) const;
  bool identify(const Found& found, const Candidate& candidate, Contact& contact) const;

  Tolerances tolerances_;
  std::vector<JointLaw> laws_;
  std::vector<double> penalty_;
  bool uses_steady_pairs_ = true;
  // Scratch.
  std::vector<Corner> corners_;  ///< per vertex
  std::vector<Whole> wholes_;    ///< per edge; empty: no edge is divided
  Motion motion_;                ///< in the step
  /// By piece of the pairs of blocks, in the order of the candidates, and the contact that each piece begins with.
  std::vector<std::vector<Found>> found_;
  std::vector<std::size_t> first_found_;
};

}  // namespace keyblock::contact
