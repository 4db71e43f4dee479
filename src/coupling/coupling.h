#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/row.h"
#include "coupling/spring_array.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

struct Attempt;
class BlockTerms;
struct Drive;
class FarField;
class ForceScale;
struct Model;
class Points;
class RowOwners;
class StagedSupports;
struct State;
class StepProblem;
class StillWater;

/// A material point of a body, a block or nodes of a line, by the basis functions of the body there.
struct MaterialPoint {
  int block = 0;            ///< number of the body
  std::vector<double> phi;  ///< N values
};

/// An end of an element, or of the stretch that it supports.
struct ElementEnd {
  Vec2 place;      ///< m, local, before the run
  int block = -1;  ///< that it is a point of; −1: of several
};

/// A part of a coupling that users know and that carries a force: a spring between two points, a support, a side of the boundary, a wall under
/// pressure. All that a run writes and draws of it (simulation/elements.h) asks for elements() and carried() alone.
struct Element {
  const char* kind = "";  ///< "spring", "support": as in the scenario
  std::string name;       ///< that of the scenario, or "spring[0]" by its place there
  double limit = 0.0;     ///< N per thickness, the largest force; infinite: none
  ElementEnd from, to;
  double spacing = 0.0;  ///< m out of plane, of which a section has one; 0: it goes on through the section
  bool may_rupture = false;
};

/// What an element carries.
struct Carried {
  Vec2 from, to;  ///< m, its ends, or those of the stretch that it supports
  double force =
      0.0;  ///< N per thickness; of springs tension is positive, of all else it is the size of the resultant
  double elongation =
      0.0;  ///< m, of springs the change of length since they were installed, of supports the mean way of what they support
  double yielded = 0.0;  ///< m of it, that does not come back
  bool present = false;
  bool ruptured = false;  ///< it has broken, and is there no more; of a liner: the rock has come off it
  double moment = 0.0;  ///< N m per thickness, of liners: positive where it stretches the side of the opening
  double shear = 0.0;   ///< N per thickness, of liners
  double utilization =
      std::numeric_limits<double>::quiet_NaN();  ///< of what has other limits than Element::limit
};

/// What some rows of a step are, that all of the problem asks for.
struct RowFacts {
  bool may_break = false;        ///< there are bonds that may break in this step
  bool lacks_room = false;       ///< the solver's pattern does not have the pair of blocks
  bool has_distant = false;      ///< the vertex is beyond an end of its edge by more than half of the edge
  bool may_change_laws = false;  ///< Coupling::change_laws has something to say of them
  RowFacts& operator|=(const RowFacts& other) {
    may_break |= other.may_break;
    may_change_laws |= other.may_change_laws;
    lacks_room |= other.lacks_room;
    has_distant |= other.has_distant;
    return *this;
  }
};

/// What the rows of a coupling are together at the end of a step.
struct CouplingTotals {
  double penetration = 0.0;  ///< m, largest depth of a contact
  int closed = 0;            ///< contacts
  CouplingTotals& operator+=(const CouplingTotals& other) {
    penetration = std::max(penetration, other.penetration);
    closed += other.closed;
    return *this;
  }
};

/// Other limits of a shear spring from now on, within a step (Coupling::change_laws).
struct LawChange {
  std::size_t row = 0;  ///< of the problem
  /// By how much of its limit it is beyond that: an event, such as rupture. Where events come at once, the largest excess is first. 0: it is
  /// none, but a limit that goes with other forces.
  double excess = 0.0;
  double least = 0.0, largest = 0.0;  ///< N per thickness; both 0: there is no spring any more
  double friction =
      -1.0;  ///< of a bond that breaks: from now on its normal spring presses alone, and this is its coefficient; −1: as it was
};

/// Where a coupling writes its rows.
struct CouplingRows {
  std::size_t first;        ///< its first row in the problem
  std::size_t first_point;  ///< its first material point
  std::span<Row> rows;      ///< its own rows
  SpringArray& springs;     ///< of all rows: those of rows[k] stand at first + k
  Points& points;
  RowOwners& owners;
  ThreadTeam& team;
};

