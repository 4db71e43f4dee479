#include "simulation/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../scene.h"
#include "core/error.h"

namespace keyblock::simulation {
namespace {

/// Two blocks side by side that fill a domain with a frame; Young's moduli of the left and the right one.
RunSetup framed(double left, double right) {
  Scene scene(left, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.rectangle({1.0, 0.0}, 1.0, 1.0);
  scene.setup.properties[1].material.young = right;
  scene.setup.domain.add(Vec2{0.0, 0.0});
  scene.setup.domain.add(Vec2{2.0, 1.0});
  scene.setup.frame = true;
  return scene.setup;
}

// Where joints give no stiffness, they have that of the softer block. The frame is of no rock: along it they are as stiff as the block
// that touches it, whichever block of the model is the first.
TEST(BuildModel, JointsAlongTheFrameAreAsStiffAsTheRockThere) {
  for (const auto& [left, right] : {std::pair{1e9, 5e10}, {5e10, 1e9}}) {
    const RunSetup setup = framed(left, right);
    dynamics::Model model = build_model(setup);
    dynamics::State state = initial_state(setup, model);
    ThreadTeam alone(1);
    Profile profile;
    dynamics::Stepper stepper(model, alone, profile);
    stepper.start(state);
    const double young[] = {left, right};
    const int frame = 2;
    int found[] = {0, 0};
    for (const contact::Contact& c : stepper.find_contacts(state)) {
      if (c.block_a != frame && c.block_b != frame) continue;
      const int rock = c.block_a == frame ? c.block_b : c.block_a;
      const double length = std::max(c.length, 0.05 * model.block_size);
      EXPECT_NEAR(c.normal_stiffness / (20.0 * young[rock] * length), 1.0, 1e-12) << rock << ", " << left;
      ++found[rock];
    }
    EXPECT_GE(found[0], 4);
    EXPECT_GE(found[1], 4);
  }
}

// Over a sliver the polynomials of an order cannot be told from each other.
TEST(BuildModel, BlocksTooThinForTheirOrderAreNamed) {
  const auto with_sliver = [](double width) {
    Scene scene(3e9, 30.0);
    scene.rectangle({0.0, -1.0}, 1.0, 1.0);
    scene.add({{0.0, 0.0}, {1.0, 1.0}, {0.5, 0.5 + width}}, false, 3);
    scene.setup.properties[1].name = "sliver";
    return scene.setup;
  };
  for (const double width : {1e-2, 1e-4, 1e-6}) EXPECT_NO_THROW(build_model(with_sliver(width))) << width;
  for (const double width : {1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
    try {
      build_model(with_sliver(width));
      ADD_FAILURE() << width;
    } catch (const InputError& e) {
      ASSERT_EQ(e.diagnostics().size(), 1U);
      const Diagnostic& diagnostic = e.diagnostics().front();
      EXPECT_EQ(diagnostic.key, "block 'sliver' about (0.5, 0.5)");
      EXPECT_EQ(diagnostic.expected, "a block wide enough for polynomials of order 3");
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
