#include "scenario/parse.h"

#include <gtest/gtest.h>

#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

std::string with(const std::string& more) {
  return two_blocks + more;
}

TEST(Defaults, OfWhatIsNotInTheFile) {
  const Scenario s = parse(two_blocks);
  EXPECT_EQ(s.title, "");
  EXPECT_EQ(s.seed, 1U);
  EXPECT_EQ(s.gravity, (Vec2{0.0, -9.81}));
  EXPECT_FALSE(s.section_azimuth);
  EXPECT_FALSE(s.domain);
  EXPECT_EQ(s.rock.state, block::PlaneState::plane_stress);
  EXPECT_EQ(s.rock.order, 1);
  EXPECT_FALSE(s.joints.cohesion);
  EXPECT_FALSE(s.blocks[1].fixed);
  EXPECT_EQ(s.blocks[1].velocity, Vec2{});
  EXPECT_EQ(s.stages[0].scale, 1.0);
  EXPECT_EQ(s.stages[0].motion, -1);
  EXPECT_EQ(s.solver.theta, dynamics::SolverOptions{}.theta);
  EXPECT_EQ(s.output.frame_interval, simulation::OutputOptions{}.frame_interval);
  EXPECT_FALSE(s.damage.fall_distance);
}

TEST(Domain, FrameAndFree) {
  const Scenario frame = parse(jointed_domain, {"domain.frame_friction=20"});
  EXPECT_TRUE(frame.domain->frame);
  EXPECT_EQ(frame.domain->frame_friction, 20.0);
  EXPECT_FALSE(parse(jointed_domain, {"domain.boundary=free"}).domain->frame);
}

TEST(JointSet, DistributionsAsNumberOrTable) {
  const std::string table = "joint_set.bedding.length={mean=2, std=0.5, distribution=\"lognormal\"}";
  const rockmass::JointSet set = parse(jointed_domain, {table}).joint_sets[0].set;
  EXPECT_EQ(set.spacing.kind, rockmass::DistributionKind::constant);
  EXPECT_EQ(set.spacing.mean, 0.5);
  EXPECT_EQ(set.length.kind, rockmass::DistributionKind::lognormal);
  EXPECT_EQ(set.length.mean, 2.0);
  EXPECT_EQ(set.length.std, 0.5);
}

TEST(JointSet, StandardDeviationWhereItHasAMeaning) {
  const auto spacing = [](const std::string& rest) {
    return mistakes(jointed_domain, {"joint_set.bedding.spacing={mean=2, distribution=" + rest + "}"});
  };
  EXPECT_EQ(spacing("\"exponential\""), "");
  EXPECT_EQ(spacing("\"exponential\", std=1"), "");
  EXPECT_EQ(spacing("\"constant\""), "");
  EXPECT_NE(spacing("\"normal\""), "");
  EXPECT_NE(spacing("\"uniform\""), "");
  EXPECT_EQ(spacing("\"uniform\", std=1"), "");
}

TEST(JointSet, OptionalKeys) {
  const Scenario s = parse(
      jointed_domain, {"joint_set.bedding.spacing_measure=trace", "joint_set.bedding.dip_std=3",
                       "joint_set.bedding.dip_direction_std=5", "joint_set.bedding.friction=25",
                       "joint_set.bedding.normal_stiffness=1e10", "joint_set.bedding.shear_stiffness=5e9"});
  EXPECT_EQ(s.joint_sets[0].set.spacing_measure, rockmass::SpacingMeasure::trace_spacing);
  EXPECT_EQ(s.joint_sets[0].set.dip_std, 3.0);
  EXPECT_EQ(s.joint_sets[0].set.dip_direction_std, 5.0);
  EXPECT_EQ(s.joint_sets[0].joints.friction, 25.0);
  EXPECT_EQ(s.joint_sets[0].joints.shear_stiffness, 5e9);
}

TEST(Blocks, RingsMayRunEitherWayAndBeClosed) {
  const Scenario s = parse(two_blocks, {"block.top.outer=[[1,1],[1,2],[3,2],[3,1],[1,1]]"});
  EXPECT_EQ(s.blocks[1].polygon.outer.size(), 4U);
  EXPECT_GT(signed_area(s.blocks[1].polygon.outer), 0.0);
}

