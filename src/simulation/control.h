#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contact/surface.h"
#include "dynamics/step.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::simulation {

struct RunSetup;

/// Strength of a joint, as in contact::JointLaw.
struct Strength {
  double friction_coefficient = 0.0;
  double cohesion = 0.0, tension = 0.0;  ///< Pa
};

/// What was changed of a running model; in checkpoints, so that a resumed run goes on with it. Empty: as the setup has it.
struct ControlMemory {
  std::vector<Strength> strengths;  ///< of all Model::laws
  std::vector<double> load_scale;   ///< factor on each load
  double motion_scale = 1.0;        ///< factor on ground motions, beside that of the stage
};

/// Changes a running model between two of its steps, for programs that steer a run: servo control, weakening by slip, staged support. All
/// that is changed acts from the next step on. Changes of velocity are work that is done from outside: Energy::input.
class Control {
 public:
  Control(const RunSetup& setup, dynamics::Model& model, dynamics::State& state, dynamics::Stepper& stepper,
          ControlMemory& memory)
      : setup_(setup), model_(model), state_(state), stepper_(stepper), memory_(memory) {}

  /// The law of a joint set, a trace map, `joints` (all others) or `frame`; null: there is no such name.
  [[nodiscard]] const contact::JointLaw* law(std::string_view name) const;
  /// Friction, cohesion and tension of joints, the names as for law(). A bond that has broken stays broken. Throws InputError for an
  /// unknown name, and for strengths that are negative or no number.
  void set_strength(std::string_view name, const Strength& strength);
  /// Factor on the load of this index, in the order of the scenario. Throws InputError for an unknown one, and for what is no number.
  void set_load_scale(std::size_t load, double factor);
  /// Factor on ground motions; the records of stages keep the motion as it was planned. Throws InputError for what is no number, where a
  /// seismic boundary has waves under way, and where histories are absolute: both integrate the motion as it was planned.
  void set_motion_scale(double factor);
  /// m/s, of all coefficients, by Block::first. Velocities of fixed blocks stay as they are. Throws InputError for another number of
  /// coefficients and for what is no number.
  void set_velocity(std::span<const double> velocity);

 private:
  [[nodiscard]] std::size_t law_index(std::string_view name) const;

  const RunSetup& setup_;
  dynamics::Model& model_;
  dynamics::State& state_;
  dynamics::Stepper& stepper_;
  ControlMemory& memory_;
};

/// Puts what a checkpoint holds into a model that was just built.
void restore(const ControlMemory& memory, dynamics::Model& model);
/// What is wrong with what a checkpoint holds, or empty.
std::string mistake_in_control(const ControlMemory& memory, const dynamics::Model& model);

}  // namespace keyblock::simulation
