#include "simulation/control.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "dynamics/energy.h"
#include "simulation/joint_laws.h"
#include "simulation/refuse.h"
#include "simulation/setup.h"

namespace keyblock::simulation {
namespace {

void check_strength(const char* key, double value) {
  if (!std::isfinite(value) || value < 0.0) refuse(key, std::to_string(value), "a finite number, at least 0");
}

void check_factor(const char* key, double value) {
  if (!std::isfinite(value)) refuse(key, std::to_string(value), "a finite number");
}

}  // namespace

std::optional<contact::JointLaw> Control::law(std::string_view name) const {
  const std::vector<std::size_t> numbers = find_laws(setup_, name);
  return numbers.empty() ? std::nullopt : std::optional(given_laws(setup_, memory_)[numbers.front()]);
}

void Control::set_strength(std::string_view name, const Strength& strength) {
  const std::vector<std::size_t> numbers = find_laws(setup_, name);
  if (numbers.empty())
    refuse("law", "\"" + std::string(name) + "\"",
           "the name of a joint set or of a trace map, \"joints\" or \"frame\"");
  check_strength("friction", strength.friction_coefficient);
  check_strength("cohesion", strength.cohesion);
  check_strength("tension", strength.tension);
  std::vector<contact::JointLaw> laws = given_laws(setup_, memory_);
  const std::vector<contact::JointLaw> before = laws;
  for (const std::size_t number : numbers) put_strength(strength, laws[number]);
  if (laws == before) return;
  memory_.strengths.clear();
  for (const contact::JointLaw& law : laws)
    memory_.strengths.push_back({law.friction_coefficient, law.cohesion, law.tension});
  stepper_.set_laws(laws_in_stage(setup_, memory_, stage_));
}

void Control::set_load_scale(std::size_t load, double factor) {
  if (load >= setup_.loads.size())
    refuse("load", std::to_string(load),
           "the number of a load, less than " + std::to_string(setup_.loads.size()));
  check_factor("load", factor);
  memory_.load_scale.resize(setup_.loads.size(), 1.0);
  memory_.load_scale[load] = factor;
  put_loads(memory_, setup_, model_);
}

void Control::set_motion_scale(double factor) {
  check_factor("motion", factor);
  if (factor == memory_.motion_scale) return;
  if (setup_.boundary)
    refuse("motion", "a seismic boundary", "a frame: waves are under way in the rock around the model");
  if (std::any_of(setup_.histories.begin(), setup_.histories.end(),
                  [](const History& h) { return h.absolute; }))
    refuse("motion", "a history with frame = \"absolute\"", "histories relative to the base");
  memory_.motion_scale = factor;
}

void Control::set_velocity(std::span<const double> velocity) {
  if (velocity.size() != state_.velocity.size())
    refuse("velocity", std::to_string(velocity.size()) + " numbers",
           std::to_string(state_.velocity.size()) + ", as many as there are coefficients");
  if (!std::all_of(velocity.begin(), velocity.end(), [](double v) { return std::isfinite(v); }))
    refuse("velocity", "a value that is not finite", "finite numbers");
  const double before = dynamics::kinetic_energy(model_, state_);
  for (const dynamics::Block& block : model_.blocks) {
    if (block.fixed) continue;
    const auto from = velocity.begin() + static_cast<std::ptrdiff_t>(block.first);
    std::copy(from, from + 2 * block.size,
              state_.velocity.begin() + static_cast<std::ptrdiff_t>(block.first));
  }
  state_.ledger.input += dynamics::kinetic_energy(model_, state_) - before;
  stepper_.forget_history();
}

void restore(const ControlMemory& memory, const RunSetup& setup, dynamics::Model& model) {
  put_loads(memory, setup, model);
  model.spring_stiffness = memory.spring_stiffness;
  put_contact_strengths(memory, model);
}

std::string mistake_in_control(const ControlMemory& memory, const dynamics::Model& model) {
  const auto fits = [](std::size_t size, std::size_t of_model) { return size == 0 || size == of_model; };
  const auto is_strength = [](const Strength& s) {
    return std::isfinite(s.friction_coefficient) && std::isfinite(s.cohesion) && std::isfinite(s.tension);
  };
  const auto is_force = [](const AppliedForce& f, const dynamics::Model& of) {
    return f.block >= 0 && f.block < std::ssize(of.blocks) &&
           !of.blocks[static_cast<std::size_t>(f.block)].fixed && std::isfinite(norm(f.point)) &&
           std::isfinite(norm(f.force));
  };
  const bool known = std::all_of(memory.strengths.begin(), memory.strengths.end(), is_strength) &&
                     fits(memory.strengths.size(), model.laws.size()) &&
                     fits(memory.load_scale.size(), model.loads.size()) &&
                     fits(memory.spring_stiffness.size(), spring_count(model)) &&
                     std::all_of(memory.spring_stiffness.begin(), memory.spring_stiffness.end(),
                                 [](double k) { return std::isfinite(k) && k >= 0.0; }) &&
                     std::all_of(memory.forces.begin(), memory.forces.end(),
                                 [&](const AppliedForce& f) { return is_force(f, model); }) &&
                     std::isfinite(memory.motion_scale) && are_contact_strengths(memory, model);
  return known ? "" : "changes of another model";
}

}  // namespace keyblock::simulation
