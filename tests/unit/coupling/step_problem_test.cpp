#include "coupling/step_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "../one_step.h"
#include "../scene.h"
#include "block/eigenvalue_floor.h"
#include "model/vertex_field.h"
#include "solve/earlier_attempt.h"
#include "solve/open_close.h"

namespace keyblock::dynamics {
namespace {

/// Two blocks on a floor, of which one has an order, and a third of that order on both.
simulation::Scene small_wall(double friction, int order) {
  simulation::Scene scene(1e7, friction);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, 0.0, false, order);
  scene.rectangle({1.0, 0.0}, 1.0, 0.5, 0.0, false, 1);
  scene.rectangle({0.5, 0.5}, 1.0, 0.5, 0.0, false, order);
  return scene;
}

class StepProblemOrder : public ::testing::TestWithParam<int> {};

// The matrix that is assembled is the derivative of the gradient, and the gradient that of the forces, at every order.
TEST_P(StepProblemOrder, MatrixIsTheDerivativeOfTheGradient) {
  simulation::Simulator s(small_wall(30.0, GetParam()));
  s.run(0.05, 0.005);

  StepProblem problem;
  const NextStep next(s);
  const std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
  const CoupledContacts coupled(contacts);
  problem.build(s.model, s.state, next.drive, coupled, s.team);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> d(s.model.coefficients, 0.0), direction(d.size(), 0.0);
  for (std::size_t k = 0; k < s.model.unknowns; ++k) {
    d[k] = 1e-7 * uniform(random);
    direction[k] = uniform(random);
  }
  const auto gradient = [&](double step) {
    std::vector<double> x = d, g(d.size());
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += step * direction[k];
    gradient_by_rows(problem, x, g);
    return g;
  };
  const double h = 1e-11;
  const std::vector<double> up = gradient(h), down = gradient(-h);

  // The same by way of the vertices, a block at a time.
  const std::vector<double> expected = gradient(0.0);
  std::vector<double> by_vertices(d.size());
  std::vector<Vec2> at_points;
  const auto force_of = [&](std::size_t c) {
    const Row& row = problem.rows()[c];
    const Vec2 r = problem.relative(row, d);
    const SpringArray& of_contact = problem.springs();
    return row.gradient(of_contact.force_at(c, of_contact.y0[c] - dot(row.normal, r),
                                            of_contact.w0[c] + dot(row.tangent(), r)));
  };
  problem.gradient(d, force_of, at_points, by_vertices);
  double largest = 0.0;
  for (const double g : expected) largest = std::max(largest, std::abs(g));
  EXPECT_GT(largest, 0.0);
  for (std::size_t k = 0; k < s.model.unknowns; ++k)
    EXPECT_NEAR(by_vertices[k], expected[k], 1e-12 * largest);

  // K direction, by solving: K⁻¹ (∂g · direction) must give the direction back.
  const auto solver = linalg::make_block_cholesky();
  analyse(s.model, problem, *solver);
  problem.terms().assemble(*solver);
  std::vector<SpringChange> springs;
  for (std::size_t c = 0; c < problem.rows().size(); ++c) {
    const Row& row = problem.rows()[c];
    const Vec2 r = problem.relative(row, d);
    const SpringArray& of_contact = problem.springs();
    const SpringArray::Branch branch = of_contact.branch_at(c, of_contact.y0[c] - dot(row.normal, r),
                                                            of_contact.w0[c] + dot(row.tangent(), r));
    springs.push_back({c, Place(problem.rows()[c]), of_contact.normal_stiffness(c, branch),
                       of_contact.shear_stiffness(c, branch)});
  }
  problem.add_springs(springs, *solver);
  ASSERT_TRUE(solver->factor());
  std::vector<double> x(s.model.unknowns);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = (up[k] - down[k]) / (2 * h);
  std::vector<double> residual(x.size());
  solver->solve(x, residual, [](std::span<const double>) { return 0.0; });
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], direction[k], 1e-4) << k;
}

