#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "block/material.h"
#include "core/error.h"
#include "geometry/polygon.h"
#include "loading/load.h"
#include "loading/projection.h"
#include "loading/suite_list.h"
#include "model/options.h"
#include "record/stage.h"
#include "rockmass/joint_set.h"
#include "rockmass/random_strength.h"
#include "rockmass/tessellation.h"
#include "rockmass/trace_map.h"
#include "scenario/study_spec.h"
#include "scenario/usual.h"
#include "simulation/boundary.h"
#include "simulation/setup.h"

/// What a scenario file says, typed and checked, before anything is generated, read or cut. Coordinates are real
/// ones; SI units. The meaning of every key: docs/scenario.md.
namespace keyblock::scenario {

/// [rock], or those of its keys that a region or a block has of its own.
struct RockKeys {
  std::optional<double> density, young, poisson;
  std::optional<block::PlaneState> state;
  std::optional<int> order;  ///< automatic_order: left to the program
};

constexpr int automatic_order = 0;

/// [joints], or those of its keys that a joint set, trace map or interface has of its own.
struct JointKeys {
  std::optional<double> friction, cohesion, tension, normal_stiffness, shear_stiffness;
  std::optional<double> residual_friction, residual_cohesion, weakening_slip;
  std::optional<double> strength_factor;  ///< tan(friction), cohesion and tension are divided by it
  bool dry = false;                       ///< of joints of their own: they hold no water
  /// Of a set or trace map, by StrengthKey: strengths that are drawn. friction, cohesion … have their means.
  std::array<std::optional<rockmass::RandomStrength>, rockmass::strength_count> random{};
  double change_of_mapped_friction =
      0.0;  ///< °, in a variant of a study, of traces whose map has their friction

  /// Whether strength falls from a peak to what is left.
  [[nodiscard]] bool has_residual() const { return residual_friction || residual_cohesion || weakening_slip; }
};

/// By StrengthKey.
inline constexpr std::array<std::optional<double> JointKeys::*, rockmass::strength_count> strength_members{
    &JointKeys::friction, &JointKeys::cohesion, &JointKeys::tension, &JointKeys::residual_friction,
    &JointKeys::residual_cohesion};

struct Domain {
  std::pair<double, double> x, y;
  bool frame = true;            ///< fixed blocks around the domain
  double frame_friction = 0.0;  ///< degrees

