#include "study/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "../fresh_folder.h"
#include "core/error.h"
#include "study/folder.h"
#include "study/plan_json.h"
#include "study/run_json.h"

namespace keyblock::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path gallery_file = std::filesystem::path(KEYBLOCK_TEST_DATA) / "study/gallery.toml";

Plan plan_of(const std::vector<std::string>& overrides = {}) {
  return make_plan(gallery_file, overrides, "1.2.3");
}

std::vector<std::string> keys_of(const Plan& plan) {
  std::vector<std::string> keys;
  for (const PlannedRun& run : plan.runs) keys.push_back(run.key);
  return keys;
}

TEST(RunKey, IsStable) {
  // These name folders of studies that exist: they never change.
  EXPECT_EQ(run_key(7, {}, ""), "r0007-af63a24c86");
  EXPECT_EQ(run_key(0, {"stage.shaken.scale=0.5"}, ""), "r0000-ac609476ab");
  EXPECT_EQ(run_key(12345, {}, "").substr(0, 7), "r12345-");
}

TEST(RunKey, DependsOnWhatVariesAlone) {
  const std::string key = run_key(1, {"rock.order=2", "stage.'a b'.scale=0.5"}, "");
  EXPECT_EQ(run_key(1, {"stage.\"a b\".scale=0.5", "rock.order=2"}, ""), key);
  EXPECT_EQ(run_key(1, {"stage.'a b'.scale = 0.50", "rock.order =2"}, ""), key);
  EXPECT_EQ(run_key(1, {"stage.'a b'.scale=5e-1", "rock.order=2.0"}, ""), key);
  EXPECT_EQ(run_key(0, {"joint_set.J1.gap={mean=1, std=2.0}"}, ""),
            run_key(0, {"joint_set.J1.gap={std=2, mean=1.0}"}, ""));
  EXPECT_EQ(run_key(0, {"block.top.velocity=[0, 1]"}, ""),
            run_key(0, {"block.top.velocity=[-0.0, 1.0]"}, ""));
  EXPECT_NE(run_key(0, {"seed=9007199254740993"}, ""), run_key(0, {"seed=9007199254740992"}, ""));
  EXPECT_NE(run_key(1, {"stage.'a b'.scale=0.6", "rock.order=2"}, ""), key);
  EXPECT_NE(run_key(1, {"rock.order=2"}, ""), key);
  EXPECT_NE(run_key(1, {"rock.order=2", "stage.'a b'.scale=0.5"}, "released"), key);
}

TEST(Plan, RunsByRealizationThenCombination) {
  const Plan plan = plan_of({"study.realizations=2"});
  ASSERT_EQ(plan.runs.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(plan.runs[k].realization, static_cast<int>(k / 2));
    EXPECT_EQ(plan.runs[k].values[0][0], k % 2 == 0 ? "0.5" : "1.0");
  }
  EXPECT_EQ(plan.stage, "after");
  EXPECT_EQ(plan.seed, 7U);
  EXPECT_THAT(overrides_of(plan, plan.runs[1]), ElementsAre("stage.shaken.scale=1.0"));
}

TEST(Plan, TheFirstPartIsASmallerStudy) {
  const auto few = keys_of(plan_of({"study.realizations=2"}));
  const auto many = keys_of(plan_of({"study.realizations=5"}));
  ASSERT_EQ(many.size(), 10U);
  EXPECT_EQ(std::vector(many.begin(), many.begin() + 4), few);
  EXPECT_EQ(std::set(many.begin(), many.end()).size(), many.size());
}

TEST(Plan, StudyIsNoPartOfItsIdentity) {
  const Plan plan = plan_of();
  EXPECT_EQ(plan_of({"study.realizations=9", "study.keep=all", "study.marginal={}"}).input, plan.input);
  EXPECT_NE(plan_of({"rock.young=1e9"}).input, plan.input);
  EXPECT_NE(plan_of({"seed=8"}).input, plan.input);
}

