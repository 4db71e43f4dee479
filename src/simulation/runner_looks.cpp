#include "simulation/build_model.h"
#include "simulation/elements.h"
#include "simulation/runner.h"
#include "simulation/slender.h"

namespace keyblock::simulation {

std::optional<record::Damage> Runner::damage() const {
  if (!gauge_.started()) return {};
  DamageGauge looking = gauge_;  // a look is remembered
  record::Damage damage = looking.measure(now_.mechanics);
  measure_elements(model_, now_.mechanics, now_.peaks, damage);
  return damage;
}

std::vector<record::BlockStatus> Runner::status() const {
  return gauge_.status(now_.mechanics);
}

Vec2 Runner::ground_acceleration() const {
  return stage_ && stage_->motion ? stage_->motion->at(now_.mechanics.time) : Vec2{};
}

int Runner::find_unstable_block(const std::vector<bool>& which_move) {
  const int found = stepper_->find_unstable_block(now_.mechanics, which_move);
  const auto orders =
      found < 0 ? orders_that_bend(model_, now_.mechanics, stepper_->contacts()) : std::nullopt;
  if (!orders) return found;
  // Blocks of low orders stand under any load: a model of blocks that can bend is tested in the place of this one.
  dynamics::Model bending = model_;
  dynamics::State state = now_.mechanics;
  simulation::change_orders(setup_, bending, state, *orders);
  put_loads(now_.control, setup_, bending);
  dynamics::Stepper stepper(bending, team_, profile_, options_.stop);
  stepper.resume(state);
  stepper.find_forces(state);
  return stepper.find_unstable_block(state, which_move);
}

}  // namespace keyblock::simulation
