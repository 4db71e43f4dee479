#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contact/contact_strengths.h"
#include "contact/surface.h"
#include "dynamics/step.h"
#include "geometry/vec2.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::record {
struct Stage;
}

namespace keyblock::simulation {

struct RunSetup;

/// Strength of a joint, as in contact::JointLaw.
struct Strength {
  double friction_coefficient = 0.0;
  double cohesion = 0.0, tension = 0.0;  ///< Pa
};

/// A force on a block at a material point, which goes with the block.
struct AppliedForce {
  std::int64_t block = 0, slot = 0;  ///< slot: its name among those on the block
  Vec2 point;                        ///< m, in reference position
  Vec2 force;                        ///< N per thickness
};

/// A spring between points of blocks, as it is.
struct SpringNow {
  std::string name;
  Vec2 from, to;           ///< m
  double length = 0.0;     ///< m
  double stiffness = 0.0;  ///< N/m per thickness
  double force = 0.0;      ///< N per thickness, tension positive
  double yield = 0.0;      ///< N per thickness, infinite where it never yields
  bool is_there = false;   ///< installed, and both its blocks are there
};

/// What was changed of a running model; in checkpoints, so that a resumed run goes on with it. Empty: as the setup has it.
struct ControlMemory {
  std::vector<Strength> strengths;  ///< of all Model::laws
  std::vector<double> load_scale;   ///< factor on each load
  double motion_scale = 1.0;        ///< factor on ground motions, beside that of the stage
  std::vector<AppliedForce> forces;
  std::vector<double> spring_stiffness;                     ///< N/m per thickness, of all springs
  std::vector<contact::ContactStrength> contact_strengths;  ///< ascending by vertex, then edge
};

/// Changes a running model between two of its steps, for programs that steer a run: servo control, weakening by slip, staged support. All
/// that is changed acts from the next step on. Changes of velocity are work that is done from outside: Energy::input.
class Control {
 public:
  /// stage: the one at hand.
  Control(const RunSetup& setup, const record::Stage& stage, dynamics::Model& model, dynamics::State& state,
          dynamics::Stepper& stepper, ControlMemory& memory)
      : setup_(setup), stage_(stage), model_(model), state_(state), stepper_(stepper), memory_(memory) {}

  /// The law of a joint set, a trace map, `joints` (all others) or `frame`, before a stage divides its strength; none: there is no such name.
  [[nodiscard]] std::optional<contact::JointLaw> law(std::string_view name) const;
  /// Friction, cohesion and tension of joints, likewise. A bond that has broken stays broken. Throws InputError for an
  /// unknown name, and for strengths that are negative or no number.
  void set_strength(std::string_view name, const Strength& strength);
  /// Of single contacts, beside what was given before: what is not a number stays as it was. Throws InputError for what are no vertex and edge
  /// of two blocks, and for strengths that are negative or infinite.
  void set_contact_strengths(std::span<const contact::ContactStrength> strengths);
  /// Those contacts have the strength of their joints again; vertices and edges count alone.
  void forget_contact_strengths(std::span<const contact::ContactStrength> contacts);
  [[nodiscard]] const std::vector<contact::ContactStrength>& contact_strengths() const {
    return memory_.contact_strengths;
  }
  /// Factor on the load of this index, in the order of the scenario. Throws InputError for an unknown one, and for what is no number.
  void set_load_scale(std::size_t load, double factor);
  /// Factor on ground motions; the records of stages keep the motion as it was planned. Throws InputError for what is no number, where a
  /// seismic boundary has waves under way, and where histories are absolute: both integrate the motion as it was planned.
  void set_motion_scale(double factor);
  /// A force on a block, in the place of the one of this slot before; zero takes it away. `place`: where it acts, as the block lies now, m;
  /// none: its mass centre. It acts until it is changed, and goes with the block without turning; its work is Energy::input. Throws InputError
  /// for a block that is fixed, gone or unknown, a place outside of it, and what is no number.
  void set_force(std::size_t block, std::int64_t slot, std::optional<Vec2> place, Vec2 force);
  [[nodiscard]] const std::vector<AppliedForce>& forces() const { return memory_.forces; }
  /// Those of the scenario, in its order.
  [[nodiscard]] std::vector<SpringNow> springs() const;
  /// N/m per thickness. The spring keeps its elongation; what that changes of its energy is Energy::input. Throws InputError for an unknown
  /// spring, and for a stiffness that is negative or no number.
  void set_spring_stiffness(std::size_t spring, double stiffness);
  /// N per thickness, tension positive: the spring is made as long as that takes. Its energy as above. Throws InputError for an unknown
  /// spring, one without stiffness, one that is not there, and a force beyond its yield.
  void set_spring_force(std::size_t spring, double force);
  /// m/s, of all coefficients, by Block::first. Velocities of fixed blocks stay as they are. Throws InputError for another number of
  /// coefficients and for what is no number.
  void set_velocity(std::span<const double> velocity);

 private:
  /// Calls change() and counts what it changes of the stored energy as input.
  template <class Change>
  void with_input(const Change& change);
  void check_spring(std::size_t spring) const;
  void check_contact(const contact::ContactStrength& strength) const;

  const RunSetup& setup_;
  const record::Stage& stage_;
  dynamics::Model& model_;
  dynamics::State& state_;
  dynamics::Stepper& stepper_;
  ControlMemory& memory_;
};

/// Puts what a checkpoint holds into a model that was just built.
void restore(const ControlMemory& memory, const RunSetup& setup, dynamics::Model& model);
/// Forces and factors of loads, after the model has got other loads.
void put_loads(const ControlMemory& memory, const RunSetup& setup, dynamics::Model& model);
/// Those of single contacts.
void put_contact_strengths(const ControlMemory& memory, dynamics::Model& model);
/// Whether those of a checkpoint are such.
bool are_contact_strengths(const ControlMemory& memory, const dynamics::Model& model);
/// Number of the springs between points.
std::size_t spring_count(const dynamics::Model& model);
/// What is wrong with what a checkpoint holds, or empty.
std::string mistake_in_control(const ControlMemory& memory, const dynamics::Model& model);

}  // namespace keyblock::simulation