TEST(Plan, KeepsPlaces) {
  const Plan before = plan_of();
  Plan after = plan_of({"study.realizations=4", "study.vary[0].values=[2.0, 1.0]"});
  keep_places(before.runs, after);
  // Three realizations of 0.5, no longer wanted; three of 1.0 in their places; four of 2.0 and one of 1.0 are new.
  ASSERT_EQ(after.runs.size(), 6U + 5U);
  EXPECT_EQ(after.wanted(), 8U);
  for (std::size_t k = 0; k < before.runs.size(); ++k) {
    EXPECT_EQ(after.runs[k].key, before.runs[k].key);
    EXPECT_EQ(after.runs[k].wanted, before.runs[k].values[0][0] == "1.0");
  }
}

// Without a word of the user, what gravity alone brought down is not counted as brought down by the shaking.
TEST(Plan, MeasuresBeginBeforeTheShaking) {
  EXPECT_EQ(plan_of().since, "excavated");
  EXPECT_EQ(plan_of({"study.since=start"}).since, "");
  EXPECT_EQ(plan_of({"study.since=start"}).before_shaking, "excavated");
  EXPECT_EQ(plan_of({"study.since='in situ'"}).since, "in situ");
  // Nothing to begin after: the measured stage is before the shaking, or there is no shaking.
  EXPECT_EQ(plan_of({"study.stage=excavated"}).since, "");
  EXPECT_EQ(plan_of({"study.stage=excavated"}).before_shaking, "");
  const Plan still = plan_of({"stage.shaken={name='shaken', kind='rest', duration=0.1}", "study.vary=[]"});
  EXPECT_EQ(still.since, "");
}

TEST(Plan, AStageThatIsNamedLikeTheWordForTheStart) {
  const auto since = [](const std::string& name) {
    return plan_of({"stage.'in situ'.name='start'", "study.since='" + name + "'"}).since;
  };
  EXPECT_EQ(since("excavated"), "excavated");
  try {
    since("start");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"start\", which is the name of a [[stage]] as well"));
  }
  try {
    plan_of({"study.since=nowhere"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"start\" or the name of a [[stage]]: \"in situ\""));
  }
}

TEST(Plan, MeasuresBeginBeforeTheyEnd) {
  EXPECT_EQ(plan_of({"study.since=excavated"}).since, "excavated");
  EXPECT_THROW(plan_of({"study.since=after"}), InputError);
  EXPECT_THROW(plan_of({"study.since=after", "study.stage=shaken"}), InputError);
  EXPECT_THROW(plan_of({"study.since=nowhere"}), InputError);
}

TEST(Plan, KnowsTheGroundOfAllCombinations) {
  const auto value = [](const Plan& plan, const std::string& name) -> std::string {
    for (const scenario::GroundFact& fact : plan.ground)
      if (fact.name == name) return fact.value;
    return "none";
  };
  EXPECT_EQ(value(plan_of(), "joints: friction φ"), "30°");
  const Plan varied = plan_of({"study.vary[0]={key='joints.friction', values=[20, 30.5]}"});
  EXPECT_EQ(value(varied, "joints: friction φ"), "20° · 30.5°");
  EXPECT_EQ(value(varied, "Young's modulus E"), "2 GPa");
}

TEST(Plan, TooManyRuns) {
  EXPECT_THROW(plan_of({"study.realizations=2000000"}), InputError);
}

TEST(Plan, VariantsMultiplyTheRuns) {
  const Plan plan = plan_of({"study.marginal={}", "study.since=start"});
  ASSERT_EQ(plan.runs.size(), 3U * 2U * 4U);
  EXPECT_EQ(plan.runs[3].variant, "released");
  EXPECT_EQ(keys_of(plan)[0], keys_of(plan_of())[0]);  // the run itself is the same
  EXPECT_NE(keys_of(plan)[1], keys_of(plan_of({"study.marginal.friction=5"}))[1]);
  EXPECT_EQ(keys_of(plan)[3], keys_of(plan_of({"study.marginal.friction=5", "study.since=start"}))[3]);
}

