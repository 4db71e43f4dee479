#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/bolts.h"
#include "scenario/build.h"
#include "scenario/closure_bound.h"
#include "scenario/dynamic_checks.h"
#include "scenario/element_histories.h"
#include "scenario/expected_blocks.h"
#include "scenario/far_rock.h"
#include "scenario/ground_facts.h"
#include "scenario/inputs.h"
#include "scenario/joint_table.h"
#include "scenario/joint_warnings.h"
#include "scenario/key_path.h"
#include "scenario/liners.h"
#include "scenario/magnitudes.h"
#include "scenario/motion_places.h"
#include "scenario/own_joints.h"
#include "scenario/polygon_checks.h"
#include "scenario/properties.h"
#include "scenario/sections.h"
#include "scenario/shaking_checks.h"
#include "scenario/size_checks.h"
#include "scenario/stage_steps.h"
#include "scenario/water_checks.h"
#include "simulation/build_boundary.h"
#include "simulation/damping_table.h"
#include "simulation/feasibility.h"
#include "simulation/history_block.h"
#include "simulation/spring_blocks.h"

namespace keyblock::scenario {
namespace {

using simulation::BlockProperties;
using simulation::RunSetup;

[[noreturn]] void fail(const Scenario& scenario, const std::string& key, std::string found,
                       std::string expected) {
  throw InputError(Diagnostic{scenario.where(key), key, std::move(found), std::move(expected), ""});
}

std::optional<block::InSituStress> in_situ_stress(const Scenario& scenario, double top) {
  if (!scenario.in_situ) return std::nullopt;
  const InSituSpec& spec = *scenario.in_situ;
  block::InSituStress stress;
  if (!spec.depth) {
    stress.sxx = spec.sxx;
    stress.syy = spec.syy;
    stress.sxy = spec.sxy;
    return stress;
  }
  const double weight = -*scenario.rock.density * scenario.gravity.y;  // N/m³, downwards
  stress.syy = -weight * *spec.depth;
  stress.syy_gradient = weight;
  stress.sxx = *spec.k0 * stress.syy;
  stress.sxx_gradient = *spec.k0 * weight;
  stress.reference_y = top;
  return stress;
}

// What acts at points is moved into local coordinates.
void place_loading(const Scenario& scenario, const BlockModel& blocks, RunSetup& setup) {
  const Vec2 origin = setup.system.origin;
  setup.loads = scenario.loads;
  for (loading::Load& load : setup.loads) {
    load.from -= origin;
    load.to -= origin;
    load.value = scenario.load_factor * load.value;
    load.value_end = scenario.load_factor * load.value_end;
    if (load.value_middle) load.value_middle = scenario.load_factor * *load.value_middle;
  }
  setup.supports = scenario.supports;
  for (loading::Support& support : setup.supports) {
    for (Vec2& p : support.points) p -= origin;
  }
  setup.waters = waters_of(scenario, origin);
  setup.springs = scenario.springs;
  for (loading::Spring& spring : setup.springs) {
    spring.from -= origin;
    spring.to -= origin;
  }
  setup.bolts = bolts_of(scenario, blocks.outlines);
  for (loading::Bolt& bolt : setup.bolts) {
    bolt.head -= origin;
    bolt.toe -= origin;
  }
  setup.liners = liners_of(scenario, blocks.outlines);
  for (loading::Liner& liner : setup.liners) {
    for (Vec2& p : liner.wall) p -= origin;
  }
  // What a stage installs that is left out never comes to life, and what is absent neither.
  for (const auto* stages : {&scenario.stages, &scenario.left_out})
    for (const record::Stage& stage : *stages)
      setup.staged_supports.insert(setup.staged_supports.end(), stage.install.begin(), stage.install.end());
  setup.staged_supports.insert(setup.staged_supports.end(), scenario.absent.begin(), scenario.absent.end());
  const auto staged = [&](const std::string& name) {
    const auto place = std::ranges::find(setup.staged_supports, name);
    return place == setup.staged_supports.end() ? -1
                                                : static_cast<int>(place - setup.staged_supports.begin());
  };
  for (loading::Spring& spring : setup.springs) spring.staged = staged(spring.name);
  for (loading::Bolt& bolt : setup.bolts) bolt.staged = staged(bolt.list);
  for (loading::Liner& liner : setup.liners) liner.staged = staged(liner.name);
}

/// Rock far away goes from the base to the ground beside its side.
void check_column(const Scenario& scenario, const RunSetup& setup, const simulation::History& history) {
  const simulation::ColumnHeights rock = simulation::column_heights(setup, *history.column);
  if (history.point.y >= rock.base && history.point.y <= rock.ground) return;
  const double origin = setup.system.origin.y;
  fail(scenario, join_path(join_path("history", history.name), "y"),
       fmt::format("{}, outside", history.point.y + origin),
       fmt::format("a height from the base to the ground there, {:.6g} to {:.6g}", rock.base + origin,
                   rock.ground + origin));
}

void place_histories(const Scenario& scenario, RunSetup& setup, std::vector<std::string>& notes) {
  for (const simulation::History& given : scenario.histories) {
    const std::string key = join_path(join_path("history", given.name), "point");
    simulation::History history = given;
    history.point -= setup.system.origin;
    if (!history.element.empty()) {
      setup.histories.push_back(std::move(history));
      continue;
    }
    if (history.column) {
      check_column(scenario, setup, history);
      setup.histories.push_back(std::move(history));
      continue;
    }
    const auto block = simulation::history_block(setup, history);
    if (!block) {
      fail(
          scenario, key, fmt::format("[{}, {}], outside", given.point.x, given.point.y),
          given.block.empty() ? "a point of a block" : fmt::format("a point of the block '{}'", given.block));
    }
    if (const auto stage = simulation::excavating_stage(setup, *block)) {
      notes.push_back(fmt::format("{}: lies in rock that the stage '{}' excavates; the history ends there",
                                  key, setup.stages[*stage].name));
    }
    setup.histories.push_back(std::move(history));
  }
}

/// The stage that installs a support, by index; empty: none.
std::optional<std::size_t> installing_stage(const RunSetup& setup, const std::string& name) {
  for (std::size_t s = 0; s < setup.stages.size(); ++s) {
    if (std::ranges::find(setup.stages[s].install, name) != setup.stages[s].install.end()) return s;
  }
  return std::nullopt;
}

/// A spring ends where a stage excavates a block of it. It does not begin where an earlier one has, or the same.
void check_spring_block(const Scenario& scenario, const RunSetup& setup, const std::string& path,
                        const loading::Spring& spring, std::size_t block, std::vector<std::string>& notes) {
  const auto excavated = simulation::excavating_stage(setup, block);
  if (!excavated) return;
  const std::string& by = setup.stages[*excavated].name;
  const auto installed = installing_stage(setup, spring.name);
  if (installed && *excavated <= *installed) {
    fail(scenario, join_path(join_path("stage", setup.stages[*installed].name), "install"),
         fmt::format("\"{}\", an end of which lies in rock that the stage '{}' excavates", spring.name, by),
         "a support between blocks that are there");
  }
  notes.push_back(
      fmt::format("{}: an end lies in rock that the stage '{}' excavates; the spring ends there", path, by));
}

// Ends of springs, which only the cut blocks tell, show at their keys.
void check_springs(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& notes) {
  for (std::size_t k = 0; k < setup.springs.size(); ++k) {
    const loading::Spring& spring = setup.springs[k];
    const std::string path = spring.name.empty() ? join_index("spring", k) : join_path("spring", spring.name);
    std::optional<simulation::SpringBlocks> blocks;
    try {
      blocks = simulation::spring_blocks(setup, k);
    } catch (const InputError& error) {
      const Diagnostic& mistake = error.diagnostics().front();
      fail(scenario, path + mistake.key.substr(mistake.key.rfind('.')), mistake.found, mistake.expected);
    }
    for (const std::size_t block : {blocks->from, blocks->to})
      check_spring_block(scenario, setup, path, spring, block, notes);
  }
}

void check_size(const Scenario& scenario, const std::vector<BlockProperties>& properties) {
  double unknowns = 0.0;
  for (const BlockProperties& block : properties) {
    const double order = block.automatic_order ? scenario.automatic.highest_order : block.order;
    unknowns += (order + 1.0) * (order + 2.0);
  }
  if (unknowns > most_unknowns) {
    fail(scenario, "rock.order", fmt::format("{:.2g} unknowns in {} blocks", unknowns, properties.size()),
         fmt::format("at most {:.0e} unknowns", most_unknowns));
  }
}

/// The blocks, what they are made of, and the openings.
void place_rock(const Scenario& scenario, const BlockModel& blocks, RunSetup& setup) {
  setup.system = blocks.system;
  const Vec2 origin = setup.system.origin;
  setup.properties = properties_of(scenario, setup.system);
  check_size(scenario, setup.properties);
  if (scenario.domain) {
    const Domain& domain = *scenario.domain;
    setup.frame = domain.frame;
    setup.has_domain = true;
    setup.domain = {Vec2{domain.x.first, domain.y.first} - origin,
                    Vec2{domain.x.second, domain.y.second} - origin};
  }
  setup.joints = joint_table(scenario, blocks);
  setup.joint_set_names = names_of(own_joint_sets(scenario));
  setup.trace_map_names = names_of(own_trace_maps(scenario));
  for (std::size_t k = 0; k < scenario.excavations.size(); ++k) {
    Ring outline = blocks.outlines[k];
    for (Vec2& p : outline) p -= origin;
    const ExcavationSpec& spec = scenario.excavations[k];
    setup.excavations.push_back(
        {spec.name, std::move(outline), pressure_of(scenario, spec), spec.filled.value_or(false)});
  }
}

void warn_of_capped(const RunSetup& setup, std::vector<std::string>& notes) {
  for (const record::DrawnStrength& drawn : setup.joints.drawn) {
    if (drawn.capped > 0)
      notes.push_back(
          fmt::format("{} of “{}”: {} of {} traces have more left than their peak; they keep the peak",
                      drawn.key, drawn.joint, drawn.capped, drawn.traces));
  }
}

/// What waves, and blocks that swing against the ground, lose by the rock and by the rule of time integration together.
void add_damping_facts(RunSetup& setup) {
  const std::vector<record::DampingRow> rows = simulation::damping_table(setup);
  if (rows.empty()) return;
  std::string frequencies, of_waves, of_blocks;
  for (const record::DampingRow& row : rows) {
    const char* between = frequencies.empty() ? "" : ", ";
    frequencies += fmt::format("{}{:g}", between, row.frequency);
    of_waves += fmt::format("{}{:.2g}", between, 100.0 * row.waves());
    of_blocks += fmt::format("{}{:.2g}", between, 100.0 * row.total());
  }
  setup.ground.emplace_back(fmt::format("damping of waves at {} Hz, with that of the rule", frequencies),
                            of_waves + " %");
  if (of_blocks != of_waves)
    setup.ground.emplace_back("damping of blocks against the ground, likewise", of_blocks + " %");
}

/// What a frame leaves out of a recorded earthquake.
void add_box_fact(RunSetup& setup) {
  const double stress = stress_left_out(setup);
  for (auto& [name, value] : setup.ground) {
    if (name == around_the_model && stress > 0.0)
      value = fmt::format("closed box: wave stress of {:.2g} MPa left out", stress / 1e6);
  }
}

/// Rules that damp stiff vibration too little make energy in contacts: guide, "Which rule of time integration".
void warn_of_made_energy(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& notes) {
  constexpr double most_radius = 0.1;
  const auto rule = scenario.solver.integrator;
  const bool average = rule == dynamics::TimeIntegration::average_acceleration,
             alpha = rule == dynamics::TimeIntegration::generalized_alpha &&
                     scenario.solver.spectral_radius > most_radius;
  const bool has_contacts = setup.properties.size() > 1;
  const bool moves = std::ranges::any_of(
      scenario.stages, [](const record::Stage& stage) { return stage.kind != record::StageKind::settle; });
  if (!(average || alpha) || !has_contacts || !moves) return;
  notes.push_back(fmt::format(
      "solver.{}: makes energy wherever joints slide, open or close; \"shi\" and \"generalized-alpha\" "
      "with spectral_radius = 0 do not",
      average
          ? fmt::format("integrator{} = \"average-acceleration\"", place_text(scenario, "solver.integrator"))
          : fmt::format("spectral_radius = {}{}", scenario.solver.spectral_radius,
                        place_text(scenario, "solver.spectral_radius"))));
}

/// What the setup as a whole shows.
void add_setup_warnings(const Scenario& scenario, RunSetup& setup, std::vector<std::string>& notes) {
  add_shaking_warnings(scenario, setup.motions, notes);
  add_boundary_warnings(scenario, setup, notes);
  warn_of_capped(setup, notes);
  warn_of_made_energy(scenario, setup, notes);
  add_dynamic_warnings(scenario, setup, notes);
  add_size_warnings(scenario, setup, notes);
  if (const simulation::JointClosure soft = simulation::largest_closure(setup);
      soft.share() > simulation::soft_joint_closure && soft.share() <= simulation::most_joint_closure) {
    notes.push_back(fmt::format(
        "joints of normal_stiffness = {:.4g} Pa/m are soft: weight or stress of {:.3g} Pa closes "
        "them by {:.2g} m, {:.2g} % of the block size; blocks that still sink may be called falling",
        soft.stiffness, soft.stress, soft.closure, 100.0 * soft.share()));
  }
  if (const auto reason = closure_is_lower_bound(scenario, setup)) {
    setup.closure_is_lower_bound = true;
    if (!scenario.accepted.order_1)
      notes.push_back(
          fmt::format("rock.order{}: {}; the closure of the opening and the stress at its wall come out "
                      "too small; order = \"auto\" or 2 lets blocks bend",
                      place_text(scenario, "rock.order"), *reason));
  }
}

}  // namespace

RunSetup build_setup(const Scenario& scenario, int realization, const BlockModel& blocks,
                     std::vector<std::string>* warnings) {
  std::vector<std::string> notes = plausibility_warnings(scenario);
  if (scenario.stages.empty()) fail(scenario, "stage", "nothing", "at least one [[stage]]");
  RunSetup setup;
  setup.title = scenario.title;
  setup.seed = scenario.seed;
  setup.realization = realization;
  setup.scenario = scenario.text;

  place_rock(scenario, blocks, setup);
  setup.stages = scenario.stages;
  setup.solver = scenario.solver;
  setup.boundary = boundary_of(scenario);
  setup.gravity = scenario.gravity;
  setup.in_situ = in_situ_stress(scenario, simulation::boundary_box(setup).max.y);
  setup.time_step = scenario.time_step;
  setup.motions = read_motions(scenario, notes, realization);
  const std::vector<GroundFact> earthquakes = earthquake_facts(scenario, setup.motions);
  const std::vector<simulation::JointPiece> pieces = place_far_rock(scenario, setup);
  take_to_base(scenario, setup);
  place_far_planes(scenario, setup, pieces, notes);
  setup.files = input_files(scenario);
  for (const GroundFact& fact : ground_facts(scenario)) setup.ground.emplace_back(fact.name, fact.value);
  for (const GroundFact& fact : earthquakes) setup.ground.emplace_back(fact.name, fact.value);
  if (std::string joints = joints_in_model(scenario, setup.system); !joints.empty())
    setup.ground.emplace_back("joints in the model, of their length", std::move(joints));
  for (auto& fact : strength_facts(setup.joints)) setup.ground.push_back(std::move(fact));
  for (auto& fact : boundary_facts(setup)) setup.ground.push_back(std::move(fact));
  place_loading(scenario, blocks, setup);
  place_histories(scenario, setup, notes);
  check_springs(scenario, setup, notes);
  check_bolts(scenario, setup, notes);
  check_liners(scenario, setup, notes);
  if (auto mistakes = stage_mistakes(scenario, setup.motions); !mistakes.empty())
    throw InputError(std::move(mistakes));
  if (auto mistakes = dynamic_mistakes(scenario, setup); !mistakes.empty())
    throw InputError(std::move(mistakes));
  add_stage_warnings(scenario, notes);
  setup.damage = scenario.damage;
  setup.output = scenario.output;
  setup.automatic_order = scenario.automatic;
  add_damping_facts(setup);
  add_box_fact(setup);
  add_block_warnings(scenario, blocks, notes);
  add_setup_warnings(scenario, setup, notes);
  check_element_histories(scenario, setup);
  if (warnings != nullptr) {
    add_overlap_warnings(scenario, setup.system, notes);
    warnings->insert(warnings->end(), notes.begin(), notes.end());
  }
  setup.warnings = std::move(notes);
  return setup;
}

RunSetup build_setup(const Scenario& scenario, int realization, std::vector<std::string>* warnings) {
  return build_setup(scenario, realization, build_blocks(scenario, realization), warnings);
}

}  // namespace keyblock::scenario