// Between its vertices an edge is a curve, and a contact there presses on the block and not on a chord: gap and displacement are those of
// the polynomial at the point.
TEST_P(StepProblemOrder, ContactsLieOnCurvedEdges) {
  simulation::Simulator s(small_wall(30.0, GetParam()));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double size = 1e-5;
  std::vector<double> d(s.model.coefficients, 0.0);
  for (std::size_t k = 0; k < s.model.unknowns; ++k) {
    s.state.position[k] += size * uniform(random);
    d[k] = uniform(random);
  }
  s.stepper.resume(s.state);  // places the blocks
  StepProblem problem;
  const NextStep next(s);
  const std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
  const CoupledContacts coupled(contacts);
  problem.build(s.model, s.state, next.drive, coupled, s.team);
  const auto field = [&](int b, Vec2 reference, const std::vector<double>& coefficients) {
    const Block& block = s.model.blocks[at(b)];
    std::vector<double> phi(at(block.size));
    block.basis.evaluate(reference, phi.data());
    return field_at(phi.data(), block.size, &coefficients[block.first]);
  };
  const contact::Surface reference = simulation::Simulator(small_wall(30.0, GetParam())).model.surface;
  int between = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const contact::Contact& contact = contacts[c];
    const Vec2 vertex = reference.position[at(contact.vertex)],
               point = lerp(reference.position[at(contact.edge)],
                            reference.position[at(reference.next[at(contact.edge)])], contact.position);
    const Vec2 apart =
        field(contact.block_a, vertex, s.state.position) - field(contact.block_b, point, s.state.position);
    EXPECT_NEAR(contact.gap, dot(contact.normal, apart), 0.02 * size) << c;
    const Vec2 moved = s.model.blocks[at(contact.block_a)].fixed ? Vec2{} : field(contact.block_a, vertex, d);
    const Vec2 r =
        moved - (s.model.blocks[at(contact.block_b)].fixed ? Vec2{} : field(contact.block_b, point, d));
    EXPECT_NEAR(norm(problem.relative(problem.rows()[c], d) - r), 0.0, 1e-3) << c;
    between += contact.position > 0.1 && contact.position < 0.9 && !s.model.blocks[at(contact.block_b)].fixed;
  }
  EXPECT_GT(between, 0);
}

// Eigenvalues of pressed blocks of order 2 are raised eight blocks at once, between blocks of other orders and blocks at rest.
TEST(StepProblem, EveryPressedBlockHasItsOwnTangent) {
  simulation::Scene scene(1e9, 30.0);
  for (int k = 0; k < 40; ++k)
    scene.rectangle({3.0 * k, 0.0}, 1.0, 0.5 + 0.01 * k, 0.0, false, k % 5 == 0 ? 1 + 2 * (k % 2) : 2);
  simulation::Simulator s(scene);
  s.model.solver.rock_damping = 0.0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.7, 1.0);
  for (std::size_t i = 0; i < s.model.blocks.size(); ++i) {
    if (i % 3 == 0) continue;
    const Block& block = s.model.blocks[i];
    for (std::size_t k = 2; k < 2 * at(block.size); ++k) s.state.position[block.first + k] *= uniform(random);
  }
  StepProblem problem;
  const NextStep next(s);
  problem.build(s.model, s.state, next.drive, ContactCoupling(), s.team);
  int raised = 0;
  for (std::size_t i = 0; i < s.model.blocks.size(); ++i) {
    const Block& block = s.model.blocks[i];
    const int n = 2 * block.size, m = block.size - 1;
    const double floor = 0.05 * problem.terms().inertia(i);
    std::vector<double> force(at(n)), tangent(at(n * n), 0.0), geometric(at(m * m));
    block.elasticity.add_force_and_material_tangent(&s.state.position[block.first], 0.0, force.data(),
                                                    tangent.data(), n, geometric.data());
    if (block::may_lie_below(geometric.data(), m, floor)) {
      block::raise_eigenvalues(geometric.data(), m, floor);
      raised += block.size == 6;
    }
    block.elasticity.add_geometric_tangent(geometric.data(), tangent.data(), n);
    std::vector<double> x(s.model.coefficients), y(x.size());
    for (int c = 0; c < n; ++c) {
      x[block.first + at(c)] = 1.0;
      problem.terms().multiply(i, x, y);
      x[block.first + at(c)] = 0.0;
      for (int r = 0; r < n; ++r) {
        const double expected =
            tangent[at(std::min(r, c) * n + std::max(r, c))] + (r == c ? problem.terms().inertia(i) : 0.0);
        EXPECT_NEAR(y[block.first + at(r)], expected, 1e-9 * problem.terms().inertia(i))
            << i << ' ' << r << ' ' << c;
      }
    }
  }
  EXPECT_GT(raised, 16);
  EXPECT_NE(raised % 8, 0);  // the last ones do not come in eights
}

