#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/atomic_file.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

const std::filesystem::path data = std::filesystem::path(KEYBLOCK_TEST_DATA) / "scenario";

TEST(Tunnel, SectionDomainAndRock) {
  const Scenario s = parse_scenario(examples / "01-tunnel.toml");
  EXPECT_EQ(s.title, "Circular tunnel in three joint sets (Hsiung & Shi 2001)");
  EXPECT_EQ(s.seed, 2001U);
  EXPECT_EQ(s.gravity, (Vec2{0.0, -9.81}));
  EXPECT_EQ(s.section_azimuth, 165.0);
  ASSERT_TRUE(s.domain);
  EXPECT_EQ(s.domain->x, (std::pair{-10.0, 10.0}));
  EXPECT_EQ(s.domain->y, (std::pair{-10.0, 10.0}));
  EXPECT_TRUE(s.domain->frame);
  EXPECT_EQ(s.domain->frame_friction, 0.0);
  EXPECT_EQ(s.rock.density, 2270.0);
  EXPECT_EQ(s.rock.young, 3.0e9);
  EXPECT_EQ(s.rock.poisson, 0.21);
  EXPECT_EQ(s.rock.state, block::PlaneState::plane_stress);
  EXPECT_EQ(s.rock.order, 1);
  EXPECT_EQ(s.joints.friction, 39.0);
  EXPECT_FALSE(s.joints.normal_stiffness);
  EXPECT_FALSE(s.in_situ);
  EXPECT_FALSE(s.study);
}

TEST(Tunnel, JointSets) {
  const Scenario s = parse_scenario(examples / "01-tunnel.toml");
  ASSERT_EQ(s.joint_sets.size(), 3U);
  const rockmass::JointSet& j2 = s.joint_sets[1].set;
  EXPECT_EQ(j2.name, "J2");
  EXPECT_EQ(j2.dip, 81.0);
  EXPECT_EQ(j2.dip_direction, 230.0);
  EXPECT_EQ(j2.spacing_measure, rockmass::SpacingMeasure::true_spacing);
  EXPECT_EQ(j2.length.kind, rockmass::DistributionKind::uniform);
  EXPECT_EQ(j2.length.mean, 2.4);
  EXPECT_EQ(j2.length.std, 0.84);
  EXPECT_EQ(j2.gap.mean, 0.3);
  EXPECT_FALSE(s.joint_sets[1].joints.friction);
}

TEST(Tunnel, ExcavationMotionAndStages) {
  const Scenario s = parse_scenario(examples / "01-tunnel.toml");
  ASSERT_EQ(s.excavations.size(), 1U);
  EXPECT_EQ(s.excavations[0].shape, ExcavationShape::circle);
  EXPECT_EQ(s.excavations[0].diameter, 5.5);
  EXPECT_EQ(s.excavations[0].chords, 96);
  EXPECT_EQ(s.time_step, 0.002);

  ASSERT_EQ(s.motions.size(), 1U);
  ASSERT_EQ(s.motions[0].components.size(), 3U);
  EXPECT_EQ(s.motions[0].components[0].file, examples / "motions/0111a.smc");
  EXPECT_EQ(s.motions[0].components[0].azimuth, 360.0);
  EXPECT_EQ(s.motions[0].components[1].azimuth, 270.0);
  EXPECT_TRUE(s.motions[0].components[2].vertical);
  EXPECT_EQ(s.motions[0].window, (std::pair{5.0, 25.0}));

  using record::StageKind;
  ASSERT_EQ(s.stages.size(), 5U);
  EXPECT_EQ(s.stages[0].kind, StageKind::settle);
  EXPECT_TRUE(s.stages[0].excavate.empty());
  EXPECT_EQ(s.stages[1].excavate, std::vector{0});
  EXPECT_EQ(s.stages[2].kind, StageKind::rest);
  EXPECT_EQ(s.stages[2].duration, 2.0);
  EXPECT_EQ(s.stages[3].kind, StageKind::shake);
  EXPECT_EQ(s.stages[3].motion, 0);
  EXPECT_EQ(s.stages[3].scale, 1.0);
  EXPECT_FALSE(s.stages[3].duration);
  EXPECT_EQ(s.stages[4].name, "after");
  EXPECT_EQ(s.stages[4].duration, 5.0);
}

