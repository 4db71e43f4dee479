#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "loading/water_table.h"

namespace keyblock::dynamics {

/// A part of an edge of a block that water may reach, before the run.
struct WaterFace {
  int vertex = 0;  ///< the start of its edge
  double from = 0.0, to = 1.0;
  int excavation = -1;   ///< on the outline of which it lies; −1: of none
  bool is_rock = false;  ///< until that opens, rock on both sides is one, and there is no joint
};

/// One of the waters of a scenario, of which a stage chooses.
struct Water {
  std::string name;
  loading::WaterTable table;
  double weight = 0.0;            ///< γ, N/m³
  std::vector<std::uint8_t> dry;  ///< per face: it never reaches it
};

/// An opening that water may drain into.
struct WaterOpening {
  std::vector<int> inside;  ///< blocks that are there until it opens
  bool is_filled = false;   ///< it stands full of water then
};

/// A block that users know, or all of them.
struct WateredBlock {
  std::string name;
  int block = -1;               ///< −1: all that move
  int from = 0, to = 0;         ///< vertices of the surface between which it is shown
  ElementEnd from_end, to_end;  ///< the same before the run
};

/// Water at rest in joints and around blocks (docs/theory.md, section "Water in joints"): a coupling of single blocks with nothing, by terms.
/// Its pressure presses across each face, as that lies at the start of a step. How large it is goes by where the rock was before the run,
///
///     p(X) = γ max(0, y_w(X) − Y)       f_k = −∫ p n φ_k ds
///
/// so that nothing slides out of its water (docs/decisions/0028-water.md). Both faces of a joint have the same p: what springs of contacts carry
/// is the effective force. Which faces are wet is known at the start of a step:
///
///   - a face that lay along no other when the run began is an outside face, and always wet;
///   - a joint is wet as long as its edge has a contact. Without one the water runs out, until it closes again, if there is a drained opening
///     below the table to run into. In static steps, which take no time, it does not (Model::water_drains);
///   - the wall of an opening is drained, or wet where the opening is filled, in proportion to what of the forces of its rock is released.
///
/// Fixed blocks feel no water. Its work is EnergyLedger::water.
class JointWater final : public Coupling, public StillWater {
 public:
  /// faces: in the order of vertices; those of an edge do not overlap. surface, reference: of the model, before the run.
  JointWater(std::vector<Water> waters, std::vector<WaterFace> faces, std::vector<WaterOpening> openings,
             std::vector<WateredBlock> blocks, const contact::Surface& surface,
             const std::vector<Vec2>& reference);

  [[nodiscard]] std::size_t memory_size() const override { return edges_ + 1; }
  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  /// The resultant on each block, and how far it has moved in the mean.
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;

  [[nodiscard]] const StillWater* still_water() const override { return this; }
  [[nodiscard]] std::vector<double> pressures(const Model& model, const State& state,
                                              std::span<const double> memory,
                                              std::span<const EdgePlace> places) const override;
  [[nodiscard]] std::vector<VertexForce> wall_forces(const Model& model, const State& state,
                                                     std::span<const double> memory,
                                                     int excavation) const override;
  [[nodiscard]] WaterTotals totals(const Model& model, const State& state,
                                   std::span<const double> memory) const override;

 private:
  /// What a water does to a face: N/m² per length of the edge, with what the ends of the edge have of it.
  struct Load {
    std::size_t face;
    double at_start, at_end;
  };
  [[nodiscard]] std::vector<Load> loads_of(const Water& water, const contact::Surface& surface,
                                           const std::vector<Vec2>& reference) const;
  /// What says which faces are wet.
  struct Wetness {
    std::span<const double> memory;  ///< empty before the first step
    std::vector<double> filled;  ///< per opening: how much of the water presses on its wall; −1: it is closed
    bool drains = false;         ///< water leaves joints that have opened
    [[nodiscard]] double remembered(int edge) const {
      return memory.empty() ? 0.0 : memory[static_cast<std::size_t>(edge)];
    }
  };
  [[nodiscard]] Wetness wetness(const Model& model, const State& state, std::span<const double> memory) const;
  /// How much of the water presses on a face, 0 to 1.
  [[nodiscard]] static double share_wet(const WaterFace& face, const Wetness& wet);
  /// Calls of_force(face, block, vertex, force) for all that act, N per thickness.
  template <typename OfForce>
  void for_forces(const Model& model, const State& state, std::span<const double> memory,
                  const OfForce& of_force) const;
  [[nodiscard]] std::vector<Vec2> forces_on_blocks(const Model& model, const State& state,
                                                   std::span<const double> memory) const;
  [[nodiscard]] static Vec2 force_on(const WateredBlock& block, const std::vector<Vec2>& of_block);
  void remember_contacts(const Model& model, const State& state, std::span<double> memory) const;

  std::vector<Water> waters_;
  std::vector<WaterFace> faces_;
  std::vector<WaterOpening> openings_;
  std::vector<WateredBlock> blocks_;
  std::vector<std::vector<Load>> loads_;  ///< of each water
  std::size_t edges_ = 0;
};

}  // namespace keyblock::dynamics