// The open-close iteration keeps its gradient up to date without the matrix; it must stay that of the problem.
TEST_P(StepProblemOrder, IterationKnowsTheGradient) {
  simulation::Simulator s(small_wall(20.0, GetParam()));
  s.run(0.05, 0.005);
  // A blow to the upper block: contacts open and slide.
  s.state.velocity[s.model.blocks[3].first] += 0.5;
  s.state.velocity[s.model.blocks[3].first + 1] += 0.1;
  enum class Solver { full, single, iterative };
  for (const Solver kind : {Solver::full, Solver::single, Solver::iterative}) {
    StepProblem problem;
    const NextStep next(s);
    std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
    const CoupledContacts coupled(contacts);
    problem.build(s.model, s.state, next.drive, coupled, s.team);
    const auto solver = kind == Solver::iterative
                            ? linalg::make_block_conjugate_residual(&s.team)
                            : linalg::make_block_cholesky(kind == Solver::full ? linalg::Precision::full
                                                                               : linalg::Precision::single);
    analyse(s.model, problem, *solver);
    std::vector<double> d(s.model.coefficients, 0.0), g(d.size());
    OpenClose iteration;
    const OpenCloseResult result =
        iteration.solve({problem, {contacts}, *solver, s.model.solver, s.team, s.profile}, d);
    EXPECT_TRUE(result.converged);
    EXPECT_GT(result.iterations, 1);
    gradient_by_rows(problem, d, g);
    EXPECT_LE(problem.terms().residual_ratio(g), s.model.solver.tolerance);
    for (std::size_t b = 0; b < s.model.blocks.size(); ++b) {
      const Block& block = s.model.blocks[b];
      if (block.fixed) continue;
      for (std::size_t k = block.first; k < block.first + 2 * static_cast<std::size_t>(block.size); ++k)
        EXPECT_NEAR(g[k], iteration.gradient()[k], 1e-8 * problem.terms().weight(b)) << k;
    }
  }
}

// Also where systems are of the neighbourhood of some blocks, and leave something over beside it.
TEST(StepProblem, EndsInBalanceWhereContactsBendInOnePlace) {
  simulation::Simulator s(long_wall());
  const double tolerance = s.model.solver.tolerance;
  for (int step = 0; step < 12; ++step) {
    s.run(0.002, 0.002);
    // A blow to one brick after the other.
    const std::size_t struck =
        s.model.blocks[1 + static_cast<std::size_t>(13 * step % (wall_rows * wall_columns))].first;
    s.state.velocity[struck] += 1.0;
    s.state.velocity[struck + 1] += step % 2 == 0 ? 1.0 : -1.0;
    StepProblem problem;
    const NextStep next(s);
    std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
    const CoupledContacts coupled(contacts);
    problem.build(s.model, s.state, next.drive, coupled, s.team);
    const auto solver = linalg::make_block_conjugate_residual(&s.team);
    analyse(s.model, problem, *solver);
    std::vector<double> d(s.model.coefficients, 0.0), g(d.size());
    OpenClose iteration;
    const OpenCloseResult result =
        iteration.solve({problem, {contacts}, *solver, s.model.solver, s.team, s.profile}, d);
    EXPECT_TRUE(result.converged) << step;
    EXPECT_GT(result.iterations, 3) << step;
    gradient_by_rows(problem, d, g);
    EXPECT_LE(problem.terms().residual_ratio(g), tolerance) << step;
  }
}

