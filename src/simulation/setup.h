#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "block/material.h"
#include "contact/joint_properties.h"
#include "cutting/block_system.h"
#include "loading/bolt.h"
#include "loading/ground_motion.h"
#include "loading/liner.h"
#include "loading/load.h"
#include "loading/water_table.h"
#include "model/options.h"
#include "record/joint_records.h"
#include "record/stage.h"
#include "simulation/boundary.h"

namespace keyblock::simulation {

/// Properties of one block beside its shape.
struct BlockProperties {
  std::string name;  ///< empty for cut blocks
  block::Material material;
  int order = 1;                          ///< of the displacement polynomial, ≥ 1
  bool automatic_order = false;           ///< chosen by the program; `order` is that at the start
  bool fixed = false;                     ///< neither moves nor deforms, but by `motion`
  loading::TimeTable motion_x, motion_y;  ///< m, prescribed displacement of a fixed block; empty: none
  Vec2 velocity;                          ///< m/s at the start
  double spin = 0.0;                      ///< rad/s at the start, counter-clockwise, about the centroid
};

/// Joint properties by what an edge is a piece of.
struct JointTable {
  contact::JointProperties
      standard;  ///< [joints]: explicit blocks, excavation outlines, and new contacts between them
  std::vector<contact::JointProperties>
      joint_sets;  ///< then of rock bridges, if there are any, and of interfaces
  std::vector<contact::JointProperties> trace_maps;
  contact::JointProperties frame;  ///< between the rock and the frame; frictionless unless given

  /// Joints of traces that have a strength of their own.
  struct OfTraces {
    cutting::EdgeLabel label;  ///< of which set or map
    contact::JointProperties joint;
  };
  std::vector<OfTraces> of_traces;  ///< those that differ, by set, then by map
  /// By set or map, of each trace: its place in of_traces; −1: it has the strength of its set or map. Empty where all traces have that.
  std::vector<std::vector<int>> joint_set_traces, trace_map_traces;
  std::vector<record::DrawnStrength> drawn;

  /// Place in of_traces of the joint that an edge is a piece of; −1: it has none.
  [[nodiscard]] int place_of_trace(cutting::EdgeLabel label) const;
};

/// A pressure that holds the wall of an opening.
struct SupportPressure {
  double constant = 0.0;         ///< Pa, in every stage
  loading::TimeTable over_time;  ///< Pa; empty: none
  /// Pa, from a stage on, by index, ascending; nothing before the first. Empty: constant, or over time.
  std::vector<std::pair<int, double>> over_stages;
  std::optional<std::pair<double, double>>
      arc;  ///< degrees about the centroid of the outline, from +x; none: all of the wall

  [[nodiscard]] bool empty() const { return constant == 0.0 && over_time.empty() && over_stages.empty(); }
};

struct Excavation {
  std::string name;
  Ring outline;  ///< counter-clockwise, local coordinates
  SupportPressure pressure = {};
  bool is_filled = false;  ///< with water, once it is open; else drained
};

/// Water in joints and around blocks.
struct Water {
  std::string name;  ///< may be empty, of one that is alone
  loading::WaterTable table;
  double density = 1000.0;       ///< kg/m³
  std::vector<bool> dry_joints;  ///< by joint law, from first_set_law on: they hold none of it
};

/// Follows a point of a block, rock far away, or what an element carries.
struct History {
  std::string name;
  std::string block;  ///< empty: the block that holds the point, see history_block.h
  Vec2 point;         ///< reference position
  bool absolute =
      false;  ///< motion against a place that does not move; else against the base, or the outcrop
  std::optional<ColumnSide> column =
      {};                    ///< of rock far away, at the height of the point; no block has it then
  std::string element = {};  ///< its name; then there is no point. Empty: it follows a point
};

/// Limits of the damage measures; see the user guide.
struct DamageLimits {
  std::optional<double>
      fall_distance;  ///< m; default 5 % of the width of the opening, half of √(area) without one
  double loosened_distance = 0.01;  ///< m
  double slip = 0.001;              ///< m; a joint counts as slipped beyond it
  double opening = 0.001;           ///< m; a joint counts as opened beyond it
};

/// How the program chooses the order of blocks that leave it open.
struct AutomaticOrder {
  double stress_accuracy =
      0.05;  ///< of the RMS stress of the rock, that the terms of highest degree of a block may carry
  int highest_order = 6;
};

/// How often results are recorded.
struct OutputOptions {
  double frame_interval = 0.1;      ///< s between frames of dynamic stages
  int settle_frame_interval = 100;  ///< steps between frames of static stages
  double contact_interval = 1.0;    ///< s between contact snapshots (always at the ends of stages)
  double history_interval = 0.0;    ///< s between history rows of dynamic stages; 0: every step
};

/// A file that belongs to the input of a run.
struct InputFile {
  std::string name;  ///< path from the folder of the scenario
  std::string hash;  ///< of its content, hexadecimal
};

/// Everything a run needs. Coordinates are local: real ones minus system.origin.
struct RunSetup {
  std::string title;
  std::string version;
  std::uint64_t seed = 0;
  int realization = 0;
  std::string scenario;          ///< text of the scenario as run
  std::vector<InputFile> files;  ///< that the scenario names
  /// Programs that steer the run (Control): their names, and hashes of their text.
  std::vector<std::pair<std::string, std::string>> hooks;
  std::vector<std::string> warnings;    ///< of input that seems odd, for the report
  bool closure_is_lower_bound = false;  ///< blocks of order 1 are too stiff for it
  /// What the rock is and what acts on it, for reports: names and values (scenario/ground_facts.h).
  std::vector<std::pair<std::string, std::string>> ground;

  cutting::BlockSystem system;
  std::vector<BlockProperties> properties;  ///< one per block of `system`
  bool frame = false;                       ///< fixed blocks around the domain
  bool has_domain = false;
  Box domain;                        ///< if there is one
  std::optional<Boundary> boundary;  ///< the rock around the model; none: a frame, or nothing
  JointTable joints;
  std::vector<std::string> joint_set_names;  ///< then those of rock bridges and interfaces
  std::vector<std::string> trace_map_names;
  std::vector<Excavation> excavations;

  Vec2 gravity{0.0, -9.81};  ///< m/s²
  std::optional<block::InSituStress> in_situ;
  double time_step = 0.0;  ///< s
  std::vector<loading::GroundMotion> motions;
  std::vector<loading::Load> loads;
  std::vector<loading::Support> supports;
  std::vector<loading::Spring> springs;
  std::vector<loading::Bolt> bolts;
  std::vector<loading::Liner> liners;
  std::vector<Water> waters;                 ///< of which a stage chooses
  std::vector<std::string> staged_supports;  ///< that stages install: names, in the order of State::installed
  std::vector<record::Stage> stages;
  std::vector<History> histories;
  DamageLimits damage;
  OutputOptions output;
  AutomaticOrder automatic_order;
  dynamics::SolverOptions solver;
};

}  // namespace keyblock::simulation
