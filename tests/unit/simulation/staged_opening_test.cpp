#include "simulation/staged_opening.h"

#include <gtest/gtest.h>

#include <numbers>

#include "../fresh_folder.h"
#include "../scene.h"
#include "core/error.h"
#include "simulation/runner.h"
#include "simulation/wall_faces.h"

namespace keyblock::simulation {
namespace {

/// Nine blocks of 1 m under pressure within fixed ones. The one in the middle is excavated.
Scene pressed_blocks() {
  Scene scene(1e9, 60.0);
  scene.rectangle({-1.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({3.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({0.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 3.0}, 3.0, 1.0, 0.0, true);
  for (const double y : {0.0, 1.0, 2.0}) {
    for (const double x : {0.0, 1.0, 2.0}) scene.rectangle({x, y}, 1.0, 1.0, 0.0, false, 2);
  }
  scene.setup.system.blocks[8].excavations = {0};
  scene.setup.excavations.push_back({"middle", {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}});
  scene.setup.gravity = {};
  scene.setup.in_situ = block::InSituStress{.sxx = -1e6, .syy = -1e6};
  scene.setup.time_step = 0.002;
  return scene;
}

record::Stage opens(const char* name, double share, int parts) {
  record::Stage s = stage(name, record::StageKind::settle);
  s.tolerance = 1e-7;
  s.excavate = {0};
  s.release = {{0, share}};
  s.release_steps = parts;
  return s;
}

record::Stage releases(const char* name, double share, int parts) {
  record::Stage s = opens(name, share, parts);
  s.excavate.clear();
  return s;
}

record::Stage settles() {
  record::Stage s = stage("in place", record::StageKind::settle);
  s.tolerance = 1e-7;
  return s;
}

record::RunRecord run_of(const RunSetup& setup) {
  record::RunObserver nobody;
  return run(setup, {}, nobody);
}

TEST(StagedOpening, NothingReleasedMovesNothing) {
  Scene scene = pressed_blocks();
  scene.setup.stages = {settles(), opens("open", 0.0, 10)};
  const record::RunRecord record = run_of(scene.setup);
  ASSERT_EQ(record.stages.size(), 2);
  const record::StageRecord& open = record.stages[1];
  EXPECT_TRUE(open.equilibrium_reached);
  EXPECT_LT(open.damage.displacement_max, 1e-9);
  ASSERT_EQ(open.release.size(), 2);
  EXPECT_LT(std::abs(open.release[1].crown), 1e-9);
  EXPECT_LT(std::abs(open.release[1].mean), 1e-9);
}

TEST(StagedOpening, PartsSumToTheWhole) {
  Scene scene = pressed_blocks();
  scene.setup.stages = {settles(), opens("open", 0.4, 10)};
  const std::vector<record::ReleasePoint> in_parts = run_of(scene.setup).stages[1].release;
  scene.setup.stages[1].release_steps = 1;
  const std::vector<record::ReleasePoint> at_once = run_of(scene.setup).stages[1].release;
  scene.setup.stages[1].release[0].second = 0.1;
  scene.setup.stages.push_back(releases("more", 0.4, 3));
  const std::vector<record::ReleasePoint> in_stages = run_of(scene.setup).stages[2].release;
  ASSERT_EQ(in_parts.size(), 11);
  ASSERT_EQ(at_once.size(), 2);
  ASSERT_EQ(in_stages.size(), 3);
  const double whole = at_once[1].crown;
  EXPECT_GT(whole, 1e-5);
  for (std::size_t k = 1; k <= 10; ++k) {
    EXPECT_NEAR(in_parts[k].released, 0.04 * static_cast<double>(k), 1e-15);
    EXPECT_NEAR(in_parts[k].crown, 0.1 * static_cast<double>(k) * whole, 1e-4 * whole);
  }
  EXPECT_NEAR(in_stages[2].crown, whole, 1e-4 * whole);
  EXPECT_EQ(in_stages[2].released, 0.4);
}

TEST(StagedOpening, AllReleasedIsWhereOpeningAtOnceEnds) {
  Scene scene = pressed_blocks();
  // So little that corners do not slip past each other: what they do depends on the way.
  scene.setup.in_situ = block::InSituStress{.sxx = -1e5, .syy = -1e5};
  scene.setup.stages = {settles(), opens("open", 1.0, 5)};
  const record::RunRecord in_parts = run_of(scene.setup);
  scene.setup.stages[1].release_steps = 1;
  const record::RunRecord in_one_part = run_of(scene.setup);
  scene.setup.stages[1].release.clear();
  const record::RunRecord at_once = run_of(scene.setup);
  EXPECT_TRUE(at_once.stages[1].release.empty());
  EXPECT_EQ(in_one_part.state_hash, at_once.state_hash);
  const double whole = at_once.stages[1].damage.closure_vertical;
  EXPECT_GT(whole, 1e-5);
  EXPECT_NEAR(in_parts.stages[1].damage.closure_vertical, whole, 1e-5 * whole);
  EXPECT_LT(in_parts.energy.residual_ratio, at_once.energy.residual_ratio);
  EXPECT_LT(in_parts.energy.residual_ratio, 1e-5);
}

TEST(StagedOpening, GoesOnFromACheckpointInTheSameBits) {
  Scene scene = pressed_blocks();
  scene.setup.stages = {settles(), opens("open", 0.3, 4), releases("more", 0.9, 3)};
  const record::RunRecord whole = run_of(scene.setup);
  const FreshFolder folder;
  RunOptions options;
  options.directory = folder;
  record::RunObserver nobody;
  {
    Runner runner(scene.setup, options, nobody);
    while (!runner.done() && runner.stage() < 2) runner.advance();
    runner.advance();
    EXPECT_FALSE(runner.state().walls.forces.empty());
  }
  options.resume = true;
  const record::RunRecord resumed = run(scene.setup, options, nobody);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
  ASSERT_EQ(resumed.stages.size(), 3);
  for (std::size_t k : {1U, 2U}) {
    ASSERT_EQ(resumed.stages[k].release.size(), whole.stages[k].release.size());
    EXPECT_EQ(resumed.stages[k].release.back().crown, whole.stages[k].release.back().crown);
    EXPECT_EQ(resumed.stages[k].release.back().step, whole.stages[k].release.back().step);
  }
}

/// A block between frictionless faces, so far from them, on rock that is excavated.
Scene hanging_block(double gap) {
  Scene scene(1e10, 0.0);
  scene.rectangle({-3.0, 0.0}, 2.5, 1.0, 0.0, true);
  scene.rectangle({0.5, 0.0}, 2.5, 1.0, 0.0, true);
  scene.rectangle({-0.5 + gap, 0.0}, 1.0 - 2.0 * gap, 1.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0);
  scene.rectangle({-3.0, -2.0}, 6.0, 1.0, 0.0, true);
  scene.setup.gravity = {0.0, -g};
  scene.setup.system.blocks[3].excavations = {0};
  scene.setup.excavations.push_back({"room", {{-2.0, -1.0}, {2.0, -1.0}, {2.0, 0.0}, {-2.0, 0.0}}});
  scene.setup.time_step = 0.002;
  return scene;
}

TEST(StagedOpening, ForcesOnABlockThatNothingElsePressesEnd) {
  Scene scene = hanging_block(0.01);
  scene.setup.stages = {settles(), opens("open", 0.0, 1), stage("rest", record::StageKind::rest, 0.1)};
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  while (!runner.done()) runner.advance();
  EXPECT_EQ(runner.state().walls.left[2], 1);
  const record::RunRecord record = runner.finish();
  const double fall = record.stages[2].damage.displacement_max - record.stages[1].damage.displacement_max;
  EXPECT_NEAR(fall, 0.5 * g * 0.1 * 0.1, 0.03 * 0.5 * g * 0.1 * 0.1);
}

TEST(SupportPressure, IsThatOfTheStage) {
  Scene scene = hanging_block(0.0);
  const double weight = 2600.0 * g;
  scene.setup.stages = {settles(), stage("open", record::StageKind::rest, 0.1),
                        stage("less", record::StageKind::rest, 0.1)};
  scene.setup.stages[1].excavate = {0};
  scene.setup.excavations[0].pressure.over_stages = {{1, weight}, {2, 0.5 * weight}};
  const record::RunRecord record = run_of(scene.setup);
  EXPECT_LT(record.stages[1].damage.displacement_max, 1e-5);
  EXPECT_NEAR(record.stages[2].damage.displacement_max, 0.25 * g * 0.01, 0.03 * 0.25 * g * 0.01);
  EXPECT_LT(record.energy.residual_ratio, 1e-6);
}

TEST(SupportPressure, FollowsATable) {
  Scene scene = hanging_block(0.0);
  const double weight = 2600.0 * g;
  scene.setup.stages = {settles(), stage("open", record::StageKind::rest, 0.2)};
  scene.setup.stages[1].excavate = {0};
  scene.setup.excavations[0].pressure.over_time =
      loading::TimeTable({{0.0, weight}, {0.1, weight}, {0.1001, 0.0}});
  const record::RunRecord record = run_of(scene.setup);
  EXPECT_NEAR(record.stages[1].damage.displacement_max, 0.5 * g * 0.01, 0.05 * 0.5 * g * 0.01);
}

TEST(SupportPressure, NeedsRockToActOn) {
  Scene scene = hanging_block(0.0);
  scene.setup.excavations[0].pressure.constant = 1e3;
  EXPECT_NO_THROW(build_model(scene.setup));
  scene.setup.excavations[0].pressure.arc = std::pair(200.0, 340.0);  // all there is fixed
  EXPECT_THROW(build_model(scene.setup), InputError);
}

double length_of(const std::vector<dynamics::WallFace>& faces, const dynamics::Model& model) {
  double sum = 0.0;
  for (const dynamics::WallFace& face : faces) {
    const std::size_t v = static_cast<std::size_t>(face.vertex),
                      next = static_cast<std::size_t>(model.surface.next[v]);
    sum += (face.to - face.from) * norm(model.reference[next] - model.reference[v]);
  }
  return sum;
}

TEST(WallFaces, LieAroundTheOutlineAndWithinAnArc) {
  const Scene scene = pressed_blocks();
  const dynamics::Model model = build_model(scene.setup);
  EXPECT_NEAR(length_of(wall_faces(scene.setup, model, 0), model), 4.0, 1e-9);
  const auto within = [&](double from, double to) {
    return length_of(wall_faces(scene.setup, model, 0, std::pair(from, to)), model);
  };
  EXPECT_NEAR(within(45.0, 135.0), 1.0, 1e-9);
  EXPECT_NEAR(within(-315.0, -225.0), 1.0, 1e-9);
  EXPECT_NEAR(within(0.0, 360.0), 4.0, 1e-9);
  EXPECT_NEAR(within(-30.0, 210.0), 2.0 + 2.0 * 0.5 * std::tan(30.0 * degree), 1e-9);
  EXPECT_NEAR(within(80.0, 100.0), 2.0 * 0.5 * std::tan(10.0 * degree), 1e-9);
}

TEST(WallFaces, EndWhereTheOutlineDoes) {
  // The outline is narrower than the block above it.
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, 0.0}, 4.0, 1.0);
  scene.rectangle({-1.0, -1.0}, 2.0, 1.0);
  scene.setup.system.blocks[1].excavations = {0};
  scene.setup.excavations.push_back({"room", {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}}});
  const dynamics::Model model = build_model(scene.setup);
  const std::vector<dynamics::WallFace> faces = wall_faces(scene.setup, model, 0);
  ASSERT_EQ(faces.size(), 1);
  EXPECT_NEAR(faces[0].from, 0.25, 1e-9);
  EXPECT_NEAR(faces[0].to, 0.75, 1e-9);
}

}  // namespace
}  // namespace keyblock::simulation
