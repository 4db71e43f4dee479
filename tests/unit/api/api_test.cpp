#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "../fresh_folder.h"
#include "keyblock/keyblock.h"

namespace keyblock {
namespace {

constexpr const char* falling = R"(
title = "drop"
rock = { density = 2500.0, young = 1e9, poisson = 0.2 }
joints = { friction = 30.0 }
time = { step = 0.002 }
block = [ { name = "floor", outer = [[0, -1], [2, -1], [2, 0], [0, 0]], fixed = true },
          { name = "stone", outer = [[0.5, 0.1], [1.5, 0.1], [1.5, 1.1], [0.5, 1.1]] } ]
stage = [ { name = "fall", kind = "rest", duration = 0.1 } ]
)";

TEST(Api, ScenariosAreReadSetAndWritten) {
  Scenario scenario = Scenario::parse(falling, "drop.toml");
  scenario.set("rock.young", "2e9");
  scenario.set("stage.fall.duration", "0.05");
  EXPECT_EQ(scenario.json("rock.young"), "2000000000.0");
  EXPECT_EQ(scenario.json("rock.colour"), "");
  EXPECT_EQ(Scenario::parse(scenario.toml()).json(), scenario.json());
  EXPECT_TRUE(scenario.check().empty());
  const std::vector<Block> blocks = scenario.cut();
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[1].name, "stone");
  EXPECT_NEAR(blocks[1].area, 1.0, 1e-12);
  EXPECT_THROW(scenario.set("stage.rise.duration", "1"), InputError);
  scenario.set("rock.young", "soft");
  EXPECT_THROW((void)scenario.check(), InputError);
}

