#include "record/before_shaking.h"

#include <gtest/gtest.h>

namespace keyblock::record {
namespace {

Stage stage(StageKind kind, std::vector<int> excavate = {}) {
  Stage made;
  made.kind = kind;
  made.excavate = std::move(excavate);
  return made;
}

std::optional<std::size_t> last(const std::vector<Stage>& stages) {
  return last_before_shaking(stages);
}

TEST(LastBeforeShaking, IsTheStageBeforeTheFirstThatShakes) {
  EXPECT_EQ(last({stage(StageKind::settle), stage(StageKind::settle, {0}), stage(StageKind::rest),
                  stage(StageKind::shake), stage(StageKind::shake)}),
            2U);
  EXPECT_EQ(last({stage(StageKind::settle), stage(StageKind::shake)}), 0U);
}

TEST(LastBeforeShaking, AnOpeningIsShakenOnceItIsThere) {
  EXPECT_EQ(last({stage(StageKind::settle), stage(StageKind::shake), stage(StageKind::settle, {0}),
                  stage(StageKind::rest), stage(StageKind::shake)}),
            3U);
  EXPECT_EQ(last({stage(StageKind::settle), stage(StageKind::shake, {0}), stage(StageKind::shake)}), 0U);
}

TEST(LastBeforeShaking, IsNoneWhereNothingComesBeforeOrNothingShakes) {
  EXPECT_FALSE(last({}));
  EXPECT_FALSE(last({stage(StageKind::settle, {0}), stage(StageKind::rest)}));
  EXPECT_FALSE(last({stage(StageKind::shake, {0}), stage(StageKind::rest)}));
  EXPECT_FALSE(last({stage(StageKind::shake), stage(StageKind::settle, {0})}));
}

}  // namespace
}  // namespace keyblock::record
