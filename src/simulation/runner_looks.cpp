#include "simulation/runner.h"

namespace keyblock::simulation {

std::optional<Damage> Runner::damage() const {
  if (!gauge_.started()) return {};
  DamageGauge looking = gauge_;  // a look is remembered
  return looking.measure(now_.mechanics);
}

std::vector<BlockStatus> Runner::status() const {
  return gauge_.status(now_.mechanics);
}

Vec2 Runner::ground_acceleration() const {
  return stage_ && stage_->motion ? stage_->motion->at(now_.mechanics.time) : Vec2{};
}

}  // namespace keyblock::simulation
