#include <gtest/gtest.h>

#include <algorithm>

#include "../one_step.h"
#include "../scene.h"
#include "coupling/step_problem.h"

namespace keyblock::dynamics {
namespace {

// Contacts are named by vertex and edge, springs by their number: no two rows have one name, whatever their numbers are.
TEST(RowKeys, RowsOfDifferentCouplingsDoNotCollide) {
  simulation::Scene scene(1e9, 30.0);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  for (const double x : {0.2, 0.4, 0.6, 0.8}) {
    loading::Spring spring;
    spring.from = {x, -0.5};
    spring.to = {x, 0.4};
    spring.stiffness = 1e6;
    scene.setup.springs.push_back(spring);
  }
  simulation::Simulator s(scene);
  s.run(0.01, 0.005);
  StepProblem problem;
  const NextStep next(s);
  const std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
  const CoupledContacts coupled(contacts);
  problem.build(s.model, s.state, next.drive, coupled, s.team);
  std::vector<Coupling::RowKey> keys;
  problem.name_rows(keys);
  ASSERT_EQ(keys.size(), contacts.size() + 4);
  for (std::size_t a = 0; a < keys.size(); ++a) {
    EXPECT_EQ(keys[a].coupling, a < contacts.size() ? 0 : 1);
    EXPECT_EQ(std::ranges::count(keys, keys[a]), 1) << a;
  }
  // The same again: the rows of a step that follows are told by them.
  std::vector<Coupling::RowKey> again;
  problem.build(s.model, s.state, next.drive, coupled, s.team);
  problem.name_rows(again);
  EXPECT_EQ(again, keys);
}

}  // namespace
}  // namespace keyblock::dynamics
