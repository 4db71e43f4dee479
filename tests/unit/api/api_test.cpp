#include <gtest/gtest.h>

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

TEST(Api, StudiesArePlannedRunAndCollected) {
  const FreshFolder folder;
  std::ofstream(folder / "study.toml")
      << falling
      << "[study]\nrealizations = 1\n[[study.vary]]\nkey = \"rock.density\"\nvalues = [2000.0, 3000.0]\n";
  const Scenario scenario = Scenario::load(folder / "study.toml");
  EXPECT_THROW(plan_study(Scenario::parse(falling), folder / "out"), InputError);
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
