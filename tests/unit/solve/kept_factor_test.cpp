#include "solve/kept_factor.h"

#include <gtest/gtest.h>

#include "../one_step.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {
namespace {

/// Two blocks on the ground, of which the factor of one step is offered to others.
struct Kept {
  /// gap: m, between the two.
  explicit Kept(double gap = 0.0) : s(pressed_blocks(gap)) { s.run(0.1, 0.005); }

  static simulation::Scene pressed_blocks(double gap) {
    simulation::Scene scene(1e8, 30.0);
    scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
    scene.rectangle({0.0, 0.0}, 1.0, 0.5);
    scene.rectangle({1.0 + gap, 0.0}, 1.0, 0.5, 0.0, false, 2);
    return scene;
  }
  /// A step that makes its factor.
  void make() {
    kept.drop();
    OneStep step(s, *solver);
    const StepSystem system = step.system();
    ASSERT_FALSE(kept.begin_step(system, matrix, update));
    kept.note(system);
    matrix.assemble(system);
    update.reset();
    ASSERT_TRUE(solver->factor());
    kept.end_step(converged, 0);
  }
  /// Whether a step would use it.
  bool is_offered(OneStep& step) { return kept.begin_step(step.system(), matrix, update); }
  bool is_offered() {
    OneStep step(s, *solver, s.stepper.find_contacts(s.state), false);
    return is_offered(step);
  }

  simulation::Simulator s;
  std::unique_ptr<linalg::BlockSolver> solver = linalg::make_block_cholesky(linalg::Precision::full);
  StepMatrix matrix;
  LowRankUpdate update;
  KeptFactor kept;
  OpenCloseResult converged{.converged = true};
};

TEST(KeptFactor, ServesTheStepsThatFollow) {
  Kept k;
  k.make();
  // The blocks move on, and one is struck.
  k.s.run(0.005, 0.005);
  k.s.state.velocity[k.s.model.blocks[1].first] -= 0.05;
  const std::vector<double> expected = plain_increment(k.s);
  OneStep step(k.s, *k.solver, k.s.stepper.find_contacts(k.s.state), false);
  ASSERT_TRUE(k.is_offered(step));
  EXPECT_TRUE(k.kept.is_kept());
  const StepSystem system = step.system();
  ASSERT_TRUE(k.update.minimize(system, step.iterate, k.matrix, true, true, step.result));
  const double tolerance = k.s.model.solver.tolerance;
  EXPECT_LE(step.out_of_balance(), tolerance);
  EXPECT_LT(apart(step.d, expected), tolerance * largest_of(expected));
  k.kept.end_step(k.converged, k.update.size());
  EXPECT_TRUE(k.is_offered());
}

TEST(KeptFactor, ResetDropAndForget) {
  Kept k;
  k.make();
  ASSERT_TRUE(k.is_offered());
  k.kept.forget();
  EXPECT_FALSE(k.kept.is_kept()) << "this step makes its own";
  k.make();
  k.kept.drop();
  EXPECT_FALSE(k.is_offered()) << "the next step does not try it";
  k.make();
  k.kept.reset();
  EXPECT_FALSE(k.is_offered());
  k.make();
  EXPECT_TRUE(k.is_offered()) << "after a reset nothing is waited for";
}

TEST(KeptFactor, IsOfOneSolverAndOneInertia) {
  Kept k;
  k.make();
  const auto other = linalg::make_block_cholesky(linalg::Precision::full);
  OneStep of_other(k.s, *other);
  EXPECT_FALSE(k.is_offered(of_other));

  k.make();
  OneStep shorter(k.s, *k.solver, k.s.stepper.find_contacts(k.s.state), false);
  shorter.next.drive.step = 0.0025;
  shorter.problem.build(k.s.model, k.s.state, shorter.next.drive, shorter.coupled, k.s.team);
  EXPECT_FALSE(k.is_offered(shorter));
}

TEST(KeptFactor, CanBeSwitchedOff) {
  Kept k;
  k.s.model.solver.accelerators.kept_factor = false;
  k.make();
  EXPECT_FALSE(k.is_offered());
}

// A contact without a spring may go; one that the factor has a spring of may not.
TEST(KeptFactor, NeedsTheContactsThatItHasSpringsOf) {
  for (const bool with_spring : {false, true}) {
    Kept k(3e-4);
    k.make();
    std::vector<contact::Contact> contacts = k.s.stepper.find_contacts(k.s.state);
    const auto gone = std::ranges::find_if(contacts, [&](const contact::Contact& c) {
      return k.matrix.has_spring(static_cast<std::size_t>(&c - contacts.data())) == with_spring;
    });
    ASSERT_NE(gone, contacts.end());
    contacts.erase(gone);
    OneStep step(k.s, *k.solver, contacts, false);
    EXPECT_EQ(k.is_offered(step), !with_spring);
  }
}

TEST(KeptFactor, IsDroppedWhereItSavesNothing) {
  using namespace step_numbers;
  const auto is_offered_after = [](const OpenCloseResult& result, std::size_t updated) {
    Kept k;
    k.make();
    EXPECT_TRUE(k.is_offered());
    k.kept.end_step(result, updated);
    return k.is_offered();
  };
  EXPECT_TRUE(is_offered_after({.converged = true}, most_kept / 2));
  EXPECT_FALSE(is_offered_after({.converged = true}, most_kept / 2 + 1));
  EXPECT_FALSE(is_offered_after({.converged = false}, 0));
  EXPECT_FALSE(is_offered_after({.converged = true, .refinements = most_refinements}, 0));
}

// Steps without a try: one after the first failure, twice as many after each that follows, up to `longest_wait`.
TEST(KeptFactor, WaitsLongerAfterEachFailure) {
  Kept k;
  int expected = 1;
  for (int failures = 0; failures < 8; ++failures) {
    k.make();
    ASSERT_TRUE(k.is_offered()) << failures;
    OneStep step(k.s, *k.solver, k.s.stepper.find_contacts(k.s.state), false);
    k.kept.note(step.system());  // the step had to make its own
    k.kept.end_step(k.converged, 0);
    int waited = 0;
    while (waited < 100 && !k.is_offered()) {
      k.kept.end_step(k.converged, 0);
      ++waited;
    }
    EXPECT_EQ(waited, expected) << failures;
    expected = std::min(2 * expected, step_numbers::longest_wait);
    k.kept.forget();
    k.kept.drop();
  }
}

}  // namespace
}  // namespace keyblock::dynamics
