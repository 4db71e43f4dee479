#include "block/order.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using dynamics::LinearSolver;

constexpr Word<dynamics::TimeIntegration> integrators[] = {
    {"shi", dynamics::TimeIntegration::shi},
    {"average-acceleration", dynamics::TimeIntegration::average_acceleration},
    {"generalized-alpha", dynamics::TimeIntegration::generalized_alpha}};
constexpr Word<LinearSolver> linear_solvers[] = {{"automatic", LinearSolver::automatic},
                                                 {"block", LinearSolver::block},
                                                 {"iterative", LinearSolver::iterative},
                                                 {"direct", LinearSolver::direct}};

void read_automatic_order(TableReader& t, simulation::AutomaticOrder& automatic) {
  t.number(
      "stress_accuracy", automatic.stress_accuracy,
      {.meaning =
           "A block gets a higher order while the stress that its terms of highest degree carry is more than "
           "this share of the RMS stress of the rock, and a lower one below a quarter of it.",
       .above = 0.0,
       .below = 1.0});
  t.integer("highest_order", automatic.highest_order,
            {.meaning = "Highest order; contact divides the edges of blocks as for this order.",
             .at_least = 1.0,
             .at_most = block::highest_order});
}

void read_contact_springs(TableReader& t, dynamics::SolverOptions& solver) {
  t.integer("face_contacts", solver.face_contacts,
            {.meaning =
                 "Contacts along a face that blocks share, at the least: 2 are at its ends. Joints of given "
                 "stiffness bend and open alike with any number. Others, between blocks of order 1, have the "
                 "bending stiffness of a joint with 3; blocks of order n have n + 1 in any case.",
             .at_least = 2.0,
             .at_most = 25.0});
  t.number(
      "penalty", solver.penalty,
      {.meaning = "Normal stiffness of joints that give none, as a multiple of Young's modulus of the softer "
                  "block, per metre.",
       .unit = "1/m",
       .above = 0.0});
}

/// How far the open-close iteration goes for a step, and for its friction.
void read_iteration(TableReader& t, dynamics::SolverOptions& solver) {
  t.integer(
      "max_iterations", solver.max_iterations,
      {.meaning =
           "Open-close iterations of a minimization, of which a step has several, before the "
           "step is retried with half its size; five times as many where damping is stiffer than springs.",
       .at_least = 1.0,
       .at_most = 1e6});
  t.integer("max_halvings", solver.max_halvings,
            {.meaning = "How often a step is halved at most.", .at_least = 0.0});
  t.number("bound_tolerance", solver.bound_tolerance,
           {.meaning =
                "Error of the friction bounds (L2 over all contacts, over their norm) beyond which they are "
                "taken anew within a step.",
            .above = 0.0});
  t.number("bound_accuracy", solver.bound_accuracy,
           {.meaning = "The error they are then brought below.", .above = 0.0});
  t.integer("max_bound_updates", solver.max_bound_updates,
            {.meaning = "How often they are taken anew at most.", .at_least = 0.0});
}

void read_solver_keys(TableReader& t, dynamics::SolverOptions& solver, bool without_ground) {
  t.word("integrator", solver.integrator, integrators,
         {.meaning = "Rule of time integration. With [boundary] the default is \"generalized-alpha\"."});
  const auto rule_is = [&](dynamics::TimeIntegration rule) {
    return t.documenting() || solver.integrator == rule;
  };
  t.number(
      "spectral_radius", solver.spectral_radius,
      only(rule_is(dynamics::TimeIntegration::generalized_alpha), "integrator = \"generalized-alpha\"",
           {.meaning =
                "Of the rule at infinite frequency: 1 damps nothing, 0 takes stiff vibration out in a step.",
            .at_least = 0.0,
            .at_most = 1.0}));
  t.number("theta", solver.theta,
           only(rule_is(dynamics::TimeIntegration::shi), "integrator = \"shi\"",
                {.meaning = "Shi's rule, M(1+θ)/Δt²: 1 is Shi's own, 0 backward Euler.",
                 .at_least = 0.0,
                 .at_most = 1.0}));
  t.number("tolerance", solver.tolerance,
           {.meaning = "Largest residual of a block over its weight for a step to count as converged.",
            .above = 0.0,
            .below = 1.0});
  t.number(
      "rock_damping", solver.rock_damping,
      {.meaning = "Damping of the vibration of blocks, as a share of critical at the first elastic frequency "
                  "of each. Rigid motion is not slowed.",
       .at_least = 0.0,
       .usual = &usual::damping});
  t.number("contact_damping", solver.contact_damping,
           {.meaning = "Damping of every contact spring with its two blocks, as a share of critical.",
            .at_least = 0.0,
            .usual = &usual::damping});
  read_damping(t, solver, without_ground);
  solver.keeps_restitution = t.number(
      "restitution", solver.restitution,
      {.meaning = "Share of the speed of approach with which blocks part after an impact, whatever the step "
                  "and the rule of integration. Where the key is not given, blocks part with 0 to 0.5 of it, "
                  "by the moment of the step at which they meet.",
       .at_least = 0.0,
       .at_most = 1.0});
  read_iteration(t, solver);
  read_contact_springs(t, solver);
  t.word("linear", solver.linear, linear_solvers,
         {.meaning = "Solver of the linear systems: `block` factors them in dense blocks, `iterative` takes "
                     "conjugate residuals, "
                     "`automatic` the cheaper of the two, and `direct` the factorization of a library, to "
                     "check them by."});
}

}  // namespace

void read_solver(TableReader& root, Scenario& scenario) {
  root.table("auto_order",
             {.meaning = "How the order of blocks with `order = \"auto\"` is chosen, at every equilibrium of "
                         "stages of kind "
                         "\"settle\"."},
             [&](TableReader& t) { read_automatic_order(t, scenario.automatic); });
  // Waves keep their height by this rule, and stiff joints do not ring.
  if (scenario.boundary) scenario.solver.integrator = dynamics::TimeIntegration::generalized_alpha;
  const bool without_ground = !scenario.boundary || scenario.boundary->sides == record::Sides::frame;
  root.table("solver", {.meaning = "How steps are solved. The defaults suit rock at engineering scale."},
             [&](TableReader& t) { read_solver_keys(t, scenario.solver, without_ground); });
}

}  // namespace keyblock::scenario