// An immediate release leaves out the stage at whose end measures begin.
// Scales of the shaking share one control run; other rock and other records have their own.
TEST(Plan, EachRockMassHasOneControlRun) {
  const Plan plan = plan_of({"study.control=true", "study.realizations=2"});
  ASSERT_EQ(plan.runs.size(), 6U);
  for (std::size_t r = 0; r < 2; ++r) {
    const PlannedRun& control = plan.runs[3 * r];
    EXPECT_EQ(control.variant, "unshaken");
    EXPECT_THAT(overrides_of(plan, control), ElementsAre("stage.shaken.scale=0"));
    for (const std::size_t k : {3 * r + 1, 3 * r + 2}) {
      EXPECT_EQ(plan.runs[k].control, control.key);
      EXPECT_EQ(control_places(plan)[k], static_cast<std::ptrdiff_t>(3 * r));
    }
    EXPECT_EQ(control_places(plan)[3 * r], -1);
  }
  const Plan orders = plan_of(
      {"study.control=true", "study.realizations=1",
       "study.vary=[{key='stage.shaken.scale', values=[0.5, 1.0]}, {key='rock.order', values=[1, 2]}]"});
  EXPECT_EQ(orders.runs.size(), 6U);
  EXPECT_EQ(std::ranges::count(orders.runs, "unshaken", &PlannedRun::variant), 2);
  // Its key hangs on no other scale, so that a study with more of them goes on with it.
  const Plan more =
      plan_of({"study.control=true", "study.realizations=1", "study.vary[0].values=[0.1, 1.0]"});
  EXPECT_EQ(more.runs[0].key, plan.runs[0].key);
}

// Two of eight values each, in rotation: 01 12 23 34 45 56 67 70, then with another distance.
TEST(Plan, RealizationsTakeValuesInRotation) {
  const std::vector<std::string> asked{"study.realizations=10", "study.control=true",
                                       "study.vary=[{key='stage.shaken.scale', values=[0.0, 0.1, 0.2, 0.3, "
                                       "0.4, 0.5, 0.6, 0.7], per_realization=2}]"};
  const Plan plan = plan_of(asked);
  std::vector<std::string> taken(10);
  for (const PlannedRun& run : plan.runs)
    if (run.variant.empty()) taken[static_cast<std::size_t>(run.realization)] += run.values[0][0].substr(2);
  EXPECT_THAT(taken, ElementsAre("01", "12", "23", "34", "45", "56", "67", "07", "02", "13"));
  EXPECT_EQ(plan.runs.size(), 30U);
  std::vector<std::string> fewer = asked;
  fewer[0] = "study.realizations=4";
  const auto few = keys_of(plan_of(fewer)), many = keys_of(plan);
  EXPECT_EQ(std::vector(many.begin(), many.begin() + static_cast<std::ptrdiff_t>(few.size())), few);
  EXPECT_THROW(plan_of({"study.vary=[{key='stage.shaken.scale', values=[1.0, 2.0], per_realization=3}]"}),
               InputError);
}

TEST(Plan, RefusesControlRunsThatTellNothing) {
  EXPECT_THROW(plan_of({"study.control=true", "study.since='start'"}), InputError);
  EXPECT_THROW(plan_of({"study.control=true", "study.since='shaken'"}), InputError);
}

TEST(Plan, SaysThatThereIsNoRelease) {
  std::vector<std::string> warnings;
  const Plan plan = make_plan(gallery_file, {"study.marginal={}"}, "1.2.3", &warnings);
  EXPECT_EQ(plan.runs.size(), 3U * 2U * 3U);
  const char* const no_release = "no variant \"released\", as it leaves out the stage \"excavated\"";
  EXPECT_THAT(warnings, ::testing::Contains(HasSubstr(no_release)));
  make_plan(gallery_file, {"study.marginal={}", "study.since=start"}, "1.2.3", &warnings);
  EXPECT_THAT(warnings, ::testing::Not(::testing::Contains(HasSubstr("no variant"))));
}

