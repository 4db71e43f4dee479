#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/profile.h"
#include "cutting/block_system.h"
#include "geometry/vec2.h"
#include "record/boundary.h"
#include "record/break_records.h"
#include "record/element_record.h"
#include "record/joint_records.h"
#include "record/stage.h"

/// What a run tells the outside: plain data, written to the result file and drawn in the report.
namespace keyblock::record {

/// What swings alone, and what goes as a wave, at a frequency loses, as shares of critical.
struct DampingRow {
  double frequency = 0.0;  ///< Hz
  double rock = 0.0;       ///< by [solver] damping, or rock_damping
  double rule = 0.0;       ///< by the rule of time integration
  /// By the part of `rock` in proportion to stiffness: a wave through the ground has no motion against the ground, which the rest acts on.
  double rock_in_waves = 0.0;
  [[nodiscard]] double total() const { return rock + rule; }
  [[nodiscard]] double waves() const { return rock_in_waves + rule; }
};

/// Rock far away beside the model, as far up as the ground there.
struct ColumnRecord {
  double x = 0.0, base = 0.0, ground = 0.0;  ///< m, local
  double longest_element = 0.0;              ///< m
};

/// The block system in reference position. Outlines are given by *display vertices*: every vertex of the block, and
/// for a block of order > 1 further points along its edges, which may curve.
struct ModelRecord {
  std::string title;
  std::string version;
  std::uint64_t seed = 0;
  int realization = 0;
  int threads = 1;
  double step_size = 0.0;             ///< s
  Vec2 origin;                        ///< real coordinates of the local origin
  std::string scenario;               ///< the TOML that was run, with overrides listed as comments at its end
  std::vector<std::string> warnings;  ///< of input that seems odd
  std::vector<std::pair<std::string, std::string>>
      hooks;                            ///< names and hashes of programs that steered the run
  bool closure_is_lower_bound = false;  ///< blocks of order 1 are too stiff for it

  struct Block {
    std::string name;  ///< empty for cut blocks
    int order = 1;     ///< at the start
    bool fixed = false;
    double area = 0.0;     ///< m²
    double density = 0.0;  ///< kg/m³
    std::vector<int> excavations;
    Vec2 centroid;
    /// Display vertices of ring r are vertices[ring_start[r] … ring_start[r + 1]) of ModelRecord.
    std::vector<int> ring_start;
    /// Stress normal to the section over the sum of those in it: 0 in plane stress, Poisson's ratio in plane strain.
    double stress_ratio_zz = 0.0;
    double young = 0.0;    ///< Pa; NaN where it is not known
    double poisson = 0.0;  ///< NaN where it is not known
  };
  std::vector<Block> blocks;
  std::vector<Vec2> vertices;  ///< reference positions of all display vertices, m
  std::vector<cutting::EdgeLabel>
      edge_label;                        ///< of the piece from each display vertex to the next of its ring
  std::vector<std::string> stage_names;  ///< of the whole plan; a run that is stopped has records of fewer
  std::vector<JointRecord> joints;  ///< of sets, then maps; by trace where these have strengths of their own
  std::vector<DrawnStrength> strengths;  ///< that were drawn, or that maps have
  bool may_break = false;                ///< there are joints that may break, or elements that may rupture
  std::vector<std::string> joint_set_names, trace_map_names, excavation_names;
  std::vector<std::vector<Vec2>> excavation_outlines;
  std::vector<std::string> history_names;  ///< of those that follow points
  std::vector<ElementDescription> elements;
  std::vector<ElementHistory> element_histories;
  std::optional<double> opening_width;              ///< m
  std::optional<double> slip_limit, opening_limit;  ///< m, beyond which a joint counts as slipped, opened
  cutting::CutStatistics cutting;
  std::vector<DampingRow> damping;         ///< at 1, 3, 10 and 30 Hz; empty without dynamic stages
  std::optional<BoundaryRecord> boundary;  ///< the rock around the model
  std::vector<ColumnRecord> columns;
  std::vector<std::pair<std::string, std::string>> ground;  ///< names and values: RunSetup::ground
};

enum class BlockStatus : std::uint8_t { in_place = 0, loosened = 1, fallen = 2, excavated = 3 };

/// One moment of the run.
struct Frame {
  double time = 0.0;  ///< s of simulated time; static steps count none
  int stage = 0;
  long step = 0;                                   ///< of the run, over all stages
  std::vector<std::array<float, 2>> displacement;  ///< of every display vertex since the start, m
  std::vector<std::array<float, 3>> stress;        ///< mean Cauchy stress of every block: xx, yy, xy, Pa
  std::vector<BlockStatus> status;                 ///< of every block
  std::vector<std::array<float, 2>> velocity;  ///< of the mass centre of every block, m/s; empty: not known
  std::vector<std::int16_t> order;             ///< of every block
  std::vector<ElementState> elements;          ///< of every element of the model
};

enum class ContactState : std::uint8_t { open = 0, sliding = 1, locked = 2 };

struct ContactRecord {
  int block_a = 0;  ///< the block with the vertex
  int block_b = 0;  ///< the block with the edge
  ContactState state = ContactState::open;
  Vec2 position;        ///< m
  Vec2 normal;          ///< unit, out of block_b
  double length = 0.0;  ///< m of joint that belongs to it
  double gap = 0.0;     ///< m, as the joint law has it then: negative where the contact is pressed
  double shear_displacement = 0.0;  ///< m, of block_a along perpendicular(normal), since the excavation
  double normal_force = 0.0;        ///< N per metre thickness, compression positive
  double shear_force = 0.0;         ///< the same; against perpendicular(normal) on block_a
  cutting::EdgeLabel label;         ///< of the edge
  double water_pressure = 0.0;  ///< Pa, of the water in the joint: the forces are what it leaves to the rock
  /// Of what slip or opening takes from a joint: JointLaw::share_left, and 0 of a bond that has broken; 1 of joints that keep their strength.
  double strength_left = 1.0;
  // Of a running model alone; results do not keep them.
  int vertex = 0, edge = 0;              ///< of the surface
  double friction = 0.0;                 ///< coefficient
  double cohesion = 0.0, tension = 0.0;  ///< Pa, of a bond