  [[nodiscard]] Box box() const { return {{x.first, y.first}, {x.second, y.second}}; }
};

/// Tolerances of cutting; those not given scale with the domain (cutting::CutTolerances).
struct CuttingKeys {
  std::optional<double> snapping, sliver_area, sliver_thickness, cluster, collinear;
  bool bridges_dead_ends = false;  ///< what ends in rock goes on as a rock bridge; else it is removed
};

struct JointSetSpec {
  rockmass::JointSet set;
  bool gap_bonds = false;  ///< its gaps are rock bridges
  JointKeys joints;
  std::string path;  ///< key path, here and below; position: Scenario::where
};

struct TraceMapSpec {
  std::string name;
  std::filesystem::path file;                          ///< empty: lines
  rockmass::MapChoice choice;                          ///< of the file
  std::vector<std::vector<Vec2>> lines;                ///< one trace each
  std::optional<rockmass::Tessellation> tessellation;  ///< its region may be empty: the domain
  JointKeys joints;
  std::string path;
};

/// [rock_bridge]
struct RockBridgeSpec {
  std::string name = "rock_bridge", path = "rock_bridge";
  JointKeys joints;
};

/// [[interface]]
struct InterfaceSpec {
  std::string name;
  std::pair<std::string, std::string> between;  ///< names of blocks, ascending
  JointKeys joints;
  std::string path;
};

struct RegionSpec {
  std::string name;
  Polygon polygon;
  RockKeys rock;
};

enum class ExcavationShape { circle, polygon, horseshoe, file, slope };

/// A slope in benches, and the air above it.
struct SlopeShape {
  Vec2 toe;
  bool rises_to_the_right = true;
  double floor = 0.0;         ///< m, from the toe away from the slope
  double face_angle = 90.0;   ///< degrees, of each bench
  double bench_height = 0.0;  ///< m
  double berm = 0.0;          ///< m, width of the step between two benches
  int benches = 1;
};

struct ExcavationSpec {
  std::string name;
  ExcavationShape shape = ExcavationShape::circle;
  Vec2 center;               ///< circle
  double diameter = 0.0;     ///< circle
  int chords = 96;           ///< of a full circle
  Ring outer;                ///< polygon, file
  Vec2 invert;               ///< horseshoe: middle of the floor
  double width = 0.0;        ///< horseshoe
  double wall_height = 0.0;  ///< horseshoe: of the vertical walls
  std::optional<double>
      arch_height;  ///< horseshoe: rise of the circular arch over the walls; default width / 2
  SlopeShape slope;
  simulation::SupportPressure pressure;                           ///< but what it is by stage
  std::vector<std::pair<std::string, double>> pressure_by_stage;  ///< Pa, from a stage on
  std::optional<bool> filled;                                     ///< with water; not given: drained
  std::string path;
};

struct BlockSpec {
  std::string name;  ///< may be empty
  Polygon polygon;
  RockKeys rock;
  bool fixed = false;
  loading::TimeTable motion_x, motion_y;  ///< of a fixed block
  Vec2 velocity;
  double spin = 0.0;
  std::string path;
};

/// What a stage says where no water is to act.
constexpr const char* no_water = "none";

/// [water]
struct WaterSpec {
  std::string name;                       ///< may be empty, of one that is alone
  std::vector<Vec2> table;                ///< m, from left to right
  double density = 1000.0;                ///< kg/m³
  std::optional<std::vector<bool>> sets;  ///< of all own_joints(): they hold it
  std::string path;
};

/// Depth with K0, or a constant stress; compression negative.
struct InSituSpec {
  std::optional<double> depth;  ///< m of rock above the top of the model
  std::optional<double> k0;
  double sxx = 0.0, syy = 0.0, sxy = 0.0;  ///< Pa, without depth
};

/// Rock beside the model, from its top downwards.
struct RockLayerSpec {
  double top = 0.0;                          ///< m, height
  double density = 0.0, vs = 0.0, vp = 0.0;  ///< kg/m³, m/s, m/s
  std::string path;
};

/// [boundary]
struct BoundarySpec {
  bool compliant = true;
  record::Sides sides = record::Sides::free_field;
  bool overburden = false;
  std::optional<double> density, vs, vp;  ///< of the half-space below
  std::vector<RockLayerSpec> column;      ///< empty: the rock of the model
  double frequency = 25.0;                ///< Hz
  bool planes = true;                     ///< level joints go on beside the model, and slip there
};

/// Where a motion was recorded.
enum class MotionPlace {
  outcrop,   ///< on free rock
  incident,  ///< the wave that goes up
  inside,    ///< the same, by an older word
  within,    ///< in the ground, at a depth: waves that go up and down
  base,      ///< what the base of the model does
};

/// [safety]: strength that is reduced from the equilibrium of a stage on.
struct SafetySpec {
  std::string stage;              ///< after which; later ones are left out
  std::vector<std::string> sets;  ///< whose strength it is: sets, maps, `joints`; empty: all
  std::optional<double>
      strength_factor;  ///< what strength is divided by; neither it nor k_h: the run is as without [safety]
  std::optional<double>
      k_h;  ///< horizontal seismic coefficient of the last stage; none: that of the stage before
  std::optional<double>
      moved;          ///< m in the stage, beyond which rock has moved; none: a share of the block size
  double area = 0.0;  ///< m², that may move; 0: nothing may
  int max_steps = 6000;
};

/// [[bolt]]: a bolt, or a pattern along the outline of an excavation.
struct BoltSpec {
  loading::Bolt bolt;   ///< head and toe: of a single one
  int excavation = -1;  ///< −1: a single one
  double length = 0.0;  ///< m, of each of a pattern
  std::optional<int> count;
  std::optional<double> spacing_along;           ///< m
  std::optional<std::pair<double, double>> arc;  ///< degrees about the centroid of the outline, from +x
};

/// [[liner]]: shotcrete along the outline of an excavation, or along a polyline.
struct LinerSpec {
  loading::Liner liner;                          ///< wall: the polyline, of one that has it
  int excavation = -1;                           ///< −1: along the polyline
  std::optional<std::pair<double, double>> arc;  ///< degrees about the centroid of the outline, from +x
};

struct MotionComponentSpec {
  std::filesystem::path file;
  std::optional<int> channel;  ///< component of a file that holds several, counted from 1
  bool vertical = false;       ///< azimuth = "up", or the file of y
  bool along_section = false;  ///< the file of x
  loading::MotionReading reading;
  std::optional<double> azimuth;  ///< degrees; neither: as the file says
  std::string path;
};

/// A record projected on the section, or along its axes, or acceleration over time in x and y.
struct MotionSpec {
  std::string name;
  std::vector<MotionComponentSpec> components;
  std::optional<std::pair<double, double>> window;  ///< s of the record
  loading::Baseline baseline = loading::Baseline::none;
  loading::AccelerationTable x, y;
  std::optional<loading::Sine> sine_x, sine_y;
  std::optional<MotionPlace> place;  ///< empty: on an outcrop over a compliant base, else at the base
  std::optional<double> depth;       ///< m below the ground, of a record within
  std::optional<double> pga, pgv;    ///< m/s², m/s: what the peak along the section is brought to
  std::string path;
  int suite = -1;            ///< place of the suite that it is of; −1: it stands in the file
  bool significant = false;  ///< the window is that of significant shaking
  bool turned = false;       ///< about the vertical, by an angle of its own in each realization
};

/// A list of records, each of which is a motion.
struct SuiteSpec {
  std::string name;
  std::filesystem::path file;
  std::vector<loading::SuiteRecord> records;
  std::string path;
  /// "crustal/RSN1"
  [[nodiscard]] std::string motion_name(std::size_t record) const {
    return name + '/' + records.at(record).name;
  }
};

/// Warnings of choices that are meant, `accept_warnings`.
struct AcceptedWarnings {
  bool plane_stress = false;   ///< of an excavation in plane stress
  bool order_1 = false;        ///< of blocks of order 1 that are too stiff for the closure of an opening
  bool free_boundary = false;  ///< of stress in rock that nothing holds
  bool step = false;           ///< of a time step that is long for the motion
  bool damping = false;        ///< of damping beyond critical, or of what nobody asked to be damped
  bool closed_box = false;     ///< of a record that shakes a frame
  bool late_falls = false;     ///< of what hangs loose when the shaking begins
  bool lost_joints = false;    ///< of joints that bound no block
  bool loads = false;          ///< of loads that are weak or pull, of displacements that go far
  bool scale = false;          ///< of a motion that its scale makes weaker than its number
  bool window = false;         ///< of a window that misses most of a record
  bool azimuth = false;  ///< of components of a record that are not normal to each other, or mostly left out
  bool closed_ground = false;  ///< of a frame that lies on the ground beside a cut
  bool skipped = false;        ///< of what drawings have beside lines
  bool direction = false;      ///< of a seismic coefficient, or tilt, that pushes into the slope
};

struct Scenario {
  std::string title;
  bool si_units = true;  ///< values may be compared with what is usual
  AcceptedWarnings accepted;
  std::uint64_t seed = 1;
  int strata = 0;  ///< rockmass::Sampling: realizations of a Latin hypercube; 0: they are independent
  Vec2 gravity{0.0, -9.81};  ///< m/s², turned by the tilt of the model
  double tilt = 0.0;         ///< degrees
  std::optional<double> section_azimuth;
  std::optional<Domain> domain;
  std::optional<BoundarySpec> boundary;
  RockKeys rock;  ///< all set
  JointKeys joints;
  double load_factor = 1.0;  ///< of all loads
  std::vector<JointSetSpec> joint_sets;
  std::vector<TraceMapSpec> trace_maps;
  std::optional<RockBridgeSpec> rock_bridge;
  std::vector<InterfaceSpec> interfaces;
  CuttingKeys cutting;
  std::vector<RegionSpec> regions;
  std::vector<ExcavationSpec> excavations;
  std::vector<BlockSpec> blocks;  ///< those of [[block]], then those of [[block_map]]
  std::vector<std::filesystem::path>
      drawings;                      ///< of block maps and excavations, which are read with the scenario
  std::vector<std::string> skipped;  ///< what of them is no line, in words
  std::optional<InSituSpec> in_situ;
  double time_step = 0.0;           ///< s; 0: not given, and no stages
  std::vector<MotionSpec> motions;  ///< those of suites after all others
  std::vector<SuiteSpec> suites;
  std::vector<loading::Load> loads;
  std::vector<loading::Support> supports;
  std::vector<loading::Spring> springs;
  std::vector<BoltSpec> bolts;
  std::vector<LinerSpec> liners;
  std::vector<WaterSpec> waters;
  std::vector<simulation::History> histories;
  std::vector<record::Stage> stages;    ///< indices are those of `excavations` and `motions`
  std::vector<record::Stage> left_out;  ///< stages after that of [safety]
  std::vector<std::string> absent;      ///< names of supports with present = false: no stage installs them
  std::optional<SafetySpec> safety;
  simulation::DamageLimits damage;
  simulation::OutputOptions output;
  simulation::AutomaticOrder automatic;
  dynamics::SolverOptions solver;
  std::optional<StudySpec> study;

  std::string file;                   ///< as given; for messages
  std::string text;                   ///< of the file, with the overrides as comments at its end
  std::vector<UnusualValue> unusual;  ///< in SI units
  std::map<std::string, SourcePosition> positions;  ///< of every value, by key path

  /// Position of a value, or of the nearest table around it, which may be the file.
  [[nodiscard]] SourcePosition where(const std::string& key_path) const;
  /// Pa/m, of contacts in the standard rock whose joint has no stiffness of its own.
  [[nodiscard]] double stiffness_by_penalty() const { return solver.penalty * rock.young.value_or(0.0); }
};

/// m, real coordinates: of the domain and the blocks that are given one by one.
Box box_of_model(const Scenario& scenario);

}  // namespace keyblock::scenario