TEST(Blocks, Holes) {
  const Scenario s = parse(two_blocks, {"block.top.holes=[[[1.5,1.2],[2.5,1.2],[2.5,1.8]]]"});
  ASSERT_EQ(s.blocks[1].polygon.holes.size(), 1U);
  EXPECT_LT(signed_area(s.blocks[1].polygon.holes[0]), 0.0);
}

TEST(Loads, TractionIsConstantUnlessItsEndIsGiven) {
  const Scenario s = parse(with(R"(
[[load]]
block = "top"
from = [1, 2]
to = [3, 2]
traction = [0, -5]
)"));
  EXPECT_TRUE(s.loads[0].is_line);
  EXPECT_EQ(s.loads[0].value_end, (Vec2{0.0, -5.0}));
}

TEST(Supports, AlongAnEdgeInOneDirection) {
  const Scenario s = parse(with(R"(
[[support]]
block = "top"
from = [1, 1]
to = [1, 2]
directions = ["y"]
stiffness = 1e12
)"));
  EXPECT_TRUE(s.supports[0].is_edge);
  EXPECT_EQ(s.supports[0].points, (std::vector{Vec2{1.0, 1.0}, Vec2{1.0, 2.0}}));
  EXPECT_FALSE(s.supports[0].along_x);
  EXPECT_TRUE(s.supports[0].along_y);
  EXPECT_EQ(s.supports[0].stiffness, 1e12);
}

TEST(Motions, TableAndSine) {
  const Scenario s = parse(with(R"(
[[motion]]
name = "table"
x = [[0, 0], [1, 2], [1, 3]]

[[motion]]
name = "sine"
x = { amplitude = 2, frequency = 1.5, cycles = 4 }
y = [[0, 1], [2, 1]]

[[stage]]
name = "shaken"
kind = "shake"
motion = "sine"
scale = 0.5
)"));
  ASSERT_EQ(s.motions.size(), 2U);
  EXPECT_EQ(s.motions[0].x.size(), 3U);
  EXPECT_EQ(s.motions[0].x[2], (std::pair{1.0, 3.0}));
  ASSERT_TRUE(s.motions[1].sine_x);
  EXPECT_EQ(s.motions[1].sine_x->frequency, 1.5);
  EXPECT_EQ(s.motions[1].y.size(), 2U);
  EXPECT_EQ(s.stages[1].motion, 1);
  EXPECT_EQ(s.stages[1].scale, 0.5);
}

TEST(Stages, SettleUnderWhateverHasToBeCarried) {
  const auto settling = [](const std::string& more) {
    return mistakes(with(more), {"gravity=[0, 0]", "stage=[{name=\"s\", kind=\"settle\"}]"});
  };
  EXPECT_NE(settling(""), "");
  EXPECT_EQ(settling("[in_situ]\nsxy = 1e3\n"), "");
  EXPECT_EQ(settling("[[load]]\nblock = \"top\"\npoint = [2, 2]\nforce = [0, -1e3]\n"), "");
  EXPECT_EQ(settling("[[load]]\nblock = \"top\"\nfrom = [1, 2]\nto = [3, 2]\ntraction = [0, 0]\n"
                     "traction_end = [0, -1e3]\n"),
            "");
}

TEST(Study, ValuesAreKeptAsToml) {
  const Scenario s = parse(with(R"(
[study]
realizations = 100
[[study.vary]]
key = "stage.quiet.duration"
values = [0.5, 1]
[[study.vary]]
key = "block.top.fixed"
values = [true, false]
)"));
  ASSERT_TRUE(s.study);
  EXPECT_EQ(s.study->realizations, 100);
  ASSERT_EQ(s.study->vary.size(), 2U);
  EXPECT_EQ(s.study->vary[0].key_text(), "stage.quiet.duration");
  using Values = std::vector<std::vector<std::string>>;
  EXPECT_EQ(s.study->vary[0].values, (Values{{"0.5"}, {"1"}}));
  EXPECT_EQ(s.study->vary[1].values, (Values{{"true"}, {"false"}}));
}

TEST(Study, OverridesMadeFromItAreRead) {
  const Scenario s = parse(with("[[study.vary]]\nkey = \"rock.order\"\nvalues = [2]\n"));
  const auto& vary = s.study->vary[0];
  EXPECT_EQ(parse(two_blocks, {vary.keys[0] + "=" + vary.values[0][0]}).rock.order, 2);
}

TEST(Study, KeysThatVaryTogether) {
  const Scenario s = parse(with(R"(
[study]
[[study.vary]]
keys = ["stage.quiet.duration", "block.top.fixed"]
values = [[0.5, true], [1, false]]
)"));
  ASSERT_EQ(s.study->vary.size(), 1U);
  EXPECT_EQ(s.study->vary[0].key_text(), "stage.quiet.duration + block.top.fixed");
  EXPECT_EQ(s.study->vary[0].value_text(1), "1, false");
}

TEST(Study, AValueVariesOnceHoweverItsKeyIsWritten) {
  const auto axes = [](const std::string& one, const std::string& other) {
    return mistakes(with("[[study.vary]]\nkey = \"" + one + "\"\nvalues = [1.0]\n[[study.vary]]\nkey = \"" +
                         other + "\"\nvalues = [1.0]\n"));
  };
  EXPECT_EQ(axes("stage.quiet.duration", "stage[0].duration"),
            "test.toml:29:7: stage[0].duration: found a key that varies already; expected every key once; "
            "'stage.quiet.duration' is the same value");
  EXPECT_NE(axes("stage.0.duration", "stage.quiet.duration"), "");
  EXPECT_EQ(axes("stage.quiet.duration", "time.step"), "");
}

TEST(Study, ATableVariesBeforeWhatIsInIt) {
  const std::string table = "[[study.vary]]\nkey = \"rock\"\nvalues = [{density=1, young=1, poisson=0}]\n";
  const std::string value = "[[study.vary]]\nkey = \"rock.young\"\nvalues = [1, 2]\n";
  EXPECT_EQ(mistakes(with(table + value)), "");
  EXPECT_NE(
      mistakes(with(value + table)).find("rock: found a key that holds 'rock.young', which varies already"),
      std::string::npos);
}

TEST(Study, EqualValuesAreTheSame) {
  const auto again = [](const std::string& key, const std::string& values) {
    return mistakes(with("[[study.vary]]\n" + key + "\nvalues = " + values + "\n"))
               .find(" again; expected") != std::string::npos;
  };
  EXPECT_TRUE(again("key = \"stage.quiet.duration\"", "[1, 2, 1.0]"));
  EXPECT_TRUE(again("key = \"stage.quiet.duration\"", "[1.5, 15e-1]"));
  EXPECT_FALSE(again("key = \"stage.quiet.duration\"", "[1, 2]"));
  EXPECT_TRUE(again("keys = [\"stage.quiet.duration\", \"block.top.fixed\"]", "[[1, true], [1.0, true]]"));
  EXPECT_FALSE(again("keys = [\"stage.quiet.duration\", \"block.top.fixed\"]", "[[1, true], [1.0, false]]"));
  // Seeds are integers that numbers cannot tell apart.
  EXPECT_FALSE(again("key = \"seed\"", "[9007199254740992, 9007199254740993]"));
}

std::string refused_combinations(const std::string& study) {
  try {
    read_combinations(with(study), "test.toml", {}, [](const Scenario&) {});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Study, EveryCombinationIsRead) {
  std::vector<std::pair<double, double>> read;
  read_combinations(with("[[study.vary]]\nkey = \"rock.young\"\nvalues = [1, 2]\n"
                         "[[study.vary]]\nkey = \"rock.density\"\nvalues = [3, 4]\n"),
                    "test.toml", {"seed=2"}, [&](const Scenario& s) {
                      read.emplace_back(*s.rock.young, *s.rock.density);
                      EXPECT_EQ(s.seed, 2U);
                    });
  EXPECT_EQ(read, (std::vector<std::pair<double, double>>{{1, 3}, {1, 4}, {2, 3}, {2, 4}}));
  EXPECT_EQ(refused_combinations("[study]\nrealizations = 2\n"), "");
}

TEST(Study, ACombinationThatARunWouldRefuse) {
  const std::string short_stage = "[[study.vary]]\nkey = \"stage.quiet.duration\"\nvalues = [0.005, 0.2]\n";
  EXPECT_EQ(
      refused_combinations(short_stage),
      "test.toml:27:11: stage.quiet.duration: found 0.005 s, 0.5 steps of 0.01 s; expected 1 to 1e+09 steps; "
      "with stage.quiet.duration = 0.005");
  // Each of these values is right beside those of the file.
  const std::string steps = "[[study.vary]]\nkey = \"time.step\"\nvalues = [0.01, 0.5]\n";
  EXPECT_EQ(
      refused_combinations("[[study.vary]]\nkey = \"stage.quiet.duration\"\nvalues = [0.1, 2]\n" + steps),
      "test.toml:27:11: stage.quiet.duration: found 0.1 s, 0.2 steps of 0.5 s; expected 1 to 1e+09 steps; "
      "with stage.quiet.duration = 0.1, time.step = 0.5");
}

TEST(Study, AllItsTables) {
  const Scenario s = parse(with(R"(
[study]
stage = "quiet"
confidence = 0.9
keep = "measures"
until = { measure = "fallen_area_m2", half_width = 0.1, minimum = 5, maximum = 50 }
marginal = { friction = 2.0 }
map = { cell = 0.25 }
[[study.level]]
name = "any"
measure = "fallen_blocks"
threshold = 0
)"));
  const StudySpec& study = *s.study;
  EXPECT_EQ(study.stage, "quiet");
  EXPECT_EQ(study.confidence, 0.9);
  EXPECT_EQ(study.keep, Keep::measures);
  ASSERT_TRUE(study.until && study.marginal && study.map_cell);
  EXPECT_EQ(study.until->maximum, 50);
  EXPECT_EQ(study.marginal->friction, 2.0);
  EXPECT_EQ(study.marginal->share, 0.5);
  EXPECT_EQ(*study.map_cell, 0.25);
  ASSERT_EQ(study.levels.size(), 1U);
  EXPECT_EQ(study.levels[0].measure, "fallen_blocks");
}

TEST(Study, CanBeLeftOut) {
  const std::string text = with("[study]\nrealizations = 3\n");
  EXPECT_FALSE(parse_scenario_text(text, "s.toml", {}, StudyTable::leave_out).study);
  EXPECT_EQ(to_toml(document_without_study(text, "s.toml", {})),
            to_toml(document_without_study(with("# nothing\n"), "s.toml", {})));
  EXPECT_NE(to_toml(document_without_study(text, "s.toml", {"rock.young=2e9"})),
            to_toml(document_without_study(text, "s.toml", {})));
}

TEST(Positions, OfValuesAndOfTheNearestTable) {
  const Scenario s = parse(two_blocks);
  EXPECT_EQ(s.where("rock.young").line, 3);
  EXPECT_EQ(s.where("rock.young").column, 9);
  EXPECT_EQ(s.where("block.top.outer").line, 19);
  EXPECT_EQ(s.where("block.top.spin").line, 17);
  EXPECT_EQ(s.where("nowhere").line, 1);
  EXPECT_EQ(s.where("nowhere").file, s.file);
}

TEST(Positions, OfMistakesAreExact) {
  try {
    parse_scenario_text(
        "[rock]\ndensity =  -1.0\nyoung = 1e9\npoisson = 0.2\n[[block]]\nouter = [[0,0], [1,0], [0, \"1\"]]",
        "f.toml");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2U);
    EXPECT_EQ(error.diagnostics()[0].where.line, 2);
    EXPECT_EQ(error.diagnostics()[0].where.column, 12);
    EXPECT_EQ(error.diagnostics()[0].key, "rock.density");
    EXPECT_EQ(error.diagnostics()[1].where.line, 6);
    EXPECT_EQ(error.diagnostics()[1].where.column, 24);
    EXPECT_EQ(error.diagnostics()[1].key, "block[0].outer[2]");
  }
}

TEST(Parse, AFileThatIsNotThere) {
  EXPECT_THROW(parse_scenario("no/such/file.toml"), InputError);
}

}  // namespace
}  // namespace keyblock::scenario
