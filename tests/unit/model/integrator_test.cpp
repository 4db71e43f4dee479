#include "model/integrator.h"

#include <gtest/gtest.h>

namespace keyblock::dynamics {
namespace {

TEST(Integrator, HasNoVelocityAfterTheWayToRest) {
  constexpr double dt = 0.003;
  const Motion start{broadcast(0.7), broadcast(-11.0), broadcast(5.0)};
  for (const Integrator& rule :
       {Integrator::shi(1.0), Integrator::shi(0.5), Integrator::shi(0.0), Integrator::average_acceleration(),
        Integrator::generalized_alpha(0.0), Integrator::generalized_alpha(0.8)}) {
    const Lanes way = rule.rest_share() * dt * start.velocity +
                      rule.rest_share_of_acceleration() * dt * dt * start.acceleration;
    EXPECT_NEAR(rule.end(start, way, dt).velocity[0], 0.0, 1e-15) << rule.inertia();
  }
}

}  // namespace
}  // namespace keyblock::dynamics