TEST(Plan, IsReadAsItWasWritten) {
  const FreshFolder folder;
  Plan plan =
      plan_of({"study.marginal={friction=2.5}", "study.map.cell=0.3",
               "study.level=[{name='any', measure='fallen_blocks', threshold=0}]", "study.confidence=0.9"});
  plan.runs[2].wanted = false;
  plan.until = scenario::UntilSpec{"slip_max_m", 0.1, std::nullopt, 4, 50};
  plan.files = {{"motions/a.smc", "0123"}};
  std::ofstream(plan_path(folder)) << plan_json(plan, folder);
  std::ofstream(scenario_path(folder)) << plan.text;
  const Plan read = read_plan(folder);
  EXPECT_EQ(plan_json(read, folder), plan_json(plan, folder));
  EXPECT_EQ(read.text, plan.text);
  EXPECT_EQ(read.runs[2].wanted, false);
  EXPECT_EQ(read.scenario, plan.scenario.lexically_normal());
  ASSERT_TRUE(read.until && read.until->half_width && !read.until->width);
  EXPECT_EQ(read.levels[0].measure, "fallen_blocks");
  EXPECT_EQ(read.grid.cell, 0.3);
}

TEST(EnterPlan, NamesWhatDiffers) {
  const FreshFolder folder;
  Plan plan = plan_of();
  enter_plan(folder, plan, false);
  Plan other = plan_of({"rock.young=1e9", "stage.after.duration=3"});
  try {
    enter_plan(folder, other, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rock.young: 2000000000.0 there, 1000000000.0 here"));
    EXPECT_THAT(error.what(), HasSubstr("stage[3].duration: 0.2 there, 3 here"));
  }
  other = make_plan(gallery_file, {}, "9.9.9");
  EXPECT_THROW(enter_plan(folder, other, true), InputError);
  EXPECT_THROW(enter_plan(folder, plan, false), InputError);
  EXPECT_NO_THROW(enter_plan(folder, plan, true));
}

/// Leaves what a run leaves that is done.
void write_run(const std::filesystem::path& directory, const Plan& plan, const PlannedRun& run) {
  std::filesystem::create_directories(run_folder(directory, run.key));
  std::ofstream(run_folder(directory, run.key) / "run.json") << run_json(empty_result(run), run_input(plan));
}

// The same runs with the axes, and the keys of one that joins several, in another order.
TEST(ReadRunState, TakesItsPlaceFromThePlan) {
  const FreshFolder folder;
  const auto plan_with = [](const std::string& axes) {
    return plan_of({"study.realizations=1", "study.vary=" + axes});
  };
  const std::string scale = "{key='stage.shaken.scale', values=[1, 2]}",
                    order = "{key='rock.order', values=[2, 1]}";
  Plan plan = plan_with("[" + scale + ", " + order + "]");
  enter_plan(folder, plan, false);
  for (const PlannedRun& run : plan.runs) write_run(folder, plan, run);
  const std::vector<std::pair<std::string, std::vector<std::string>>> later{
      {"[" + order + ", " + scale + "]", {"2/1", "2/2", "1/1", "1/2"}},
      {"[{keys=['rock.order', 'stage.shaken.scale'], values=[[1, 1], [2, 1], [1, 2], [2, 2]]}]",
       {"1, 1", "2, 1", "1, 2", "2, 2"}}};
  for (const auto& [axes, expected] : later) {
    Plan next = plan_with(axes);
    const std::vector<PlannedRun> runs = next.runs;
    enter_plan(folder, next, true);
    ASSERT_EQ(next.runs.size(), plan.runs.size());
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const RunState state = read_run_state(folder, next, runs[k]);
      ASSERT_EQ(state.kind, RunState::Kind::done) << state.problem;
      std::string values;
      for (const std::string& value : state.result.values) values += (values.empty() ? "" : "/") + value;
      EXPECT_EQ(values, expected[k]);
    }
  }
}