/// A kind of energy between two blocks, or between a block and the ground: contacts of joints, supports, springs between points. It is
/// part of what a step minimizes, in one of two ways (docs/theory.md, section "Couplings"):
///
///   - *terms*: ½ Dᵀ K D − fᵀ D of single blocks, added to H and b (BlockTerms);
///   - *rows*: the potential of two springs each, which act on the relative displacement of two points (Row, SpringArray).
///
/// Its description does not change during a run. What it remembers from step to step stands in State, so that a run that is resumed knows
/// it: `memory_size` numbers, which are zero before the first step.
class Coupling {
 public:
  using BlockPairs = std::vector<std::pair<int, int>>;
  /// Names a row from step to step among all rows of a problem.
  struct RowKey {
    int coupling = 0;           ///< StepProblem's number of it
    std::pair<int, int> row{};  ///< among its own rows
    friend bool operator==(const RowKey&, const RowKey&) = default;
  };

  Coupling() = default;
  Coupling(const Coupling&) = delete;
  Coupling& operator=(const Coupling&) = delete;
  virtual ~Coupling() = default;

  /// Material points that the rows connect: in the problem, Points::material_point.
  [[nodiscard]] virtual std::span<const MaterialPoint> points() const { return {}; }
  /// Adds the pairs of blocks that the matrix of a step needs room for.
  virtual void add_pairs(BlockPairs& /*pairs*/) const {}
  [[nodiscard]] virtual std::size_t memory_size() const { return 0; }

  /// Adds its terms to those of the blocks.
  virtual void add_terms(const Model& /*model*/, const State& /*state*/, const Drive& /*drive*/,
                         std::span<const double> /*memory*/, BlockTerms& /*terms*/) const {}
  /// Number of its rows in the step at hand.
  [[nodiscard]] virtual std::size_t rows() const { return 0; }
  /// Of a row, among its own rows: what it is in other steps too.
  [[nodiscard]] virtual std::pair<int, int> key(std::size_t row) const { return {0, static_cast<int>(row)}; }
  /// Writes its rows and their springs, unstretched by D.
  virtual RowFacts build(const Model& /*model*/, const State& /*state*/, const Drive& /*drive*/,
                         std::span<const double> /*memory*/, CouplingRows /*out*/) const {
    return {};
  }

  /// What the solution of a step, as it is so far, does to the laws of its rows, added to `changes`. Asked only where
  /// RowFacts::may_change_laws. Events end: each row has few. Nothing of it is remembered but by account(), which sees it in the springs.
  virtual void change_laws(const StepProblem& /*problem*/, std::size_t /*first*/,
                           std::span<const double> /*memory*/, std::vector<LawChange>& /*changes*/) const {}

  /// Before blocks are moved: where its energy went in the step, into the ledger, and what it stores at the end as the step has it, into
  /// the energy of its kind in the state; what it remembers. `first`: its first row. spin: rad, by which the step turns each block.
  virtual CouplingTotals account(const Attempt& /*attempt*/, std::span<const double> /*spin*/,
                                 std::size_t /*first*/, std::span<double> /*memory*/,
                                 State& /*state*/) const {
    return {};
  }
  /// J per thickness, that it stores where blocks are.
  [[nodiscard]] virtual double stored_energy(const Model& /*model*/, const State& /*state*/, double /*time*/,
                                             std::span<const double> /*memory*/) const {
    return 0.0;
  }

  /// What users see of it; always the same, in the order of the scenario.
  [[nodiscard]] virtual std::vector<Element> elements() const { return {}; }
  /// Of each element, where blocks are.
  [[nodiscard]] virtual std::vector<Carried> carried(const Model& /*model*/, const State& /*state*/,
                                                     std::span<const double> /*memory*/) const {
    return {};
  }

  // What only some couplings are (facets.h); null: this one is not.
  [[nodiscard]] virtual const StagedSupports* staged_supports() const { return nullptr; }
  [[nodiscard]] virtual const FarField* far_field() const { return nullptr; }
  [[nodiscard]] virtual const ForceScale* force_scale() const { return nullptr; }
  [[nodiscard]] virtual const StillWater* still_water() const { return nullptr; }

  /// Adds the blocks that it holds to the ground.
  virtual void add_held_blocks(std::vector<int>& /*blocks*/) const {}
  /// Adds to the forces of blocks, N per thickness, by what its stiffness multiplies of a coordinate of this `extent`, m: their rounding
  /// error is a few ε of it.
  virtual void add_rounding_forces(const Model& /*model*/, double /*extent*/,
                                   std::span<double> /*force*/) const {}
};

/// Row::pair of two blocks, given by Block::unknown, in a pattern (State::pattern).
[[nodiscard]] int pair_in(std::span<const std::pair<int, int>> pattern, int unknown_a, int unknown_b);
/// The blocks that couplings hold to the ground.
[[nodiscard]] std::vector<int> held_blocks(const Model& model);

}  // namespace keyblock::dynamics
