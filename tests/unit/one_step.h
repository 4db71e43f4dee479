#pragma once
#include <algorithm>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "coupling/contact_coupling.h"
#include "scene.h"
#include "solve/newton.h"
#include "solve/step_matrix.h"

namespace keyblock::dynamics {

/// Room for all pairs that have contacts.
inline void analyse(const Model& model, StepProblem& problem, linalg::BlockSolver& solver) {
  std::vector<int> sizes;
  for (const Block& block : model.blocks) {
    if (!block.fixed) sizes.push_back(2 * block.size);
  }
  std::set<std::pair<int, int>> found;
  for (const Row& row : problem.rows()) {
    if (row.unknown_a >= 0 && row.unknown_b >= 0) found.insert(std::minmax(row.unknown_a, row.unknown_b));
  }
  const std::vector<std::pair<int, int>> pairs(found.begin(), found.end());
  problem.find_pairs(pairs);
  solver.analyse(sizes, pairs);
}

/// Drives a scene on from where it is, by 5 ms.
struct NextStep {
  explicit NextStep(const simulation::Simulator& s) : rule(s.model.blocks.size()) {
    drive.step = 0.005;
    drive.end_time = s.state.time + drive.step;
    drive.rule = rule;
  }
  NextStep(const NextStep&) = delete;
  NextStep& operator=(const NextStep&) = delete;

  std::vector<Integrator> rule;
  Drive drive;
};

/// Contacts as the coupling of a step. `analyse` says where in the pattern their pairs of blocks are.
class CoupledContacts {
 public:
  explicit CoupledContacts(std::span<const contact::Contact> contacts) {
    int most = -1;
    for (const contact::Contact& c : contacts) most = std::max(most, c.candidate);
    pairs_.assign(static_cast<std::size_t>(most + 1), -1);
    coupling_.begin_step(contacts, pairs_, {}, {});
  }
  CoupledContacts(const CoupledContacts&) = delete;
  CoupledContacts& operator=(const CoupledContacts&) = delete;
  operator const Coupling&() const { return coupling_; }  // NOLINT(google-explicit-constructor)

 private:
  std::vector<int> pairs_;
  ContactCoupling coupling_;
};

/// The minimization of the next step of a scene, with bounds of friction frozen, and what an open-close iteration has of it.
struct OneStep {
  OneStep(simulation::Simulator& s, linalg::BlockSolver& linear)
      : OneStep(s, linear, s.stepper.find_contacts(s.state)) {}
  OneStep(simulation::Simulator& s, linalg::BlockSolver& linear, std::vector<contact::Contact> of_step,
          bool is_first = true)
      : next(s), contacts(std::move(of_step)), coupled(contacts), solver(linear), simulator(s) {
    problem.build(s.model, s.state, next.drive, coupled, s.team);
    if (is_first) analyse(s.model, problem, solver);
    d.assign(s.model.coefficients, 0.0);
    iterate.begin(system(), d);
  }
  OneStep(const OneStep&) = delete;
  OneStep& operator=(const OneStep&) = delete;

  [[nodiscard]] StepSystem system() {
    return {problem, {contacts}, solver, simulator.model.solver, simulator.team, simulator.profile};
  }
  /// Residual ratio of the gradient at d, contact by contact.
  [[nodiscard]] double out_of_balance() const {
    std::vector<double> g(d.size());
    gradient_by_rows(problem, d, g);
    return problem.terms().residual_ratio(g);
  }

  NextStep next;
  std::vector<contact::Contact> contacts;
  CoupledContacts coupled;
  linalg::BlockSolver& solver;
  simulation::Simulator& simulator;
  StepProblem problem;
  std::vector<double> d;
  Iterate iterate;
  OpenCloseResult result;
};

/// The increment of the next step by Newton's method, with a new factor in each iteration.
inline std::vector<double> plain_increment(simulation::Simulator& s) {
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  OneStep step(s, *solver);
  const StepSystem system = step.system();
  StepMatrix matrix;
  Newton newton;
  newton.begin(system);
  step.iterate.place(system);
  step.iterate.find_gradient(system);
  const double enough = 1e-6 * s.model.solver.tolerance;
  for (int k = 0; k < 60 && step.iterate.out_of_balance(system) > enough; ++k) {
    matrix.assemble(system);
    if (!solver->factor() || !newton.solve(system, step.iterate, true, step.result)) break;
    if (!newton.go_along(system, step.iterate, enough, true, step.result)) break;
  }
  return step.d;
}

/// Largest |x|.
inline double largest_of(std::span<const double> x) {
  double largest = 0.0;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Largest |x − y|.
inline double apart(std::span<const double> x, std::span<const double> y) {
  double largest = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) largest = std::max(largest, std::abs(x[k] - y[k]));
  return largest;
}

/// Rows and columns of long_wall().
constexpr int wall_rows = 3, wall_columns = 150;

/// A long wall of bricks; the size at which few blocks are worth a system of their own.
inline simulation::Scene long_wall() {
  simulation::Scene scene(1e9, 35.0);
  scene.rectangle({-2.0, -1.0}, wall_columns + 4.0, 1.0, 0.0, true);
  for (int row = 0; row < wall_rows; ++row) {
    for (int column = 0; column < wall_columns; ++column)
      scene.rectangle({1.0 * column + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5);
  }
  return scene;
}

}  // namespace keyblock::dynamics
