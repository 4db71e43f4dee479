#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "keyblock/export.h"
#include "keyblock/scenario.h"

namespace keyblock {

namespace api {
struct SimulationAccess;
}

struct RunOptions {
  /// Where results go: result.h5, summary.json, histories.csv, report.html, checkpoints. Empty: nothing is written.
  std::filesystem::path folder;
  int realization = 0;
  int threads = 1;       ///< any number gives the same bits
  bool resume = false;   ///< go on from the checkpoint in `folder`
  bool replace = false;  ///< results of other input in `folder` may go
  /// Names and hashes of programs that steer the run. summary.json has them; a run is resumed with the same ones only.
  std::vector<std::pair<std::string, std::string>> hooks;
};

/// Strength of a joint.
struct JointStrength {
  double friction = 0.0;  ///< degrees
  double cohesion = 0.0;  ///< Pa
  double tension = 0.0;   ///< Pa
};

/// Strength of a single contact, by its vertex and edge.
struct ContactStrength {
  std::int32_t vertex = 0, edge = 0;
  std::optional<double> friction;           ///< degrees
  std::optional<double> cohesion, tension;  ///< Pa
};

/// Contacts between blocks after a step, one element each in every list.
struct Contacts {
  std::vector<std::int32_t> block_a, block_b;  ///< the block with the vertex, and the block with the edge
  std::vector<std::int32_t> vertex, edge;  ///< of all blocks, as in Simulation::vertices(); empty in Results
  std::vector<std::uint8_t> state;         ///< 0 open, 1 sliding, 2 locked
  std::vector<double> position, normal;    ///< m; unit vector out of block_b; x and y in turn
  std::vector<double> length, gap;         ///< m; gap negative where the contact is pressed
  std::vector<double> slip;                ///< m, since the excavation: the magnitude
  std::vector<double>
      shear_displacement;  ///< m, the same with its sign: of block_a along (-normal y, normal x)
  std::vector<double> normal_force, shear_force;  ///< N per metre thickness, compression positive
  std::vector<double> friction;                   ///< degrees, as it acted; empty in Results, as the next two
  std::vector<double> cohesion, tension;          ///< Pa; 0 where there is no bond, or none any more
  std::vector<std::int32_t> joint;                ///< place in joint_names
  std::vector<std::string> joint_names;           ///< as in Block::edges
};

/// Lists of Contacts, by their names.
enum class ContactColumn : std::uint8_t {
  block_a,
  block_b,
  vertex,
  edge,
  state,
  position,
  normal,
  length,
  gap,
  slip,
  shear_displacement,
  normal_force,
  shear_force,
  friction,
  cohesion,
  tension,
  joint
};

/// A list of numbers of Contacts, by its name.
struct ContactNumbers {
  const char* name;
  ContactColumn column;
  std::vector<double> Contacts::*list;
};
/// All of them.
inline constexpr ContactNumbers contact_numbers[] = {
    {"length", ContactColumn::length, &Contacts::length},
    {"gap", ContactColumn::gap, &Contacts::gap},
    {"slip", ContactColumn::slip, &Contacts::slip},
    {"shear_displacement", ContactColumn::shear_displacement, &Contacts::shear_displacement},
    {"normal_force", ContactColumn::normal_force, &Contacts::normal_force},
    {"shear_force", ContactColumn::shear_force, &Contacts::shear_force},
    {"friction", ContactColumn::friction, &Contacts::friction},
    {"cohesion", ContactColumn::cohesion, &Contacts::cohesion},
    {"tension", ContactColumn::tension, &Contacts::tension}};

/// What of a block stays the same in a run.
struct BlockFacts {
  std::string name;                      ///< of an explicit block; "frame"; empty for cut ones
  std::vector<std::string> excavations;  ///< whose outlines hold the block
  bool fixed = false;
  double area = 0.0;                  ///< m², in reference position
  double density = 0.0;               ///< kg/m³
  double young = 0.0, poisson = 0.0;  ///< Pa; –
};

/// A force on a block that set_force() has put there.
struct AppliedForce {
  std::size_t block = 0;
  std::int64_t slot = 0;
  std::array<double, 2> force{};  ///< N per metre thickness
};

/// A [[spring]] as it is, in the order of the scenario.
struct SpringState {
  std::string name;
  std::array<double, 2> from{}, to{};  ///< m, local coordinates
  double length = 0.0;                 ///< m
  double stiffness = 0.0;              ///< N/m per metre thickness
  double force = 0.0;                  ///< N per metre thickness, tension positive
  double yield = 0.0;                  ///< N per metre thickness; infinite: it never yields
  bool is_there = false;               ///< installed, and both its blocks are there
};

/// How far a run is.
struct Progress {
  int stage = 0, stages = 0;
  std::string stage_name;
  double fraction = 0.0;      ///< of the stage, 0 … 1; an estimate in static stages
  double time = 0.0;          ///< s, simulated in the stage
  long step = 0;              ///< of the stage
  double seconds_left = 0.0;  ///< of the stage; negative: unknown
};

/// A run, step by step. Between steps it can be looked at and changed. What was changed is in checkpoints: a resumed run goes on with it.
///
///     keyblock::RunOptions options;
///     options.folder = "out";
///     keyblock::Simulation run(scenario, options);
///     while (run.advance()) { … }
///     std::string summary = run.finish();
///
/// Not for several threads at once, except stop(). Spans hold until the next call that is not const.
class KEYBLOCK_API Simulation {
  struct Parts;

