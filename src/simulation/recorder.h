#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/rock_column.h"
#include "dynamics/step.h"
#include "record/record.h"
#include "simulation/damage.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Turns the state of a run into the records that observers receive.
class Recorder {
 public:
  /// Throws InputError when a history point lies in no block, or there is no element of the name that a history follows.
  Recorder(const RunSetup& setup, const dynamics::Model& model, const DamageGauge& gauge, int threads);

  [[nodiscard]] record::ModelRecord model() const;
  [[nodiscard]] record::Frame frame(const dynamics::State& state, int stage) const;
  [[nodiscard]] record::ContactFrame contacts(const dynamics::State& state, const dynamics::Stepper& stepper,
                                              int stage) const;
  /// Gives the contacts of the last step in their order, some at a time: so few that they stay in the nearest cache.
  void each_contact(const dynamics::Stepper& stepper, const record::TakeContacts& take,
                    record::ContactParts parts = {}) const;
  /// What broke in the last step: joints, and elements by their numbers; but for the stage.
  [[nodiscard]] std::vector<record::BreakRecord> breaks(const dynamics::State& state,
                                                        std::span<const dynamics::JointBreak> joints,
                                                        std::span<const int> elements) const;
  /// Velocities of the history points, m/s. frame: how what displacements are relative to has moved (frame_motion()).
  [[nodiscard]] std::vector<Vec2> velocities(const dynamics::State& state,
                                             const dynamics::GroundMove& frame) const;
  /// before: velocities() before the step that led to `state`; empty: a static step, which has no acceleration.
  [[nodiscard]] record::HistoryRow history(const dynamics::State& state, const dynamics::GroundMove& frame,
                                           std::span<const Vec2> before) const;
  /// Largest true overlap of any two blocks, if it is deeper than `least_depth`, m.
  [[nodiscard]] std::optional<record::OverlapRecord> overlap(const dynamics::State& state, int stage,
                                                             double least_depth) const;
  /// Largest relative change of area of a block.
  [[nodiscard]] double area_change(const dynamics::State& state) const;

  /// Brings what depends on the orders of blocks up to date.
  void orders_changed();

 private:
  [[nodiscard]] cutting::EdgeLabel label_of(int edge, int block_a, int block_b) const;
  void put_water(const dynamics::State& state, std::span<record::ContactRecord> to) const;
  void put_places(std::span<const contact::Contact> contacts, std::span<record::ContactRecord> to) const;
  struct Point {
    std::optional<std::size_t> block;  ///< none: rock far away
    Vec2 reference;
    std::vector<double> phi;
    bool absolute = false;
  };
  [[nodiscard]] Point point_of(const History& history) const;
  void put_element_histories(const dynamics::State& state, record::HistoryRow& row) const;
  [[nodiscard]] bool is_there(const Point& point) const;
  /// In the frame of the point.
  [[nodiscard]] dynamics::GroundMove move_of(const Point& point, const dynamics::State& state,
                                             const dynamics::GroundMove& frame) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  const DamageGauge& gauge_;
  int threads_;
  std::vector<cutting::EdgeLabel> labels_;
  std::vector<Point> points_;
  std::vector<std::string> point_names_;
  std::vector<record::ElementHistory> element_histories_;
};

}  // namespace keyblock::simulation