  [[nodiscard]] double slip() const { return std::abs(shear_displacement); }  ///< m
};

/// What contacts are asked for that takes time; what is not asked for stays 0.
struct ContactParts {
  bool places = true;     ///< blocks, vertex, edge with its label, position, normal, length
  bool slips = true;      ///< shear displacement
  bool forces = true;     ///< state, gap, forces
  bool strengths = true;  ///< friction, cohesion, tension
};

/// Receives contacts, some at a time.
using TakeContacts = std::function<void(std::span<const ContactRecord>)>;

struct ContactFrame {
  double time = 0.0;
  int stage = 0;
  std::vector<ContactRecord> contacts;
  long step = 0;  ///< of the run, over all stages
};

/// One row of DIR/histories.csv: displacement, velocity, Cauchy stress and acceleration at the chosen points; NaN once the block is
/// excavated. Rock far away has no stress. The acceleration is the mean over the last step, (v′ − v)/Δt; 0 in static stages.
struct HistoryRow {
  double time = 0.0;
  struct Point {
    double ux, uy, vx, vy, sxx, syy, sxy;
    double ax = 0.0, ay = 0.0;
  };
  std::vector<Point> points;
  long step = 0;  ///< of the run, over all stages
  std::vector<ElementState>
      elements;  ///< of histories that follow one; forces and ways are NaN where it is not there
};

/// What water does to the blocks that move.
struct WaterRecord {
  std::string name;               ///< of the water that acts; it may have none
  double largest_pressure = 0.0;  ///< Pa
  double wet = 0.0;               ///< m of edges of blocks
  double drained = 0.0;  ///< m of edges below the table that are dry: along openings, or as it has run out
  std::vector<std::pair<std::string, Vec2>> forces;  ///< N per thickness, by the names of its elements
};

/// Energies in J per metre thickness. Losses and inputs accumulate from the start of the first stage.
/// kinetic + strain + gravity + contact + friction + damping + radiated + numerical − input − water = residual ≈ 0.
struct Energy {
  double kinetic = 0.0;
  double strain = 0.0;
  double gravity = 0.0;   ///< potential, relative to the start
  double contact = 0.0;   ///< stored in contact and support springs
  double friction = 0.0;  ///< dissipated
  double damping = 0.0;   ///< dissipated by the dashpots of contacts and the viscosity of the rock
  double input =
      0.0;  ///< work of ground motion, loads and moved supports; energy removed with excavated blocks is negative
  double numerical = 0.0;  ///< dissipated by the time integration, computed step by step
  double residual_ratio =
      0.0;                ///< |residual| over the largest term, or over what nobody sees (energy_audit.cpp)
  double radiated = 0.0;  ///< carried away by waves through a seismic boundary
  double water = 0.0;     ///< work of the pressure of water
};

/// Energy that the time integration makes rather than dissipates: how far Energy::numerical has come down from its highest value before in a
/// dynamic stage. A later loss of any size does not make up for it. It is measured by the largest of the other terms until then, as single
/// terms go through zero.
struct MadeEnergy {
  double ratio = 0.0;    ///< made over the largest other term, at the worst moment that was looked at
  double time = 0.0;     ///< s, of that moment
  double highest = 0.0;  ///< J per thickness, of `numerical` in the dynamic stage at hand so far
  double most = 0.0;     ///< J per thickness, made
  double largest = 0.0;  ///< J per thickness, of all other terms so far