TEST(Api, KeyBlocksAreThoseOfTheScenario) {
  Scenario scenario = Scenario::parse(falling, "drop.toml");
  scenario.set("block.stone.outer", "[[0.5, 0.0], [1.5, 0.0], [1.5, 1.0], [0.5, 1.0]]");
  scenario.set("gravity", "[4.0, -4.0]");  // 45°: steeper than the friction angle
  const Census census = scenario.census(0, 2.0);
  ASSERT_EQ(census.blocks.size(), 1U);
  const KeyBlock& stone = census.blocks.front();
  EXPECT_EQ(stone.name, "stone");
  EXPECT_EQ(stone.mode, "slides");
  EXPECT_EQ(stone.layer, 1);
  EXPECT_EQ(stone.joints, std::vector<std::string>{"[joints]"});
  EXPECT_NEAR(stone.factor_of_safety, 1.0 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(stone.force, 2500.0 * 4.0 * (1.0 - 0.5 / std::sqrt(3.0)), 1e-8);
  EXPECT_NEAR(stone.direction[0], 1.0, 1e-12);
  EXPECT_THROW((void)scenario.census(-1), InputError);
  EXPECT_THROW((void)scenario.census(0, 0.9), InputError);
}

TEST(Api, ListsGrowAndCopiesStayAsTheyWere) {
  Scenario scenario = Scenario::parse(falling, "drop.toml");
  const Scenario before = scenario;
  scenario.append("stage", "{ name = \"one\", kind = \"rest\", duration = 0.1 }");
  scenario.append("stage", "{ name = \"two\", kind = \"rest\", duration = 0.1 }");
  scenario.append("history", "{ name = \"top\", block = \"stone\", point = [1.0, 1.0] }");
  EXPECT_TRUE(scenario.check().empty());
  EXPECT_EQ(scenario.changes().size(), 2U);  // the list of stages, and that of histories
  EXPECT_EQ(scenario.json("stage.two.duration"), "0.1");
  EXPECT_EQ(before.json("stage.one"), "");
  EXPECT_TRUE(before.changes().empty());
  EXPECT_THROW(scenario.append("rock", "{ young = 1 }"), InputError);
  EXPECT_EQ(scenario.changes().size(), 2U);
}

TEST(Api, ScenariosAreMadeFromNothing) {
  Scenario made;
  const Scenario read = Scenario::parse(falling);
  for (const char* key : {"title", "rock", "joints", "time", "block", "stage"}) {
    const std::string json = read.json(key);
    std::string toml = json;  // JSON of these is TOML, except for the colons of tables
    for (std::size_t at = toml.find("\":"); at != std::string::npos; at = toml.find("\":", at))
      toml[at + 1] = '=';
    made.set(key, toml);
  }
  EXPECT_EQ(made.json(), read.json());
  Simulation ours(made), theirs(read);
  while (ours.advance()) {
  }
  while (theirs.advance()) {
  }
  EXPECT_EQ(ours.state_hash(), theirs.state_hash());
}

TEST(Api, SimulationsAreSteppedSteeredAndEnded) {
  Simulation whole(Scenario::parse(falling)), stepped(Scenario::parse(falling));
  while (whole.advance()) {
  }
  int steps = 0;
  stepped.after_step([&] { ++steps; });
  while (stepped.advance()) {
  }
  EXPECT_EQ(steps, 50);
  EXPECT_EQ(stepped.state_hash(), whole.state_hash());
  EXPECT_NEAR(whole.block_velocities()[3], -9.81 * 0.1, 1e-9);
  EXPECT_NEAR(whole.centroids()[3], 0.6 - 0.5 * 9.81 * 0.01, 1e-3);
  EXPECT_EQ(whole.vertices().size(), 16U);
  EXPECT_EQ(whole.stages(), std::vector<std::string>{"fall"});
  EXPECT_DOUBLE_EQ(whole.strength("joints").friction, 30.0);
  EXPECT_THROW((void)whole.strength("J9"), InputError);
  EXPECT_NE(whole.finish().find(whole.state_hash()), std::string::npos);
  EXPECT_EQ(whole.finish(), whole.finish());
}

TEST(Api, WhatACallerThrowsComesBack) {
  const FreshFolder folder;
  RunOptions options;
  options.folder = folder / "out";
  Simulation simulation(Scenario::parse(falling), options);
  simulation.after_step([&] {
    if (simulation.step() == 7) throw std::logic_error("mine");
  });
  EXPECT_THROW(
      {
        while (simulation.advance()) {
        }
      },
      std::logic_error);
  EXPECT_TRUE(simulation.done());
  simulation.finish();
  const Results results(folder / "out");
  EXPECT_EQ(results.blocks(), 2U);
  EXPECT_EQ(results.rings()[1][0][1] - results.rings()[1][0][0], 4);
  EXPECT_GT(results.frames(), 0U);
  EXPECT_NE(results.summary().find("\"interrupted\": true"), std::string::npos);
}

TEST(Api, ValuesGoInAsTheyAre) {
  Scenario by_text = Scenario::parse(falling), by_value = by_text;
  by_text.set("rock.young", "2e9");
  by_value.set("rock.young", 2e9);
  by_text.set("block[1].outer", "[[0.5, 0.2], [1.5, 0.2], [1.5, 1.2], [0.5, 1.2]]");
  const std::vector<double> outer{0.5, 0.2, 1.5, 0.2, 1.5, 1.2, 0.5, 1.2};
  by_value.set("block[1].outer", Value::rows(outer, 2));
  by_text.set("block[0].fixed", "true");
  by_value.set("block[0].fixed", true);
  by_text.append("stage", "{ name = \"more\", kind = \"rest\", duration = 0.1 }");
  by_value.append(
      "stage", Value::Table{{"name", Value::text("more")}, {"kind", Value::text("rest")}, {"duration", 0.1}});
  EXPECT_EQ(by_value.toml(), by_text.toml());
  EXPECT_EQ(by_value.changes(), by_text.changes());
  EXPECT_EQ(std::get<double>(by_value.value("rock.young")->is), 2e9);
  EXPECT_FALSE(by_value.value("rock.colour"));
  EXPECT_EQ(by_value.keys("stage"), (std::vector<std::string>{"fall", "more"}));
  by_value.remove("stage.more");
  EXPECT_EQ(by_value.keys("stage"), std::vector<std::string>{"fall"});
  EXPECT_TRUE(by_value.is_made());
  EXPECT_THROW(by_value.remove("stage.more"), InputError);
  EXPECT_TRUE(by_text.has("stage.more"));
  bool knows_order = false;
  for (const KeyMeaning& key : Scenario::known_keys("rock"))
    knows_order = knows_order || (key.key == "order" && !key.meaning.empty());
  EXPECT_TRUE(knows_order);
}

TEST(Api, UnknownKeysOfAValueAreTold) {
  Scenario::check_keys("rock.young");
  Scenario::check_keys("joint_set.J1.spacing.mean");
  Scenario::check_keys("stage[0].release.'any name'", 0.5);
  Scenario::check_keys("motion",
                       Value::List{Value::Table{{"x", Value::List{Value::rows(std::vector{0.0, 1.0})}}}});
  const Value rock = Value::Table{{"yung", 1e9}, {"density", 2600.0}, {"kn", 1e9}};
  try {
    Scenario::check_keys("rock", rock);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].key, "rock.yung");
    EXPECT_EQ(error.diagnostics()[0].found, "an unknown key");
    EXPECT_EQ(error.diagnostics()[0].hint, "did you mean 'young'?");
    EXPECT_EQ(error.diagnostics()[1].key, "rock.kn");
  }
  for (const char* key : {"rok.young", "rock.yung", "joint_set.J1.spacing.meen", "joint_set[2].dipp"})
    EXPECT_THROW(Scenario::check_keys(key), InputError) << key;
  // What is put in all the same is told by check().
  Scenario scenario = Scenario::parse(falling);
  scenario.set("rock.yung", 1e9);
  EXPECT_THROW(static_cast<void>(scenario.check()), InputError);
}

