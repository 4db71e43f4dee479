#pragma once
#include "dynamics/step.h"
#include "loading/ground_motion.h"
#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// The ground motion of a stage, scaled, in the time of the run. `factor`, beside the scale, may change between steps.
class StageMotion final : public dynamics::GroundAcceleration {
 public:
  StageMotion(const loading::GroundMotion& motion, double scale, double start, const double& factor)
      : motion_(motion), scale_(scale), start_(start), factor_(factor) {}
  [[nodiscard]] Vec2 mean(double t0, double t1) const override {
    return scale_ * factor_ * motion_.mean(t0 - start_, t1 - start_);
  }
  [[nodiscard]] Vec2 at(double t) const override { return scale_ * factor_ * motion_.at(t - start_); }

 private:
  const loading::GroundMotion& motion_;
  double scale_, start_;
  const double& factor_;
};

/// How long a dynamic stage lasts and what shakes it: known before its first step.
void plan_motion(const RunSetup& setup, record::StageRecord& record);

}  // namespace keyblock::simulation