  /// Of the largest term of the whole run: what is made before rock falls is little of that fall.
  [[nodiscard]] double share() const { return most > 0.0 ? most / largest : 0.0; }
};

/// How the steps went, one row now and then.
struct StepRow {
  double time = 0.0;
  long step = 0;  ///< of the run, over all stages
  int stage = 0;
  int iterations = 0;             ///< open-close iterations of the step
  double step_size = 0.0;         ///< s; smallest part of one that was cut; static: pseudo time step
  double penetration = 0.0;       ///< m, largest depth seen by the contact code
  double max_displacement = 0.0;  ///< m, largest of a step
  int closed_contacts = 0;
  Energy energy;
};

/// What of the outlines of openings a place lies behind, as seen along gravity.
enum class WallPart : std::uint8_t { none = 0, crown = 1, left = 2, right = 3, invert = 4 };

struct FallenBlock {
  int block = 0;
  double area = 0.0;    ///< m²
  double weight = 0.0;  ///< N per metre of tunnel
  /// m, of the farthest corner of its place behind the outlines of openings. NaN without an opening.
  double depth = 0.0;
  WallPart part = WallPart::none;  ///< that this corner is behind
};

/// Measures as defined in the user guide; cumulative since the first excavation. NaN: there is no such number.
struct Damage {
  int fallen_blocks = 0;
  int hinges = 0;              ///< joints in place that are open at one end and closed at another
  double fallen_area = 0.0;    ///< m²
  double fallen_weight = 0.0;  ///< N per metre of tunnel
  /// Pa, weight of the largest fallen block over its own width along the wall (width_along_wall); NaN without an opening.
  double largest_block_pressure = 0.0;
  double largest_fallen_area = 0.0, largest_fallen_weight = 0.0;  ///< m², N per metre; of one block
  /// m, behind the outlines of openings, where there are any, else NaN.
  double fallen_depth = 0.0, fallen_depth_crown = 0.0, fallen_depth_left = 0.0, fallen_depth_right = 0.0,
         fallen_depth_invert = 0.0;
  double opening_filled_ratio = 0.0;
  double loosened_area = 0.0;  ///< m²
  /// m², of blocks that have fallen, that a static stage calls moving, or that a dynamic one leaves faster than `loosened_distance` per second.
  double moving_area = 0.0;
  double displacement_max = 0.0;                              ///< m, of a centroid against the base
  double stage_displacement = 0.0;                            ///< m, the same since the stage at hand began
  double rotation_max = 0.0;                                  ///< degrees, of a block
  double slip_max = 0.0, slip_mean = 0.0, opening_max = 0.0;  ///< m, of joints in place
  double slipped_length = 0.0, opened_length = 0.0;           ///< m, likewise
  /// m, of these and of joints beside blocks that have fallen: the largest up to now.
  double slip_max_ever = 0.0, opening_max_ever = 0.0, slipped_length_ever = 0.0, opened_length_ever = 0.0;
  double closure_vertical = 0.0, closure_horizontal = 0.0;  ///< m
  /// Since the start of the run: elements that have reached their limit, and the largest force over the limit of its element; NaN where no
  /// element has a limit.
  int yielded_elements = 0;
  int ruptured_elements = 0;  ///< that have broken
  double largest_utilization = 0.0;
};

struct MovingBlock {
  int block = 0;
  double carried = 0.0;  ///< share of its weight that contacts carry
  int group = 0;  ///< the same for moving blocks that touch and do not fall: the least of their numbers
};

/// The blocks by which it is told how blocks are at the end of a stage: those that have fallen, or else those that move (standing.h).
struct Movers {
  int blocks = 0;                ///< how many
  int heaviest = -1;             ///< of them; −1: there are none
  double weight = 0.0;           ///< N per metre of tunnel, of all of them
  double heaviest_weight = 0.0;  ///< N per metre of tunnel
  double way = 0.0;              ///< m, the largest since the reference
};

/// How blocks are at the end of a stage (standing.h).
enum class Standing : std::uint8_t {
  stands = 0,
  moves = 1,
  collapsed = 2,  ///< around no opening
  unsettled = 3,  ///< static steps ended before it was known
  rocks = 4,
  fallen = 5,    ///< the same as collapsed, beside an opening
  unstable = 6,  ///< in equilibrium that is not stable
};

/// How far the wall of an opening has come into it, at a share of release.
struct ReleasePoint {
  long step = 0;          ///< of the run
  double released = 0.0;  ///< 0 … 1
  /// m, inwards since it was opened: at the top, in the mean of the two sides, in the mean along the wall. NaN where rock of later
  /// excavations was.
  double crown = 0.0, springline = 0.0, mean = 0.0;
  int excavation = 0;
};

/// What a stage that ends when all is still waits for first: planned loads, motions of fixed blocks and supports, pressures, the shaking.
struct StageWait {
  double until = 0.0;  ///< s, in the stage
  std::string what;    ///< "load 1"
};

struct StageRecord {
  Stage stage;
  long steps = 0;
  double start_time = 0.0, duration = 0.0;  ///< s
  std::optional<double>
      planned_duration;  ///< s, what `duration` is unless the stage is interrupted; none when static
  double pga = 0.0;      ///< m/s², of the scaled motion in the section, as far as the stage applies it
  double pgv = 0.0;      ///< m/s, of its velocity from rest
  double arias = 0.0;    ///< m/s, its Arias intensity, sum of both components
  bool equilibrium_reached = false;   ///< settle only
  double worst_residual_ratio = 0.0;  ///< settle only: over blocks that are not moving
  /// settle only: the largest way of a block that is not moving, while it was out of balance; m, and as a share of the block size
  double way = 0.0, way_share = 0.0;
  std::vector<MovingBlock> moving;
  int unstable_block = -1;  ///< settle only: goes farthest where the equilibrium is not stable; −1: it is
  std::vector<ReleasePoint> release;  ///< of excavations that were opened in parts, in the order of steps
  std::vector<int> blocks_by_order;   ///< [n]: blocks of order n that are there at the end and not fixed
  Damage damage;
  std::vector<FallenBlock> fallen;   ///< at its end, ascending
  double largest_speed = 0.0;        ///< m/s, of a centroid against the base, at its end
  std::optional<Standing> standing;  ///< none where there are excavations
  Movers movers;                     ///< around openings, too
  double wall_time = 0.0;            ///< s
  bool interrupted = false;
  bool still = false;                  ///< it ended before `planned_duration`, as nothing moved any more
  std::optional<StageWait> waits_for;  ///< before that may be
  /// The motion as applied, thinned to what a plot needs: time in the stage (s), acceleration (m/s²).
  std::vector<double> motion_time;
  std::vector<Vec2> motion;
};

struct OpenCloseStatistics {
  double mean_iterations = 0.0;
  int max_iterations = 0;
  long retried_steps = 0;
  long unconverged_steps = 0;
  long last_converged_step = 0;  ///< of the run, over all stages; 0: none has converged
};

/// A true overlap of two blocks.
struct OverlapRecord {
  double depth = 0.0;  ///< m; 0: there was none
  int block_a = -1, block_b = -1;
  Vec2 where;         ///< in both
  double time = 0.0;  ///< s, simulated
  std::string stage;  ///< its name
};

/// Where vertices of blocks were against other blocks, looked for in every step (dynamics::ContactAudit).
struct ContactChecks {
  /// Contacts that pressed although their vertex was outside the other block, over all steps: a mistake of the program where it is not 0.
  long across_gaps = 0;
  OverlapRecord farthest;     ///< of these; `depth` is how far outside
  OverlapRecord deepest;      ///< the deepest vertex that pressed
  OverlapRecord unexplained;  ///< the deepest vertex, less what closes the joint there
};

/// A joint that goes on in the rock beside the model, at the end of the run.
struct PlaneRecord {
  std::string joint;                 ///< the set or map that it is of
  double x = 0.0, height = 0.0;      ///< m, local: of its column, and in it
  double dip = 0.0;                  ///< degrees, downwards to the right
  double mobilized = 0.0;            ///< FarPlane::mobilized
  double normal = 0.0, shear = 0.0;  ///< Pa, that it carries
  double slip = 0.0;                 ///< m, positive where the upper rock has gone to the right
  double slip_max = 0.0;             ///< m, the largest in the run
  bool opened = false;               ///< at any time
};

struct RunRecord {
  long steps = 0;
  double wall_time = 0.0;  ///< s
  int dof = 0;
  std::string state_hash;  ///< of the final state, hexadecimal
  OpenCloseStatistics open_close;
  OverlapRecord max_overlap;     ///< the largest that was seen
  ContactChecks contact_checks;  ///< of all steps
  double max_area_change = 0.0;  ///< relative
  Energy energy;
  MadeEnergy made;
  std::vector<StageRecord> stages;
  std::vector<PlaneRecord> planes;      ///< beside the model, from left to right and from below
  std::vector<ElementRecord> elements;  ///< springs and supports, at the end
  std::optional<WaterRecord> water;     ///< at the end, where some acts
  std::vector<BreakCount> breaks;       ///< in the order in which each was first
  bool interrupted = false;
  Profile profile;  ///< of this run; of the part after resuming, if it was resumed
};

/// What a terminal needs to draw a progress bar.
struct Progress {
  int stage = 0, stage_count = 0;
  std::string stage_name;
  StageKind kind = StageKind::settle;
  long step = 0;          ///< of the stage
  double fraction = 0.0;  ///< of the stage, 0 … 1; an estimate while settling
  double time = 0.0;      ///< s simulated in the stage
  double steps_per_second = 0.0;
  double seconds_left = 0.0;  ///< of the stage; negative: unknown
  double mean_iterations = 0.0;
  double worst_residual_ratio = 0.0;  ///< settle
};

/// What a run had reported by the time of a checkpoint.
struct Reported {
  long frames = 0, contacts = 0, histories = 0, breaks = 0,
       steps = 0;             ///< calls of these members of RunObserver
  int stages = 0;             ///< that had ended
  bool within_stage = false;  ///< the one after them had begun
};

/// Receives a run as it goes on. Calls come from one thread, in the order of simulated time.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void begin(const ModelRecord&) {}
  /// After begin, when the run goes on from a checkpoint: so much an earlier run reported before it. What that one reported later
  /// comes again.
  virtual void resume(const Reported&) {}
  virtual void stage_begin(int /*index*/, const StageRecord&) {}
  virtual void frame(const Frame&) {}
  virtual void contacts(const ContactFrame&) {}
  virtual void history(const HistoryRow&) {}
  /// Something broke in the step before. Only where ModelRecord::may_break.
  virtual void breaks(const BreakRecord&) {}
  virtual void step(const StepRow&) {}
  /// A checkpoint is about to be written, from which a resumed run goes on: what was reported so far must outlast this one.
  virtual void checkpoint() {}
  virtual void progress(const Progress&) {}
  virtual void stage_end(int /*index*/, const StageRecord&) {}
  virtual void end(const RunRecord&) {}
};

}  // namespace keyblock::record