TEST(Api, ASimulationWithinAStepIsNotSteppedAgain) {
  Simulation run(Scenario::parse(falling));
  run.after_step([&] { run.advance(); });
  EXPECT_THROW(run.advance(), std::logic_error);
  Simulation other(Scenario::parse(falling));
  other.after_step([&] { static_cast<void>(other.finish()); });
  EXPECT_THROW(other.advance(), std::logic_error);
}

TEST(Api, AFolderIsLetGo) {
  const FreshFolder folder;
  RunOptions options;
  options.folder = folder / "out";
  Simulation first(Scenario::parse(falling), options);
  first.advance();
  EXPECT_THROW(Simulation(Scenario::parse(falling), options), InputError);
  first.close();
  EXPECT_EQ(first.step(), 1);
  EXPECT_THROW(first.advance(), std::logic_error);
  Simulation second(Scenario::parse(falling), options);
  while (second.advance()) {
  }
  second.finish();
  Simulation third(Scenario::parse(falling), options);
  while (third.advance()) {
  }
  EXPECT_EQ(third.state_hash(), second.state_hash());
}

TEST(Api, ForcesCarryBlocks) {
  Simulation run(Scenario::parse(falling));
  ASSERT_EQ(run.block_facts()[1].name, "stone");
  EXPECT_DOUBLE_EQ(run.block_facts()[1].density, 2500.0);
  run.set_force(1, {0.0, 2.0 * 2500.0 * 9.81});
  while (run.advance()) {
  }
  EXPECT_NEAR(run.block_velocities()[3], 9.81 * 0.1, 1e-6);
  EXPECT_EQ(run.forces().size(), 1U);
  EXPECT_THROW(run.set_force(0, {0.0, 1.0}), InputError);
  EXPECT_THROW(run.set_force(1, {0.0, 1.0}, std::array<double, 2>{30.0, 0.0}), InputError);
  EXPECT_EQ(run.stress().size(), 6U);
  EXPECT_TRUE(run.springs().empty());
}

TEST(Api, SingleContactsHaveStrengthsOfTheirOwn) {
  Scenario scenario = Scenario::parse(falling);
  scenario.set("block[1].outer", "[[0.5, 0.0], [1.5, 0.0], [1.5, 1.0], [0.5, 1.0]]");
  scenario.set("gravity", "[4.0, -9.81]");
  Simulation held(scenario), freed(scenario);
  held.advance();
  freed.advance();
  const Contacts contacts =
      freed.contacts({ContactColumn::vertex, ContactColumn::edge, ContactColumn::friction});
  ASSERT_EQ(contacts.vertex.size(), freed.contact_count());
  EXPECT_TRUE(contacts.slip.empty());
  EXPECT_NEAR(contacts.friction[0], 30.0, 1e-12);
  std::vector<ContactStrength> strengths;
  for (std::size_t k = 0; k < contacts.vertex.size(); ++k)
    strengths.push_back({contacts.vertex[k], contacts.edge[k], 0.0, {}, {}});
  const double before = freed.block_velocities()[2];
  freed.set_contact_strengths(strengths);
  while (held.advance()) {
  }
  while (freed.advance()) {
  }
  EXPECT_NEAR(held.block_velocities()[2], 0.0, 1e-3);
  EXPECT_NEAR(freed.block_velocities()[2] - before, 4.0 * 0.098, 2e-3);
  EXPECT_EQ(freed.contact_strengths().size(), strengths.size());
  EXPECT_EQ(freed.contact_strengths()[0].friction, 0.0);
  EXPECT_FALSE(freed.contact_strengths()[0].cohesion);
  EXPECT_THROW(freed.set_contact_strengths({{0, 1, 30.0, {}, {}}}), InputError);  // of one block
  EXPECT_THROW(freed.set_contact_strengths({{-1, 5, 30.0, {}, {}}}), InputError);
  EXPECT_THROW(freed.set_contact_strengths({{5, 0, -1.0, {}, {}}}), InputError);
  freed.forget_contact_strengths(strengths);
  EXPECT_TRUE(freed.contact_strengths().empty());
}