TEST(Explicit, Blocks) {
  const Scenario s = parse_scenario(data / "explicit.toml");
  EXPECT_FALSE(s.domain);
  ASSERT_EQ(s.blocks.size(), 2U);
  EXPECT_EQ(s.blocks[0].name, "base");
  EXPECT_TRUE(s.blocks[0].fixed);
  EXPECT_EQ(s.blocks[0].polygon.outer.size(), 3U);
  EXPECT_NEAR(area(s.blocks[0].polygon), 28.86751345948129, 1e-12);
  EXPECT_FALSE(s.blocks[1].fixed);
  EXPECT_EQ(s.blocks[1].rock.order, 3);
  EXPECT_FALSE(s.blocks[1].rock.density);
}

TEST(Explicit, LoadsSupportsHistories) {
  const Scenario s = parse_scenario(data / "explicit.toml");
  ASSERT_EQ(s.loads.size(), 2U);
  EXPECT_FALSE(s.loads[0].is_line);
  EXPECT_EQ(s.loads[0].block, "slider");
  EXPECT_EQ(s.loads[0].from, (Vec2{1.5, 6.066}));
  EXPECT_EQ(s.loads[0].value, (Vec2{0.0, -1.0}));
  EXPECT_EQ(s.loads[0].factor(0.25), 0.25);
  EXPECT_TRUE(s.loads[1].is_line);
  EXPECT_EQ(s.loads[1].to, (Vec2{1.5, 6.066}));
  EXPECT_EQ(s.loads[1].value, (Vec2{0.0, 10.0}));
  EXPECT_EQ(s.loads[1].value_end, (Vec2{0.0, 20.0}));
  EXPECT_TRUE(s.loads[1].factor.empty());

  ASSERT_EQ(s.supports.size(), 1U);
  EXPECT_FALSE(s.supports[0].is_edge);
  EXPECT_EQ(s.supports[0].points, (std::vector{Vec2{1.0, 5.2}}));
  EXPECT_TRUE(s.supports[0].along_x);
  EXPECT_TRUE(s.supports[0].along_y);
  EXPECT_FALSE(s.supports[0].stiffness);
  EXPECT_EQ(s.supports[0].motion_x(0.5), 0.25);
  EXPECT_TRUE(s.supports[0].motion_y.empty());

  ASSERT_EQ(s.histories.size(), 1U);
  EXPECT_EQ(s.histories[0].name, "s");
  EXPECT_EQ(s.histories[0].block, "slider");
  EXPECT_EQ(s.histories[0].point, (Vec2{1.433, 5.633}));
}

// The lines of a scenario without the remarks behind them; keys that are commented out stay.
std::vector<std::string> lines_without_remarks(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    line.resize(std::min(line.size(), line.find('#', 1)));
    line.resize(line.find_last_not_of(' ') + 1);
    lines.push_back(line);
  }
  return lines;
}

// The two scenarios are quoted from the description of the product, where it is at hand. Ours may say more in front.
TEST(Product, ScenariosAreThoseOfItsDescription) {
  const auto page = std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "../shared/design/product.md";
  if (!exists(page)) GTEST_SKIP() << page << " is not there";
  const std::string text = read_file(page), mark = "```toml\n";
  std::size_t at = 0;
  for (const auto& file : {examples / "01-tunnel.toml", data / "explicit.toml"}) {
    at = text.find(mark, at) + mark.size();
    const auto quoted = lines_without_remarks(text.substr(at, text.find("```", at) - at));
    const auto ours = lines_without_remarks(read_file(file));
    ASSERT_GE(ours.size(), quoted.size()) << file;
    EXPECT_EQ(std::vector(ours.end() - std::ssize(quoted), ours.end()), quoted) << file;
  }
}

}  // namespace
}  // namespace keyblock::scenario