// Runs of a value that was dropped are used when it comes back: with the file as it was.
TEST(EnterPlan, RemembersFilesOfEarlierPlans) {
  const FreshFolder folder;
  Plan plan = plan_of();
  plan.files = {{"a.smc", "0123"}, {"b.smc", "4567"}};
  enter_plan(folder, plan, false);
  Plan fewer = plan_of();
  fewer.files = {{"a.smc", "0123"}};
  enter_plan(folder, fewer, true);
  EXPECT_EQ(read_plan(folder).files.size(), 2U);
  Plan again = plan_of();
  again.files = {{"a.smc", "0123"}, {"b.smc", "89ab"}};
  try {
    enter_plan(folder, again, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the content of b.smc"));
  }
}

TEST(EnterPlan, MapsOfOtherCellsAreRefusedOnceRunsAreDone) {
  const FreshFolder folder;
  Plan plan = plan_of();
  enter_plan(folder, plan, false);
  Plan finer = plan_of({"study.map.cell=0.1"});
  EXPECT_NO_THROW(enter_plan(folder, finer, true));
  write_run(folder, finer, finer.runs[1]);
  plan = plan_of();
  try {
    enter_plan(folder, plan, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("study.map.cell: 0.1 there, 0.05 here"));
  }
  EXPECT_EQ(read_plan(folder).grid.cell, 0.1);
}

TEST(ReadPlan, RefusesACopyThatWasEdited) {
  const FreshFolder folder;
  Plan plan = plan_of({"rock.poisson=0.25"});
  enter_plan(folder, plan, false);
  const std::string text = plan.text;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string edited = text;
    edited.replace(edited.find(from), from.size(), to);
    std::ofstream(scenario_path(folder)) << edited;
  };
  with("density = 2500.0", "density = 2600.0");
  try {
    read_plan(folder);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("study.toml: found a scenario other than that of plan.json"));
  }
  with("realizations = 3", "realizations = 4  # without effect");
  EXPECT_NO_THROW(read_plan(folder));
}

TEST(FileLock, IsHeldOnce) {
  const FreshFolder folder;
  const auto lock = lock_study(folder);
  EXPECT_TRUE(lock->held());
  try {
    lock_study(folder);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(::getpid()) + " on "));
  }
}

TEST(DamageLevels, AreSharesOfTheOpenings) {
  const Plan plan = plan_of();
  ASSERT_EQ(plan.levels.size(), 3U);
  EXPECT_NEAR(plan.levels[2].threshold, 0.1 * 3.14, 0.002);
  EXPECT_EQ(plan.levels[0].measure, "fallen_area_m2");
}

TEST(MapGrid, SurroundsTheOpening) {
  MapGrid grid = plan_of().grid;
  // The opening is 2 m wide: its box grown by 2 m is the whole domain.
  EXPECT_EQ(grid.corner, (Vec2{-3.0, -3.0}));
  EXPECT_DOUBLE_EQ(grid.cell, 0.05);
  EXPECT_EQ(grid.columns, 120);
  EXPECT_EQ(grid.rows, 120);
  grid = plan_of({"excavation.gallery.center=[1.0, 0.5]", "excavation.gallery.diameter=1.0",
                  "study.map.cell=0.3"})
             .grid;
  EXPECT_NEAR(grid.corner.x, -0.5, 1e-9);
  EXPECT_NEAR(grid.corner.y, -1.0, 2e-3);  // of 96 chords
  EXPECT_EQ(grid.columns, 10);
  EXPECT_THROW(plan_of({"study.map.cell=1e-4"}), InputError);
}

}  // namespace
}  // namespace keyblock::study