TEST(Api, ResultsHaveElements) {
  const FreshFolder folder;
  RunOptions options;
  options.folder = folder / "out";
  Scenario scenario = Scenario::parse(falling);
  scenario.append("spring",
                  "{ name = \"rope\", from = [1.0, -0.5], to = [1.0, 1.0], stiffness = 1e6, yield = 2e4 }");
  scenario.append("history", "{ name = \"cell\", element = \"rope\" }");
  Simulation run(scenario, options);
  while (run.advance()) {
  }
  run.finish();
  const Results results(options.folder);
  ASSERT_EQ(results.elements().size(), 1U);
  const Element rope = results.elements()[0];
  EXPECT_EQ(rope.name, "rope");
  EXPECT_EQ(rope.kind, "spring");
  EXPECT_EQ(rope.limit, 2e4);
  EXPECT_EQ(rope.to[1], 1.0);
  EXPECT_EQ(rope.to_block, 1);
  const Frame last = results.frame(results.frames() - 1);
  ASSERT_EQ(last.elements.size(), 1U);
  EXPECT_LT(last.elements[0].force, 0.0);  // the stone presses it
  EXPECT_TRUE(last.elements[0].present);
  ASSERT_EQ(results.element_histories().size(), 1U);
  const HistoryOfElement cell = results.element_histories()[0];
  EXPECT_EQ(cell.element, 0U);
  EXPECT_EQ(cell.force.size(), results.history_times().size());
  EXPECT_EQ(cell.force.back(), last.elements[0].force);
  EXPECT_TRUE(results.histories().empty());
}

TEST(Api, ResultsHaveContactsHistoriesAndEnergies) {
  const FreshFolder folder;
  RunOptions options;
  options.folder = folder / "out";
  Scenario scenario = Scenario::parse(falling);
  scenario.append("history", "{ name = \"top\", block = \"stone\", point = [1.0, 1.0] }");
  Simulation run(scenario, options);
  while (run.advance()) {
  }
  run.finish();
  const Results results(options.folder);
  ASSERT_EQ(results.histories().size(), 1U);
  EXPECT_EQ(results.histories()[0].velocity.size(), results.history_times().size());
  EXPECT_NEAR(results.histories()[0].velocity.back()[1], -9.81 * 0.1, 0.05);
  EXPECT_NEAR(results.frame(results.frames() - 1).velocity[1][1], -9.81F * 0.1F, 0.05F);
  EXPECT_GT(results.contact_snapshots(), 0U);
  EXPECT_EQ(results.contacts(0).contacts.slip.size(), results.contacts(0).contacts.block_a.size());
  ASSERT_FALSE(results.energies().empty());
  EXPECT_EQ(results.energies().back().energy.front().first, "kinetic");
  EXPECT_FALSE(results.export_to(folder / "csv", "csv").empty());
  EXPECT_THROW(results.export_to(folder / "xls", "xls"), InputError);
}

TEST(Api, StudiesArePlannedRunAndCollected) {
  const FreshFolder folder;
  std::ofstream(folder / "study.toml")
      << falling
      << "[study]\nrealizations = 1\n[[study.vary]]\nkey = \"rock.density\"\nvalues = [2000.0, 3000.0]\n";
  const Scenario scenario = Scenario::load(folder / "study.toml");
  plan_study(scenario, folder / "out");
  EXPECT_EQ(study_state(folder / "out").missing, (std::vector<std::size_t>{0, 1}));
  run_of_study(folder / "out", 1);
  EXPECT_EQ(study_state(folder / "out").missing, std::vector<std::size_t>{0});
  EXPECT_THROW(run_of_study(folder / "out", 2), InputError);
  run_of_study(folder / "out", 0);
  collect_study(folder / "out");
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "runs.csv"));
}

}  // namespace
}  // namespace keyblock
