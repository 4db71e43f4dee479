#include "simulation/order_control.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "../fresh_folder.h"
#include "../scene.h"
#include "simulation/run.h"

namespace keyblock::simulation {
namespace {

/// A block in a corner under its own weight, and a slab of 4 × 0.5 m that leans out over it, clamped at its left end.
RunSetup slab(int order) {
  Scene scene(1e9, 30.0);
  scene.setup.solver.rock_damping = 0.1;
  scene.rectangle({0.0, 0.0}, 4.0, 0.5, 0.0, false, std::max(order, 1));
  scene.rectangle({-1.0, -2.0}, 8.0, 1.0, 0.0, true);
  scene.rectangle({5.0, -1.0}, 0.5, 0.5, 0.0, false, std::max(order, 1));
  RunSetup setup = scene.setup;
  loading::Support clamp;
  clamp.block = "b0";
  clamp.is_edge = true;
  clamp.points = {{0.0, 0.0}, {0.0, 0.5}};
  setup.supports.push_back(clamp);
  setup.histories.push_back({"tip", "b0", {4.0, 0.25}});
  if (order == 0) {
    for (BlockProperties& block : setup.properties) block.automatic_order = true;
  }
  setup.time_step = 0.002;
  setup.scenario = "slab";
  record::Stage settle;
  settle.name = "settle";
  settle.tolerance = 1e-4;
  record::Stage rest;
  rest.name = "rest";
  rest.kind = record::StageKind::rest;
  rest.duration = 0.2;
  setup.stages = {settle, rest};
  return setup;
}

struct Tip final : record::RunObserver {
  double down = 0.0;
  std::atomic<bool> stop = false;
  long after = -1;
  std::vector<std::int16_t> first_orders, orders;
  void frame(const record::Frame& frame) override {
    if (first_orders.empty()) first_orders = frame.order;
    orders = frame.order;
  }
  void history(const record::HistoryRow& row) override { down = -row.points[0].uy; }
  void step(const record::StepRow& row) override { stop = after >= 0 && row.step >= after; }
};

TEST(OrderControl, RaisesWhereStressVariesAndLowersWhereItDoesNot) {
  Tip best, chosen, first;
  run(slab(8), {}, best);
  const record::RunRecord record = run(slab(0), {}, chosen);
  run(slab(1), {}, first);
  EXPECT_TRUE(record.stages[0].equilibrium_reached);
  EXPECT_NEAR(chosen.down / best.down, 1.0, 0.01);
  EXPECT_LT(first.down, 0.7 * best.down);
  // The slab has gone up, to 3 at least; the block that merely lies there down to 1, 6 unknowns.
  EXPECT_GE(record.dof, 20 + 6);
  EXPECT_LE(record.dof, 56 + 6);
  EXPECT_LT(record.energy.residual_ratio, 0.01);
  EXPECT_EQ(chosen.first_orders, (std::vector<std::int16_t>{1, 1, 1}));
  EXPECT_GE(chosen.orders[0], 3);
  EXPECT_EQ(chosen.orders[2], 1);
}

TEST(OrderControl, IndicatorIsTheStressOfTheHighestDegree) {
  RunSetup setup = slab(3);
  dynamics::Model model = build_model(setup);
  dynamics::State state = initial_state(setup, model);
  const dynamics::Block& block = model.blocks[0];
  EXPECT_EQ(OrderControl::indicators(model, state)[0], 0.0);
  state.position[block.first + 2] *= 1.0001;  // uniform strain
  EXPECT_LT(OrderControl::indicators(model, state)[0], 1e-9);
  state.position[block.first + 2 * 6] += 1e-6;  // a term of degree 3
  const double eta = OrderControl::indicators(model, state)[0];
  EXPECT_GT(eta, 1e-3);
}

TEST(OrderControl, StateKeepsItsShapeWhenOrdersChange) {
  RunSetup setup = slab(0);
  setup.properties[0].order = 3;
  dynamics::Model model = build_model(setup);
  dynamics::State state = initial_state(setup, model);
  state.position[model.blocks[0].first + 2 * 7] += 0.01;
  const double before = model.blocks[0].elasticity.energy(&state.position[model.blocks[0].first]);
  change_orders(setup, model, state, std::vector<int>{5, 1, 2});
  EXPECT_EQ(model.blocks[0].size, 21);
  EXPECT_EQ(model.blocks[2].size, 6);
  EXPECT_NEAR(model.blocks[0].elasticity.energy(&state.position[model.blocks[0].first]) / before, 1.0, 1e-9);
  EXPECT_EQ(state.position.size(), model.coefficients);
  EXPECT_EQ(state.position.size(), 42U + 6U + 12U);
}

// A block that is given a lower order loses what its vertices had bent by: springs begin from where they are then.
TEST(OrderControl, EnergyOfSpringsIsThatOfWhereBlocksAreNow) {
  Scene scene(1e8, 30.0);
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, false, 2);
  Simulator s(scene);
  s.run(0.2, 0.002);
  const dynamics::Block& block = s.model.blocks[1];
  s.state.position[block.first + 2 * 3 + 1] += 1e-5;
  change_orders(scene.setup, s.model, s.state, std::vector<int>{1, 1});
  dynamics::Stepper stepper(s.model, s.team, s.profile);
  stepper.resume(s.state);
  stepper.measure_stored_energy(s.state);
  const auto balance = [&] {
    const dynamics::EnergyLedger& ledger = s.state.ledger;
    return dynamics::kinetic_energy(s.model, s.state) + dynamics::strain_energy(s.model, s.state) +
           dynamics::gravity_energy(s.model, s.state) + dynamics::spring_energy(s.state) + ledger.friction +
           ledger.damping + ledger.numerical - ledger.input;
  };
  const double before = balance(), stored = s.state.contact_energy;
  EXPECT_GT(stored, 0.0);
  for (int k = 0; k < 10; ++k) stepper.advance(s.state, 0.002, nullptr);
  EXPECT_NEAR(balance(), before, 1e-6 * stored);
}

TEST(OrderControl, ResumedRunEndsInTheSameBits) {
  const FreshFolder folder;
  Tip nobody, stopper;
  const record::RunRecord whole = run(slab(0), {}, nobody);
  stopper.after = whole.stages[0].steps + 10;
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  EXPECT_TRUE(run(slab(0), options, stopper).interrupted);
  options.stop = nullptr;
  options.resume = true;
  EXPECT_EQ(run(slab(0), options, nobody).state_hash, whole.state_hash);
}

}  // namespace
}  // namespace keyblock::simulation