// A look that is given up when bounds have to be taken anew comes to the same end in the next one; one that has come to its end
// leaves nothing to do.
TEST_P(StepProblemOrder, AnotherLookGoesOnFromTheOneBefore) {
  simulation::Simulator s(small_wall(20.0, GetParam()));
  s.run(0.05, 0.005);
  s.state.velocity[s.model.blocks[3].first] += 0.5;
  s.state.velocity[s.model.blocks[3].first + 1] -= 0.5;
  simulation::settle_bounds(s.model.solver);
  const NextStep next(s);
  EarlierAttempt earlier;
  const auto solve = [&](const std::function<bool()>& gives_up, std::vector<double>& d) {
    std::vector<contact::Contact> contacts = s.stepper.find_contacts(s.state);
    StepProblem problem;
    const CoupledContacts coupled(contacts);
    problem.build(s.model, s.state, next.drive, coupled, s.team);
    earlier.give(contacts, problem.springs());
    const auto solver = linalg::make_block_cholesky();
    analyse(s.model, problem, *solver);
    d.assign(s.model.coefficients, 0.0);
    OpenClose iteration;
    const OpenCloseResult result =
        iteration.solve({problem, {contacts}, *solver, s.model.solver, s.team, s.profile}, d, gives_up);
    earlier.keep(contacts, problem.springs());
    return result;
  };
  std::vector<double> whole, first, second, third;
  const OpenCloseResult at_once = solve({}, whole);
  EXPECT_FALSE(at_once.given_up);
  EXPECT_GT(at_once.bound_updates, 1);
  earlier.forget();
  int asked = 0;
  const OpenCloseResult stopped = solve([&] { return ++asked > 0; }, first);
  EXPECT_TRUE(stopped.given_up);
  EXPECT_EQ(stopped.bound_updates, 1);
  EXPECT_EQ(asked, 1);
  const OpenCloseResult again = solve([&] { return ++asked < 0; }, second);
  EXPECT_FALSE(again.given_up);
  EXPECT_EQ(asked, 2);
  const OpenCloseResult settled = solve({}, third);
  EXPECT_EQ(settled.bound_updates, 0);
  EXPECT_EQ(settled.iterations, 1);
  double largest = 0.0;
  for (const double x : whole) largest = std::max(largest, std::abs(x));
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(second[k], whole[k], 1e-7 * largest) << k;
    EXPECT_NEAR(third[k], whole[k], 1e-7 * largest) << k;
  }
}

// The factorization of this project corrects the springs that change; a library's solver goes from factor to factor. Both find
// the minimum, also where more springs change than are worth correcting.
TEST_P(StepProblemOrder, CorrectionsFindWhatNewtonFinds) {
  for (const double blow : {0.02, 0.5, 5.0}) {
    simulation::Scene scene(1e7, 30.0);
    scene.rectangle({-1.0, -1.0}, 8.0, 1.0, 0.0, true);
    for (int row = 0; row < 4; ++row) {
      for (int k = 0; k < 5; ++k)
        scene.rectangle({k + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false, k == 2 ? GetParam() : 1);
    }
    std::vector<double> found[2];
    long factorizations[2] = {0, 0};
    for (const bool library : {false, true}) {
      simulation::Scene copy = scene;
      copy.setup.solver.linear = library ? LinearSolver::direct : LinearSolver::block;
      simulation::settle_bounds(copy.setup.solver);
      simulation::Simulator s(copy);
      s.run(0.02, 0.005);
      for (const std::size_t b : {std::size_t{3}, std::size_t{8}, std::size_t{12}}) {
        s.state.velocity[s.model.blocks[b].first] += blow;
        s.state.velocity[s.model.blocks[b].first + 1] -= blow;
      }
      s.run(0.015, 0.005);
      found[library ? 1 : 0] = s.state.position;
      factorizations[library ? 1 : 0] = s.profile[Phase::factorization].count;
    }
    double largest = 0.0;
    for (std::size_t k = 0; k < found[0].size(); ++k)
      largest = std::max(largest, std::abs(found[0][k] - found[1][k]));
    EXPECT_LT(largest, 1e-9 * blow) << blow;
    EXPECT_LT(factorizations[0], factorizations[1]) << blow;
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, StepProblemOrder, ::testing::Values(1, 2, 3, 5));

}  // namespace
}  // namespace keyblock::dynamics
