#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/detection.h"
#include "model/model.h"
#include "model/state.h"
#include "record/record.h"
#include "simulation/base.h"
#include "simulation/closure.h"
#include "simulation/joint_gauge.h"
#include "simulation/openings.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Position of block b's outline now: the polygon of its contact vertices.
Polygon deformed_polygon(const dynamics::Model& model, std::size_t block);

/// Measures what has happened since the first excavation, as the user guide defines it. Blocks move against the base (base.h), and
/// openings move with it.
class DamageGauge {
 public:
  DamageGauge(const RunSetup& setup, const dynamics::Model& model)
      : setup_(setup), model_(model), base_(setup, model), joints_(setup, model) {
    reference_.open.resize(setup.excavations.size());
    name_moving({});
  }

  /// Excavations, by index, that are about to be opened: their outlines count as openings from now on, and closure stays as it is
  /// where the rock of a wall is excavated.
  void open(std::span<const int> excavations, const dynamics::State& state);
  [[nodiscard]] bool started() const { return !reference_.start.empty(); }
  /// Takes the present state as the reference. Blocks of the excavations are gone by now.
  void start(const dynamics::State& state, std::span<const contact::Contact> contacts);
  /// A stage begins, after its excavations: what Damage::stage_displacement is measured from.
  void begin_stage(const dynamics::State& state);
  /// A look at what a block that falls later would take away with it.
  void watch(const dynamics::State& state);

  /// Blocks that a static stage calls moving, at its end: they would go beyond any distance, and are held where they were named. They count as
  /// loosened until this is called again.
  void name_moving(std::span<const record::MovingBlock> moving);

  /// A look, and all measures.
  [[nodiscard]] record::Damage measure(const dynamics::State& state);
  [[nodiscard]] std::vector<record::BlockStatus> status(const dynamics::State& state) const;
  /// The blocks of this status that have fallen.
  [[nodiscard]] std::vector<record::FallenBlock> fallen(std::span<const record::BlockStatus> status) const;
  /// All that the record of a stage that has ended tells of damage.
  void describe(const dynamics::State& state, record::StageRecord& record);
  [[nodiscard]] const JointGauge& joints() const { return joints_; }
  [[nodiscard]] std::optional<double> opening_width() const;
  /// Whether a block has moved by more than the distance of a fall, wherever to.
  [[nodiscard]] bool is_beyond_fall(std::size_t block, const dynamics::State& state) const;

  struct Reference {
    std::vector<std::uint8_t> open;  ///< per excavation
    std::vector<Vec2> start;         ///< centroids, per block
    std::vector<double> turn;        ///< rad, of every block against its reference position
    std::vector<Vec2> base;          ///< m, displacement of the base, per block
    std::vector<Vec2>
        of_stage;            ///< centroids less the displacement of the base, as the stage began, per block
    Diameter height, width;  ///< of the first excavation
  };
  /// All that is remembered, for checkpoints.
  struct Memory {
    Reference reference;
    std::vector<JointGauge::Piece> pieces;
  };
  [[nodiscard]] Memory memory() const { return {reference_, joints_.pieces()}; }
  void restore(Memory memory);

 private:
  /// Where the outline of a block would be now if the base had not moved.
  [[nodiscard]] Polygon polygon_on_base(std::size_t block, const dynamics::State& state) const;
  [[nodiscard]] Vec2 down() const;
  /// m/s, of a centroid against the base.
  [[nodiscard]] double speed(std::size_t block, const dynamics::State& state) const;
  void find_movers(const dynamics::State& state, record::StageRecord& record) const;
  /// How far a block has gone and turned.
  void measure_way(std::size_t block, const dynamics::State& state, record::Damage& damage) const;
  /// m; 0: nothing falls.
  [[nodiscard]] double fall_distance(const dynamics::Block& block) const;
  /// m, of a centroid less the displacement of the base.
  [[nodiscard]] Vec2 place_on_base(std::size_t block, const dynamics::State& state) const;
  /// m, of a centroid against the base since the reference.
  [[nodiscard]] Vec2 displacement(std::size_t block, const dynamics::State& state) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  Base base_;
  JointGauge joints_;
  Reference reference_;
  Openings openings_;
  std::vector<std::uint8_t> moving_;  ///< per block: named by name_moving
};

}  // namespace keyblock::simulation
