#include <cmath>
#include <numbers>

#include "api/contact_columns.h"
#include "api/simulation_parts.h"
#include "simulation/refuse.h"

// What can be changed of a simulation between its steps.
namespace keyblock {
namespace {

using simulation::refuse;

/// Of an angle in degrees.
double coefficient_of(double friction) {
  if (!(friction >= 0.0 && friction < 90.0))
    refuse("friction", std::to_string(friction), "degrees, from 0 to less than 90");
  return std::tan(friction / (180.0 / std::numbers::pi));
}

double number_of(const char* key, std::optional<double> value) {
  if (value && std::isnan(*value)) refuse(key, "nan", "a finite number, at least 0");
  return value.value_or(contact::ContactStrength::of_joint);
}

std::vector<contact::ContactStrength> strengths_of(const std::vector<ContactStrength>& given) {
  std::vector<contact::ContactStrength> strengths;
  strengths.reserve(given.size());
  for (const ContactStrength& s : given) {
    const double friction = s.friction ? coefficient_of(*s.friction) : contact::ContactStrength::of_joint;
    strengths.push_back(
        {s.vertex, s.edge, friction, number_of("cohesion", s.cohesion), number_of("tension", s.tension)});
  }
  return strengths;
}

}  // namespace

void Simulation::set_velocity(std::span<const double> velocity) {
  parts_->runner().control().set_velocity(velocity);
}

JointStrength Simulation::strength(const std::string& joint) const {
  const std::optional<contact::JointLaw> law = parts_->runner().control().law(joint);
  if (!law)
    refuse("joint", "\"" + joint + "\"",
           "the name of a joint set or of a trace map, \"joints\" or \"frame\"");
  return {api::degrees_of(law->friction_coefficient), law->cohesion, law->tension};
}

void Simulation::set_strength(const std::string& joint, const JointStrength& strength) {
  const double given = coefficient_of(strength.friction);
  // What was read and is set again changes no bit.
  const bool same = strength.friction == this->strength(joint).friction;
  const double coefficient = same ? parts_->runner().control().law(joint)->friction_coefficient : given;
  parts_->runner().control().set_strength(joint, {coefficient, strength.cohesion, strength.tension});
}

void Simulation::set_contact_strengths(const std::vector<ContactStrength>& strengths) {
  parts_->runner().control().set_contact_strengths(strengths_of(strengths));
}

void Simulation::forget_contact_strengths(const std::vector<ContactStrength>& contacts) {
  parts_->runner().control().forget_contact_strengths(strengths_of(contacts));
}

void Simulation::set_load_factor(std::size_t load, double factor) {
  parts_->runner().control().set_load_scale(load, factor);
}

void Simulation::set_force(std::size_t block, const std::array<double, 2>& force,
                           const std::optional<std::array<double, 2>>& place, std::int64_t slot) {
  const auto at = place ? std::optional(Vec2{(*place)[0], (*place)[1]}) : std::nullopt;
  parts_->runner().control().set_force(block, slot, at, {force[0], force[1]});
}

void Simulation::set_spring_stiffness(std::size_t spring, double stiffness) {
  parts_->runner().control().set_spring_stiffness(spring, stiffness);
}

void Simulation::set_spring_force(std::size_t spring, double force) {
  parts_->runner().control().set_spring_force(spring, force);
}

void Simulation::set_motion_scale(double factor) {
  parts_->runner().control().set_motion_scale(factor);
}

}  // namespace keyblock
