#include "record/stage.h"

#include <gtest/gtest.h>

#include <vector>

#include "../scene.h"

namespace keyblock::simulation {
namespace {

std::vector<bool> which_wear(const std::vector<record::Stage>& stages) {
  std::vector<bool> wear;
  for (std::size_t k = 0; k < stages.size(); ++k) wear.push_back(wears_joints(stages, k));
  return wear;
}

TEST(WearOfJoints, BeginsAfterGravityIsTurnedOn) {
  const record::Stage settle = stage("settle", record::StageKind::settle),
                      rest = stage("rest", record::StageKind::rest, 1.0);
  EXPECT_EQ(which_wear({settle, rest, settle}), (std::vector{false, true, true}));
  EXPECT_EQ(which_wear({settle, settle, rest}), (std::vector{false, false, true}));
  EXPECT_EQ(which_wear({rest, settle}), (std::vector{true, true}));
}

TEST(WearOfJoints, BeginsWhereSomethingIsOpenedShakenOrInstalled) {
  const record::Stage settle = stage("settle", record::StageKind::settle),
                      rest = stage("rest", record::StageKind::rest, 1.0);
  record::Stage opens = settle, leans = settle, installs = settle;
  opens.excavate = {0};
  leans.k_h = 0.1;
  installs.install = {"anchor"};
  for (const record::Stage& first : {opens, leans, installs})
    EXPECT_TRUE(wears_joints(std::vector{first, rest}, 0));
  EXPECT_EQ(which_wear({settle, opens, settle, rest}), (std::vector{false, true, true, true}));
}

TEST(WearOfJoints, IsThereWhereNothingFollows) {
  EXPECT_TRUE(wears_joints(std::vector{stage("settle", record::StageKind::settle)}, 0));
}

TEST(WearOfJoints, IsWhatTheStageSays) {
  record::Stage settle = stage("settle", record::StageKind::settle),
                rest = stage("rest", record::StageKind::rest, 1.0);
  settle.wears_joints = true;
  rest.wears_joints = false;
  EXPECT_EQ(which_wear({settle, rest}), (std::vector{true, false}));
}

}  // namespace
}  // namespace keyblock::simulation