 public:
  /// Cuts the blocks and makes the model. Throws InputError, RunError.
  explicit Simulation(const Scenario& scenario, const RunOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// One step of the plan; false when there is nothing left to do. Throws RunError when the run cannot go on, and std::logic_error within
  /// after_step() and on_progress(), and after close().
  bool advance();
  [[nodiscard]] bool done() const;
  /// Ends the run where it is and writes what remains; summary.json as text. Calls after the first give the same. The folder is let go:
  /// other runs may use it. Not within after_step(). The first call throws a RunError, once all is written, where a whole run has errors of the
  /// computation.
  std::string finish();
  /// Lets the folder go without more ado: it then has what a killed run leaves, results up to the last flush and a checkpoint. The run can
  /// still be looked at, but goes on no more. Not within after_step().
  void close();
  /// The run ends within the step at hand. May be called from another thread and from a signal handler.
  void stop() noexcept;
  /// Is called after each step, before a checkpoint is written: here changes belong, or a resumed run misses them. Exceptions that it throws
  /// end the run, and advance() throws them.
  void after_step(std::function<void()> call);
  /// Is called now and then with how far the run is.
  void on_progress(std::function<void(const Progress&)> call);

  [[nodiscard]] double time() const;  ///< s, simulated; static steps count none
  [[nodiscard]] long step() const;    ///< of the run
  [[nodiscard]] int stage() const;    ///< number of the stage at hand, or of the next one
  [[nodiscard]] std::vector<std::string> stages() const;
  [[nodiscard]] std::vector<std::string> warnings() const;
  [[nodiscard]] std::string state_hash() const;

  [[nodiscard]] std::size_t blocks() const;
  [[nodiscard]] std::vector<BlockFacts> block_facts() const;
  /// m: real coordinates of (0, 0) of local ones.
  [[nodiscard]] std::array<double, 2> origin() const;
  /// m, x and y of all vertices of all blocks where they are now; block b has vertices first_vertex()[b] … first_vertex()[b + 1].
  [[nodiscard]] std::span<const double> vertices() const;
  [[nodiscard]] std::span<const int> first_vertex() const;
  /// Per block: 1 while it is there, 0 once it is excavated. The frame, if any, is the last block.
  [[nodiscard]] std::span<const std::uint8_t> present() const;
  /// x and y of the mass centre of each block: m; m/s.
  [[nodiscard]] std::vector<double> centroids() const;
  [[nodiscard]] std::vector<double> block_velocities() const;
  /// m/s, of all coefficients of the displacement polynomials; of block b from first_coefficient()[b] on.
  [[nodiscard]] std::span<const double> velocity() const;
  [[nodiscard]] std::vector<std::size_t> first_coefficient() const;
  /// None before the first step.
  [[nodiscard]] Contacts contacts() const;
  /// These lists alone, and joint_names; the others stay empty. Much cheaper than all of them.
  [[nodiscard]] Contacts contacts(const std::vector<ContactColumn>& columns) const;
  [[nodiscard]] std::size_t contact_count() const;
  /// Pa, mean of every block: xx, yy, xy in turn; tension positive.
  [[nodiscard]] std::vector<double> stress() const;
  /// Of every block: 0 in place, 1 loosened, 2 fallen, 3 excavated.
  [[nodiscard]] std::vector<std::uint8_t> status() const;
  /// Measures of damage so far, by their names in summary.json; none before the first excavation.
  [[nodiscard]] std::vector<std::pair<std::string, double>> damage() const;
  /// m/s², of the ground now; zero outside of shaking stages.
  [[nodiscard]] std::array<double, 2> ground_acceleration() const;
  [[nodiscard]] std::vector<SpringState> springs() const;
  [[nodiscard]] std::vector<AppliedForce> forces() const;
  /// J per metre thickness, by name: kinetic, strain, gravity, contact, friction, damping, input, numerical, radiated, water.
  [[nodiscard]] std::vector<std::pair<std::string, double>> energy() const;

  /// Replaces all velocities. The work that this does is Energy::input. Throws InputError for another number of them.
  void set_velocity(std::span<const double> velocity);
  /// Of a joint set, a trace map, "joints" (all others) or "frame". Throws InputError for an unknown name.
  [[nodiscard]] JointStrength strength(const std::string& joint) const;
  void set_strength(const std::string& joint, const JointStrength& strength);
  /// Of single contacts, beside what was given of them before. It acts from the next step on and stays with vertex and edge, also while they
  /// do not touch; cohesion and tension act where the bond holds. Strengths of joints that are set do not touch it. Throws InputError for what
  /// is no contact of two blocks, and for strengths that are negative or no number.
  void set_contact_strengths(const std::vector<ContactStrength>& strengths);
  /// Those contacts have the strength of their joints again; vertices and edges count alone.
  void forget_contact_strengths(const std::vector<ContactStrength>& contacts);
  /// What was given, ascending by vertex, then edge.
  [[nodiscard]] std::vector<ContactStrength> contact_strengths() const;
  /// Factor on the load of this number, in the order of the scenario, beside its own. Throws InputError for an unknown one.
  void set_load_factor(std::size_t load, double factor);
  /// A force on a block, N per metre thickness, in the place of the one of this slot before; zero takes it away. `place`: where it acts, m, in
  /// local coordinates, as the block lies now; none: its mass centre. It acts until it is changed, and goes with the block without turning; its
  /// work is in the energy "input". Throws InputError for a block that is fixed, gone or unknown, and for a place outside of it.
  void set_force(std::size_t block, const std::array<double, 2>& force,
                 const std::optional<std::array<double, 2>>& place = {}, std::int64_t slot = 0);
  /// N/m per metre thickness; the spring keeps its elongation. Throws InputError for an unknown spring.
  void set_spring_stiffness(std::size_t spring, double stiffness);
  /// N per metre thickness, tension positive: the spring is made as long as that takes. What both change of the stored energy is in "input".
  void set_spring_force(std::size_t spring, double force);
  /// Factor on ground motions, beside that of the stage. Throws InputError where a seismic boundary has waves under way.
  void set_motion_scale(double factor);

 private:
  friend struct api::SimulationAccess;
  KEYBLOCK_HIDDEN explicit Simulation(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Runs all stages, as `keyblock run` does; summary.json as text. `progress` may return false to stop the run.
KEYBLOCK_API std::string run(const Scenario& scenario, const RunOptions& options,
                             const std::function<bool(const Progress&)>& progress = {});

}  // namespace keyblock
